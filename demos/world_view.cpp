#include "world_view.h"

#include <algorithm>
#include <cmath>

#include "scenes/taut_world.h"
#include "shape_mesh.h"

namespace demo {

namespace {

using render::Colour;
using render::from_srgb;
using render::Instance;
using render::Vec3;
using scenes::check;
using scenes::Look;
using scenes::ShapeKind;

const Colour kSensor = from_srgb(0x4FC28B), kQuarantine = from_srgb(0xFF2F4F);
constexpr float kPlaneHalfWidth = 50;  // of a plane that is not level [m]
constexpr float kThinnest = 1e-3f;     // radius of a cable that is still seen, of the distance of what is looked at
// Level is what deviates by less than single precision tells.
constexpr double kLevel = 1 - 1e-6;

// As scenes tell shapes; hulls, meshes and height fields by their triangles alone.
scenes::Shape shape_of(taut_shape handle) {
    scenes::Shape shape;
    taut_shape_kind kind = TAUT_SHAPE_BOX;
    check(taut_shape_get_kind(handle, &kind), "reading a shape's kind");
    switch (kind) {
        case TAUT_SHAPE_PLANE: {
            taut_plane_def def;
            taut_plane_def_init(&def);
            check(taut_shape_get_plane(handle, &def), "reading a plane");
            shape.kind = ShapeKind::plane;
            shape.normal = def.normal;
            break;
        }
        case TAUT_SHAPE_BOX: {
            taut_box_def def;
            taut_box_def_init(&def);
            check(taut_shape_get_box(handle, &def), "reading a box");
            shape.kind = ShapeKind::box;
            shape.half_extents = def.half_extents;
            break;
        }
        case TAUT_SHAPE_SPHERE: {
            taut_sphere_def def;
            taut_sphere_def_init(&def);
            check(taut_shape_get_sphere(handle, &def), "reading a sphere");
            shape.kind = ShapeKind::sphere;
            shape.radius = def.radius;
            break;
        }
        case TAUT_SHAPE_CAPSULE: {
            taut_capsule_def def;
            taut_capsule_def_init(&def);
            check(taut_shape_get_capsule(handle, &def), "reading a capsule");
            shape.kind = ShapeKind::capsule;
            shape.radius = def.radius;
            shape.half_length = def.half_length;
            break;
        }
        case TAUT_SHAPE_CYLINDER: {
            taut_cylinder_def def;
            taut_cylinder_def_init(&def);
            check(taut_shape_get_cylinder(handle, &def), "reading a cylinder");
            shape.kind = ShapeKind::cylinder;
            shape.radius = def.radius;
            shape.half_length = def.half_length;
            break;
        }
        case TAUT_SHAPE_CONE: {
            taut_cone_def def;
            taut_cone_def_init(&def);
            check(taut_shape_get_cone(handle, &def), "reading a cone");
            shape.kind = ShapeKind::cone;
            shape.radius = def.radius;
            shape.half_length = def.half_length;
            break;
        }
        case TAUT_SHAPE_TAPERED_CAPSULE: {
            taut_tapered_capsule_def def;
            taut_tapered_capsule_def_init(&def);
            check(taut_shape_get_tapered_capsule(handle, &def), "reading a tapered capsule");
            shape.kind = ShapeKind::tapered_capsule;
            shape.radius = def.bottom_radius;
            shape.top_radius = def.top_radius;
            shape.half_length = def.half_length;
            break;
        }
        case TAUT_SHAPE_HULL:
            shape.kind = ShapeKind::hull;
            break;
        case TAUT_SHAPE_SURFACE:
            shape.kind = ShapeKind::mesh;
            break;
        case TAUT_SHAPE_KIND_MAX:
            break;
    }
    return shape;
}

Look look_of(taut_body_kind kind, uint32_t flags) {
    if ((flags & TAUT_COLLIDER_GRAIN) != 0) return Look::sand;
    if (kind == TAUT_BODY_STATIC) return Look::stone;
    return kind == TAUT_BODY_KINEMATIC ? Look::steel : Look::crate;
}

}  // namespace

// Up is against gravity. The origin is near what moves, on the grid of the ground's bold lines.
void WorldView::settle() {
    constexpr double kGrid = 10;  // [m]
    taut_vec3 g{};
    check(taut_world_get_gravity(world_, &g), "reading the gravity");
    if (g.x != 0 || g.y != 0 || g.z != 0)
        placement_.turn = scenes::turn_from_to({-double{g.x}, -double{g.y}, -double{g.z}}, {0, 1, 0});
    std::vector<taut_body> bodies;
    check(read_all(taut_world_get_bodies, world_, bodies), "listing the bodies");
    if (const auto box = bounds_of(moving_bodies(world_))) {
        const taut_pos middle = scenes::middle(box->low, box->high);
        const auto rounded = [](double x) { return kGrid * std::round(x / kGrid); };
        placement_.origin = {rounded(middle.x), rounded(middle.y), rounded(middle.z)};
    }
    find_ground(bodies);
    camera_.emplace(render::Camera{{5.5f, 4.5f, 8.5f}, {0, 0, 0}, 0.7f}, size_of(g), aspect_);
    settled_ = true;
}

// The highest level plane that stands.
void WorldView::find_ground(const std::vector<taut_body>& bodies) {
    for (const taut_body body : bodies) {
        taut_body_kind kind = TAUT_BODY_DYNAMIC;
        check(taut_body_get_kind(body, &kind), "reading a body's kind");
        if (kind != TAUT_BODY_STATIC) continue;
        taut_pose pose{};
        check(taut_body_get_pose(body, &pose), "reading a pose");
        check(read_all(taut_body_get_colliders, body, colliders_), "listing colliders");
        for (const taut_collider collider : colliders_) {
            taut_collider_def def;
            taut_collider_def_init(&def);
            check(taut_collider_get_def(collider, &def), "reading a collider");
            const scenes::Shape& shape = drawn(def.shape).shape;
            if (shape.kind != ShapeKind::plane) continue;
            const taut_quat turn = scenes::times(placement_.turn, scenes::times(pose.rotation, def.rotation));
            const taut_pos up = scenes::rotated(turn, {shape.normal.x, shape.normal.y, shape.normal.z});
            if (up.y < kLevel) continue;
            const taut_pos out = scenes::rotated(pose.rotation, {def.position.x, def.position.y, def.position.z});
            const double height = placement_.picture(scenes::plus(pose.position, out.x, out.y, out.z)).y;
            ground_ = std::max(ground_.value_or(height), height);
        }
    }
}

void WorldView::step(float h) {
    if (!settled_) settle();
    auto box = bounds_of(moving_bodies(world_));
    if (!box) return;
    // Turned, the box about its corners.
    Vec3 low = at(box->low), high = low;
    for (int corner = 1; corner < 8; ++corner) {
        const Vec3 p = at({corner & 1 ? box->high.x : box->low.x, corner & 2 ? box->high.y : box->low.y,
                           corner & 4 ? box->high.z : box->low.z});
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    camera_->follow(low, high, h);
}

const WorldView::Drawn& WorldView::drawn(taut_shape handle) {
    const auto [entry, is_new] = shapes_.try_emplace(handle.bits);
    if (is_new) {
        entry->second.shape = shape_of(handle);
        entry->second.mesh = entry->second.shape.kind == ShapeKind::plane
                                 ? renderer_.add_mesh(shape_mesh(entry->second.shape, handle, kPlaneHalfWidth))
                                 : mesh_of(entry->second.shape, handle, renderer_);
    }
    return entry->second;
}

void WorldView::add_colliders(render::DrawList& list, taut_body body, const taut_pose& pose, Instance instance) {
    taut_body_kind kind = TAUT_BODY_STATIC;
    check(taut_body_get_kind(body, &kind), "reading a body's kind");
    check(read_all(taut_body_get_colliders, body, colliders_), "listing colliders");
    taut_quarantine_reason reason = TAUT_QUARANTINE_NONE;
    check(taut_body_get_quarantine(body, &reason), "asking for quarantine");
    const bool sleeps = kind != TAUT_BODY_STATIC && is_asleep(body);
    for (const taut_collider collider : colliders_) {
        taut_collider_def def;
        taut_collider_def_init(&def);
        check(taut_collider_get_def(collider, &def), "reading a collider");
        const Drawn& shape = drawn(def.shape);
        const taut_pos out = scenes::rotated(pose.rotation, {def.position.x, def.position.y, def.position.z});
        instance.position = at(scenes::plus(pose.position, out.x, out.y, out.z));
        instance.rotation = quat(scenes::times(placement_.turn, scenes::times(pose.rotation, def.rotation)));
        const bool sensor = (def.flags & TAUT_COLLIDER_SENSOR) != 0;
        instance.pass = sensor || between_.count(body.bits) != 0 ? render::Pass::ghost : render::Pass::solid;
        const Colour own = colour_of(look_of(kind, def.flags), number_of(body));
        instance.colour = reason != TAUT_QUARANTINE_NONE ? kQuarantine : sensor ? kSensor : sleeps ? darker(own) : own;
        if (shape.shape.kind == ShapeKind::plane) {
            if (ground_ &&
                rotate(instance.rotation, {shape.shape.normal.x, shape.shape.normal.y, shape.shape.normal.z}).y >=
                    static_cast<float>(kLevel))
                continue;
            instance.mesh = shape.mesh;
            list.instances.push_back(instance);
        } else
            add_shape(list, shape.shape, shape.mesh, instance);
    }
}

void WorldView::add_cable(render::DrawList& list, taut_cable cable) {
    std::vector<taut_pos> points;
    std::vector<taut_body> bodies;
    check(read_all(taut_cable_get_points, cable, points), "reading a cable's points");
    check(read_all(taut_cable_get_bodies, cable, bodies), "reading a cable's bodies");
    float radius = kRopeRadius;
    if (!bodies.empty()) {
        check(read_all(taut_body_get_colliders, bodies[0], colliders_), "listing colliders");
        if (!colliders_.empty()) {
            taut_collider_def def;
            taut_collider_def_init(&def);
            check(taut_collider_get_def(colliders_[0], &def), "reading a collider");
            radius = std::max(drawn(def.shape).shape.radius, kThinnest * length(list.camera.eye - list.camera.target));
        }
    }
    const Colour colour = colour_of(Look::link, 0);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        list.instances.push_back(rod(at(points[i]), at(points[i + 1]), radius, colour));
        list.instances.push_back(ball(at(points[i + 1]), radius, colour, 0.22f));
    }
}

// What joints of which nothing else is seen look like: rods, ropes over their sheaves, pins of balls.
void WorldView::add_joints(render::DrawList& list) {
    std::vector<taut_joint> joints;
    check(read_all(taut_world_get_joints, world_, joints), "listing the joints");
    const Colour colour = colour_of(Look::link, 0), pin = colour_of(Look::particle, 0);
    for (const taut_joint joint : joints) {
        taut_joint_kind kind = TAUT_JOINT_BALL;
        uint32_t enabled = 0;
        check(taut_joint_get_kind(joint, &kind), "reading a joint's kind");
        check(taut_joint_get_enabled(joint, &enabled), "asking whether a joint is enabled");
        if (enabled == 0) continue;
        taut_pos a{}, b{};
        check(taut_joint_get_anchors(joint, &a, &b), "reading a joint's anchors");
        if (kind == TAUT_JOINT_DISTANCE)
            list.instances.push_back(rod(at(a), at(b), kRopeRadius, colour));
        else if (kind == TAUT_JOINT_BALL)
            list.instances.push_back(ball(at(b), kRopeRadius, pin, 0.7f));
        else if (kind == TAUT_JOINT_PULLEY) {
            taut_body housing{};
            taut_frame sheaves[2] = {};
            check(taut_joint_get_housing(joint, &housing), "reading a housing");
            check(taut_joint_get_housing_frames(joint, &sheaves[0], &sheaves[1]), "reading sheaves");
            Vec3 way[4] = {at(a), {}, {}, at(b)};
            for (int i = 0; i < 2; ++i) {
                const taut_pos local = sheaves[i].position;
                taut_pos place = local;
                if (housing.bits != 0)
                    check(taut_body_get_world_point(
                              housing,
                              {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)},
                              &place),
                          "placing a sheave");
                way[i + 1] = at(place);
            }
            for (int i = 0; i < 3; ++i) list.instances.push_back(rod(way[i], way[i + 1], kRopeRadius, colour));
        }
    }
}

