// Chains of rigid links with a heavy weight, in the air, over an edge and against walls.
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

// The chain of chainN and swing: n 1 kg links, a cube of r kg.
Scene chain_with_weight(double n, double r, double angle, const Options& options) {
    constexpr double kCube = 0.5;
    Scene scene = empty_scene();
    ChainPlan plan;
    const double size = n / 10;  // the view grows with the chain
    plan.links = static_cast<int>(n);
    plan.anchor = {0, 7 * size, 0};
    plan.weight_mass = r;
    plan.weight_shape = cube_shape(scene, kCube);
    plan.weight_reach = kCube / 2;
    plan.angle = angle;
    add_chain(scene, plan);
    perturb(scene, options.seed);
    decorate_with_crane(scene, plan.anchor);
    scene.camera = {{2.5 * size, 4.9 * size, 15.5 * size}, {0.3 * size, 4.3 * size, 0}, 36};
    scene.stage = {{-7 * size, 0, -5}, {7 * size, 9 * size, 5}};
    return scene;
}

// A chain along x whose links turn on crossed pins, one level and one upright: they bend either way and do not twist.
// Pins rub by a torque of at most mu r N, where N = g (R + links beyond) [N] is what would hang on them. Without, the
// weight is a pendulum that nothing but the link on the edge damps: it swings on for up to a minute.
void put_on_pins(Scene& scene, double mu, double radius) {
    const Chain& chain = *scene.roles.chain;
    double hanging = 0;  // [kg]
    for (size_t i = chain.joints.size(); i-- > 1;) {
        hanging += static_cast<double>(scene.bodies[static_cast<size_t>(chain.bodies[i])].mass);
        const double force = -static_cast<double>(scene.world.gravity.y) * hanging;
        taut_axis_def pin = free_axis();
        pin.friction = static_cast<float>(mu * radius * force);
        Joint& joint = scene.joints[static_cast<size_t>(chain.joints[i])];
        joint.kind = TAUT_JOINT_UNIVERSAL;
        joint.rotation_a = joint.rotation_b = turn({0, 1, 0}, -std::numbers::pi / 2);  // its x level, its y upright
        joint.axes = {pin, pin};
    }
}

}  // namespace

Scene build_chain(double n, double r, const Options& options) { return chain_with_weight(n, r, 0, options); }

Scene build_swing(double, double r, const Options& options) {
    Scene scene = chain_with_weight(10, r, -std::numbers::pi / 3, options);  // 30 degrees from straight down
    scene.roles.swings = true;
    return scene;
}

Scene build_chain_over_edge(double, double r, const Options& options) {
    constexpr double kTop = 5, kThickness = 0.06, kGap = 0.005, kCube = 0.5;
    constexpr double kPinRadius = kThickness / 6, kFriction = 0.5;
    constexpr int kLinks = 20;
    Scene scene = empty_scene();
    add_ground(scene);
    // The box ends at x = 0; half of the links lie on it, the others stick out beyond its edge.
    add_static_box(scene, {-4, kTop / 2, 0}, 4, kTop / 2, 2, Look::stone);
    ChainPlan plan;
    plan.links = kLinks;
    plan.link_length = 0.3;
    plan.link_thickness = kThickness;
    plan.anchor = {-0.5 * kLinks * plan.link_length, kTop + kThickness / 2 + kGap, 0};
    plan.weight_mass = r;
    plan.weight_shape = cube_shape(scene, kCube);
    plan.weight_reach = kCube / 2;
    add_chain(scene, plan);
    scene.roles.pile = scene.roles.chain->bodies;
    put_on_pins(scene, kFriction, kPinRadius);
    perturb(scene, options.seed, ChainStart::laid_out);
    scene.camera = {{6.4, 8.6, 9.4}, {-0.7, 4.0, 0}, 42};
    scene.stage = {{-8.5, 0, -4}, {5, 7, 4}};
    return scene;
}

Scene build_wrecking_ball(double, double, const Options& options) {
    constexpr double kRadius = 0.4, kSide = 0.5;
    Scene scene = empty_scene();
    add_ground(scene);
    ChainPlan plan;
    plan.anchor = {0, 8.2, 0.07};  // a little off the wall's plane of symmetry
    plan.links = 8;
    plan.link_length = 0.8;
    plan.link_thickness = 0.1;
    plan.weight_mass = 1000;
    plan.weight_shape = sphere_shape(scene, kRadius);
    plan.weight_reach = kRadius;
    plan.angle = std::numbers::pi;
    add_chain(scene, plan);
    int cube = cube_shape(scene, kSide);
    for (int i = 0; i < 50; ++i) {
        taut_pos at = {0.8, kSide / 2 + i / 10 * kSide, (i % 10 - 4.5) * 0.505};
        scene.roles.pile.push_back(scene.add_body(crate(cube, at, 1, Look::brick)));
    }
    perturb(scene, options.seed);
    decorate_with_crane(scene, plan.anchor);
    scene.camera = {{9.8, 5.8, 14.2}, {0.4, 4.5, 0}, 42};
    scene.stage = {{-8, 0, -7}, {10, 10, 7}};
    return scene;
}

Scene build_main(double, double, const Options& options) {
    constexpr double kRadius = 0.5, kSide = 0.5, kBrickMass = 10;
    constexpr int kWide = 12, kHigh = 7;
    Scene scene = empty_scene();
    add_ground(scene);
    ChainPlan plan;
    plan.anchor = {0, 7.6, 0};
    plan.links = 10;
    plan.link_length = 0.6;
    plan.link_thickness = 0.14;
    plan.weight_mass = 1000;
    plan.weight_shape = sphere_shape(scene, kRadius);
    plan.weight_reach = kRadius;
    plan.angle = std::numbers::pi;
    add_chain(scene, plan);
    int cube = cube_shape(scene, kSide);
    for (int row = 0; row < kHigh; ++row)
        for (int column = 0; column < kWide; ++column) {
            double shift = 0.25 * (row % 2 ? 1 : -1);  // bricks of one row lie across the joints of the next
            taut_pos at = {1.1, kSide / 2 + row * kSide, (column - 0.5 * (kWide - 1) + 0.5 * shift) * 0.502};
            scene.roles.pile.push_back(scene.add_body(crate(cube, at, kBrickMass, Look::brick)));
        }
    perturb(scene, options.seed);
    decorate_with_crane(scene, plan.anchor);
    scene.camera = {{9.2, 5.3, 14.4}, {0.2, 4.4, 0}, 42};
    scene.stage = {{-8, 0, -8}, {12, 9, 8}};
    return scene;
}

}  // namespace scenes
