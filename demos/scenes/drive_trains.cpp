// A car of wheel joints with an engine and a differential, over hills; and gears, a rack and a pulley in one train.
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

constexpr int32_t kJointedCarGroup = -32, kTrainGroup = -33;

// A joint's frame whose x and y axes are two directions of the world that are square to each other.
taut_quat frame_of(taut_pos x, taut_pos y) {
    const taut_quat first = turn_from_to({1, 0, 0}, x);
    return times(turn_from_to(rotated(first, {0, 1, 0}), y), first);
}

// Strut and axle of a wheel.
Joint wheel_at(const Scene& scene, int chassis, int wheel, taut_pos place, taut_pos strut, taut_pos axle) {
    Joint joint = joint_at(scene, TAUT_JOINT_WHEEL, chassis, wheel, place);
    joint.rotation_a = in_body(scene, chassis, frame_of(strut, axle));
    joint.rotation_b = in_body(scene, wheel, frame_of(strut, axle));
    return joint;
}

// Two bodies that a housing guides, each along or about its own axis.
Joint geared(const Scene& scene, taut_joint_kind kind, int a, int b, int housing, taut_pos at_a, taut_pos at_b,
             taut_pos axis_a, taut_pos axis_b, double ratio) {
    const Joint guide_a = joint_at(scene, kind, housing, a, at_a, axis_a),
                guide_b = joint_at(scene, kind, housing, b, at_b, axis_b);
    Joint joint = guide_b;
    joint.body_a = a;
    joint.housing = housing;
    joint.housing_a = {guide_a.anchor_a, guide_a.rotation_a};
    joint.anchor_a = guide_a.anchor_b;
    joint.rotation_a = guide_a.rotation_b;
    joint.housing_b = {guide_b.anchor_a, guide_b.rotation_a};
    joint.ratio = static_cast<float>(ratio);
    joint.drawn_radius = 0;
    if (kind == TAUT_JOINT_GEAR) joint.solve = TAUT_JOINT_SOLVE_DIRECT;
    return joint;
}

taut_axis_def spring(double stiffness, double damping, double target = 0) {
    taut_axis_def axis = free_axis();
    axis.drive.stiffness = static_cast<float>(stiffness);
    axis.drive.damping = static_cast<float>(damping);
    axis.drive.target = static_cast<float>(target);
    return axis;
}

// Flat where the car starts, then waves along and across [m].
double road(double x, double z) {
    const double rise = std::min(1.0, std::max(0.0, 0.2 * (x + 8)));
    return rise * (0.35 * std::sin(0.7 * x) + 0.12 * std::sin(1.9 * x + 0.8 * z));
}

void add_road(Scene& scene) {
    constexpr uint32_t kSamples = 81;
    constexpr double kSpacing = 0.35, kHalf = 0.5 * (kSamples - 1) * kSpacing;
    Shape shape;
    shape.kind = ShapeKind::height_field;
    shape.rows = kSamples;
    shape.spacing = static_cast<float>(kSpacing);
    for (uint32_t row = 0; row < kSamples; ++row)
        for (uint32_t column = 0; column < kSamples; ++column)
            shape.heights.push_back(static_cast<float>(road(column * kSpacing - kHalf, row * kSpacing - kHalf)));
    Body ground;
    ground.kind = TAUT_BODY_STATIC;
    ground.shape = scene.add_shape(std::move(shape));
    ground.position = {-kHalf, 0.5, -kHalf};
    ground.look = Look::wood;
    ground.friction = 1;
    scene.add_body(ground);
}

}  // namespace

