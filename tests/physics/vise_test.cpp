// Rows of bodies between something that presses and something that does not yield.
#include <algorithm>

#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"
#include "starts.h"

namespace lab {
namespace {

enum class Kind { boxes, balls, mixed };

taut_shape shape_of(const World& world, Kind kind, double half, std::mt19937& random) {
    if (kind == Kind::balls) return world.sphere(half);
    if (kind == Kind::mixed && random() % 2) return world.cylinder(half, half);
    return world.box({half, half, half});
}

// Two to seven bodies of .1 to 3 kg on the ground, not quite in line, and a plate on a slider that a motor pushes
// against them, and them against a wall.
struct Vise {
    World world;
    std::vector<taut_body> row;
    taut_body plate{}, wall{};

    Vise(Kind kind, double force, std::mt19937& random) {
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({30, 1, 30}), .position = {0, -1, 0}});
        double end = 0.05;
        for (int count = 2 + static_cast<int>(random() % 6); count > 0; --count) {
            const double half = between(random, 0.03, 0.1), turn = kind == Kind::boxes ? between(random, -0.1, 0.1) : 0;
            row.push_back(world.add({.shape = shape_of(world, kind, half, random),
                                     .position = {end + half, half, between(random, -0.02, 0.02)},
                                     .rotation = Quat::turn({0, 1, 0}, turn),
                                     .mass = between(random, 0.1, 3)}));
            end += 2.2 * half;
        }
        wall =
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.1, 0.5, 0.5}), .position = {end + 0.1, 0.5, 0}});
        const Vec start(-0.15, 0.202, 0);
        plate = world.add({.shape = world.box({0.1, 0.2, 0.4}), .position = start, .mass = between(random, 1, 8)});
        auto def = at(world, taut_slider_joint_def_init, {}, plate, start, {1, 0, 0});
        def.slide = motor(between(random, 0.1, 1), force);
        def.base.solve = static_cast<taut_joint_solve>(random() % 3);
        taut_joint joint{};
        ok(taut_world_add_slider_joint(world.handle, &def, &joint));
    }
    double overlap() const {  // the deepest [m]
        std::vector<taut_collider> colliders;
        const auto take = [&](taut_body body) {
            uint32_t count = 0;
            ok(taut_body_get_colliders(body, &colliders.emplace_back(), 1, &count));
        };
        for (const taut_body body : row) take(body);
        take(plate);
        take(wall);
        double deepest = 0;
        for (size_t i = 0; i < row.size(); ++i)
            for (size_t k = i + 1; k < colliders.size(); ++k) {
                taut_distance gap;
                ok(taut_collider_distance(colliders[i], colliders[k], &gap));
                deepest = std::max(deepest, -static_cast<double>(gap.distance));
            }
        return deepest;
    }
};

class ViseOn : public testing::TestWithParam<Kind> {};

// Swept, of 60 starts with 1 kN 44 to 53 were deeper than 5 mm, and of five boxes of .2 kg in line one went through the
// wall; with 100 kN they sank in by up to 22 cm. A body bears up to a hundred thousand times its weight.
TEST_P(ViseOn, HoldsARowThatItPresses) {
    int deep = 0;  // of 80: one row of balls goes in by 43 mm
    for (const double force : {200.0, 1e3, 1e4, 1e5}) {
        std::mt19937 random(static_cast<uint32_t>(force));
        for (int start = 0; start < starts(20); ++start) {
            Vise vise(GetParam(), force, random);
            vise.world.step(180);
            EXPECT_LT(vise.overlap(), 0.05) << force << " N, start " << start;
            deep += vise.overlap() >= 0.008;
        }
    }
    EXPECT_LE(deep, 1);
}

INSTANTIATE_TEST_SUITE_P(Row, ViseOn, testing::Values(Kind::boxes, Kind::balls, Kind::mixed), [](const auto& of) {
    return of.param == Kind::boxes ? "of_boxes" : of.param == Kind::balls ? "of_balls" : "of_mixed";
});

// Two fingers on a carriage grip three boxes of .2 kg in a row and lift them by friction alone.
TEST(Gripper, LiftsARowOfBoxes) {
    for (const double force : {20.0, 100.0, 1e3}) {
        World world;
        world.add_ground();
        constexpr double kHalf = 0.05;
        std::vector<taut_body> boxes;
        for (const double x : {-2 * kHalf, 0.0, 2 * kHalf})
            boxes.push_back(
                world.add({.shape = world.box({kHalf, kHalf, kHalf}), .position = {x, kHalf, 0}, .mass = 0.2}));
        const taut_body carriage = world.add({.kind = TAUT_BODY_KINEMATIC, .position = {0, 1, 0}});
        for (const double side : {-1.0, 1.0}) {
            const Vec start(side * (3 * kHalf + 0.06), kHalf, 0);
            const taut_body finger =
                world.add({.shape = world.box({0.03, kHalf, kHalf}), .position = start, .mass = 0.5});
            slider(world, carriage, finger, start, {-side, 0, 0}, motor(0.3, force));
        }
        world.step(60);
        ok(taut_body_set_velocity(carriage, {0, 0.5f, 0}, {}));
        world.step(120);
        ok(taut_body_set_velocity(carriage, {}, {}));
        world.step(60);
        for (const taut_body box : boxes) EXPECT_NEAR(position(box).y, kHalf + 1, 0.01) << force << " N";
        EXPECT_NEAR(position(boxes[2]).x - position(boxes[0]).x, 4 * kHalf, 0.004) << force << " N";
    }
}

}  // namespace
}  // namespace lab
