// What pictures of scenes and of recordings are put together from.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "render/renderer.h"
#include "scenes/pose.h"
#include "scenes/scene.h"

namespace demo {

constexpr float kRodRadius = 0.04f, kRopeRadius = 0.028f, kPointRadius = 0.05f;  // drawn sizes [m]

inline render::Vec3 vec(taut_pos p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}
inline render::Quat quat(taut_quat q) { return {q.x, q.y, q.z, q.w}; }

render::Instance rod(render::Vec3 a, render::Vec3 b, float radius, render::Colour colour);
render::Instance ball(render::Vec3 centre, float radius, render::Colour colour, float gloss);

bool is_asleep(taut_body body);
// Of what sleeps, and of the back of a cloth.
render::Colour darker(const render::Colour& colour);

// The renderer's mesh of a shape: a builtin one, or its own, which is added.
uint32_t mesh_of(const scenes::Shape& shape, taut_shape handle, render::Renderer& renderer);
// A shape of that mesh where the instance is. Planes are the renderer's ground.
void add_shape(render::DrawList& list, const scenes::Shape& shape, uint32_t mesh, render::Instance instance);

// Where a world is in the picture: about an origin, its up turned to +y.
struct Placement {
    taut_pos origin{};
    taut_quat turn{0, 0, 0, 1};

    taut_pos picture(taut_pos p) const { return scenes::rotated(turn, scenes::minus(p, origin)); }
    taut_pos world(taut_pos p) const;
};

// Dynamic bodies and particles, vertices and points of cables among them.
std::vector<taut_body> moving_bodies(taut_world world);
// The box about bodies, and points of those without colliders [m]; none about none.
std::optional<scenes::Bounds> bounds_of(const std::vector<taut_body>& bodies);
float size_of(taut_vec3 gravity);  // [m/s^2]; that of the Earth for none, by which cameras still follow

// The eye not below the ground.
render::Camera above_ground(render::Camera camera, float height);

// A camera whose eye is in no body and behind no surface of triangles: else it comes nearer along its ray; and what
// stands on the way to what it looks at. filter: what counts.
struct ClearView {
    render::Camera camera;
    std::vector<taut_body> between;  // static bodies
};
ClearView clear_view(render::Camera camera, taut_world world, const Placement& placement,
                     const taut_query_filter& filter);

// The whole of an array of the library's; entries: numbers in each.
template <class Read, class Handle, class T>
taut_result read_all(Read read, Handle handle, std::vector<T>& out, size_t entries = 1) {
    uint32_t count = 0;
    read(handle, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
    out.resize(count * entries);
    return read(handle, out.data(), count, &count);
}

// The triangles of a cloth or solid as they are.
struct Surface {
    std::vector<taut_pos> points;
    std::vector<taut_vec3> normals;
    std::vector<uint32_t> triangles;

    void read(taut_cloth cloth);
    void read(taut_solid solid);
    void add(render::DrawList& list, const std::function<render::Colour(uint32_t)>& colour_of_vertex,
             bool both_sides) const;
};

}  // namespace demo
