// Of many throws with restitution 1 none gains energy from an impact.
#include <cstdio>

#include "physics/throw_lab.h"

namespace {

using namespace lab;

struct Gains {
    double most = 0;
    int above = 0, count = 0;  // by more than 1 %
    void add(double gain) {
        most = std::max(most, gain);
        above += gain > 1.01;
        ++count;
    }
};

class Bounces : public testing::TestWithParam<Throw> {};

TEST_P(Bounces, GainNoEnergy) {
    Thrower thrower(GetParam(), 977);
    Gains alone[Thrower::kShapes], heap, chain;
    for (int shot = 0; shot < 100 * Thrower::kShapes; ++shot)
        alone[shot % Thrower::kShapes].add(thrower.throw_one(shot % Thrower::kShapes));
    for (int shot = 0; shot < 15; ++shot) heap.add(thrower.throw_heap(30));
    for (int shot = 0; shot < 80; ++shot) chain.add(thrower.throw_chain(shot % 2 == 1));
    for (int kind = 0; kind < Thrower::kShapes; ++kind) {
        std::printf("shape %d: %d of %d gain more than 1 %%, most %.4f\n", kind, alone[kind].above, alone[kind].count,
                    alone[kind].most);
        EXPECT_EQ(alone[kind].above, 0) << "shape " << kind;
    }
    std::printf("heaps: %d of %d, most %.4f; chains: %d of %d, most %.4f\n", heap.above, heap.count, heap.most,
                chain.above, chain.count, chain.most);
    EXPECT_EQ(heap.above, 0);
    EXPECT_LE(chain.above, chain.count / 15);
    EXPECT_LT(chain.most, 1.3);
}

INSTANTIATE_TEST_SUITE_P(Soak, Bounces,
                         testing::Values(Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0.5},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 30, 1, 0.2},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 120, 16, 0.2},
                                         Throw{TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, 60, 2, 0.3},
                                         Throw{TAUT_SOLVER_ACCELERATED_JACOBI, 60, 4, 0.3}));

}  // namespace
