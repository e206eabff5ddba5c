// A knee: bones that touch, ligaments that pull from a length on, a kneecap in the tendon of the thigh's muscle, which
// stretches and bends the leg (after Tournier et al. 2015, figure 8).
#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr taut_pos kKnee = {0, 0.9, 0};
constexpr double kCondyle = 0.025, kApart = 0.024;  // radius, half of the distance between the two [m]
constexpr float kSlippery = 0.01f;                  // cartilage
constexpr int32_t kThigh = -1, kShin = -2;          // groups: parts of a bone do not touch each other

Joint weld(const Scene& scene, int a, int b, taut_pos at) { return joint_at(scene, TAUT_JOINT_FIXED, a, b, at); }

// Tight from its length now times slack on; then it gives by force over stiffness [N/m].
Joint ligament(const Scene& scene, int a, taut_pos from, int b, taut_pos to, double slack, double stiffness) {
    Joint band = rod_at(scene, a, from, b, to);
    band.max_length = band.length * static_cast<float>(slack);
    band.compliance = static_cast<float>(1 / stiffness);
    band.damping = static_cast<float>(0.002 * stiffness);
    band.drawn_radius = 0.005;
    return band;
}

}  // namespace

Scene build_knee(double, double, const Options& options) {
    Scene scene = soft_hall(1.2);
    add_ground(scene);
    const auto at = [](double x, double y, double z) { return plus(kKnee, x, y, z); };
    const auto add_part = [&](int shape, taut_pos position, double mass, int32_t group) {
        Body part = crate(shape, position, mass, Look::skin);
        part.friction = kSlippery;
        part.group = group;
        if (mass <= 0) part.kind = TAUT_BODY_STATIC;
        return scene.add_body(part);
    };
    // The thigh lies level and is held.
    const int condyle = sphere_shape(scene, kCondyle);
    for (const double side : {-kApart, kApart}) add_part(condyle, at(0, 0, side), 0, kThigh);
    const int femur = add_capsule(scene, at(-0.4, 0.015, 0), at(-0.045, 0.005, 0), 0.017, 0, Look::skin, kThigh);
    scene.bodies[static_cast<size_t>(femur)].kind = TAUT_BODY_STATIC;

    // The shin hangs: a plateau under the condyles, a shaft and a foot.
    const double top = -kCondyle - 0.008;
    const int plateau = add_part(box_shape(scene, 0.028, 0.008, 0.045), at(0, top, 0), 0.6, kShin);
    const int shaft = add_capsule(scene, at(0, top - 0.03, 0), at(0, -0.4, 0), 0.016, 2.2, Look::skin, kShin);
    const int foot = add_part(box_shape(scene, 0.1, 0.02, 0.035), at(0.055, -0.44, 0), 0.9, kShin);
    scene.add_joint(weld(scene, plateau, shaft, at(0, top - 0.008, 0)));
    scene.add_joint(weld(scene, shaft, foot, at(0, -0.42, 0)));

    const int cap = add_part(sphere_shape(scene, 0.02), at(0.031, 0.031, 0), 0.1, kShin);
    const double under = top - 0.008;
    // Cruciate ligaments inside, collateral ones at the sides, the tendon under the kneecap.
    scene.add_joint(ligament(scene, femur, at(-0.012, 0.004, 0.005), plateau, at(0.018, under, 0.004), 1.01, 1.5e5));
    scene.add_joint(ligament(scene, femur, at(0.006, 0.004, -0.005), plateau, at(-0.02, under, -0.004), 1.01, 1.5e5));
    for (const double side : {-0.052, 0.052}) {
        scene.add_joint(ligament(scene, femur, at(0, 0, side), shaft, at(0, -0.085, 0.6 * side), 1.005, 8e4));
    }
    scene.add_joint(ligament(scene, cap, at(0.031, 0.031, 0), shaft, at(0.022, -0.085, 0), 1.0, 3e5));

    // The muscle: what is drawn in [m] over time. Half of the weight hangs on it, so it is drawn in against a spring.
    Joint muscle = rod_at(scene, femur, at(-0.36, 0.05, 0), cap, at(0.031, 0.031, 0));
    taut_axis_def pull = free_axis();
    pull.drive.stiffness = 4e4f;
    pull.drive.damping = 400;
    muscle.axes = {pull};
    muscle.drawn_radius = 0.011;
    Motion work;
    work.joint = scene.add_joint(muscle);
    work.track.keys = {{0.5, 0, 0}, {2.2, -0.058, 0}, {2.8, -0.058, 0}, {4.2, -0.005, 0}, {5.2, -0.058, 0}, {6, 0, 0}};
    scene.motions.push_back(work);
    scene.forces = ForceScale{0, 3};
    scene.camera = {{0.55, 1.05, 0.85}, {0.02, 0.75, 0}, 38};
    scene.stage = {{-0.7, 0, -0.6}, {0.8, 1.2, 0.6}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
