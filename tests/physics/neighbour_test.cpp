// Nothing feels what it does not touch, not by a bit: contacts are swept sixteen pairs at a time, whoever lies beside.
#include "physics/lab.h"

namespace {

using namespace lab;

// Two planks on a ball joint that tumble on the ground, and sticks that whirl further along z and touch neither.
std::vector<BodyState> path_of_plank(int sticks) {
    World world;
    world.add_ground();
    const taut_shape plank = world.box({0.5, 0.05, 0.1}), stick = world.box({0.5, 0.02, 0.02});
    const Quat tilted = Quat::turn({0.3, 0.2, 1}, 0.4);
    const taut_body a =
        world.add({.shape = plank, .position = {0, 0.3, 0}, .rotation = tilted, .spin = {0.2, 1.5, 0.3}, .mass = 1});
    const taut_body b = world.add({.shape = plank, .position = {1, 0.3, 0}, .mass = 1});
    world.ball(a, {0.5, 0, 0}, b, {-0.5, 0, 0});
    for (int i = 0; i < sticks; ++i)
        world.add({.shape = stick,
                   .position = {0, 0.3 + 0.02 * i, 5.0 + 3 * i},
                   .rotation = Quat::turn({1, 0, 0}, 0.3 * i),
                   .spin = {30.0 + i, 20, 0},
                   .mass = 1});
    std::vector<BodyState> path;
    for (int frame = 0; frame < 60; ++frame) {
        world.step(1);
        path.push_back(state(a));
    }
    return path;
}

TEST(Neighbours, WhoTouchNothingOfItChangeNoBit) {
    const std::vector<BodyState> alone = path_of_plank(0);
    for (int sticks : {1, 12, 40}) {
        SCOPED_TRACE(sticks);
        const std::vector<BodyState> beside = path_of_plank(sticks);
        for (size_t frame = 0; frame < alone.size(); ++frame) {
            ASSERT_EQ(norm(beside[frame].position - alone[frame].position), 0) << "frame " << frame;
            ASSERT_EQ(norm(beside[frame].velocity - alone[frame].velocity), 0) << "frame " << frame;
            ASSERT_EQ(norm(beside[frame].spin - alone[frame].spin), 0) << "frame " << frame;
        }
    }
}

}  // namespace
