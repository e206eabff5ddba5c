// Compliant joints are springs: force = -error / compliance - damping * rate, whatever the frame rate.
#include "physics/lab.h"

namespace {

using namespace lab;

constexpr double kMass = 8;               // [kg], a period of 2 s
constexpr double kCompliance = 1 / 80.0;  // [m/N]
constexpr double kLength = 1;             // [m]

double critical() { return 2 * std::sqrt(kMass / kCompliance); }  // [N s/m]

// A weight on a spring from the world's origin downwards, at its unstretched length less `stretch`.
struct Hung {
    Hung(World& world, bool particle, double damping, double stretch) {
        const Vec at(0, -kLength - stretch, 0);
        weight = particle ? world.particle(kMass, at)
                          : world.add({.shape = world.box({0.1, 0.1, 0.1}), .position = at, .mass = kMass});
        spring = world.rod({}, {0, 0, 0}, weight, {}, kLength, kCompliance, damping);
    }
    double stretch() const { return -position(weight).y - kLength; }
    taut_body weight{};
    taut_joint spring{};
};

class Spring : public testing::TestWithParam<bool> {};

TEST_P(Spring, SagsByWeightTimesComplianceAtAnyFrameRate) {
    for (double hertz : {30.0, 60.0, 120.0}) {
        World world([&](taut_world_def& def) { def.time_step = static_cast<float>(1 / hertz); });
        const Hung hung(world, GetParam(), critical(), 0);
        world.step(static_cast<int>(5 * hertz));
        EXPECT_NEAR(hung.stretch() / (kMass * kG * kCompliance), 1, 0.005) << hertz << " Hz";
        taut_vec3 force{};
        ok(taut_joint_get_force(hung.spring, &force));
        EXPECT_NEAR(Vec(force).y / (kMass * kG), 1, 0.005) << hertz << " Hz";
    }
}

TEST_P(Spring, OscillatesAtItsPeriod) {
    World world;
    const double sag = kMass * kG * kCompliance;
    const Hung hung(world, GetParam(), 0, sag + 0.2);
    Crossings crossings;
    for (int frame = 1; frame <= 600; ++frame) {
        world.step();
        crossings.sample(frame * world.frame(), hung.stretch() - sag);
    }
    const double exact = 2 * kPi * std::sqrt(kMass * kCompliance);
    EXPECT_NEAR(crossings.period() / exact, 1, 0.02);
}

// Successive maxima of x'' + 2 z w x' + w^2 x = 0 fall by exp(-2 pi z / sqrt(1 - z^2)). Implicit Euler in substeps
// of h adds w h / 2 of its own to z (the roots of 1 + 2 z w h + (w h)^2 to first order): 0.007 here.
TEST_P(Spring, DampsByItsDampingRatio) {
    for (double ratio : {0.1, 0.2, 0.4}) {
        World world;
        const double sag = kMass * kG * kCompliance, own = static_cast<double>(world.def.time_step) /
                                                           world.def.substeps / 2 / std::sqrt(kMass * kCompliance);
        const Hung hung(world, GetParam(), ratio * critical(), sag + 0.2);
        std::vector<double> peaks = {0.2};
        double before = 0.2, last = 0.2;
        for (int frame = 1; frame <= 600 && peaks.size() < 3; ++frame) {
            world.step();
            const double x = hung.stretch() - sag;
            if (last > before && last > x && last > 0) peaks.push_back(last);
            before = last, last = x;
        }
        ASSERT_EQ(peaks.size(), 3u) << "ratio " << ratio;
        const double decrement = std::log(peaks[0] / peaks[2]) / 2;
        const double found = decrement / std::sqrt(4 * kPi * kPi + decrement * decrement);
        EXPECT_NEAR(found / ratio, 1, 0.10) << "ratio " << ratio << ", found " << found;
        EXPECT_NEAR(found / (ratio + own), 1, 0.03) << "ratio " << ratio << ", found " << found;
    }
}

INSTANTIATE_TEST_SUITE_P(Holds, Spring, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "particle" : "body"; });

// Three springs of a compliant ball joint: sag along gravity, none across.
TEST(SpringyBallJoint, SagsByWeightTimesCompliance) {
    World world;
    const taut_body weight = world.add({.position = {0, 0, 0}, .mass = kMass, .inertia = {0.1, 0.1, 0.1}});
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.base.body_b = weight;
    def.base.compliance = static_cast<float>(kCompliance);
    def.base.damping = static_cast<float>(critical());
    taut_joint joint{};
    ok(taut_world_add_ball_joint(world.handle, &def, &joint));
    world.step(300);
    EXPECT_NEAR(position(weight).y / (-kMass * kG * kCompliance), 1, 0.005);
    float error = 0;
    ok(taut_joint_get_error(joint, &error));
    EXPECT_NEAR(static_cast<double>(error) / (kMass * kG * kCompliance), 1, 0.005);
}

}  // namespace
