// A mechanism that would pass something is put back where it was before the step. One whose joint pulls it there in
// every frame must not hang for good: after some frames it goes on.
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

// Two balls on either side of a plate that their joint pulls together: moved back as one, one or the other has passed.
struct Torn {
    taut_joint_solve solve;
    double apart;  // [m]
};

void PrintTo(const Torn& torn, std::ostream* out) {
    *out << (torn.solve == TAUT_JOINT_SOLVE_DIRECT ? "direct" : "swept") << ", " << torn.apart << " m apart";
}

class HeldBack : public testing::TestWithParam<Torn> {};

TEST_P(HeldBack, WaitsAndGoesOn) {
    World world(weightless);
    world.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(world, Wall::plate)});
    const taut_shape ball = world.sphere(0.1);
    const double off = GetParam().apart / 2;
    const taut_body a = world.add({.shape = ball, .position = {-off - 0.03, 0, 0}, .mass = 1});
    const taut_body b = world.add({.shape = ball, .position = {off, 0, 0}, .mass = 1});
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.body_a = a;
    def.body_b = b;
    def.solve = GetParam().solve;
    taut_joint joint{};
    ok(taut_world_add_ball_joint(world.handle, &def, &joint));
    const auto gap = [&] { return norm(state(a).position - state(b).position); };
    world.step(2);
    const double held = gap();
    EXPECT_GT(held, 0.3);
    world.step(7);
    EXPECT_EQ(gap(), held) << "was not held back";
    world.step(111);
    EXPECT_LT(gap(), 0.03) << "hangs";
}

INSTANTIATE_TEST_SUITE_P(Joints, HeldBack,
                         testing::Values(Torn{TAUT_JOINT_SOLVE_DIRECT, 0.4}, Torn{TAUT_JOINT_SOLVE_SOFT, 1}),
                         [](const auto& tested) {
                             return tested.param.solve == TAUT_JOINT_SOLVE_DIRECT ? "direct" : "swept";
                         });

}  // namespace
