// Swept joints gain no energy, come to rest, and close the more the finer their steps: random mechanisms of every joint
// type.
#include "physics/swept_lab.h"

namespace {

using namespace lab;

class SweptBy : public testing::TestWithParam<taut_solver> {
protected:
    bool is_slow() const { return GetParam() == TAUT_SOLVER_ACCELERATED_JACOBI; }  // some thirty times
};

constexpr double kRates[] = {30, 60, 120, 240};
constexpr Net kNets[] = {Net::chain, Net::tree, Net::loops};

TEST_P(SweptBy, ThrownMechanismsGainNoEnergy) {
    uint32_t seed = 11;
    for (uint32_t kind = 0; kind <= kJointKinds; ++kind)
        for (const uint32_t substeps : {1u, 4u, 16u}) {
            if (is_slow() && substeps > 1) continue;
            const double rate = kRates[++seed % 4];
            SweptMechanism thrown({.seed = seed,
                                   .kind = kind,
                                   .net = kNets[seed % 3],
                                   .held = seed % 2 == 0,
                                   .ratio = seed % 5 == 0 ? 100.0 : 10.0,
                                   .speed = 3,
                                   .rate = rate,
                                   .substeps = substeps,
                                   .solver = GetParam()});
            thrown.step(static_cast<int>(rate / 2));
            EXPECT_LT(thrown.gain, 0.01) << "kind " << kind << ", seed " << seed << ", substeps " << substeps;
        }
}

// What spans many joints a sweep hardly reaches: were the correction of gaps among the impulses that are carried on,
// all but the shortest of these chains would leave at kilometres a second.
TEST_P(SweptBy, ChainsHangAtRest) {
    for (const int links : {6, 14, 24}) {
        if (is_slow() && links > 14) continue;
        SweptMechanism hanging({.kind = TAUT_JOINT_BALL, .net = Net::chain, .bodies = links, .solver = GetParam()});
        hanging.step(600);
        EXPECT_LT(hanging.fastest(), 1e-3) << links << " links";
        EXPECT_LT(hanging.gap, 2e-3) << links << " links";
        EXPECT_LT(hanging.gain, 1e-3) << links << " links";
    }
}

TEST_P(SweptBy, GapsShrinkInFinerSteps) {
    const auto widest = [](uint32_t substeps, uint32_t sweeps) {
        SweptMechanism hanging({.seed = 5,
                                .kind = TAUT_JOINT_BALL,
                                .net = Net::chain,
                                .bodies = 16,
                                .substeps = substeps,
                                .sweeps = sweeps,
                                .solver = GetParam()});
        hanging.step(60);
        return hanging.widest;
    };
    EXPECT_LT(widest(4, 0), 0.5 * widest(1, 0));
    EXPECT_LT(widest(16, 0), 0.5 * widest(4, 0));
    EXPECT_LT(widest(1, 4), 0.9 * widest(1, 1));
    EXPECT_LT(widest(1, 16), 0.9 * widest(1, 4));
}

// As wide as it is high: loops of four everywhere.
TEST_P(SweptBy, GridHangsAtRest) {
    SweptMechanism hanging(
        {.kind = TAUT_JOINT_BALL, .net = Net::grid, .bodies = is_slow() ? 5 : 12, .solver = GetParam()});
    hanging.step(300);
    EXPECT_LT(hanging.fastest(), 1e-3);
    EXPECT_LT(hanging.gap, 1e-3);
    EXPECT_LT(hanging.gain, 1e-3);
}

std::string solver_name(const testing::TestParamInfo<taut_solver>& tested) {
    const char* names[] = {"block", "sweeps", "jacobi"};
    return names[tested.param];
}

INSTANTIATE_TEST_SUITE_P(Solver, SweptBy,
                         testing::Values(TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                         TAUT_SOLVER_ACCELERATED_JACOBI),
                         solver_name);

}  // namespace
