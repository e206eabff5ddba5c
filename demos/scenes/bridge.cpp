// A suspension bridge and a truck of eight tonnes that drives over it.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

constexpr int kPlanks = 16;
constexpr double kPlank = 1.5, kSpan = kPlanks * kPlank, kDeck = 5, kThick = 0.2;  // height of the deck's top [m]
constexpr double kHalfWidth = 1.7, kCableSide = 1.9;                               // off the middle line [m]
constexpr double kTower = kDeck + 4.6, kSag = 3.6;                                 // [m]
constexpr double kPlankMass = 400, kLinkMass = 25, kTruckMass = 8000;              // [kg]
constexpr float kDeckDamping = 3000;                                               // of a hinge [N m s]
constexpr int32_t kBridgeGroup = -1, kTruckGroup = -2;

struct Strength {
    double hanger = 0, deck = 0, weak_deck = 0;  // breaking forces; weak: of every fifth hinge; 0: any [N]
};

double x_of(int i) { return -kSpan / 2 + i * kPlank; }

double cable_height(int i) {
    const double s = 2 * x_of(i) / kSpan;
    return kTower - kSag * (1 - s * s);
}

// Planks on hinges across the bridge; at the far end the last one slides on its bearing, so that the deck can sag.
std::vector<int> add_deck(Scene& scene, const Strength& strength) {
    std::vector<int> planks;
    const int shape = box_shape(scene, kPlank / 2 - 0.02, kThick / 2, kHalfWidth);
    for (int i = 0; i <= kPlanks; ++i) {
        if (i < kPlanks) {
            Body plank = crate(shape, {x_of(i) + kPlank / 2, kDeck - kThick / 2, 0}, kPlankMass, Look::wood);
            plank.group = kBridgeGroup;
            plank.friction = 0.9f;
            planks.push_back(scene.add_body(plank));
        }
        const taut_pos pivot = {x_of(i), kDeck - kThick / 2, 0};
        const int before = i == 0 ? kWorld : planks[static_cast<size_t>(i) - 1];
        Joint joint;
        if (i < kPlanks) {
            joint = joint_at(scene, TAUT_JOINT_HINGE, before, planks.back(), pivot, {0, 0, 1});
            joint.axes = {free_axis()};
            joint.axes[0].drive.damping = kDeckDamping;
        } else {
            joint = joint_at(scene, TAUT_JOINT_SIX_DOF, kWorld, before, pivot);
            joint.axes.assign(6, free_axis());
            joint.axes[0] = limited_axis(-0.5, 0.5);
            joint.axes[1].mode = TAUT_AXIS_LOCKED;
        }
        joint.break_force = static_cast<float>(i % 5 == 0 ? strength.weak_deck : strength.deck);
        scene.add_joint(joint);
    }
    return planks;
}

// One side's main cable from tower to tower, and its hangers to the edges of the planks.
void add_cable(Scene& scene, double side, const std::vector<int>& planks, const Strength& strength) {
    int last = kWorld;
    for (int i = 0; i <= kPlanks; ++i) {
        const taut_pos top = {x_of(i), cable_height(i), side};
        if (i == kPlanks) {
            scene.add_joint(joint_at(scene, TAUT_JOINT_BALL, kWorld, last, top));
            break;
        }
        const taut_pos next = {x_of(i + 1), cable_height(i + 1), side};
        const int link = add_capsule(scene, top, next, 0.06, kLinkMass, Look::link, kBridgeGroup);
        scene.add_joint(joint_at(scene, TAUT_JOINT_BALL, last, link, top));
        if (i > 0) {
            Joint hanger = rod_at(scene, link, top, planks[static_cast<size_t>(i)],
                                  {x_of(i), kDeck - kThick / 2, side < 0 ? -kHalfWidth : kHalfWidth});
            hanger.max_length = hanger.length;
            hanger.compliance = 2e-7f;
            hanger.damping = 2e4f;
            hanger.break_force = static_cast<float>(strength.hanger);
            scene.add_joint(hanger);
        }
        last = link;
    }
    // Back stays, for the eye and for what falls on them.
    for (double sign : {-1.0, 1.0}) {
        const int stay = add_capsule(scene, {sign * kSpan / 2, kTower, side}, {sign * (kSpan / 2 + 7), kDeck, side},
                                     0.06, 0, Look::steel, kBridgeGroup);
        scene.bodies[static_cast<size_t>(stay)].kind = TAUT_BODY_STATIC;
    }
}

