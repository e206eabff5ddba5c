// Floors of solids side by side go as one: what slides or rolls over the seams meets no face between them, but every
// step, wall and ramp that stands out.
#include <ostream>

#include "physics/surface_lab.h"

namespace {

using namespace lab;

enum class Tiles { boxes, colliders, hulls, boxes_and_hulls, meshes, boxes_and_meshes, kinematic, lift };
enum class Slider { box, ball, capsule, cylinder, stone, crate, raft };

struct Course {
    Tiles tiles;
    Slider slider;
    double speed, rate;  // [m/s], [Hz]
    uint32_t substeps;

    friend std::ostream& operator<<(std::ostream& out, const Course& c) {
        constexpr const char* kTiles[] = {"boxes",  "colliders",        "hulls",     "boxes and hulls",
                                          "meshes", "boxes and meshes", "kinematic", "lift"};
        constexpr const char* kSliders[] = {"box", "ball", "capsule", "cylinder", "stone", "crate", "raft"};
        return out << kSliders[static_cast<int>(c.slider)] << " on " << kTiles[static_cast<int>(c.tiles)] << " at "
                   << c.speed << " m/s, " << c.rate << " Hz, " << c.substeps << " substeps";
    }
};

constexpr double kTile = 0.9, kDepth = 0.35, kLift = 0.6;  // [m], [m], [m/s]

void change(taut_world_def& def, double rate, uint32_t substeps) {
    def.time_step = static_cast<float>(1 / rate);
    def.substeps = substeps;
}

taut_shape hull_box(const World& world, const Vec& half) {
    std::vector<taut_vec3> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(Vec(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z).narrow());
    return hull(world, points);
}

taut_body add_collider(taut_body body, taut_shape shape, const Vec& position, double friction) {
    taut_collider_def d;
    taut_collider_def_init(&d);
    d.shape = shape;
    d.position = position.narrow();
    d.material.friction = static_cast<float>(friction);
    taut_collider out{};
    ok(taut_body_add_collider(body, &d, &out));
    return body;
}

// Along x about the origin, tops at y = 0.
void add_tiles(const World& world, Tiles tiles, int count, double friction) {
    const Vec half(kTile / 2, kDepth / 2, 2);
    taut_body first{};
    for (int i = 0; i < count; ++i) {
        const double x = (i - 0.5 * (count - 1)) * kTile;
        const bool other = i % 2 != 0;
        if (tiles == Tiles::colliders && i > 0) {
            add_collider(first, world.box(half), {i * kTile, 0, 0}, friction);
            continue;
        }
        BodyPlan plan{.kind = TAUT_BODY_STATIC, .position = {x, -kDepth / 2, 0}, .friction = friction};
        if (tiles == Tiles::meshes || (tiles == Tiles::boxes_and_meshes && other)) {
            plan.shape = mesh(world, grid(kTile, 4, kTile / 2));
            plan.position = {x - kTile / 2, 0, -2};
        } else if (tiles == Tiles::hulls || (tiles == Tiles::boxes_and_hulls && other)) {
            plan.shape = hull_box(world, half);
        } else {
            plan.shape = world.box(half);
        }
        if (tiles == Tiles::kinematic || tiles == Tiles::lift) plan.kind = TAUT_BODY_KINEMATIC;
        if (tiles == Tiles::lift) plan.velocity = {0, kLift, 0};
        first = world.add(plan);
    }
}

taut_body add_slider(const World& world, Slider slider, double x, double friction) {
    switch (slider) {
        case Slider::box:
            return world.add({.shape = world.box({0.35, 0.25, 0.3}), .position = {x, 0.25, 0}, .friction = friction});
        case Slider::ball:
            return world.add({.shape = world.sphere(0.22), .position = {x, 0.22, 0}, .friction = friction});
        case Slider::capsule:
            return world.add({.shape = world.capsule(0.15, 0.35),
                              .position = {x, 0.15, 0},
                              .rotation = Quat::turn({1, 0, 0}, kPi / 2),
                              .friction = friction});
        case Slider::cylinder:
            return world.add({.shape = world.cylinder(0.28, 0.2), .position = {x, 0.2, 0}, .friction = friction});
        case Slider::stone:
            return world.add({.shape = stone(world), .position = {x, 0.2, 0}, .friction = friction});
        case Slider::crate:
            return world.add({.shape = world.box({0.45, 0.08, 0.45}), .position = {x, 0.08, 0}, .friction = friction});
        default: {
            const taut_shape plank = world.box({0.16, 0.06, 0.2});
            const taut_body raft = world.add({.shape = plank, .position = {x, 0.06, 0}, .friction = friction});
            for (int i = 1; i < 4; ++i) add_collider(raft, plank, {0.32 * (i % 2), 0, 0.4 * (i / 2)}, friction);
            return raft;
        }
    }
}

struct Ride {
    double speed_lost = 0;      // share of the first
    double rose = 0, sank = 0;  // against where it lay [m]
    double aside = 0;           // [m]
};

Ride slide(const Course& course) {
    World world([&](taut_world_def& def) { change(def, course.rate, course.substeps); });
    add_tiles(world, course.tiles, 14, 0);
    const taut_body body = add_slider(world, course.slider, -4.13, 0);
    world.step(static_cast<int>(course.rate / 3));
    const double lift = course.tiles == Tiles::lift ? kLift : 0;
    ok(taut_body_set_velocity(body, Vec(course.speed, lift, 0).narrow(), Vec().narrow()));
    const Vec from = position(body);
    Ride ride;
    const double way = course.speed < 2 ? 2.5 : 8;  // [m]
    const int most = static_cast<int>(1.5 * way / course.speed * course.rate);
    for (int frame = 1; frame <= most && position(body).x < from.x + way; ++frame) {
        world.step();
        const Vec at = position(body);
        const double height = at.y - from.y - lift * frame / course.rate;
        ride.rose = std::max(ride.rose, height);
        ride.sank = std::max(ride.sank, -height);
        ride.aside = std::max(ride.aside, std::abs(at.z - from.z));
    }
    ride.speed_lost = 1 - velocity(body).x / course.speed;
    return ride;
}

class TileSeams : public testing::TestWithParam<Course> {};

TEST_P(TileSeams, CatchNothing) {
    const Ride ride = slide(GetParam());
    EXPECT_LT(std::abs(ride.speed_lost), 1e-3);
    // As it comes onto the next tile its contacts are new there: they let it fall for a substep, and what has colliders
    // side by side then tilts.
    const double substep = 1 / (GetParam().rate * GetParam().substeps), fall = kG * substep * substep;
    EXPECT_LT(ride.rose, 1e-3 + (GetParam().slider == Slider::raft ? 2 * fall : 0));
    EXPECT_LT(ride.sank, 1e-3 + fall);
    EXPECT_LT(ride.aside, 2e-3);
}

std::vector<Course> courses() {
    constexpr double kSpeeds[] = {1.1, 4.5, 18}, kRates[] = {60, 240, 30, 120};
    constexpr uint32_t kSubsteps[] = {4, 1, 8, 2, 16};
    std::vector<Course> out;
    size_t i = 0;
    for (int tiles = 0; tiles <= static_cast<int>(Tiles::lift); ++tiles)
        for (int slider = 0; slider <= static_cast<int>(Slider::raft); ++slider)
            for (const double speed : kSpeeds) {
                const double rate = kRates[i % 4];
                const uint32_t substeps = kSubsteps[i % 5];
                // At 30 Hz what lies sinks in by 11 mm in single steps.
                out.push_back({static_cast<Tiles>(tiles), static_cast<Slider>(slider), speed, rate,
                               rate == 30 ? std::max(substeps, 2u) : substeps});
                ++i;
            }
    return out;
}

INSTANTIATE_TEST_SUITE_P(Level, TileSeams, testing::ValuesIn(courses()));

// Thrown with v a crate stops after v^2 / (2 mu g), over seams as well.
TEST(TileSeam, CrateStopsWhereFrictionSays) {
    constexpr double kMu = 0.45, kSpeed = 4.4;
    const double expected = kSpeed * kSpeed / (2 * kMu * kG);
    for (const auto& [rate, substeps] : {std::pair(60.0, 4u), std::pair(30.0, 2u), std::pair(240.0, 1u)})
        for (const Tiles tiles : {Tiles::boxes, Tiles::hulls, Tiles::colliders}) {
            World world([&](taut_world_def& def) { change(def, rate, substeps); });
            add_tiles(world, tiles, 8, kMu);
            const taut_body body = add_slider(world, Slider::crate, -1.77, kMu);
            world.step(static_cast<int>(rate / 3));
            const Vec from = position(body);
            ok(taut_body_set_velocity(body, Vec(kSpeed, 0, 0).narrow(), Vec().narrow()));
            double rose = 0;
            for (int i = 0; i < static_cast<int>(2 * rate); ++i) {
                world.step();
                rose = std::max(rose, position(body).y - from.y);
            }
            EXPECT_NEAR(position(body).x - from.x, expected, 0.05 * expected) << rate;
            EXPECT_LT(rose, 2e-3) << rate;
        }
}

// What moves past its own thickness in a frame is looked for along its way, where seams catch nothing either.
TEST(TileSeam, FastOnesCatchNothing) {
    for (const double speed : {25.0, 110.0})
        for (const double radius : {0.03, 0.12})
            for (const bool is_ball : {false, true}) {
                World world;
                add_tiles(world, Tiles::boxes, 40, 0);
                const taut_shape shape = is_ball ? world.sphere(radius) : world.box({radius, radius, radius});
                const taut_body body = world.add(
                    {.shape = shape, .position = {-16.07, radius, 0}, .velocity = {speed, 0, 0}, .friction = 0});
                double rose = 0;
                for (int i = 0; i < static_cast<int>(30 / speed * 60); ++i) {
                    world.step();
                    rose = std::max(rose, position(body).y - radius);
                }
                EXPECT_NEAR(velocity(body).x, speed, 1e-3 * speed) << radius << " " << is_ball;
                EXPECT_LT(rose, 1e-3) << radius << " " << is_ball << " " << speed;
            }
}

// What joints hold is solved directly with its contacts, which are found again within the frame.
TEST(TileSeam, JointedBodiesCatchNothing) {
    for (const double speed : {1.0, 5.0, 12.0}) {
        World world;
        add_tiles(world, Tiles::boxes, 20, 0);
        std::vector<taut_body> sled;
        for (int i = 0; i < 4; ++i)
            sled.push_back(world.add({.shape = i == 1 ? world.sphere(0.2) : world.box({0.2, 0.2, 0.2}),
                                      .position = {-6 + 0.6 * i, 0.2, 0},
                                      .velocity = {speed, 0, 0},
                                      .mass = i == 0 ? 400.0 : 1.0,
                                      .friction = 0}));
        for (size_t i = 1; i < sled.size(); ++i) world.ball(sled[i - 1], {0.3, 0, 0}, sled[i], {-0.3, 0, 0});
        double rose = 0;
        for (int i = 0; i < static_cast<int>(8 / speed * 60); ++i) {
            world.step();
            for (const taut_body body : sled) rose = std::max(rose, position(body).y - 0.2);
        }
        for (const taut_body body : sled) EXPECT_NEAR(velocity(body).x, speed, 0.01 * speed);
        EXPECT_LT(rose, 1e-3) << speed;
    }
}

// Tiles that do not quite touch, and that do not quite lie in one plane, are as far apart as the tolerance of clipping.
TEST(TileSeam, SmallGapsAndStepsCatchNothing) {
    for (const auto& [gap, step] : {std::pair(0.004, 0.0), std::pair(0.0, 2.5e-4)})
        for (const Slider slider : {Slider::box, Slider::ball, Slider::crate, Slider::capsule}) {
            World world;
            for (int i = 0; i < 14; ++i)
                world.add({.kind = TAUT_BODY_STATIC,
                           .shape = world.box({0.4, 0.2, 1}),
                           .position = {(i - 6.5) * (0.8 + gap), -0.2 + (i % 2 ? step : 0), 0},
                           .friction = 0});
            const taut_body body = add_slider(world, slider, -4.2, 0);
            world.step(20);
            const double from = position(body).y;
            ok(taut_body_set_velocity(body, Vec(4, 0, 0).narrow(), Vec().narrow()));
            double rose = 0;
            for (int i = 0; i < 120; ++i) {
                world.step();
                rose = std::max(rose, position(body).y - from);
            }
            EXPECT_NEAR(velocity(body).x, 4, 0.01) << static_cast<int>(slider) << " " << gap;
            EXPECT_LT(rose, step + 5e-4) << static_cast<int>(slider) << " " << gap;
        }
}

// ---------------------------------------------------------------- what stands out

// A floor of tiles, and at x = 0 one that stands out by a height; or a plane and one box upon it.
void add_curb(const World& world, double height, bool tiles = true) {
    const auto add = [&](taut_shape shape, const Vec& at) {
        world.add({.kind = TAUT_BODY_STATIC, .shape = shape, .position = at, .friction = 0});
    };
    if (!tiles) {
        add(world.plane(), {});
        add(world.box({2.5, 0.25, 2}), {2.5, height - 0.25, 0});
        return;
    }
    for (int i = -4; i < 5; ++i) add(world.box({0.5, 0.25, 2}), {i + 0.5, (i >= 0 ? height : 0) - 0.25, 0});
}

// A plastic blow at the edge leaves a ball v cos(phi) along it, cos(phi) = 1 - h / r: it flies up by
// (v cos(phi) sin(phi))^2 / (2 g), or a little more where the blow comes early.
TEST(Curb, LiftsABall) {
    constexpr double kRadius = 0.25;
    for (const double height : {0.002, 0.005, 0.01})
        for (const double speed : {2.0, 6.0}) {
            World world;
            add_curb(world, height);
            const taut_body ball = world.add({.shape = world.sphere(kRadius),
                                              .position = {-1.31, kRadius, 0},
                                              .velocity = {speed, 0, 0},
                                              .friction = 0});
            double top = 0;
            for (int i = 0; i < static_cast<int>(150 / speed); ++i) {
                world.step();
                top = std::max(top, position(ball).y - kRadius);
            }
            const double cosine = 1 - height / kRadius, sine = std::sqrt(1 - cosine * cosine);
            const double up = speed * cosine * sine;
            EXPECT_NEAR(velocity(ball).x, speed * cosine * cosine, 0.08 * speed) << height << " " << speed;
            EXPECT_GT(top, 0.9 * std::max(height, up * up / (2 * kG))) << height << " " << speed;
        }
}

// A box goes on as before the same curb on a plane: slow ones stop, fast ones turn over it.
TEST(Curb, StopsABoxAsOnAPlane) {
    for (const double height : {0.002, 0.005, 0.01})
        for (const double speed : {0.5, 3.0, 6.0}) {
            double furthest[2] = {-9, -9}, top[2] = {0, 0};
            for (const bool tiles : {false, true}) {
                World world;
                add_curb(world, height, tiles);
                const taut_body box = world.add({.shape = world.box({0.3, 0.2, 0.3}),
                                                 .position = {-1.31, 0.2, 0},
                                                 .velocity = {speed, 0, 0},
                                                 .friction = 0});
                for (int i = 0; i < static_cast<int>(120 / speed); ++i) {
                    world.step();
                    furthest[tiles] = std::max(furthest[tiles], position(box).x);
                    top[tiles] = std::max(top[tiles], position(box).y - 0.2);
                }
            }
            EXPECT_NEAR(furthest[1], furthest[0], 0.02) << height << " " << speed;
            EXPECT_NEAR(top[1], top[0], 0.1 * top[0] + 1e-3) << height << " " << speed;
            if (speed < 1) {
                EXPECT_LT(furthest[1], -0.29) << height;
            }
        }
}

// Down it goes on as before: nothing stands out.
TEST(Curb, DownhillStopsNothing) {
    World world;
    add_curb(world, -0.01);
    const taut_body box = world.add(
        {.shape = world.box({0.3, 0.2, 0.3}), .position = {-1.31, 0.2, 0}, .velocity = {3, 0, 0}, .friction = 0});
    world.step(60);
    EXPECT_NEAR(velocity(box).x, 3, 0.03);
    EXPECT_NEAR(position(box).y, 0.19, 1e-3);
}

// A wall that stands on the seam of two tiles, and on one.
TEST(WallOnTiles, StopsWhatSlidesAgainstIt) {
    for (const Slider slider : {Slider::box, Slider::ball, Slider::cylinder, Slider::stone, Slider::raft})
        for (const double at : {0.0, 0.31})
            for (const double speed : {1.0, 6.0, 15.0}) {
                World world;
                add_tiles(world, Tiles::boxes, 10, 0);
                world.add({.kind = TAUT_BODY_STATIC,
                           .shape = world.box({0.2, 0.5, 2}),
                           .position = {at + 0.2, 0.5, 0},
                           .friction = 0});
                const taut_body body = add_slider(world, slider, -1.93, 0);
                world.step(10);
                ok(taut_body_set_velocity(body, Vec(speed, 0, 0).narrow(), Vec().narrow()));
                double furthest = -10;
                for (int i = 0; i < static_cast<int>(3 / speed * 60); ++i) {
                    world.step();
                    furthest = std::max(furthest, position(body).x);
                }
                const double reach = slider == Slider::box        ? 0.35
                                     : slider == Slider::ball     ? 0.22
                                     : slider == Slider::cylinder ? 0.28
                                     : slider == Slider::stone    ? 0.37
                                                                  : 0.48;
                // What hangs over, as the stone does, tips against the wall.
                EXPECT_LT(furthest, at - reach + (slider == Slider::stone ? 0.04 : 7e-3))
                    << static_cast<int>(slider) << " " << speed;
                EXPECT_GT(furthest, at - reach - 0.05) << static_cast<int>(slider) << " " << speed;
            }
}

// Three walls and a floor of four tiles that meet in a corner hold boxes thrown into it.
TEST(BinOfTiles, HoldsWhatIsThrownIntoItsCorner) {
    World world;
    for (int i = 0; i < 4; ++i)
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = world.box({0.5, 0.25, 0.5}),
                   .position = {i % 2 - 0.5, -0.25, i / 2 - 0.5}});
    for (int i = 0; i < 4; ++i) {
        const bool x = i < 2;
        const double side = i % 2 ? 1.2 : -1.2;
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = world.box({x ? 0.2 : 1.4, 1, x ? 1.4 : 0.2}),
                   .position = {x ? side : 0, 1, x ? 0 : side}});
    }
    std::vector<taut_body> boxes;
    for (int i = 0; i < 12; ++i) {
        boxes.push_back(world.add({.shape = world.box({0.12, 0.1, 0.15}),
                                   .position = {-0.2, 0.6 + 0.05 * i, -0.1},
                                   .rotation = Quat::turn({1, 2, 0.5}, 0.7 * i),
                                   .velocity = {4.0 - i % 3, 0, 3.0 + i % 2}}));
        world.step(30);
    }
    world.step(300);
    for (const taut_body box : boxes) {
        const Vec at = position(box);
        EXPECT_LT(std::max(std::abs(at.x), std::abs(at.z)), 1.0);
        EXPECT_GT(at.y, 0.09);
        EXPECT_LT(norm(velocity(box)), 0.05);
    }
}

