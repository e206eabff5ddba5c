// Swept joints gain no energy, come to rest, and close the more the finer their steps: random mechanisms of every joint
// type.
#include "physics/swept_lab.h"

namespace {

using namespace lab;

class SweptBy : public testing::TestWithParam<taut_solver> {};

constexpr double kRates[] = {30, 60, 120, 240};

TEST_P(SweptBy, ThrownMechanismsGainNoEnergy) {
    const bool jacobi = GetParam() == TAUT_SOLVER_ACCELERATED_JACOBI;  // some thirty times as slow
    uint64_t seed = 11;
    for (int kind = -1; kind < kJointKinds; ++kind)
        for (const uint32_t substeps : {1u, 4u, 16u}) {
            if (jacobi && substeps > 1) continue;
            SweptPlan plan;
            plan.seed = ++seed;
            plan.kind = kind;
            plan.loops = static_cast<int>(seed % 3) * 3;
            plan.held = seed % 2 == 0;
            plan.ratio = seed % 5 == 0 ? 100 : 10;
            plan.speed = 3;
            plan.substeps = substeps;
            plan.rate = kRates[seed % 4];
            plan.solver = GetParam();
            SweptMechanism thrown(plan);
            thrown.step(static_cast<int>(plan.rate / 2));
            EXPECT_LT(thrown.gain, 0.01) << "kind " << kind << ", seed " << seed << ", substeps " << substeps;
        }
}

// What spans many joints a sweep hardly reaches: were the correction of gaps among the impulses that are carried on, all
// but the shortest of these chains would leave at kilometres a second.
TEST_P(SweptBy, ChainsHangAtRest) {
    const bool jacobi = GetParam() == TAUT_SOLVER_ACCELERATED_JACOBI;
    for (const int links : {6, 14, 24}) {
        if (jacobi && links > 14) continue;
        SweptPlan plan;
        plan.kind = static_cast<int>(JointKind::ball);
        plan.chain = true;
        plan.bodies = links;
        plan.solver = GetParam();
        SweptMechanism hanging(plan);
        hanging.step(600);
        EXPECT_LT(hanging.fastest(), 1e-3) << links << " links";
        EXPECT_LT(hanging.gap(), 2e-3) << links << " links";
        EXPECT_LT(hanging.gain, 1e-3) << links << " links";
    }
}

TEST_P(SweptBy, GapsShrinkInFinerSteps) {
    const auto gap = [](uint32_t substeps, uint32_t sweeps) {
        SweptPlan plan;
        plan.seed = 5;
        plan.kind = static_cast<int>(JointKind::ball);
        plan.chain = true;
        plan.bodies = 16;
        plan.substeps = substeps;
        plan.sweeps = sweeps;
        plan.solver = GetParam();
        SweptMechanism hanging(plan);
        double most = 0;
        for (int frame = 0; frame < 60; ++frame) {
            hanging.step(1);
            most = std::max(most, hanging.gap());
        }
        return most;
    };
    EXPECT_LT(gap(4, 0), 0.5 * gap(1, 0));
    EXPECT_LT(gap(16, 0), 0.5 * gap(4, 0));
    EXPECT_LT(gap(1, 4), 0.9 * gap(1, 1));
    EXPECT_LT(gap(1, 16), 0.9 * gap(1, 4));
}

// A net hung by its upper row, as wide as it is high: loops of four everywhere.
TEST_P(SweptBy, NetHangsAtRest) {
    const int side = GetParam() == TAUT_SOLVER_ACCELERATED_JACOBI ? 5 : 12;
    const World world([](taut_world_def& def) { def.solver = GetParam(); });
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;
    const auto join = [&](taut_body a, const Vec& at_a, taut_body b, const Vec& at_b) {
        taut_ball_joint_def d;
        taut_ball_joint_def_init(&d);
        d.body_a = a, d.body_b = b, d.anchor_a = at_a.pos(), d.anchor_b = at_b.pos();
        d.solve = TAUT_JOINT_SOLVE_SOFT;
        taut_joint out{};
        ok(taut_world_add_ball_joint(world.handle, &d, &out));
        joints.push_back(out);
    };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const Vec at(0.3 * i, -0.3 * k, 0);
            const taut_body above = k > 0 ? bodies.back() : taut_body{};
            bodies.push_back(world.add({.position = at, .mass = 2, .inertia = {0.01, 0.01, 0.01}}));
            join(above, k > 0 ? Vec(0, -0.15, 0) : at + Vec(0, 0.15, 0), bodies.back(), {0, 0.15, 0});
            if (i > 0) join(bodies[bodies.size() - 1 - side], {0.15, 0, 0}, bodies.back(), {-0.15, 0, 0});
        }
    const double start = totals(bodies).height;
    world.step(300);
    double most = 0, gap = 0;
    for (const taut_body body : bodies) most = std::max(most, norm(velocity(body)));
    for (const taut_joint joint : joints) gap = std::max(gap, error(joint));
    EXPECT_LT(most, 1e-3);
    EXPECT_LT(gap, 1e-3);
    EXPECT_LE(totals(bodies).height, start + 1e-6 * std::abs(start));
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
