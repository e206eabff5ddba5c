// Stacks and pyramids stand for ten seconds, sink little and come to rest; a deep start comes out gently.
#include "scenes/running_scene.h"

namespace {

using namespace lab;

struct Standing {
    const char* scene;
    double drop_pct, rest_speed;
};

void PrintTo(const Standing& s, std::ostream* out) { *out << s.scene; }

class Stands : public testing::TestWithParam<Standing> {};

TEST_P(Stands, ForTenSecondsAtRest) {
    RunningScene run(GetParam().scene);
    double rest = 0;
    for (int frame = 0; frame < 600; ++frame) {
        run.step();
        if (frame >= 540) rest = std::max(rest, run.pile_speed());
    }
    ASSERT_TRUE(run.sound());
    const auto top = static_cast<size_t>(run.scene.roles.top_body);
    const Vec moved = run.body(top).position - run.start[top].position;
    EXPECT_LE(-100 * moved.y / run.start[top].position.y, GetParam().drop_pct);
    EXPECT_LE(moved.y, 1e-3) << "rose";
    EXPECT_LE(std::hypot(moved.x, moved.z), 0.05) << "leans";
    EXPECT_LE(rest, GetParam().rest_speed);
    RecordProperty("drop_pct", std::to_string(-100 * moved.y / run.start[top].position.y));
    RecordProperty("rest_speed", std::to_string(rest));
    RecordProperty("lateral_mm", std::to_string(1e3 * std::hypot(moved.x, moved.z)));
}

INSTANTIATE_TEST_SUITE_P(Scene, Stands,
                         testing::Values(Standing{"stack10", 1, 0.01}, Standing{"stack20", 1, 0.01},
                                         Standing{"pyramid7", 1, 0.01}, Standing{"pyramid8", 1, 0.01},
                                         Standing{"pyramid9", 1, 0.01}, Standing{"pyramid10", 1, 0.01},
                                         Standing{"pyramid13", 1, 0.01}, Standing{"pyramid30", 1, 0.01},
                                         Standing{"pyramid40", 1, 0.01}, Standing{"heavy_on_light_r10", 1, 0.01}),
                         [](const auto& tested) { return tested.param.scene; });

// Made 0.2 m inside the ground: the push must not throw it out.
TEST(DeepStart, ComesOutWithoutLeavingTheGround) {
    RunningScene run("deep_start");
    const auto cube = static_cast<size_t>(run.scene.roles.pile.front());
    const double rest = 0.5;
    double highest = 0;
    for (uint32_t frame = 0; frame < run.scene.steps; ++frame) {
        run.step();
        highest = std::max(highest, run.body(cube).position.y);
    }
    EXPECT_LE(highest, rest + 0.01);
    EXPECT_NEAR(run.body(cube).position.y, rest, 0.005) << "still inside";
    EXPECT_LE(run.pile_speed(), 0.01);
}

}  // namespace
