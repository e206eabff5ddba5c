// Cables of particles and distance constraints (Tournier et al. 2015, section 5.1 and table 1). They run the
// paper's plain scheme: one solve a step, geometric stiffness damps all motion.
#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

struct CablePlan {
    int count;
    double length;      // [m]
    double point_mass;  // [kg]
    double end_mass;    // [kg]
    taut_pos anchor;
    taut_vec3 direction;
    float time_step;  // [s]
};

Scene cable(const CablePlan& plan, const Options& options) {
    constexpr double kNoise = 1e-3;  // sideways [m/s]
    Scene scene = empty_scene();
    scene.world.time_step = plan.time_step;
    scene.world.substeps = 1;
    scene.world.fixed_substeps = 1;
    scene.world.velocity_filter = 0;
    Chain chain;
    chain.anchor = plan.anchor;
    chain.length = plan.length;
    chain.link_length = plan.length / plan.count;
    Random random(1);
    for (int i = 1; i <= plan.count; ++i) {
        double along = plan.length * i / plan.count;
        Body point;
        point.kind = TAUT_BODY_PARTICLE;
        point.mass = static_cast<float>(i == plan.count ? plan.end_mass : plan.point_mass);
        point.position = {plan.anchor.x + plan.direction.x * along, plan.anchor.y + plan.direction.y * along,
                          plan.anchor.z + plan.direction.z * along};
        point.look = i == plan.count ? Look::steel : Look::particle;
        // Across a vertical cable in both directions, across a horizontal one to its side.
        double across = plan.direction.y != 0 ? kNoise * random.around_zero() : 0;
        point.linear_velocity = {static_cast<float>(across), 0, static_cast<float>(kNoise * random.around_zero())};
        Joint rod;
        rod.kind = TAUT_JOINT_DISTANCE;
        rod.body_a = i == 1 ? kWorld : static_cast<int>(scene.bodies.size()) - 1;
        rod.body_b = scene.add_body(point);
        if (i == 1) rod.anchor_a = plan.anchor;
        rod.length = static_cast<float>(chain.link_length);
        chain.joints.push_back(scene.add_joint(rod));
        chain.bodies.push_back(rod.body_b);
        chain.hang_depth.push_back(along);
    }
    scene.roles.chain = std::move(chain);
    perturb(scene, options.seed);
    decorate_with_crane(scene, plan.anchor);
    double reach = plan.length, low = plan.anchor.y - 0.5 * reach;
    scene.camera = {{0.35 * reach, low + 0.12 * reach, 1.85 * reach + 4}, {0, low + 0.02 * reach, 0}, 38};
    scene.stage = {{-reach - 1, 0, -4}, {reach + 1, plan.anchor.y + 1, 4}};
    return scene;
}

}  // namespace

Scene build_cable(double n, double r, const Options& options) {
    constexpr double kLength = 10, kMass = 500, kTonne = 1000;
    int count = static_cast<int>(n);
    return cable({count, kLength, kMass / count, r * kTonne, {0, kLength + 1, 0}, {0, -1, 0}, 0.01f}, options);
}

Scene build_falling_cable(double n, double, const Options& options) {
    int count = static_cast<int>(n);
    double length = 0.1 * count;
    return cable({count, length, 1, 100, {0, 1.2 * length + 0.5, 0}, {1, 0, 0}, 0.04f}, options);
}

}  // namespace scenes
