// A derrick: mast and boom on driven hinges, a cable that is hauled in at the boom's tip, a load on the ground.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

constexpr int32_t kMachineGroup = -1;

}  // namespace

Scene build_crane(double, double, const Options& options) {
    constexpr double kPivot = 3.2, kBoom = 12, kStart = degrees(38), kLuff = degrees(26), kSlew = -degrees(55);
    constexpr int kLinks = 20;
    constexpr double kCable = 10, kCableMass = 500, kDiameter = 0.12, kLoad = 5000, kHalf = 0.7, kHaul = 3;
    Scene scene = empty_scene();
    add_ground(scene);

    const int mast = add_capsule(scene, {0, 0.6, 0}, {0, kPivot, 0}, 0.45, 4000, Look::paint, kMachineGroup);
    Joint slewing = joint_at(scene, TAUT_JOINT_HINGE, kWorld, mast, {0, 0.2, 0}, {0, 1, 0});
    slewing.axes = {strong_motor()};
    const int slewing_joint = scene.add_joint(slewing);

    const taut_pos foot = {0, kPivot, 0}, tip = plus(foot, kBoom * std::cos(kStart), kBoom * std::sin(kStart), 0);
    const int boom = add_capsule(scene, foot, tip, 0.22, 1500, Look::paint, kMachineGroup);
    Joint luffing = joint_at(scene, TAUT_JOINT_HINGE, mast, boom, foot, {0, 0, 1});
    luffing.axes = {strong_motor()};
    const int luffing_joint = scene.add_joint(luffing);

    // The cable hangs straight, the load stands below it.
    const taut_pos hook = plus(tip, 0, -kCable, 0);
    const double height = hook.y / 2;  // of the load's half, up to the hook
    Body load = crate(box_shape(scene, kHalf, height, kHalf), {hook.x, height, 0}, kLoad, Look::steel);
    load.group = kMachineGroup;
    scene.roles.load = scene.add_body(load);
    Cable cable =
        cable_along(scene, TAUT_CABLE_LINKS, {tip, hook}, boom, scene.roles.load, kDiameter, kCableMass / kCable);
    cable.def.segment_count = kLinks;
    cable.def.filter.group = kMachineGroup;
    const int cable_index = scene.add_cable(cable);

    scene.motions.push_back({-1, luffing_joint, 0, {}, {{{0.5, 0, 0}, {9, kLuff, 0}}, {}}});
    scene.motions.push_back({-1, slewing_joint, 0, {}, {{{6, 0, 0}, {18.5, kSlew, 0}}, {}}});
    scene.motions.push_back({-1, -1, 0, {}, {{{9.5, 0, 0}, {18, -kHaul, 0}}, {}}, cable_index});
    scene.forces = ForceScale{3, 5};
    perturb(scene, options.seed);
    scene.camera = {{-2, 7.5, 21.5}, {4.0, 7.2, 0}, 42};
    scene.stage = {{-3, 0, -6}, {13, 16, 12}};
    return scene;
}

}  // namespace scenes
