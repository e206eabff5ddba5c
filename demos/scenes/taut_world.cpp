#include "taut_world.h"

namespace scenes {

namespace {

taut_result add_shape(taut_world world, const Shape& shape, taut_shape* out) {
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
    def.user_data = index;
    return taut_world_add_body(world, &def, out);
}

taut_result add_joint(taut_world world, const Joint& joint, taut_body a, taut_body b, uint64_t index, taut_joint* out) {
    if (joint.kind == TAUT_JOINT_DISTANCE) {
        taut_distance_joint_def def;
        taut_distance_joint_def_init(&def);
        def.body_a = a;
        def.body_b = b;
        def.anchor_a = joint.anchor_a;
        def.anchor_b = joint.anchor_b;
        def.length = joint.length;
        def.user_data = index;
        return taut_world_add_distance_joint(world, &def, out);
    }
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.body_a = a;
    def.body_b = b;
    def.anchor_a = joint.anchor_a;
    def.anchor_b = joint.anchor_b;
    def.user_data = index;
    return taut_world_add_ball_joint(world, &def, out);
}

constexpr struct {
    taut_solver solver;
    const char* name;
} kSolvers[] = {{TAUT_SOLVER_BLOCK_LDLT, "block_ldlt"},
                {TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, "projected_gauss_seidel"},
                {TAUT_SOLVER_ACCELERATED_JACOBI, "accelerated_jacobi"}};

}  // namespace

taut_solver solver_named(const std::string& name) {
    std::string known;
    for (const auto& entry : kSolvers) {
        if (name == entry.name) return entry.solver;
        known += std::string(" ") + entry.name;
    }
    throw BadScene("no solver is called '" + name + "'; there are:" + known);
}

const char* solver_name(taut_solver solver) {
    for (const auto& entry : kSolvers)
        if (solver == entry.solver) return entry.name;
    return "unknown";
}

void check(taut_result result, const char* what) {
    if (result == TAUT_OK) return;
    throw TautError(std::string(what) + ": " + taut_result_name(result) + ": " + taut_last_error());
}

TautWorld::TautWorld(const Scene& scene) {
    check(taut_world_create(&scene.world, &world), "creating the world");
    try {
        build(scene);
    } catch (...) {
        taut_world_destroy(world);
        throw;
    }
}

TautWorld::~TautWorld() { taut_world_destroy(world); }

void TautWorld::build(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        taut_shape handle{};
        std::string what = shape.source.empty() ? "adding a shape" : shape.source;
        check(add_shape(world, shape, &handle), what.c_str());
        shapes.push_back(handle);
    }
    for (const Body& body : scene.bodies) {
        taut_body handle{};
        taut_shape shape = body.shape < 0 ? taut_shape{} : shapes[static_cast<size_t>(body.shape)];
        check(add_body(world, body, shape, bodies.size(), &handle), "adding a body");
        bodies.push_back(handle);
    }
    for (const Joint& joint : scene.joints) {
        taut_joint handle{};
        check(add_joint(world, joint, end(joint.body_a), end(joint.body_b), joints.size(), &handle), "adding a joint");
        joints.push_back(handle);
    }
}

taut_pose TautWorld::pose(size_t body) const {
    taut_pose pose{};
    check(taut_body_get_pose(bodies[body], &pose), "reading a pose");
    return pose;
}

taut_profile TautWorld::profile() const {
    taut_profile profile{};
    profile.struct_size = sizeof profile;
    check(taut_world_get_profile(world, &profile), "reading the profile");
    return profile;
}

}  // namespace scenes
