// A net of bodies tied by ball joints, hung by three corners: closed loops everywhere.
#include "builders.h"
#include "parts.h"

namespace scenes {

Scene build_net(double n, double, const Options& options) {
    constexpr double kLink = 0.5, kRadius = 0.09;  // [m]
    constexpr float kMass = 1, kInertia = 0.02f;   // [kg], [kg m^2]: of a cross of thin arms
    const int side = static_cast<int>(n);
    const double width = kLink * (side - 1), height = 1.1 * width + 1;
    Scene scene = empty_scene();
    const int knot = sphere_shape(scene, kRadius);
    const auto place = [&](int i, int k) { return taut_pos{kLink * i - width / 2, height, kLink * k - width / 2}; };
    const auto at = [side](int i, int k) { return i * side + k; };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            Body body = crate(knot, place(i, k), kMass, Look::particle);
            body.inertia = {kInertia, kInertia, kInertia, 0, 0, 0};
            body.group = -1;
            scene.add_body(body);
        }
    const auto tie = [&](int a, taut_pos anchor_a, int b, taut_pos anchor_b) {
        Joint joint;
        joint.body_a = a;
        joint.body_b = b;
        joint.anchor_a = anchor_a;
        joint.anchor_b = anchor_b;
        scene.add_joint(joint);
    };
    constexpr double kArm = kLink / 2;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            if (i + 1 < side) tie(at(i, k), {kArm, 0, 0}, at(i + 1, k), {-kArm, 0, 0});
            if (k + 1 < side) tie(at(i, k), {0, 0, kArm}, at(i, k + 1), {0, 0, -kArm});
        }
    const int last = side - 1;
    tie(kWorld, place(0, 0), at(0, 0), {});
    if (side > 1) {
        tie(kWorld, place(last, 0), at(last, 0), {});
        tie(kWorld, place(0, last), at(0, last), {});
    }
    scene.roles.mesh_width = kLink;
    perturb(scene, options.seed);
    scene.camera = {{0.8 * width + 1, height + 0.45 * width, 1.2 * width + 2}, {0, 0.9 * height, 0}, 42};
    scene.stage = {{-width, 0, -width}, {width, height + 1, width}};
    return scene;
}

}  // namespace scenes
