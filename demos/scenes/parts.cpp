#include "parts.h"

#include <algorithm>
#include <numbers>

#include "pose.h"

namespace scenes {

namespace {

constexpr int32_t kChainGroup = -1;  // links and weight of one chain don't collide with each other

// Turns the whole chain about its anchor in the x-y plane.
void turn_chain(Scene& scene, const Chain& chain, double angle) {
    double c = cosine(angle), s = sine(angle);
    for (int index : chain.bodies) {
        Body& body = scene.bodies[index];
        double x = body.position.x - chain.anchor.x, y = body.position.y - chain.anchor.y;
        body.position = {chain.anchor.x + c * x - s * y, chain.anchor.y + s * x + c * y, body.position.z};
        body.rotation = times(turn({0, 0, 1}, angle), body.rotation);
    }
}

struct Slim {
    double radius, length;  // [m]
};

// A body along y from one point to another. Its inertia is a slim rod's, but about its length not as little as its
// own: it would spin up (TAUT_LINT_THIN_INERTIA).
int add_slim(Scene& scene, int shape, taut_pos from, taut_pos to, Slim size, double mass, Look look, int32_t group) {
    constexpr double kMostRatio = 80;
    Body body = crate(shape, middle(from, to), mass, look);
    body.rotation = turn_from_to({0, 1, 0}, minus(to, from));
    body.group = group;
    const double square = size.radius * size.radius, across = mass * (size.length * size.length / 12 + square / 4);
    const auto wide = static_cast<float>(across);
    const auto round = static_cast<float>(std::fmax(mass * square / 2, across / kMostRatio));
    if (mass > 0) body.inertia = {wide, round, wide, 0, 0, 0};
    return scene.add_body(body);
}

}  // namespace

Scene empty_scene() {
    Scene scene;
    taut_world_def_init(&scene.world);
    return scene;
}

int box_shape(Scene& scene, double half_x, double half_y, double half_z) {
    Shape shape;
    shape.kind = ShapeKind::box;
    shape.half_extents = {static_cast<float>(half_x), static_cast<float>(half_y), static_cast<float>(half_z)};
    return scene.add_shape(std::move(shape));
}

int cube_shape(Scene& scene, double side) { return box_shape(scene, side / 2, side / 2, side / 2); }

int sphere_shape(Scene& scene, double radius) {
    Shape shape;
    shape.kind = ShapeKind::sphere;
    shape.radius = static_cast<float>(radius);
    return scene.add_shape(std::move(shape));
}

int capsule_shape(Scene& scene, double radius, double half_length) {
    Shape shape;
    shape.kind = ShapeKind::capsule;
    shape.radius = static_cast<float>(radius);
    shape.half_length = static_cast<float>(half_length);
    return scene.add_shape(std::move(shape));
}

int add_capsule(Scene& scene, taut_pos from, taut_pos to, double radius, double mass, Look look, int32_t group) {
    const double reach = length(minus(to, from));
    const int shape = capsule_shape(scene, radius, reach / 2);
    return add_slim(scene, shape, from, to, {radius, reach + 2 * radius}, mass, look, group);
}

int add_beam(Scene& scene, taut_pos from, taut_pos to, double half_width, double mass, Look look, int32_t group) {
    const double reach = length(minus(to, from));
    const int shape = box_shape(scene, half_width, reach / 2, half_width);
    return add_slim(scene, shape, from, to, {half_width, reach}, mass, look, group);
}

Joint joint_at(const Scene& scene, taut_joint_kind kind, int body_a, int body_b, taut_pos pivot, taut_pos axis_a,
               taut_pos axis_b) {
    Joint joint;
    joint.kind = kind;
    joint.body_a = body_a;
    joint.body_b = body_b;
    joint.anchor_a = in_body(scene, body_a, pivot);
    joint.anchor_b = in_body(scene, body_b, pivot);
    const taut_quat axes = turn_from_to({1, 0, 0}, axis_a);
    joint.rotation_a = in_body(scene, body_a, axes);
    joint.rotation_b = in_body(scene, body_b, times(turn_from_to(axis_a, axis_b), axes));
    return joint;
}

Joint joint_at(const Scene& scene, taut_joint_kind kind, int body_a, int body_b, taut_pos pivot, taut_pos axis) {
    return joint_at(scene, kind, body_a, body_b, pivot, axis, axis);
}

Joint rod_at(const Scene& scene, int body_a, taut_pos point_a, int body_b, taut_pos point_b) {
    Joint joint;
    joint.kind = TAUT_JOINT_DISTANCE;
    joint.body_a = body_a;
    joint.body_b = body_b;
    joint.anchor_a = in_body(scene, body_a, point_a);
    joint.anchor_b = in_body(scene, body_b, point_b);
    joint.length = static_cast<float>(length(minus(point_b, point_a)));
    return joint;
}

Cable cable_along(const Scene& scene, taut_cable_kind kind, std::vector<taut_pos> path, int body_0, int body_1,
                  double diameter, double mass_per_metre) {
    Cable cable;
    taut_cable_def_init(&cable.def);
    cable.def.kind = kind;
    cable.def.diameter = static_cast<float>(diameter);
    cable.def.mass_per_metre = static_cast<float>(mass_per_metre);
    cable.end_body[0] = body_0;
    cable.end_body[1] = body_1;
    for (int e = 0; e < 2; ++e) {
        cable.def.end[e].attached = 1;
        cable.def.end[e].anchor = in_body(scene, cable.end_body[e], e == 0 ? path.front() : path.back());
    }
    cable.path = std::move(path);
    return cable;
}

taut_axis_def free_axis() {
    taut_axis_def axis;
    taut_axis_def_init(&axis);
    return axis;
}

taut_axis_def strong_motor() {
    taut_axis_def axis = free_axis();
    axis.drive.stiffness = 1e9f;
    axis.drive.damping = 1e8f;
    return axis;
}

taut_axis_def limited_axis(double lower, double upper) {
    taut_axis_def axis = free_axis();
    axis.mode = TAUT_AXIS_LIMITED;
    axis.lower = static_cast<float>(lower);
    axis.upper = static_cast<float>(upper);
    return axis;
}

void add_ground(Scene& scene) {
    Shape plane;
    plane.kind = ShapeKind::plane;
    Body ground;
    ground.kind = TAUT_BODY_STATIC;
    ground.shape = scene.add_shape(std::move(plane));
    ground.look = Look::ground;
    scene.add_body(ground);
}

void add_static_box(Scene& scene, taut_pos centre, double half_x, double half_y, double half_z, Look look) {
    Body body;
    body.kind = TAUT_BODY_STATIC;
    body.shape = box_shape(scene, half_x, half_y, half_z);
    body.position = centre;
    body.look = look;
    scene.add_body(body);
}

void add_bin(Scene& scene, double half, double height, double thickness) {
    for (double sign : {-1.0, 1.0}) {
        const double at = sign * (half + thickness / 2), along = half + thickness;
        add_static_box(scene, {at, height / 2, 0}, thickness / 2, height / 2, along, Look::wall);
        add_static_box(scene, {0, height / 2, at}, along, height / 2, thickness / 2, Look::wall);
    }
}

Body crate(int shape, taut_pos position, double mass, Look look) {
    Body body;
    body.shape = shape;
    body.position = position;
    body.mass = static_cast<float>(mass);
    body.look = look;
    return body;
}

void add_chain(Scene& scene, const ChainPlan& plan) {
    Chain chain;
    chain.anchor = plan.anchor;
    chain.link_length = plan.link_length;
    chain.length = plan.links * plan.link_length + plan.weight_reach;
    double half = plan.link_length / 2, c = cosine(plan.angle), s = sine(plan.angle);
    int link_shape = box_shape(scene, half, plan.link_thickness / 2, plan.link_thickness / 2);
    taut_pos end_of_last = plan.anchor;
    int last = kWorld;
    for (int i = 0; i <= plan.links; ++i) {
        bool is_weight = i == plan.links;
        double reach = is_weight ? plan.weight_reach : half;  // from the joint to the centre
        double along = i * plan.link_length + reach;
        Body body = crate(is_weight ? plan.weight_shape : link_shape, plus(plan.anchor, c * along, s * along, 0),
                          is_weight ? plan.weight_mass : plan.link_mass, is_weight ? Look::steel : Look::link);
        body.rotation = turn({0, 0, 1}, plan.angle);
        body.group = kChainGroup;
        Joint joint;
        joint.body_a = last;
        joint.body_b = scene.add_body(body);
        joint.anchor_a = end_of_last;
        joint.anchor_b = {-reach, 0, 0};
        chain.joints.push_back(scene.add_joint(joint));
        chain.bodies.push_back(joint.body_b);
        chain.hang_depth.push_back(along);
        last = joint.body_b;
        end_of_last = {half, 0, 0};
    }
    scene.roles.chain = std::move(chain);
}

void perturb(Scene& scene, uint64_t seed, ChainStart start) {
    if (seed == 0) return;
    Random random(seed * 0x2545f4914f6cdd1du);
    std::vector<bool> in_chain(scene.bodies.size(), false);
    if (scene.roles.chain) {
        const Chain& chain = *scene.roles.chain;
        double angle = random.around_zero() * std::numbers::pi / 6;
        double speed = std::pow(10.0, -3 + 2.5 * random.uniform());  // [m/s]
        if (start == ChainStart::turned) turn_chain(scene, chain, angle);
        for (int index : chain.bodies) {
            taut_vec3 v = random.in_cube(speed), &old = scene.bodies[index].linear_velocity;
            old = {old.x + v.x, old.y + v.y, old.z + v.z};
            in_chain[index] = true;
        }
    }
    std::vector<bool> jointed(scene.bodies.size(), false);
    for (const Joint& joint : scene.joints)
        for (int end : {joint.body_a, joint.body_b})
            if (end != kWorld) jointed[static_cast<size_t>(end)] = true;
    for (const Cable& cable : scene.cables)
        for (int end : cable.end_body)
            if (end != kWorld) jointed[static_cast<size_t>(end)] = true;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        Body& body = scene.bodies[i];
        if (in_chain[i] || body.kind == TAUT_BODY_STATIC || body.kind == TAUT_BODY_KINEMATIC) continue;
        taut_vec3 offset = random.in_cube(jointed[i] ? 0 : 1e-3);  // [m]
        body.position = plus(body.position, offset.x, std::fabs(offset.y), offset.z);
        body.linear_velocity = random.in_cube(1e-2);   // [m/s]
        body.angular_velocity = random.in_cube(1e-2);  // [rad/s]
    }
    const auto shake = [&](auto& soft) {
        soft.velocities.resize(soft.points.size());
        for (taut_vec3& v : soft.velocities) {
            const taut_vec3 more = random.in_cube(1e-2);  // [m/s]
            v = {v.x + more.x, v.y + more.y, v.z + more.z};
        }
        for (const uint32_t vertex : soft.pinned) soft.velocities[vertex] = {0, 0, 0};
    };
    for (Cloth& cloth : scene.cloths) shake(cloth);
    for (Solid& solid : scene.solids) shake(solid);
}

void decorate_with_crane(Scene& scene, taut_pos anchor) {
    constexpr double kBack = 3.0, kHalf = 0.16;  // [m]
    double top = anchor.y + 2 * kHalf;
    scene.decorations.push_back(
        {{anchor.x, anchor.y + kHalf, anchor.z - kBack / 2 + 0.1},
         {static_cast<float>(kHalf), static_cast<float>(kHalf), static_cast<float>(kBack / 2 + 0.2)}});
    scene.decorations.push_back(
        {{anchor.x, top / 2, anchor.z - kBack},
         {static_cast<float>(1.3 * kHalf), static_cast<float>(top / 2), static_cast<float>(1.3 * kHalf)}});
    scene.decorations.push_back({{anchor.x, 0.1, anchor.z - kBack}, {0.7f, 0.1f, 0.7f}});
}

}  // namespace scenes
