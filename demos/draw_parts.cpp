#include "draw_parts.h"

#include <algorithm>
#include <cmath>

#include "scenes/taut_world.h"
#include "shape_mesh.h"

namespace demo {

using render::Colour;
using render::Instance;
using render::Vec3;
using scenes::ShapeKind;

Instance rod(Vec3 a, Vec3 b, float radius, Colour colour) {
    Vec3 along = b - a;
    float half = 0.5f * length(along);
    Instance instance;
    instance.mesh = render::kMeshCylinder;
    instance.position = (a + b) * 0.5f;
    instance.scale = {radius, std::max(half, 1e-4f), radius};
    instance.rotation = render::from_y_to(half > 0 ? normalised(along) : Vec3{0, 1, 0});
    instance.colour = colour;
    return instance;
}

Instance ball(Vec3 centre, float radius, Colour colour, float gloss) {
    Instance instance;
    instance.mesh = render::kMeshSphere;
    instance.position = centre;
    instance.scale = {radius, radius, radius};
    instance.colour = colour;
    instance.gloss = gloss;
    return instance;
}

bool is_asleep(taut_body body) {
    uint32_t awake = 1;
    scenes::check(taut_body_get_awake(body, &awake), "asking whether a body is awake");
    return awake == 0;
}

Colour darker(const Colour& colour) { return {0.4f * colour.x, 0.4f * colour.y, 0.4f * colour.z}; }

uint32_t mesh_of(const scenes::Shape& shape, taut_shape handle, render::Renderer& renderer) {
    if (shape.kind == ShapeKind::sphere) return render::kMeshSphere;
    if (shape.kind == ShapeKind::cylinder) return render::kMeshDrum;
    const std::vector<render::Vertex> own = own_mesh(shape, handle);
    return own.empty() ? render::kMeshBox : renderer.add_mesh(own);
}

void add_shape(render::DrawList& list, const scenes::Shape& shape, uint32_t mesh, Instance instance) {
    instance.mesh = mesh;
    const float r = shape.radius;
    switch (shape.kind) {
        case ShapeKind::plane:
            return;
        case ShapeKind::box:
            instance.scale = {shape.half_extents.x, shape.half_extents.y, shape.half_extents.z};
            break;
        case ShapeKind::sphere:
            instance.scale = {r, r, r};
            break;
        case ShapeKind::cylinder:
            instance.scale = {r, shape.half_length, r};
            break;
        case ShapeKind::hull:
        case ShapeKind::scaled_hull:
        case ShapeKind::mesh:
        case ShapeKind::height_field:
        case ShapeKind::cone:
        case ShapeKind::tapered_capsule:
            break;  // meshes of their own
        case ShapeKind::capsule: {
            const Vec3 half = rotate(instance.rotation, {0, shape.half_length, 0});
            Instance pieces[] = {rod(instance.position - half, instance.position + half, r, instance.colour),
                                 ball(instance.position - half, r, instance.colour, instance.gloss),
                                 ball(instance.position + half, r, instance.colour, instance.gloss)};
            for (Instance& piece : pieces) {
                piece.pass = instance.pass;
                list.instances.push_back(piece);
            }
            return;
        }
    }
    list.instances.push_back(instance);
}

taut_pos Placement::world(taut_pos p) const {
    const taut_pos back = scenes::rotated(scenes::inverse(turn), p);
    return scenes::plus(back, origin.x, origin.y, origin.z);
}

std::vector<taut_body> moving_bodies(taut_world world) {
    std::vector<taut_body> bodies;
    scenes::check(read_all(taut_world_get_bodies, world, bodies), "listing the bodies");
    std::erase_if(bodies, [](taut_body body) {
        taut_body_kind kind = TAUT_BODY_STATIC;
        uint32_t enabled = 0;
        scenes::check(taut_body_get_kind(body, &kind), "reading a body's kind");
        scenes::check(taut_body_get_enabled(body, &enabled), "asking whether a body is enabled");
        return enabled == 0 || (kind != TAUT_BODY_DYNAMIC && kind != TAUT_BODY_PARTICLE);
    });
    return bodies;
}

std::optional<scenes::Bounds> bounds_of(const std::vector<taut_body>& bodies) {
    std::optional<scenes::Bounds> box;
    for (const taut_body body : bodies) {
        scenes::Bounds own;
        if (taut_body_get_bounds(body, &own.low, &own.high) != TAUT_OK) {
            taut_pose pose{};
            scenes::check(taut_body_get_pose(body, &pose), "reading a pose");
            own = {pose.position, pose.position};
        }
        if (!box) box = own;
        box->low = {std::min(box->low.x, own.low.x), std::min(box->low.y, own.low.y), std::min(box->low.z, own.low.z)};
        box->high = {std::max(box->high.x, own.high.x), std::max(box->high.y, own.high.y),
                     std::max(box->high.z, own.high.z)};
    }
    return box;
}

float size_of(taut_vec3 gravity) {
    const float size = std::hypot(gravity.x, gravity.y, gravity.z);
    return size > 0 ? size : 9.81f;
}

render::Camera above_ground(render::Camera camera, float height) {
    const float clear = 2 * render::near_plane(camera);
    camera.eye.y = std::max(camera.eye.y, height + clear);
    return camera;
}

ClearView clear_view(render::Camera camera, taut_world world, const Placement& placement,
                     const taut_query_filter& filter) {
    const taut_pos from = placement.world({camera.target.x, camera.target.y, camera.target.z});
    const taut_pos to = placement.world({camera.eye.x, camera.eye.y, camera.eye.z}), way = scenes::minus(to, from);
    taut_ray ray;
    taut_ray_init(&ray);
    ray.origin = from;
    ray.translation = {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)};
    uint32_t count = 0;
    taut_world_cast_ray_all(world, &ray, &filter, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
    std::vector<taut_query_hit> hits(count);
    scenes::check(taut_world_cast_ray_all(world, &ray, &filter, hits.data(), count, &count), "looking for a view");
    ClearView view;
    double clear = 1;
    for (size_t i = count; i-- > 0;) {  // from the eye inwards
        const taut_query_hit& hit = hits[i];
        taut_collider_def def;
        taut_collider_def_init(&def);
        scenes::check(taut_collider_get_def(hit.collider, &def), "reading a collider");
        taut_shape_kind shape = TAUT_SHAPE_BOX;
        scenes::check(taut_shape_get_kind(def.shape, &shape), "reading a shape's kind");
        taut_body_kind kind = TAUT_BODY_DYNAMIC;
        scenes::check(taut_body_get_kind(hit.body, &kind), "reading a body's kind");
        int32_t within = shape == TAUT_SHAPE_SURFACE;  // nothing is inside these
        const taut_pos eye = scenes::plus(from, clear * way.x, clear * way.y, clear * way.z);
        if (within == 0) scenes::check(taut_collider_overlap_point(hit.collider, eye, &within), "looking for a view");
        if (within != 0 && hit.inside == 0)
            clear = hit.fraction;
        else if (kind == TAUT_BODY_STATIC)
            view.between.push_back(hit.body);
    }
    if (clear < 1) {
        const render::Vec3 back = camera.eye - camera.target;
        const float distance = static_cast<float>(clear) * length(back);
        camera.eye =
            camera.target + normalised(back) * std::max(distance - 2 * render::near_plane(camera), 0.5f * distance);
    }
    view.camera = camera;
    return view;
}

void Surface::read(taut_cloth cloth) {
    scenes::check(read_all(taut_cloth_get_points, cloth, points), "reading a cloth's points");
    scenes::check(read_all(taut_cloth_get_normals, cloth, normals), "reading a cloth's normals");
    scenes::check(read_all(taut_cloth_get_triangles, cloth, triangles, 3), "reading a cloth's triangles");
}

void Surface::read(taut_solid solid) {
    scenes::check(read_all(taut_solid_get_points, solid, points), "reading a solid's points");
    scenes::check(read_all(taut_solid_get_normals, solid, normals), "reading a solid's normals");
    scenes::check(read_all(taut_solid_get_triangles, solid, triangles, 3), "reading a solid's triangles");
}

void Surface::add(render::DrawList& list, const std::function<Colour(uint32_t)>& colour_of_vertex,
                  bool both_sides) const {
    const auto corner = [&](size_t k, float side) {
        const uint32_t v = triangles[k];
        const Vec3 normal = {normals[v].x, normals[v].y, normals[v].z};
        const Colour colour = colour_of_vertex(v);
        // Both sides lie apart, lest they shade each other.
        list.surfaces.push_back(
            {vec(points[v]) + normal * (side * 0.001f), normal * side, side > 0 ? colour : darker(colour), 0.1f});
    };
    for (size_t t = 0; t < triangles.size(); t += 3) {
        for (size_t k = 0; k < 3; ++k) corner(t + k, 1);
        for (size_t k = 3; both_sides && k-- > 0;) corner(t + k, -1);
    }
}

}  // namespace demo
