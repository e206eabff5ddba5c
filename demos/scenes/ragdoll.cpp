// Ragdolls of twelve bodies and 75 kg: a heap of them, and one that hangs by both hands from a bar on a liana.
#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// Which way the limbs bend. x is to the doll's left, z where it looks.
struct Doll {
    Scene& scene;
    taut_pos hip;      // middle of the pelvis
    double stiff = 4;  // friction of every joint [N m]

    taut_pos at(double x, double y, double z = 0) const { return plus(hip, x, y, z); }
    int limb(taut_pos from, taut_pos to, double radius, double mass, Look look) const {
        // The round ends reach the joints.
        return add_capsule(scene, toward(from, to, radius), toward(to, from, radius), radius, mass, look);
    }
    void cone(int a, int b, taut_pos pivot, taut_pos axis_a, taut_pos axis_b, double swing, double twist) const {
        Joint joint = joint_at(scene, TAUT_JOINT_CONE_TWIST, a, b, pivot, axis_a, axis_b);
        taut_axis_def cone = limited_axis(0, swing), roll = limited_axis(-twist, twist);
        cone.lower = -INFINITY;
        cone.friction = roll.friction = static_cast<float>(stiff);
        joint.axes = {cone, roll};
        scene.add_joint(joint);
    }
    void hinge(int a, int b, taut_pos pivot, taut_pos axis, double most) const {
        Joint joint = joint_at(scene, TAUT_JOINT_HINGE, a, b, pivot, axis);
        taut_axis_def bend = limited_axis(0, most);
        bend.friction = static_cast<float>(stiff);
        joint.axes = {bend};
        scene.add_joint(joint);
    }
    void leg(int pelvis, double side) const {
        const taut_pos top = at(0.11 * side, -0.06), knee = at(0.12 * side, -0.48), foot = at(0.12 * side, -0.92);
        const int thigh = limb(top, knee, 0.075, 8.5, Look::cloth), shin = limb(knee, foot, 0.055, 4.3, Look::skin);
        cone(pelvis, thigh, top, {0.15 * side, -0.85, 0.5}, minus(knee, top), degrees(60), degrees(30));
        hinge(thigh, shin, knee, {1, 0, 0}, degrees(140));
    }
    struct Trunk {
        int pelvis, chest;
    };
    Trunk trunk() const {
        const int pelvis = limb(at(-0.16, 0), at(0.16, 0), 0.095, 11, Look::cloth);
        const int belly = limb(at(0, 0.05), at(0, 0.27), 0.1, 10, Look::cloth);
        const int chest = limb(at(-0.17, 0.38), at(0.17, 0.38), 0.115, 16, Look::cloth);
        const int head = limb(at(0, 0.52, 0.03), at(0, 0.76, 0.06), 0.095, 5, Look::skin);
        cone(pelvis, belly, at(0, 0.08), {0, 1, 0}, {0, 1, 0}, degrees(25), degrees(20));
        cone(belly, chest, at(0, 0.27), {0, 1, 0}, {0, 1, 0}, degrees(25), degrees(20));
        cone(chest, head, at(0, 0.52, 0.02), {0, 1, 0}, {0, 1, 0}, degrees(35), degrees(50));
        return {pelvis, chest};
    }
    // Returns the forearm; the hand is at the grip.
    int arm(int chest, double side, taut_pos grip) const {
        const taut_pos shoulder = at(0.2 * side, 0.47);
        const double reach = length(minus(grip, shoulder));
        const taut_pos elbow = toward(shoulder, grip, 0.52 * reach);
        const int upper = limb(shoulder, elbow, 0.045, 2.2, Look::cloth),
                  fore = limb(elbow, grip, 0.04, 1.9, Look::skin);
        const taut_pos out = {0.6 * side, 0.35, 0.7}, along = minus(elbow, shoulder);
        cone(chest, upper, shoulder, out, along, degrees(110), degrees(80));
        // Flexing brings the raised hand forwards and down.
        hinge(upper, fore, elbow, {1, 0, 0}, degrees(145));
        return fore;
    }
    void all() const {
        const auto [pelvis, chest] = trunk();
        for (double side : {-1.0, 1.0}) {
            leg(pelvis, side);
            arm(chest, side, at(0.55 * side, 0.05, 0.1));
        }
    }
};

}  // namespace

Scene build_ragdolls(double n, double, const Options& options) {
    constexpr int kRow = 4;
    constexpr double kSpacing = 1.1, kLayer = 1.9, kBin = 2.6, kWallHeight = 5.0, kWallThickness = 0.5;  // [m]
    Scene scene = empty_scene();
    add_ground(scene);
    add_bin(scene, kBin, kWallHeight, kWallThickness);
    Random random(1);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1);
        const taut_vec3 shift = random.in_cube(0.1);
        const Doll doll{scene, plus({(column - middle) * kSpacing, 1.2 + layer * kLayer, (row - middle) * kSpacing},
                                    shift.x, shift.y, shift.z)};
        const size_t first = scene.bodies.size();
        doll.all();
        for (size_t body = first; body < scene.bodies.size(); ++body)
            scene.roles.pile.push_back(static_cast<int>(body));
    }
    scene.roles.bin = Bounds{{-kBin, 0, -kBin}, {kBin, 1e3, kBin}};
    perturb(scene, options.seed);
    scene.camera = {{5.5, 5.0, 7.5}, {0, 1.2, 0}, 42};
    scene.stage = {{-4, 0, -4}, {4, 12, 4}};
    return scene;
}