// A ramp beside the floor, with the face between them upright: what comes goes up by (v cos(a))^2 / (2 g).
TEST(RampBesideTiles, IsClimbed) {
    constexpr double kAngle = 0.25, kSpeed = 4;
    for (const Slider slider : {Slider::box, Slider::ball}) {
        World world;
        add_tiles(world, Tiles::boxes, 8, 0);
        const double edge = 4 * kTile, run = 12, rise = run * std::tan(kAngle);
        std::vector<taut_vec3> points;
        for (const double z : {-2.0, 2.0})
            for (const Vec& p : {Vec(0, 0, z), Vec(0, -0.5, z), Vec(run, -0.5, z), Vec(run, rise, z)})
                points.push_back(p.narrow());
        world.add({.kind = TAUT_BODY_STATIC, .shape = hull(world, points), .position = {edge, 0, 0}, .friction = 0});
        const taut_body body = add_slider(world, slider, edge - 1.5, 0);
        world.step(10);
        ok(taut_body_set_velocity(body, Vec(kSpeed, 0, 0).narrow(), Vec().narrow()));
        const double from = position(body).y;
        double top = 0;
        for (int i = 0; i < 240; ++i) {
            world.step();
            top = std::max(top, position(body).y - from);
        }
        const double along = kSpeed * std::cos(kAngle), expected = along * along / (2 * kG);
        EXPECT_NEAR(top, expected, 0.12 * expected) << static_cast<int>(slider);
    }
}

