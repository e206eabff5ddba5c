// A Ferris wheel: two rims that close on themselves, cars between them, a motor at the hub.
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

Scene build_ferris_wheel(double n, double, const Options& options) {
    constexpr double kRadius = 5, kHeight = 6.6, kRim = 0.85, kSpeed = 0.35;  // [m], [rad/s]
    constexpr double kGive = 1e-8;  // of what closes a loop [m/N]: steel yields too, and rows stay distinct
    constexpr int32_t kGroup = -1;
    const int count = static_cast<int>(n);
    Scene scene = empty_scene();
    add_ground(scene);
    const taut_pos hub_at = {0, kHeight, 0};
    const int hub = add_capsule(scene, plus(hub_at, 0, 0, -1), plus(hub_at, 0, 0, 1), 0.3, 800, Look::steel, kGroup);
    scene.roles.load = hub;
    Joint axle = joint_at(scene, TAUT_JOINT_HINGE, kWorld, hub, hub_at, {0, 0, 1});
    axle.axes = {free_axis()};
    axle.axes[0].drive.damping = INFINITY;
    axle.axes[0].drive.max_force = 3e5f;
    const double begin = 0.5 * 2 * kSpeed;  // turned while it gathers speed
    scene.motions.push_back({-1, scene.add_joint(axle), 0, {}, {{{0, 0, 0}, {2, begin, kSpeed}}, {}}});

    auto tip = [&](int i, double z) {
        const double angle = 2 * std::numbers::pi * (i % count + 0.5) / count;
        return plus(hub_at, kRadius * std::cos(angle), kRadius * std::sin(angle), z);
    };
    std::vector<int> spokes[2];
    for (int rim = 0; rim < 2; ++rim) {
        const double z = rim ? kRim : -kRim;
        const taut_pos middle_of = plus(hub_at, 0, 0, z);
        for (int i = 0; i < count; ++i) {
            const taut_pos root = toward(middle_of, tip(i, z), 0.3);
            const int spoke = add_capsule(scene, root, tip(i, z), 0.06, 60, Look::link, kGroup);
            scene.add_joint(joint_at(scene, TAUT_JOINT_FIXED, hub, spoke, root, minus(tip(i, z), root)));
            spokes[rim].push_back(spoke);
        }
        for (int i = 0; i < count; ++i) {
            const int rail = add_capsule(scene, tip(i, z), tip(i + 1, z), 0.05, 50, Look::link, kGroup);
            scene.add_joint(joint_at(scene, TAUT_JOINT_BALL, spokes[rim][static_cast<size_t>(i)], rail, tip(i, z)));
            Joint closing = joint_at(scene, TAUT_JOINT_BALL, spokes[rim][static_cast<size_t>((i + 1) % count)], rail,
                                     tip(i + 1, z));
            closing.compliance = kGive;
            closing.damping = 1e4f;
            scene.add_joint(closing);
        }
    }
    const int car_shape = box_shape(scene, 0.55, 0.5, 0.6);
    for (int i = 0; i < count; ++i) {
        Body car = crate(car_shape, plus(tip(i, 0), 0, -0.75, 0), 250);
        car.group = kGroup;
        const int body = scene.add_body(car);
        Joint hinge =
            joint_at(scene, TAUT_JOINT_HINGE, spokes[0][static_cast<size_t>(i)], body, tip(i, -kRim), {0, 0, 1});
        hinge.axes = {free_axis()};
        hinge.axes[0].drive.damping = 60;
        scene.add_joint(hinge);
        Joint other = joint_at(scene, TAUT_JOINT_BALL, spokes[1][static_cast<size_t>(i)], body, tip(i, kRim));
        other.compliance = kGive;
        other.damping = 1e4f;
        scene.add_joint(other);
    }
    for (double z : {-1.45, 1.45}) {  // the stand
        for (double foot : {-2.6, 2.6}) {
            const int leg = add_capsule(scene, {foot, 0, z}, plus(hub_at, 0, 0, z), 0.12, 0, Look::stone, kGroup);
            scene.bodies[static_cast<size_t>(leg)].kind = TAUT_BODY_STATIC;
        }
    }
    scene.forces = ForceScale{2, 5};
    perturb(scene, options.seed);
    scene.camera = {{7, 6.8, 16.5}, {0, 6, 0}, 44};
    scene.stage = {{-7, 0, -4}, {7, 13, 4}};
    return scene;
}

}  // namespace scenes
