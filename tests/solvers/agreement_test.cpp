// Every solver in the list on scenes whose forces are known: what the direct solve gives exactly, the sweeps approach.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/lab.h"
#include "rig.h"

namespace taut::test {
namespace {

constexpr double kGravity = 9.81f;

using lab::position;
using lab::Vec;

// A world through its public interface.
class Scene : public lab::World {
public:
    Scene(size_t solver, uint32_t sweeps)
        : World([=](taut_world_def& d) {
              d.solver = static_cast<taut_solver>(solver);
              d.sweeps = sweeps;
              d.fixed_substeps = 1;  // impulses are of a substep
          }) {}

    taut_body box(const Vec& half, const Vec& at, double mass = 0) const {
        return add({.shape = World::box(half), .position = at, .mass = mass});
    }
    // Normal and friction forces of all contacts of a body in the last substep, added up [N].
    std::pair<double, double> contact_forces(taut_body body) const {
        std::pair<double, double> sum{0, 0};
        for (const taut_contact& contact : contacts()) {
            if (contact.body_a.bits != body.bits && contact.body_b.bits != body.bits) continue;
            sum.first += contact.normal_impulse / substep;
            sum.second += contact.friction_impulse / substep;
        }
        return sum;
    }

    const double substep = def.time_step / def.substeps;
};

double speed(taut_body body) { return norm(lab::velocity(body)); }
double weight_of(taut_body body) { return lab::mass_of(body).mass * kGravity; }
Vec force(taut_joint joint) {
    taut_vec3 out{};
    lab::ok(taut_joint_get_force(joint, &out));
    return out;
}

constexpr taut_body kWorld{0};

class EverySolver : public testing::TestWithParam<size_t> {
protected:
    const Solver& solver() const { return *solvers()[GetParam()]; }
    // Tolerance of the direct solve (results are read as floats) or of one that sweeps.
    double within(double direct, double sweeps) const { return solver().direct ? direct : sweeps; }
};

INSTANTIATE_TEST_SUITE_P(List, EverySolver, testing::ValuesIn(solvers_of_joints()),
                         [](const auto& param) { return std::string(solvers()[param.param]->name); });

// Elastic rows are the same equations for all, so one substep has one answer; sweeps keep velocities in float.
TEST_P(EverySolver, AgreesWithDenseEquationsOfAnElasticChain) {
    Rig rig;
    uint32_t last = kNone;
    for (int i = 0; i < 6; ++i) {
        const uint32_t link = rig.body(1 + i % 3, Vec3(0.1, 0.15, 0.2), Vec3(i + 0.5, 0.1 * i, 0), Quat::Identity(),
                                       Vec3(0, 1, -0.5 * i), Vec3(1, 0, 1));
        rig.ball(last, link, Vec3(last == kNone ? 0 : 0.5, 0, 0), Vec3(-0.5, 0, 0), 1e-5, 1e3);
        last = link;
    }
    rig.rod(kNone, last, Vec3(9, 2, 0), Vec3(0.5, 0, 0), 3, 1e-4, 10);
    rig.settings.geometric_stiffness = false;
    rig.settings.sweeps = 20000;
    rig.settings.stepping = Stepping::velocity;
    rig.begin(solver());
    rig.predict();
    const DenseSubstep exact = solve_dense(rig, {});
    rig.solve();
    EXPECT_LE((velocities(rig) - exact.velocity).norm(), within(1e-8, 1e-5) * exact.velocity.norm());
    double size = 0;
    for (const auto& f : exact.force) size = std::max(size, f.norm());
    for (size_t j = 0; j < exact.force.size(); ++j) {
        const Joint& joint = rig.w.joints.record[j];
        EXPECT_LE((Eigen::VectorXd::Map(joint.lambda, joint.type->rows) - exact.force[j]).norm(),
                  within(1e-8, 1e-4) * size);
    }
}

// Joint k carries what hangs below it. Rows that are swept are soft: S lambda / om^2 long, om = 2 pi 0.25 / h, and
// overdamped, so that a long chain with a weight takes seconds to hang still.
TEST_P(EverySolver, AgreesWithDirectOnHangingChain) {
    Scene scene(GetParam(), 100);
    constexpr int kLinks = 8;
    std::vector<taut_body> link;
    std::vector<taut_joint> joint;
    for (int i = 0; i < kLinks; ++i) {
        link.push_back(scene.box({0.05, 0.5, 0.05}, {0, -0.5 - i, 0}, i + 1 == kLinks ? 10 : 1));
        joint.push_back(i == 0 ? scene.ball(kWorld, {0, 0, 0}, link[0], {0, 0.5, 0})
                               : scene.ball(link[i - 1], {0, -0.5, 0}, link[i], {0, 0.5, 0}));
    }
    scene.step(480);
    double below = 0;
    for (int i = kLinks; i-- > 0;) {
        below += weight_of(link[i]);
        EXPECT_LE(norm(force(joint[i]) - Vec(0, below, 0)), within(1e-6, 1e-3) * below) << "joint " << i;
    }
    const double om = 2 * 3.14159265 * 0.25 / scene.substep;
    const double give =
        kLinks * 7.0 * below / (om * om);  // at most: each joint with the whole load, S <= 7/kg with levers
    EXPECT_NEAR(position(link.back()).y, -kLinks + 0.5, within(1e-9, give));
    for (taut_body body : link) EXPECT_LE(speed(body), within(1e-7, 1e-3));
}

// Particles on elastic rods between two banks, started straight. Velocities are dropped at every peak of the kinetic
// energy, which takes any solver to rest. At rest the horizontal pull H is the same everywhere and rod k carries
// (H, V_k), V_k = m g (n/2 - k): with that, lengths and sag follow.
TEST_P(EverySolver, AgreesWithDirectOnBridge) {
    constexpr int kPlanks = 9;  // particles; one rod more
    constexpr double kMass = 2, kSpacing = 0.5, kPull = 300, kCompliance = 1e-5;
    std::vector<Vec> rest(1);
    std::vector<double> tension, length;
    for (int k = 0; k <= kPlanks; ++k) {
        const double v = kMass * kGravity * (0.5 * kPlanks - k);
        const Vec along(kSpacing, -kSpacing * v / kPull, 0);
        tension.push_back(std::hypot(kPull, v));
        length.push_back(static_cast<float>(norm(along) - kCompliance * tension.back()));
        rest.push_back(rest.back() + along);
    }
    Scene scene(GetParam(), 60);
    std::vector<taut_body> plank;
    std::vector<taut_joint> rod;
    for (int k = 1; k <= kPlanks; ++k) plank.push_back(scene.particle(kMass, {k * kSpacing, 0, 0}));
    for (int k = 0; k <= kPlanks; ++k)
        rod.push_back(scene.rod(k > 0 ? plank[k - 1] : kWorld, {}, k < kPlanks ? plank[k] : kWorld,
                                k < kPlanks ? Vec() : rest.back(), length[k], kCompliance));
    double before = 0;
    for (int frame = 0; frame < 400; ++frame) {
        scene.step(1);
        double now = 0;
        for (taut_body body : plank) now += std::pow(speed(body), 2);
        if (now < before) {
            for (taut_body body : plank) taut_body_set_velocity(body, {0, 0, 0}, {0, 0, 0});
            now = 0;
        }
        before = now;
    }
    for (int k = 1; k <= kPlanks; ++k)
        EXPECT_LE(norm(position(plank[k - 1]) - rest[k]), within(2e-5, 1e-4)) << "particle " << k;
    for (int k = 0; k <= kPlanks; ++k)
        EXPECT_NEAR(norm(force(rod[k])), tension[k], within(1e-3, 1e-2) * tension[k]) << "rod " << k;
}

// A box on the ground, relieved of half its weight by a spring above it and pulled sideways by another within friction.
TEST_P(EverySolver, AgreesWithDirectOnBoxOnTheGroundWithSprings) {
    Scene scene(GetParam(), 200);
    scene.add_ground();
    const taut_body box = scene.box({0.5, 0.25, 0.5}, {0, 0.25, 0}, 20);
    const double weight = weight_of(box), lift = 0.5 * weight, pull = 0.15 * weight, compliance = 1e-3;
    const taut_joint above = scene.rod(box, {0, 0, 0}, kWorld, {0, 3.25, 0}, 3 - compliance * lift, compliance, 50);
    const taut_joint aside = scene.rod(box, {0, -0.2, 0}, kWorld, {4, 0.05, 0}, 4 - compliance * pull, compliance, 50);
    scene.step(120);
    const auto [normal, friction] = scene.contact_forces(box);
    EXPECT_NEAR(norm(force(above)), lift, 5e-3 * weight);
    EXPECT_NEAR(norm(force(aside)), pull, 5e-3 * weight);
    EXPECT_NEAR(normal, weight - lift, 1e-2 * weight);
    EXPECT_GE(friction, 0.99 * pull);  // magnitudes at four points, not all of one direction
    EXPECT_LE(friction, 1.001 * 0.5 * normal);
    EXPECT_LE(norm(position(box) - Vec(0, 0.25, 0)), 2e-3);
    EXPECT_LE(speed(box), 1e-3);
}

// A beam on two supports at one end and on a rigid rod from above at the other: half the weight each, by symmetry.
TEST_P(EverySolver, AgreesWithDirectOnBeamBetweenContactAndRod) {
    Scene scene(GetParam(), 200);
    for (double z : {-0.3, 0.3})
        scene.add({.kind = TAUT_BODY_STATIC, .shape = scene.sphere(0.25), .position = {-0.8, -0.25, z}});
    const taut_body beam = scene.box({1, 0.1, 0.4}, {0, 0.1, 0}, 30);
    const taut_joint rod = scene.rod(beam, {0.8, 0, 0}, kWorld, {0.8, 2, 0}, 1.9);
    scene.step(120);
    const double weight = weight_of(beam);
    EXPECT_NEAR(norm(force(rod)), 0.5 * weight, 1e-2 * weight);
    EXPECT_NEAR(scene.contact_forces(beam).first, 0.5 * weight, 1e-2 * weight);
    EXPECT_LE(norm(position(beam) - Vec(0, 0.1, 0)), 3e-3);
}

// Two boxes side by side, tied by a rigid rod between their tops: the ground carries both.
TEST_P(EverySolver, CarriesJointedBoxesOnTheGround) {
    Scene scene(GetParam(), 200);
    scene.add_ground();
    const taut_body small = scene.box({0.4, 0.3, 0.4}, {-1, 0.3, 0}, 5),
                    large = scene.box({0.4, 0.4, 0.4}, {1, 0.4, 0}, 50);
    scene.ball(small, {0.4, 0.1, 0}, large, {-1.6, 0, 0});
    scene.step(120);
    const double weight = weight_of(small) + weight_of(large);
    EXPECT_NEAR(scene.contact_forces(small).first + scene.contact_forces(large).first, weight, 1e-2 * weight);
    EXPECT_LE(speed(small) + speed(large), 1e-3);
}

// Boxes of many sizes at rest, alone and stacked two by two: each pair of surfaces carries what stands on it.
TEST_P(EverySolver, ContactForcesCarryTheWeight) {
    Scene scene(GetParam(), 100);
    scene.add_ground();
    struct Stack {
        taut_body lower, upper;
    };
    std::vector<Stack> stacks;
    for (int i = 0; i < 4; ++i) {
        const double half = 0.2 + 0.1 * i;
        stacks.push_back({scene.box({half, half, half}, {3.0 * i, half, 0}),
                          scene.box({half, 0.1, half}, {3.0 * i, 2 * half + 0.1, 0})});
    }
    const taut_body alone = scene.box({0.5, 0.5, 0.5}, {-3, 0.5, 0}, 7);
    scene.step(120);
    EXPECT_NEAR(scene.contact_forces(alone).first, weight_of(alone), 2e-3 * weight_of(alone));
    for (const Stack& s : stacks) {
        const double upper = weight_of(s.upper), both = upper + weight_of(s.lower);
        EXPECT_NEAR(scene.contact_forces(s.upper).first, upper, 5e-3 * upper);
        EXPECT_NEAR(scene.contact_forces(s.lower).first - scene.contact_forces(s.upper).first, both, 5e-3 * both);
    }
}

// A ball dropped on the ground leaves it with its restitution times the speed of impact.
TEST_P(EverySolver, BouncesBack) {
    Scene scene(GetParam(), 0);
    scene.add_ground(0.5, 0.6);
    const taut_body ball = scene.add({.shape = scene.sphere(0.5), .position = {0, 2, 0}, .restitution = 0.6});
    double fastest = 0, up = 0;
    for (int frame = 0; frame < 60; ++frame) {
        scene.step();
        const double v = lab::velocity(ball).y;
        fastest = std::max(fastest, -v);
        up = std::max(up, v);
    }
    EXPECT_NEAR(up, 0.6 * fastest, 0.1 * fastest);
}

}  // namespace
}  // namespace taut::test
