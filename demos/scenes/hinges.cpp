// A row of bodies on hinges with stops, held at one end.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

Scene build_hinges(double n, double, const Options& options) {
    constexpr double kLink = 0.2, kThick = 0.14, kWide = 0.4, kMass = 2, kWeight = 100, kCube = 0.4;
    constexpr double kStop = degrees(20);
    constexpr float kDamping = 500;  // [N m s]
    constexpr int32_t kGroup = -1;
    const int count = static_cast<int>(n);
    const double size = 0.2 * n, height = size + 1.2;
    Scene scene = empty_scene();
    add_ground(scene);
    const int shape = box_shape(scene, 0.46 * kLink, kThick / 2, kWide / 2);
    int last = kWorld;
    for (int i = 0; i < count; ++i) {
        Body body = crate(shape, {(i + 0.5) * kLink, height, 0}, kMass, Look::link);
        body.group = kGroup;
        const int next = scene.add_body(body);
        Joint hinge = joint_at(scene, TAUT_JOINT_HINGE, last, next, {i * kLink, height, 0}, {0, 0, 1});
        hinge.axes = {limited_axis(-kStop, kStop)};
        hinge.axes[0].drive.damping = kDamping;
        scene.add_joint(hinge);
        last = next;
    }
    Body weight = crate(cube_shape(scene, kCube), {count * kLink + kCube / 2, height, 0}, kWeight, Look::steel);
    weight.group = kGroup;
    scene.roles.load = scene.add_body(weight);
    scene.add_joint(joint_at(scene, TAUT_JOINT_FIXED, last, scene.roles.load, {count * kLink, height, 0}, {1, 0, 0}));
    scene.forces = ForceScale{2, 4};
    perturb(scene, options.seed);
    decorate_with_crane(scene, {-0.25, height, 0});
    scene.camera = {{-0.1 * size, 0.85 * size, 2.2 * size + 2}, {-0.33 * size, 0.64 * size, 0}, 40};
    scene.stage = {{-size - 1, 0, -5}, {size + 1, height + 1, 4}};
    return scene;
}

}  // namespace scenes
