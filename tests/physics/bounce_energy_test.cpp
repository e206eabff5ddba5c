// No impact gives energy, whatever hits what, and however.
#include "physics/throw_lab.h"

namespace {

using namespace lab;

class NothingGainsEnergy : public testing::TestWithParam<Throw> {};

TEST_P(NothingGainsEnergy, Alone) {
    Thrower thrower(GetParam(), 20);
    for (int shot = 0; shot < 3 * Thrower::kShapes; ++shot)
        EXPECT_LT(thrower.throw_one(shot % Thrower::kShapes), 1.01) << "shape " << shot % Thrower::kShapes;
}

TEST_P(NothingGainsEnergy, InAHeap) { EXPECT_LT(Thrower(GetParam(), 21).throw_heap(24), 1.01); }

// Contacts that are solved directly with joints bounce by Newton's law, from the speed at which each point came: rough
// ones may give a little.
TEST_P(NothingGainsEnergy, InJoints) {
    Thrower thrower(GetParam(), 22);
    const bool may_give = GetParam().solver == TAUT_SOLVER_BLOCK_LDLT && GetParam().friction > 0.5;
    for (int shot = 0; shot < 6; ++shot)
        EXPECT_LT(thrower.throw_chain(shot % 2 == 1), may_give ? 1.25 : 1.02) << "shot " << shot;
}

// A thin rod that spins about its axis and passes another is put back, turn and spin: with the spin in another
// direction it had a hundred times the energy, and heaps ten times theirs.
TEST(PutBack, GainsNoEnergy) {
    Thrower thrower({TAUT_SOLVER_BLOCK_LDLT, 30, 1, 0.2}, 5);
    for (int shot = 0; shot < 60; ++shot) EXPECT_LT(thrower.throw_heap(30), 1.01) << "shot " << shot;
}

INSTANTIATE_TEST_SUITE_P(Plans, NothingGainsEnergy,
                         testing::Values(Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0.6},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 30, 1, 0.3},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 240, 1, 0},
                                         Throw{TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, 60, 8, 0.3},
                                         Throw{TAUT_SOLVER_ACCELERATED_JACOBI, 60, 4, 0.3}));

}  // namespace
