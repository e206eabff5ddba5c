// Nothing goes through a thin wall or the ground, however it is thrown and spins.
#include <cstdio>

#include "soak/shots.h"

namespace {

using soak::ShootingRange;
using soak::Target;

struct Case {
    const char* name;
    soak::ShotPlan plan;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

constexpr Case kCases[] = {{"plate", {Target::plate, 5, 200}},
                           {"sheet", {Target::sheet, 5, 200}},
                           {"mesh", {Target::mesh, 5, 200}},
                           {"height_field", {Target::height_field, 5, 200}}};

// Of each kind of body; how many came through.
int shoot(const Case& at, int shots, uint64_t seed) {
    int sum = 0;
    std::printf("%s:", at.name);
    for (int kind = 0; kind < ShootingRange::kKinds; ++kind) {
        ShootingRange range(at.plan, seed + static_cast<uint64_t>(kind));
        int through = 0;
        for (int shot = 0; shot < shots; ++shot) through += range.comes_through(kind);
        std::printf(" %s %d", ShootingRange::name(kind), through);
        sum += through;
    }
    std::printf(" of %d each\n", shots);
    return sum;
}

struct ShotsShort : testing::TestWithParam<Case> {};
TEST_P(ShotsShort, NoneComesThrough) { EXPECT_EQ(shoot(GetParam(), 100, 31), 0); }

struct Shots : testing::TestWithParam<Case> {};
TEST_P(Shots, NoneComesThrough) { EXPECT_EQ(shoot(GetParam(), 1000, 4211), 0); }

// Of ragdolls at 20, 50 and 100 m/s by how their joints are solved; how many left a limb behind.
int throw_ragdolls(const Case& at, int throws, uint64_t seed) {
    int sum = 0;
    for (double speed : {20.0, 50.0, 100.0})
        for (taut_joint_solve solve : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT, TAUT_JOINT_SOLVE_BY_LOAD}) {
            ShootingRange range({at.plan.target, speed, speed}, seed);
            int torn = 0, limbs = 0;
            for (int i = 0; i < throws; ++i) {
                const int through = range.limbs_through(solve);
                torn += through > 0;
                limbs += through;
            }
            std::printf("%s, %.0f m/s, solve %d: %d of %d ragdolls leave %d limbs behind\n", at.name, speed,
                        static_cast<int>(solve), torn, throws, limbs);
            sum += torn;
        }
    return sum;
}

struct RagdollsShort : testing::TestWithParam<Case> {};
TEST_P(RagdollsShort, LeaveNoLimbBehind) { EXPECT_EQ(throw_ragdolls(GetParam(), 10, 31), 0); }

struct Ragdolls : testing::TestWithParam<Case> {};
TEST_P(Ragdolls, LeaveNoLimbBehind) { EXPECT_EQ(throw_ragdolls(GetParam(), 200, 977), 0); }

std::string case_name(const testing::TestParamInfo<Case>& tested) { return tested.param.name; }

INSTANTIATE_TEST_SUITE_P(At, ShotsShort, testing::ValuesIn(kCases), case_name);
INSTANTIATE_TEST_SUITE_P(At, Shots, testing::ValuesIn(kCases), case_name);
INSTANTIATE_TEST_SUITE_P(At, RagdollsShort, testing::ValuesIn(kCases), case_name);
INSTANTIATE_TEST_SUITE_P(At, Ragdolls, testing::ValuesIn(kCases), case_name);

}  // namespace