// Bodies are numbered as they are first seen, so that each keeps its colour.
size_t WorldView::number_of(taut_body body) { return numbers_.try_emplace(body.bits, numbers_.size()).first->second; }

void WorldView::add_body(render::DrawList& list, taut_body body) {
    uint32_t enabled = 0;
    check(taut_body_get_enabled(body, &enabled), "asking whether a body is enabled");
    if (enabled == 0) return;
    taut_pose pose{};
    check(taut_body_get_pose(body, &pose), "reading a pose");
    Instance instance;
    instance.gloss = 0.22f;
    add_colliders(list, body, pose, instance);
    if (colliders_.empty())
        list.instances.push_back(ball(at(pose.position), kPointRadius, colour_of(Look::particle, 0), 0.22f));
}

void WorldView::add_softs(render::DrawList& list, const std::vector<taut_body>& bodies) {
    std::set<uint64_t> seen;
    for (const taut_body body : bodies) {
        taut_cloth cloth{};
        taut_solid solid{};
        check(taut_body_get_cloth(body, &cloth), "asking for a cloth");
        check(taut_body_get_solid(body, &solid), "asking for a solid");
        if (cloth.bits != 0 && seen.insert(cloth.bits).second)
            surface_.read(cloth);
        else if (solid.bits != 0 && seen.insert(solid.bits).second)
            surface_.read(solid);
        else
            continue;
        const Colour paint = from_srgb(cloth.bits != 0 ? kClothPaint : kSolidPaint);
        for (taut_pos& point : surface_.points) point = placement_.picture(point);
        for (taut_vec3& normal : surface_.normals) {
            const taut_pos n = scenes::rotated(placement_.turn, {normal.x, normal.y, normal.z});
            normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
        }
        surface_.add(
            list, [&](uint32_t) { return paint; }, cloth.bits != 0);
    }
}