Scene build_car(double, double, const Options& options) {
    constexpr double kBase = 2.3, kTrack = 1.5, kWheel = 0.34, kMass = 700, kWheelMass = 22;  // [m], [kg]
    constexpr double kStiffness = 3e4, kStart = -11, kLevel = 0.5 + kWheel;                   // [N/m], [m]
    const taut_pos up = {0, 1, 0}, across = {0, 0, 1};
    Scene scene = empty_scene();
    add_ground(scene);
    add_road(scene);
    Body hull = crate(box_shape(scene, 1.55, 0.22, 0.6), {kStart, kLevel + 0.3, 0}, kMass, Look::paint);
    hull.group = kJointedCarGroup;
    const int chassis = scene.add_body(hull);
    Body cabin = crate(box_shape(scene, 0.7, 0.25, 0.55), {kStart - 0.2, kLevel + 0.75, 0}, 60, Look::crate);
    cabin.group = kJointedCarGroup;
    scene.add_joint(joint_at(scene, TAUT_JOINT_FIXED, chassis, scene.add_body(cabin), {kStart - 0.2, kLevel + 0.5, 0}));
    // The carrier of the differential, which the engine turns.
    const taut_pos middle = {kStart - 0.5 * kBase, kLevel + 0.1, 0};
    const int carrier =
        add_capsule(scene, plus(middle, 0, 0, -0.1), plus(middle, 0, 0, 0.1), 0.12, 15, Look::steel, kJointedCarGroup);
    Joint engine = joint_at(scene, TAUT_JOINT_HINGE, chassis, carrier, middle, across);
    engine.axes = {free_axis()};
    engine.axes[0].drive.damping = INFINITY;
    engine.axes[0].drive.max_force = 1500;
    engine.drawn_radius = 0;
    scene.motions.push_back({-1, scene.add_joint(engine), 0, {}, {{{0.5, 0, 0}, {2.5, -8, -8}}, {}}});
    int rear[2] = {};
    for (int i = 0; i < 4; ++i) {
        const bool front = i < 2;
        const double side = i % 2 == 0 ? -0.5 * kTrack : 0.5 * kTrack;
        const taut_pos place = {kStart + (front ? 0.5 : -0.5) * kBase, kLevel, side};
        const int wheel = add_capsule(scene, plus(place, 0, 0, -0.06), plus(place, 0, 0, 0.06), kWheel, kWheelMass,
                                      Look::stone, kJointedCarGroup);
        scene.bodies[static_cast<size_t>(wheel)].friction = 1;
        Joint joint = wheel_at(scene, chassis, wheel, place, up, across);
        taut_axis_def locked = free_axis();
        locked.mode = TAUT_AXIS_LOCKED;
        taut_axis_def strut = spring(kStiffness, 2500, -(kMass + 60) * 9.81 / 4 / kStiffness);
        strut.mode = TAUT_AXIS_LIMITED;
        strut.lower = -0.2f;
        strut.upper = 0.2f;
        joint.axes = {strut, front ? spring(2e4, 600) : locked, free_axis()};
        const int added = scene.add_joint(joint);
        if (front)
            scene.motions.push_back(
                {-1, added, 1, {}, {{{3, 0, 0}, {4, 0.12, 0}, {5, 0, 0}, {6, -0.12, 0}, {7, 0, 0}}, {}}});
        else
            rear[i - 2] = wheel;
    }
    scene.add_joint(geared(scene, TAUT_JOINT_GEAR, rear[0], rear[1], carrier,
                           scene.bodies[static_cast<size_t>(rear[0])].position,
                           scene.bodies[static_cast<size_t>(rear[1])].position, across, across, -1));
    scene.roles.load = chassis;
    scene.forces = ForceScale{2, 5};
    scene.camera = {{5, 3.4, 8}, {0, 0.8, 0}, 46, {chassis}};
    scene.stage = {{-14, 0, -14}, {14, 4, 14}};
    perturb(scene, options.seed);
    return scene;
}

