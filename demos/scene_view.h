// Fills a draw list from a scene living in a Taut world.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "draw_parts.h"
#include "render/follow_camera.h"
#include "scenes/taut_world.h"

namespace demo {

// Joint forces on a logarithmic scale from blue to red.
class TensionScale {
public:
    explicit TensionScale(const scenes::Scene& scene);

    render::Colour colour(float force) const;  // [N]
    static render::Colour ramp(float t);       // t in [0, 1]
    int low_decade() const { return low_; }
    int high_decade() const { return high_; }

private:
    int low_ = 0, high_ = 5;  // powers of ten [N]
};

class SceneView {
public:
    // Uploads the hulls, meshes and height fields of the scene to the renderer and sets its stage.
    SceneView(const scenes::Scene& scene, const scenes::TautWorld& world, render::Renderer& renderer);

    render::Camera camera() const;
    // From here on the camera follows what the scene says, or all that moves. aspect: width over height.
    void follow(float aspect);
    void step();  // after each of the world's
    render::Stage stage() const;
    void add_bodies(render::DrawList& list, bool tension) const;
    void add_joints(render::DrawList& list, bool tension) const;
    void add_cables(render::DrawList& list, bool tension);
    void add_softs(render::DrawList& list);
    void add_curves(render::DrawList& list) const;
    void add_contacts(render::DrawList& list);
    const TensionScale& tension_scale() const { return scale_; }

private:
    void add_body(render::DrawList& list, size_t index, render::Colour colour) const;
    void add_shape(render::DrawList& list, int shape, const render::Instance& instance) const;
    void add_hinge(render::DrawList& list, size_t index, render::Vec3 at) const;
    void add_arms(render::DrawList& list, size_t index, const std::array<render::Vec3, 2>& anchors, bool tension) const;
    float needle_scale() const;
    struct Paint {
        render::Colour plain;
        bool both_sides;
        double most;  // of values_, at the top of the scale; 0: plain
    };
    void spread_over_vertices(const std::vector<uint32_t>& elements, size_t corners, size_t vertices);
    void put_on(const scenes::Skin& skin);
    void add_surface(render::DrawList& list, const Paint& paint) const;
    bool is_in_the_way(size_t index) const;
    float thickness_at(const scenes::Joint& joint) const;

    const scenes::Scene& scene_;
    const scenes::TautWorld& world_;
    render::Renderer& renderer_;
    std::optional<render::FollowCamera> follows_;
    TensionScale scale_;
    std::vector<uint32_t> meshes_;  // of each shape
    std::vector<taut_contact> contacts_;
    std::vector<taut_pos> points_;  // of a cable
    std::vector<float> tensions_;
    Surface surface_;                          // of a cloth or solid
    std::vector<float> values_, at_vertices_;  // strain or stress
};

}  // namespace demo