// The seams of a body's own colliders: a raft of planks slides over posts, of which each plank touches one at least.
TEST(SeamsOfABody, CatchNothingOnPosts) {
    for (const double speed : {1.3, 5.0, 14.0}) {
        World world;
        for (int i = 0; i < 48; ++i)
            for (const double z : {-0.3, 0.3})
                world.add({.kind = TAUT_BODY_STATIC,
                           .shape = world.box({0.08, 0.2, 0.08}),
                           .position = {0.5 * i - 4, -0.2, z},
                           .friction = 0});
        const taut_shape plank = world.box({0.4, 0.1, 0.5});
        const taut_body raft = world.add({.shape = plank, .position = {-3.2, 0.1, 0}, .friction = 0});
        for (int i = 1; i < 5; ++i) add_collider(raft, plank, {0.8 * i, 0, 0}, 0);
        world.step(10);
        ok(taut_body_set_velocity(raft, Vec(speed, 0, 0).narrow(), Vec().narrow()));
        double rose = 0;
        for (int i = 0; i < static_cast<int>(8 / speed * 60); ++i) {
            world.step();
            rose = std::max(rose, position(raft).y - 0.1);
        }
        EXPECT_NEAR(velocity(raft).x, speed, 0.01 * speed);
        EXPECT_LT(rose, 1e-3) << speed;
    }
}

}  // namespace