// A motor turns N gears, each with the next; the last drives a rack that lifts, and a drum's rope over two sheaves.
Scene build_gears(double n, double, const Options& options) {
    constexpr double kHigh = 3, kThick = 0.12, kMotor = 2.5;  // [m], [rad/s]
    const taut_pos across = {0, 0, 1};
    const int count = static_cast<int>(n);
    Scene scene = empty_scene();
    add_ground(scene);
    int last = -1;
    double x = 0, last_radius = 0;
    taut_pos last_at{};
    for (int i = 0; i < count; ++i) {
        const double radius = i % 2 == 0 ? 0.28 : 0.46;
        x += i == 0 ? 0 : last_radius + radius;
        const taut_pos place = {x, kHigh, 0};
        Shape disc;
        disc.kind = ShapeKind::cylinder;
        disc.radius = static_cast<float>(0.97 * radius);
        disc.half_length = static_cast<float>(kThick / 2);
        const double mass = 60 * radius * radius * std::numbers::pi;
        Body wheel = crate(scene.add_shape(std::move(disc)), place, mass, i % 2 == 0 ? Look::steel : Look::brick);
        wheel.rotation = turn_from_to({0, 1, 0}, across);
        wheel.group = kTrainGroup;
        const float about = static_cast<float>(mass * radius * radius / 2), side = about / 2;
        wheel.inertia = {side, about, side, 0, 0, 0};
        wheel.parts = {{box_shape(scene, 0.8 * radius, 0.75 * kThick, 0.06)}};  // a bar that shows how it turns
        const int body = scene.add_body(wheel);
        Joint axle = joint_at(scene, TAUT_JOINT_HINGE, kWorld, body, place, across);
        axle.axes = {free_axis()};
        if (i == 0) {
            axle.axes[0].drive.damping = INFINITY;
            axle.axes[0].drive.max_force = 5e3f;
        }
        const int held = scene.add_joint(axle);
        if (i == 0)
            scene.motions.push_back(
                {-1,
                 held,
                 0,
                 {},
                 {{{0.5, 0, 0}, {1.5, 0.5 * kMotor, kMotor}, {3.5, 2.5 * kMotor, kMotor}, {5, 2.5 * kMotor, -kMotor}},
                  {}}});
        else
            scene.add_joint(geared(scene, TAUT_JOINT_GEAR, last, body, kWorld, last_at, place, across, across,
                                   -last_radius / radius));
        last = body;
        last_at = place;
        last_radius = radius;
    }
    // The rack, on the far side of the last gear, with a weight below.
    const taut_pos rack_at = plus(last_at, last_radius + 0.05, -0.2, 0);
    const int rack =
        add_beam(scene, plus(rack_at, 0, -1, 0), plus(rack_at, 0, 1.4, 0), 0.05, 20, Look::link, kTrainGroup);
    Joint guide = joint_at(scene, TAUT_JOINT_SLIDER, kWorld, rack, rack_at, {0, 1, 0});
    guide.axes = {free_axis()};
    guide.drawn_radius = 0;
    scene.add_joint(guide);
    scene.add_joint(
        geared(scene, TAUT_JOINT_RACK_PINION, last, rack, kWorld, last_at, rack_at, across, {0, 1, 0}, last_radius));
    // A rope from the rack over two sheaves to a crate.
    const taut_pos hook = plus(rack_at, 0, 1.4, 0), load_at = plus(rack_at, 1.6, -0.9, 0);
    Body load = crate(cube_shape(scene, 0.5), load_at, 25);
    load.group = kTrainGroup;
    const int weight = scene.add_body(load);
    Joint rope = joint_at(scene, TAUT_JOINT_PULLEY, rack, weight, hook);
    rope.anchor_b = {0, 0.25, 0};
    rope.housing_a.position = plus(rack_at, 0, 2.6, 0);
    rope.housing_b.position = plus(load_at, 0, 3.5, 0);
    scene.add_joint(rope);
    scene.roles.load = weight;
    scene.forces = ForceScale{1, 4};
    scene.camera = {{0.5 * x + 0.5, 3.4, 6 + 0.4 * x}, {0.5 * x + 0.5, 2.8, 0}, 42};
    scene.stage = {{-2, 0, -3}, {x + 4, 6, 3}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
