// Many random mechanisms of swept joints: see tests/physics/swept_joint_test.cpp.
#include "physics/swept_lab.h"

namespace {

using namespace lab;

class SweptJoints : public testing::TestWithParam<taut_solver> {};

constexpr Net kNets[] = {Net::chain, Net::tree, Net::loops, Net::grid};
constexpr double kRates[] = {30, 60, 120, 240};

SweptPlan plan_of(uint32_t seed, taut_solver solver) {
    std::mt19937 random(seed);
    SweptPlan plan;
    plan.seed = seed;
    plan.kind = random() % (kJointKinds + 1);
    plan.net = kNets[random() % 4];
    plan.bodies = plan.net == Net::grid ? 2 + static_cast<int>(random() % 4) : 2 + static_cast<int>(random() % 20);
    plan.held = one_in(random, 2);
    plan.ratio = std::pow(100, draw(random, 0, 1));
    plan.rate = kRates[random() % 4];
    plan.substeps = 1u << random() % 5;
    plan.solver = solver;
    return plan;
}

TEST_P(SweptJoints, GainNoEnergy) {
    constexpr uint32_t kStarts = 400;
    uint32_t gains = 0;
    double most = 0;
    for (uint32_t seed = 1; seed <= kStarts; ++seed) {
        SweptPlan plan = plan_of(seed, GetParam());
        plan.speed = std::pow(10, 0.2 * (seed % 6));
        SweptMechanism thrown(plan);
        thrown.step(static_cast<int>(plan.rate));
        if (thrown.gain > 0.01)
            std::printf("seed %u: gains %.3g (kind %u, net %d of %d, ratio %.0f, %g m/s, %g Hz, %u substeps)\n", seed,
                        thrown.gain, plan.kind, static_cast<int>(plan.net), plan.bodies, plan.ratio, plan.speed,
                        plan.rate, plan.substeps);
        gains += thrown.gain > 0.01;
        most = std::max(most, thrown.gain);
    }
    std::printf("%u of %u gain more than 1 %%, %.4f at most\n", gains, kStarts, most);
    EXPECT_EQ(gains, 0u);
}

// What hangs in balance: chains and trees straight down, grids flat. In steps so long that sweeps take more than these
// ten seconds to find what holds, it still swings.
TEST_P(SweptJoints, StayAtRest) {
    constexpr uint32_t kStarts = 200;
    uint32_t starts = 0, moves = 0;
    double gap = 0;
    for (uint32_t seed = 5001; starts < kStarts; ++seed) {
        SweptPlan plan = plan_of(seed, GetParam());
        if (plan.substeps * plan.rate < 240) continue;
        ++starts;
        plan.held = true;
        SweptMechanism hanging(plan);
        hanging.step(static_cast<int>(10 * plan.rate));
        const double speed = hanging.fastest();
        EXPECT_LT(hanging.gain, 0.01) << "seed " << seed;
        if (speed > 1e-3)
            std::printf("seed %u: %.3g m/s (kind %u, net %d of %d, ratio %.0f, %g Hz, %u substeps)\n", seed, speed,
                        plan.kind, static_cast<int>(plan.net), plan.bodies, plan.ratio, plan.rate, plan.substeps);
        moves += speed > 1e-3;
        gap = std::max(gap, hanging.gap);
    }
    std::printf("%u of %u move by more than 1 mm/s; gaps of at most %.2g m\n", moves, kStarts, gap);
    EXPECT_LE(moves, kStarts / 100);
    EXPECT_LT(gap, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Solver, SweptJoints,
                         testing::Values(TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                         TAUT_SOLVER_ACCELERATED_JACOBI),
                         [](const auto& of) { return std::to_string(static_cast<int>(of.param)); });

}  // namespace