Scene build_rain(double n, double, const Options& options) {
    constexpr int kRow = 10, kBeams = 21;
    constexpr double kApart = 1.6, kLayer = 2.2, kBeam = 0.15, kGap = 1, kHeight = 3;  // [m]
    Scene scene = empty_scene();
    add_ground(scene);
    for (int i = 0; i < kBeams; ++i)
        for (int k = 0; k < kBeams; ++k)
            add_static_box(scene, {kGap * (i - 0.5 * (kBeams - 1)), kHeight, kGap * (k - 0.5 * (kBeams - 1))}, kBeam,
                           kBeam, kBeam, Look::stone);
    Random random(1);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        const auto at = [&](int k) { return kApart * (k - 0.5 * (kRow - 1)); };
        const taut_vec3 shift = random.in_cube(0.2);
        const Doll doll{scene, plus({at(i % kRow), kHeight + 2 + kLayer * (i / (kRow * kRow)), at(i / kRow % kRow)},
                                    shift.x, shift.y, shift.z)};
        const size_t first = scene.bodies.size();
        doll.all();
        for (size_t body = first; body < scene.bodies.size(); ++body)
            scene.roles.pile.push_back(static_cast<int>(body));
    }
    perturb(scene, options.seed);
    scene.camera = {{18, 12, 24}, {0, 3, 0}, 42};
    scene.stage = {{-12, 0, -12}, {12, 16, 12}};
    return scene;
}

Scene build_ragdoll_liana(double, double, const Options& options) {
    constexpr double kTop = 7.5, kLink = 0.5, kShake = 0.35;
    constexpr int kLinks = 10;
    Scene scene = empty_scene();
    add_ground(scene);

    Body branch = crate(box_shape(scene, 0.25, 0.08, 0.25), {0, kTop + 0.08, 0}, 0, Look::wood);
    branch.kind = TAUT_BODY_KINEMATIC;
    const int top = scene.add_body(branch);
    scene.motions.push_back({top, -1, 0, {1, 0.35f, 0.3f}, {{}, {kShake, 0.9, 1, 7}}});
    const taut_pos end = {0, kTop - kLinks * kLink, 0};
    const int bar = add_capsule(scene, plus(end, -0.3, 0, 0), plus(end, 0.3, 0, 0), 0.025, 2, Look::wood);
    Cable liana = cable_along(scene, TAUT_CABLE_LINKS, {{0, kTop, 0}, end}, top, bar, 0.07, 4);
    liana.def.segment_count = kLinks;
    scene.add_cable(liana);

    const Doll doll{scene, plus(end, 0, -0.98, 0)};
    const auto [pelvis, chest] = doll.trunk();
    for (double side : {-1.0, 1.0}) {
        doll.leg(pelvis, side);
        const taut_pos grip = doll.at(0.2 * side, 0.98);
        const int fore = doll.arm(chest, side, grip);
        scene.add_joint(joint_at(scene, TAUT_JOINT_BALL, bar, fore, grip));
    }
    scene.roles.load = chest;
    scene.forces = ForceScale{2, 4};
    perturb(scene, options.seed);
    scene.camera = {{2.3, 4.1, 7.9}, {-0.4, 4.3, 0}, 50};
    scene.stage = {{-5, 0, -5}, {5, 9, 5}};
    return scene;
}

// One falls on its back on a trampoline, feet first.
Scene build_ragdoll_on_trampoline(double, double, const Options& options) {
    constexpr int kSide = 26;
    constexpr double kWide = 2.5, kLean = -1.2;  // [m], [rad]
    Scene scene = soft_hall(1.6);
    add_ground(scene);
    add_trampoline(scene, kSide, kWide);
    const taut_pos hip = {0.1, kTrampolineHeight + 1.5, -0.1};
    const Doll doll{scene, hip};
    const size_t first = scene.bodies.size();
    const auto [pelvis, chest] = doll.trunk();
    for (double side : {-1.0, 1.0}) {
        doll.leg(pelvis, side);
        doll.arm(chest, side, doll.at(0.55 * side, 0.05, 0.1));
    }
    const taut_quat lean = turn({1, 0, 0}, kLean);
    for (size_t i = first; i < scene.bodies.size(); ++i) {
        Body& body = scene.bodies[i];
        const taut_pos out = rotated(lean, minus(body.position, hip));
        body.position = plus(hip, out.x, out.y, out.z);
        body.rotation = times(lean, body.rotation);
    }
    scene.roles.load = chest;
    scene.camera = {{3.2, 2.6, 4.2}, {0, 1.25, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, 4, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