void add_banks(Scene& scene) {
    constexpr double kBank = 8;
    for (double sign : {-1.0, 1.0}) {
        add_static_box(scene, {sign * (kSpan / 2 + kBank / 2 + 0.05), kDeck / 2, 0}, kBank / 2, kDeck / 2, 3,
                       Look::stone);
        scene.bodies.back().friction = 0.9f;
        for (double side : {-kCableSide, kCableSide}) {
            add_static_box(scene, {sign * (kSpan / 2 + 0.2), kTower / 2, side}, 0.18, kTower / 2 + 0.1, 0.14,
                           Look::stone);
            scene.bodies.back().group = kBridgeGroup;  // the cable ends inside
        }
        add_static_box(scene, {sign * (kSpan / 2 + 0.2), kTower - 0.3, 0}, 0.18, 0.2, kCableSide, Look::stone);
    }
}

// A body with a cab fixed to it, on four driven wheels.
void add_truck(Scene& scene, double x) {
    constexpr double kWheel = 0.45, kWheelMass = 150, kCabMass = 900, kTrack = 1.05, kBase = 1.5;
    const double axle = kDeck + kWheel, bed = axle + 0.15;
    auto part = [&](int shape, taut_pos at, double mass, Look look) {
        Body body = crate(shape, at, mass, look);
        body.group = kTruckGroup;
        body.friction = 0.9f;
        return scene.add_body(body);
    };
    const int freight = part(box_shape(scene, 1.5, 0.75, 0.85), {x - 0.6, bed + 0.75, 0},
                             kTruckMass - kCabMass - 4 * kWheelMass, Look::paint);
    const int cab = part(box_shape(scene, 0.6, 0.85, 0.85), {x + 1.55, bed + 0.85, 0}, kCabMass, Look::steel);
    scene.add_joint(joint_at(scene, TAUT_JOINT_FIXED, freight, cab, {x + 0.9, bed + 0.5, 0}));
    scene.roles.load = freight;

    const int wheel = sphere_shape(scene, kWheel);
    constexpr double kSpeed = 4, kWay = kSpan + 11;  // [m/s], [m]
    for (double forward : {-kBase, kBase})
        for (double side : {-kTrack, kTrack}) {
            const taut_pos at = {x + forward, axle, side};
            const int body = part(wheel, at, kWheelMass, Look::steel);
            Joint joint = joint_at(scene, TAUT_JOINT_HINGE, freight, body, at, {0, 0, 1});
            taut_axis_def motor = free_axis();
            motor.drive.damping = 1e4f;
            motor.drive.max_force = 4000;
            joint.axes = {motor};
            const double turn = -1 / kWheel;  // forwards is a turn to the right
            Track drive;
            drive.keys = {{0.5, 0, 0},
                          {2, 0.5 * 1.5 * kSpeed * turn, kSpeed * turn},
                          {2 + (kWay - 6) / kSpeed, (0.5 * 1.5 * kSpeed + kWay - 6) * turn, kSpeed * turn},
                          {4 + (kWay - 6) / kSpeed, (0.5 * 3.5 * kSpeed + kWay - 6) * turn, 0}};
            scene.motions.push_back({-1, scene.add_joint(joint), 0, {}, drive});
        }
}

Scene bridge(const Strength& strength, const Options& options) {
    Scene scene = empty_scene();
    add_ground(scene);
    add_banks(scene);
    const std::vector<int> planks = add_deck(scene, strength);
    for (double side : {-kCableSide, kCableSide}) add_cable(scene, side, planks, strength);
    scene.roles.pile = planks;
    add_truck(scene, -kSpan / 2 - 4.5);
    scene.forces = ForceScale{3, 5};
    perturb(scene, options.seed);
    scene.camera = {{7, 10.5, 31}, {0, 6.4, 0}, 38};
    scene.stage = {{-20, 0, -5}, {20, kTower + 1, 5}};
    for (Joint& joint : scene.joints) joint.solve = TAUT_JOINT_SOLVE_DIRECT;  // what carries a load over many joints
    return scene;
}

}  // namespace

Scene build_bridge(double, double, const Options& options) { return bridge({}, options); }

Scene build_bridge_breaking(double, double, const Options& options) { return bridge({45e3, 3e6, 500e3}, options); }

}  // namespace scenes
