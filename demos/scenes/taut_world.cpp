#include "taut_world.h"

#include <algorithm>

#include "pose.h"
#include "random.h"
#include "taut_joint.h"
#include "track.h"

namespace scenes {

namespace {

// earlier: the world's shapes before this one.
taut_result add_shape(taut_world world, const Shape& shape, const std::vector<taut_shape>& earlier, taut_shape* out) {
    switch (shape.kind) {
        case ShapeKind::plane: {
            taut_plane_def def;
            taut_plane_def_init(&def);
            def.normal = shape.normal;
            return taut_world_add_plane(world, &def, out);
        }
        case ShapeKind::box: {
            taut_box_def def;
            taut_box_def_init(&def);
            def.half_extents = shape.half_extents;
            return taut_world_add_box(world, &def, out);
        }
        case ShapeKind::sphere: {
            taut_sphere_def def;
            taut_sphere_def_init(&def);
            def.radius = shape.radius;
            return taut_world_add_sphere(world, &def, out);
        }
        case ShapeKind::capsule: {
            taut_capsule_def def;
            taut_capsule_def_init(&def);
            def.radius = shape.radius;
            def.half_length = shape.half_length;
            return taut_world_add_capsule(world, &def, out);
        }
        case ShapeKind::cylinder: {
            taut_cylinder_def def;
            taut_cylinder_def_init(&def);
            def.radius = shape.radius;
            def.half_length = shape.half_length;
            return taut_world_add_cylinder(world, &def, out);
        }
        case ShapeKind::cone: {
            taut_cone_def def;
            taut_cone_def_init(&def);
            def.radius = shape.radius;
            def.half_length = shape.half_length;
            return taut_world_add_cone(world, &def, out);
        }
        case ShapeKind::tapered_capsule: {
            taut_tapered_capsule_def def;
            taut_tapered_capsule_def_init(&def);
            def.bottom_radius = shape.radius;
            def.top_radius = shape.top_radius;
            def.half_length = shape.half_length;
            return taut_world_add_tapered_capsule(world, &def, out);
        }
        case ShapeKind::scaled_hull: {
            taut_scaled_hull_def def;
            taut_scaled_hull_def_init(&def);
            def.hull = earlier.at(static_cast<size_t>(shape.hull));
            def.scale = shape.scale;
            return taut_world_add_scaled_hull(world, &def, out);
        }
        case ShapeKind::mesh: {
            taut_mesh_def def;
            taut_mesh_def_init(&def);
            def.vertex_count = static_cast<uint32_t>(shape.points.size());
            def.vertices = shape.points.data();
            def.triangle_count = static_cast<uint32_t>(shape.indices.size() / 3);
            def.indices = shape.indices.data();
            const taut_result added = taut_world_add_mesh(world, &def, out);
            return added == TAUT_OK && shape.sampled ? taut_shape_sample_distance(*out, 0) : added;
        }
        case ShapeKind::height_field: {
            taut_height_field_def def;
            taut_height_field_def_init(&def);
            def.rows = shape.rows;
            def.columns = static_cast<uint32_t>(shape.heights.size()) / shape.rows;
            def.row_spacing = def.column_spacing = shape.spacing;
            def.heights = shape.heights.data();
            return taut_world_add_height_field(world, &def, out);
        }
        case ShapeKind::hull:
            break;
    }
    taut_hull_def def;
    taut_hull_def_init(&def);
    def.point_count = static_cast<uint32_t>(shape.points.size());
    def.points = shape.points.data();
    return taut_world_add_hull(world, &def, out);
}

taut_result add_body(taut_world world, const Body& body, taut_shape shape, uint64_t index, taut_body* out) {
    if (body.kind == TAUT_BODY_PARTICLE) {
        taut_particle_def def;
        taut_particle_def_init(&def);
        def.mass = body.mass;
        def.position = body.position;
        def.velocity = body.linear_velocity;
        def.shape = shape;
        def.material.friction = body.friction;
        def.collider_flags = body.grain ? TAUT_COLLIDER_GRAIN : 0;
        def.user_data = index;
        return taut_world_add_particle(world, &def, out);
    }
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = body.kind;
    def.position = body.position;
    def.rotation = body.rotation;
    def.linear_velocity = body.linear_velocity;
    def.angular_velocity = body.angular_velocity;
    def.shape = shape;
    def.material.friction = body.friction;
    def.filter.group = body.group;
    def.density = body.density;
    def.mass = body.mass;
    def.inertia = body.inertia;
    def.centre_of_mass = body.centre_of_mass;
    def.user_data = index;
    return taut_world_add_body(world, &def, out);
}

}  // namespace

taut_solver solver_named(const std::string& name) {
    std::string known;
    for (uint32_t i = 0; const char* each = taut_solver_name(static_cast<taut_solver>(i)); ++i) {
        if (name == each) return static_cast<taut_solver>(i);
        known += std::string(" ") + each;
    }
    throw BadScene("no solver is called '" + name + "'; there are:" + known);
}

void check(taut_result result, const char* what) {
    if (result == TAUT_OK) return;
    throw TautError(std::string(what) + ": " + taut_result_name(result) + ": " + taut_last_error());
}

namespace {

void start(const std::vector<taut_body>& vertices, const std::vector<taut_vec3>& velocities) {
    for (size_t i = 0; i < velocities.size(); ++i)
        check(taut_body_set_velocity(vertices[i], velocities[i], {}), "starting a vertex");
}

}  // namespace

TautWorld::TautWorld(const Scene& scene, const std::function<void(taut_world)>& history) : scene_(scene) {
    check(taut_world_create(&scene.world, &world), "creating the world");
    try {
        if (history) history(world);
        build();
    } catch (...) {
        taut_world_destroy(world);
        throw;
    }
}

TautWorld::~TautWorld() { taut_world_destroy(world); }

void TautWorld::build() {
    for (const Shape& shape : scene_.shapes) {
        taut_shape handle{};
        std::string what = shape.source.empty() ? "adding a shape" : shape.source;
        check(add_shape(world, shape, shapes, &handle), what.c_str());
        shapes.push_back(handle);
    }
    for (const Body& body : scene_.bodies) {
        taut_body handle{};
        taut_shape shape = body.shape < 0 ? taut_shape{} : shapes[static_cast<size_t>(body.shape)];
        check(add_body(world, body, shape, bodies.size(), &handle), "adding a body");
        bodies.push_back(handle);
        add_parts(body, handle);
    }
    for (const Cloth& cloth : scene_.cloths) {
        cloths.push_back(add(cloth, cloths.size()));
        cloth_vertices.emplace_back(cloth.points.size());
        auto count = static_cast<uint32_t>(cloth.points.size());
        check(taut_cloth_get_bodies(cloths.back(), cloth_vertices.back().data(), count, &count), "reading a cloth");
        start(cloth_vertices.back(), cloth.velocities);
    }
    for (const Solid& solid : scene_.solids) {
        solids.push_back(add(solid, solids.size()));
        solid_vertices.emplace_back(solid.points.size());
        auto count = static_cast<uint32_t>(solid.points.size());
        check(taut_solid_get_bodies(solids.back(), solid_vertices.back().data(), count, &count), "reading a solid");
        start(solid_vertices.back(), solid.velocities);
    }
    const bool knots = std::any_of(scene_.joints.begin(), scene_.joints.end(), [](const Joint& joint) {
        return joint.vertex_a.cable >= 0 || joint.vertex_b.cable >= 0;
    });
    if (knots) add_cables();
    add_joints();
    if (!knots) add_cables();
    broken.reserve(joints.size());
}

void TautWorld::add_joints() {
    for (const Joint& joint : scene_.joints) {
        taut_joint handle{};
        check(add_joint(world, joint, end(joint.body_a, joint.vertex_a), end(joint.body_b, joint.vertex_b),
                        end(joint.housing, {}), joints.size(), &handle),
              "adding a joint");
        joints.push_back(handle);
    }
}

void TautWorld::add_cables() {
    for (const Cable& cable : scene_.cables) cables.push_back(add(cable, cables.size()));
}

void TautWorld::add_parts(const Body& plan, taut_body body) const {
    for (const Part& part : plan.parts) {
        taut_collider_def def;
        taut_collider_def_init(&def);
        def.shape = shapes[static_cast<size_t>(part.shape)];
        def.position = part.position;
        def.rotation = part.rotation;
        def.material.friction = plan.friction;
        def.filter.group = plan.group;
        taut_collider collider{};
        check(taut_body_add_collider(body, &def, &collider), "adding a collider");
    }
}

taut_body TautWorld::end(int index, const SoftVertex& vertex) const {
    if (vertex.cable >= 0) {
        const taut_cable cable = cables[static_cast<size_t>(vertex.cable)];
        uint32_t count = 0;
        taut_cable_get_bodies(cable, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
        std::vector<taut_body> points(count);
        check(taut_cable_get_bodies(cable, points.data(), count, &count), "reading a cable");
        return points.at(vertex.vertex);
    }
    if (vertex.cloth >= 0) return cloth_vertices[static_cast<size_t>(vertex.cloth)][vertex.vertex];
    if (vertex.solid >= 0) return solid_vertices[static_cast<size_t>(vertex.solid)][vertex.vertex];
    return end(index);
}

taut_cloth TautWorld::add(Cloth plan, uint64_t index) const {
    plan.def.points = plan.points.data();
    plan.def.rest = plan.rest.empty() ? nullptr : plan.rest.data();
    plan.def.point_count = static_cast<uint32_t>(plan.points.size());
    const bool quads = plan.def.kind == TAUT_CLOTH_QUADS;
    plan.def.triangles = quads ? nullptr : plan.triangles.data();
    plan.def.triangle_count = static_cast<uint32_t>(plan.triangles.size() / 3);
    plan.def.quads = quads ? plan.quads.data() : nullptr;
    plan.def.quad_count = static_cast<uint32_t>(plan.quads.size() / 4);
    plan.def.uv = plan.uv.empty() ? nullptr : plan.uv.data();
    plan.def.user_data = index;
    taut_cloth handle{};
    const std::string what = plan.source.empty() ? "adding a cloth" : plan.source;
    check(taut_world_add_cloth(world, &plan.def, &handle), what.c_str());
    for (const uint32_t vertex : plan.pinned) check(taut_cloth_pin(handle, vertex, 1), "pinning a cloth");
    return handle;
}

taut_solid TautWorld::add(Solid plan, uint64_t index) const {
    plan.def.points = plan.points.data();
    plan.def.rest = plan.rest.empty() ? nullptr : plan.rest.data();
    plan.def.point_count = static_cast<uint32_t>(plan.points.size());
    if (plan.def.corners != TAUT_SOLID_MESHLESS) {
        plan.def.cells = plan.cells.data();
        plan.def.cell_count = static_cast<uint32_t>(plan.cells.size()) / plan.def.corners;
    } else if (!plan.triangles.empty()) {
        plan.def.triangles = plan.triangles.data();
        plan.def.triangle_count = static_cast<uint32_t>(plan.triangles.size() / 3);
    }
    plan.def.user_data = index;
    taut_solid handle{};
    const std::string what = plan.source.empty() ? "adding a solid" : plan.source;
    check(taut_world_add_solid(world, &plan.def, &handle), what.c_str());
    for (const uint32_t vertex : plan.pinned) check(taut_solid_pin(handle, vertex, 1), "pinning a solid");
    return handle;
}

taut_cable TautWorld::add(Cable plan, uint64_t index) const {
    plan.def.points = plan.path.data();
    plan.def.point_count = static_cast<uint32_t>(plan.path.size());
    for (int e = 0; e < 2; ++e) plan.def.end[e].body = end(plan.end_body[e], plan.end_vertex[e]);
    plan.def.user_data = index;
    taut_cable handle{};
    check(taut_world_add_cable(world, &plan.def, &handle), "adding a cable");
    return handle;
}

// Where everything with a plan is to be at the end of the step.
void TautWorld::follow_plans() {
    const double time = static_cast<double>(steps_ + 1) * static_cast<double>(scene_.world.time_step);
    std::vector<bool> moved(scene_.bodies.size(), false);
    for (const Motion& motion : scene_.motions) {
        const TrackPoint point = at(motion.track, time);
        if (motion.body >= 0) {
            if (!moved[static_cast<size_t>(motion.body)]) move(motion.body, time);
            moved[static_cast<size_t>(motion.body)] = true;
        } else if (motion.cloth >= 0 || motion.solid >= 0)
            move_vertices(motion, point.value);
        else if (motion.cable >= 0)
            check(taut_cable_set_reel_speed(cables[static_cast<size_t>(motion.cable)], motion.axis,
                                            static_cast<float>(point.rate), 0),
                  "reeling a cable");
        else if (is_whole(static_cast<size_t>(motion.joint)))
            drive(motion, point.value, point.rate);
    }
    take_away(time);
}

// Joints whose time is over before the step's end.
void TautWorld::take_away(double time) {
    for (size_t i = 0; i < joints.size(); ++i)
        if (scene_.joints[i].until > 0 && time > scene_.joints[i].until && is_whole(i))
            check(taut_joint_remove(joints[i]), "taking a joint away");
}

namespace {

taut_quat turn_of(const Motion& motion, double value) {
    const taut_vec3& w = motion.about;
    const double size = length({static_cast<double>(w.x), static_cast<double>(w.y), static_cast<double>(w.z)});
    if (!(size > 0)) return {0, 0, 0, 1};
    const auto s = static_cast<float>(1 / size);
    return turn({s * w.x, s * w.y, s * w.z}, size * value);
}

taut_pos moved_point(const Motion& motion, const taut_quat& by, taut_pos from, double value) {
    const taut_vec3 &a = motion.along, &w = motion.about;
    if (w.x != 0 || w.y != 0 || w.z != 0) {
        const taut_pos out = rotated(by, minus(from, motion.pivot));
        from = plus(motion.pivot, out.x, out.y, out.z);
    }
    return plus(from, value * static_cast<double>(a.x), value * static_cast<double>(a.y),
                value * static_cast<double>(a.z));
}

}  // namespace

void TautWorld::move(int body, double time) const {
    const Body& start = scene_.bodies[static_cast<size_t>(body)];
    taut_pose pose{};
    pose.position = start.position;
    pose.rotation = start.rotation;
    for (const Motion& motion : scene_.motions) {
        if (motion.body != body) continue;
        const double value = at(motion.track, time).value;
        const taut_quat by = turn_of(motion, value);
        pose.position = moved_point(motion, by, pose.position, value);
        const taut_vec3& w = motion.about;
        if (w.x != 0 || w.y != 0 || w.z != 0) pose.rotation = times(by, pose.rotation);
    }
    check(taut_body_move_kinematic(bodies[static_cast<size_t>(body)], &pose), "moving a body");
}

void TautWorld::move_vertices(const Motion& motion, double value) const {
    const bool solid = motion.solid >= 0;
    const auto soft = static_cast<size_t>(solid ? motion.solid : motion.cloth);
    const std::vector<taut_pos>& points = solid ? scene_.solids[soft].points : scene_.cloths[soft].points;
    const std::vector<taut_body>& bodies_of = solid ? solid_vertices[soft] : cloth_vertices[soft];
    const taut_quat by = turn_of(motion, value);
    for (const uint32_t vertex : motion.vertices) {
        taut_pose pose{};
        pose.position = moved_point(motion, by, points[vertex], value);
        pose.rotation = {0, 0, 0, 1};
        check(taut_body_move_kinematic(bodies_of[vertex], &pose), "moving a vertex");
    }
}

// A motor that holds a speed alone takes no target, which grows beyond a turn.
void TautWorld::drive(const Motion& motion, double value, double rate) const {
    const auto joint = static_cast<size_t>(motion.joint);
    const taut_drive& drive = scene_.joints[joint].axes[motion.axis].drive;
    const bool aims = drive.stiffness > 0 || drive.frequency > 0;
    check(taut_joint_set_target(joints[joint], motion.axis, aims ? static_cast<float>(value) : 0.0f,
                                static_cast<float>(rate)),
          "driving a joint");
}

void TautWorld::step() {
    follow_plans();
    check(taut_world_step(world), "taking a step");
    ++steps_;
    taut_events events{};
    check(taut_world_get_events(world, &events), "reading the events");
    for (uint32_t i = 0; i < events.broken_count; ++i) broken.push_back(static_cast<int>(events.broken[i].user_data));
    quarantined += events.quarantined_count;
}

taut_pose TautWorld::pose(size_t body) const {
    taut_pose pose{};
    check(taut_body_get_pose(bodies[body], &pose), "reading a pose");
    return pose;
}

double TautWorld::energy() const {
    uint32_t count = 0;
    taut_world_get_bodies(world, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
    std::vector<taut_body> all(count);
    check(taut_world_get_bodies(world, all.data(), count, &count), "listing the bodies");
    const taut_vec3 g = scene_.world.gravity;
    double sum = 0;
    for (taut_body body : all) {
        float mass = 0;
        taut_vec3 centre{}, v{}, w{};
        taut_sym3 i{};
        taut_pos at{};
        check(taut_body_get_mass(body, &mass, &centre, &i), "reading a mass");
        if (!(mass > 0)) continue;
        check(taut_body_get_world_point(body, centre, &at), "reading a centre of mass");
        check(taut_body_get_velocity(body, &v, &w), "reading a velocity");
        check(taut_body_get_local_vector(body, w, &w), "turning a spin into its body's frame");
        const double m = mass, x = w.x, y = w.y, z = w.z;
        sum += 0.5 * m * (double{v.x} * v.x + double{v.y} * v.y + double{v.z} * v.z);
        sum += 0.5 * (i.xx * x * x + i.yy * y * y + i.zz * z * z) + i.xy * x * y + i.xz * x * z + i.yz * y * z;
        sum -= m * (g.x * at.x + g.y * at.y + g.z * at.z);
    }
    return sum;
}

double TautWorld::joint_error() const {
    float most = cables.empty() ? 0 : profile().joint_error;
    for (size_t i = 0; i < joints.size(); ++i) {
        if (scene_.joints[i].compliance > 0 || !is_whole(i)) continue;
        float error = 0;
        check(taut_joint_get_error(joints[i], &error), "reading a joint's error");
        if (!(error <= most)) most = error;  // a NaN too
    }
    return static_cast<double>(most);
}

taut_profile TautWorld::profile() const {
    taut_profile profile{};
    profile.struct_size = sizeof profile;
    check(taut_world_get_profile(world, &profile), "reading the profile");
    return profile;
}

}  // namespace scenes