void WorldView::add(render::DrawList& list) {
    if (!settled_) settle();
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    render::Camera camera = camera_->camera();
    if (ground_) camera = above_ground(camera, static_cast<float>(*ground_));
    const ClearView view = clear_view(camera, world_, placement_, filter);
    list.camera = view.camera;
    between_.clear();
    for (const taut_body body : view.between) between_.insert(body.bits);
    const Vec3 middle = camera_->middle(), r = Vec3{1, 1, 1} * std::max(camera_->radius(), kPointRadius);
    render::Stage stage{middle - r, middle + r, static_cast<float>(ground_.value_or(0)), ground_.has_value()};
    renderer_.set_stage(stage);

    std::vector<taut_body> bodies;
    check(read_all(taut_world_get_bodies, world_, bodies), "listing the bodies");
    std::set<uint64_t> cables;
    std::vector<taut_body> vertices;
    for (const taut_body body : bodies) {
        taut_cable cable{};
        taut_cloth cloth{};
        taut_solid solid{};
        check(taut_body_get_cable(body, &cable), "asking for a cable");
        check(taut_body_get_cloth(body, &cloth), "asking for a cloth");
        check(taut_body_get_solid(body, &solid), "asking for a solid");
        if (cable.bits != 0) {
            if (cables.insert(cable.bits).second) add_cable(list, cable);
        } else if (cloth.bits != 0 || solid.bits != 0)
            vertices.push_back(body);
        else
            add_body(list, body);
    }
    add_softs(list, vertices);
    add_joints(list);
}

}  // namespace demo
