// What falls onto a plane: thin things lie down on it, and fast ones land on all their corners; so on broad boxes.
#include <algorithm>

#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

std::vector<Vec> box_corners(const Vec& half) {
    std::vector<Vec> out;
    for (int i = 0; i < 8; ++i)
        out.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    return out;
}

std::vector<Vec> prism_corners(double radius, double half_thickness) {
    std::vector<Vec> out;
    for (int i = 0; i < 6; ++i)
        for (const double y : {-half_thickness, half_thickness})
            out.push_back({radius * std::cos(i * kPi / 3), y, radius * std::sin(i * kPi / 3)});
    return out;
}

taut_shape hull_of(const World& world, const std::vector<Vec>& corners) {
    std::vector<taut_vec3> points;
    for (const Vec& corner : corners) points.push_back(corner.narrow());
    return hull(world, points);
}

// How deep the lowest of a body's corners is in the ground [m].
double depth_of(taut_body body, const std::vector<Vec>& corners) {
    const BodyState s = state(body);
    double lowest = 1e30;
    for (const Vec& corner : corners) lowest = std::min(lowest, (s.position + s.rotation.rotate(corner)).y);
    return std::max(0.0, -lowest);
}

struct Thin {
    const char* name;
    std::vector<Vec> corners;
    bool hull = false;
};

void PrintTo(const Thin& thin, std::ostream* out) { *out << thin.name; }

struct ThinOnPlane : testing::TestWithParam<Thin> {};

// All their corners are within the contact margin: the four that bear are to be those below.
TEST_P(ThinOnPlane, LiesStillAndDoesNotSinkIn) {
    const std::vector<Vec>& corners = GetParam().corners;
    const double reach = norm(corners.back());
    std::mt19937 random(11);
    for (int start = 0; start < 6; ++start) {
        World world;
        world.add_ground();
        const bool flat = start % 2 == 0;
        const double height = flat ? corners.back().y + between(random, 0, 0.005) : 1.1 * reach;
        const taut_body body =
            world.add({.shape = GetParam().hull ? hull_of(world, corners) : world.box(corners.back()),
                       .position = {0, height, 0},
                       .rotation = flat ? Quat() : Quat::turn(random_direction(random), between(random, 0, 2 * kPi)),
                       .rolling = 0.002,
                       .spinning = 0.002});
        world.step(600);
        EXPECT_LT(norm(velocity(body)), 0.005) << start;
        EXPECT_LT(norm(state(body).spin) * reach, 0.005) << start;
        EXPECT_LT(depth_of(body, corners), 0.001) << start;
    }
}

const Thin kThin[] = {
    {"plate_5mm", box_corners({0.15, 0.0025, 0.12})},  {"plate_10mm", box_corners({0.15, 0.005, 0.12})},
    {"rod_5mm", box_corners({0.15, 0.0025, 0.0025})},  {"rod_11mm", box_corners({0.15, 0.0055, 0.0055})},
    {"cube_10mm", box_corners({0.005, 0.005, 0.005})}, {"prism_5mm", prism_corners(0.15, 0.0025), true},
    {"prism_10mm", prism_corners(0.15, 0.005), true},
};
INSTANTIATE_TEST_SUITE_P(Each, ThinOnPlane, testing::ValuesIn(kThin), [](const auto& thin) { return thin.param.name; });

struct FastOnPlane : testing::TestWithParam<double> {};

// Falls nearly flat, all corners within one frame. Bounds are a quarter of a frame's fall, and a fraction of what a
// box that stops on one corner makes of its speed.
TEST_P(FastOnPlane, LandsOnAllItsCorners) {
    const double speed = GetParam();
    std::mt19937 random(5);
    for (const double thickness : {0.1, 0.3}) {
        for (int start = 0; start < 20; ++start) {
            World world;
            world.add_ground();
            const Vec half(0.25, thickness / 2, 0.2), axis(between(random, -1, 1), 0, between(random, -1, 1));
            const taut_body body = world.add({.shape = world.box(half),
                                              .position = {0, 0.5 + between(random, 0, speed / 60), 0},
                                              .rotation = Quat::turn(axis, between(random, 0, 0.03)),
                                              .velocity = {0, -speed, 0}});
            double deepest = 0, spin = 0, up = 0;
            for (int frame = 0; frame < 60; ++frame) {
                world.step();
                deepest = std::max(deepest, depth_of(body, box_corners(half)));
                spin = std::max(spin, norm(state(body).spin));
                up = std::max(up, velocity(body).y);
            }
            EXPECT_LT(deepest, 0.25 * speed / 60) << thickness << " m thick, start " << start;
            EXPECT_LT(spin * norm(half), 0.3 * speed) << thickness << " m thick, start " << start;
            EXPECT_LT(up, 0.05 * speed) << thickness << " m thick, start " << start;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(MetresPerSecond, FastOnPlane, testing::Values(10.0, 20.0, 40.0));

struct Landing {
    double speed, spin;
};

// Mean depth [m] of what stones, thrown down at random, go into a plane or a broad box.
double mean_depth_of_stones(const Landing& landing, bool on_plane, int stones) {
    std::mt19937 random(3);
    double sum = 0;
    for (int stone = 0; stone < stones; ++stone) {
        World world;
        if (on_plane)
            world.add_ground();
        else
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({20, 0.5, 20}), .position = {0, -0.5, 0}});
        std::vector<Vec> corners;
        for (int i = 0; i < 14; ++i) corners.push_back(between(random, 0.24, 0.36) * random_direction(random));
        const taut_body body = world.add({.shape = hull_of(world, corners),
                                          .position = {0, between(random, 0.4, 0.8), 0},
                                          .rotation = Quat::turn(random_direction(random), between(random, 0, 6)),
                                          .velocity = {between(random, -1, 1), -landing.speed, 0},
                                          .spin = landing.spin * random_direction(random),
                                          .mass = 80});
        double deepest = 0;
        for (int frame = 0; frame < 60; ++frame) {
            world.step();
            deepest = std::max(deepest, depth_of(body, corners));
        }
        sum += deepest;
    }
    return sum / stones;
}

struct StonesOnBox : testing::TestWithParam<Landing> {};

// The corners next to those that touch first come down in the same frame: on a box, too, they have their points.
TEST_P(StonesOnBox, GoInHardlyDeeperThanIntoAPlane) {
    const double plane = mean_depth_of_stones(GetParam(), true, 40), box = mean_depth_of_stones(GetParam(), false, 40);
    std::printf("%.2f mm into a plane, %.2f mm into a box\n", 1e3 * plane, 1e3 * box);
    EXPECT_LT(box, plane + 0.003);
}

INSTANTIATE_TEST_SUITE_P(Each, StonesOnBox,
                         testing::Values(Landing{1, 5}, Landing{4, 5}, Landing{10, 5}, Landing{1, 15}, Landing{4, 15},
                                         Landing{10, 15}));

struct Tumbling {
    const char* name;
    Vec half;
    Landing landing;
    double most_of_nine_in_ten, most;  // depth [m]
};

void PrintTo(const Tumbling& tumbling, std::ostream* out) { *out << tumbling.name; }

struct TumblesOnBox : testing::TestWithParam<Tumbling> {};

// What one corner stops turns about it, and what turns already swings corners down that are further away than the way
// of its centre: these have their points too.
TEST_P(TumblesOnBox, SwingsHardlyIn) {
    const Tumbling& thing = GetParam();
    std::mt19937 random(21);
    std::vector<double> depths;
    for (int start = 0; start < 200; ++start) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({10, 0.5, 10}), .position = {0, -0.5, 0}});
        const double height = norm(thing.half) + 0.02 + between(random, 0, thing.landing.speed / 60);
        const taut_body body = world.add({.shape = world.box(thing.half),
                                          .position = {0, height, 0},
                                          .rotation = Quat::turn(random_direction(random), between(random, 0, 2 * kPi)),
                                          .velocity = {0, -thing.landing.speed, 0},
                                          .spin = thing.landing.spin * random_direction(random)});
        double deepest = 0;
        for (int frame = 0; frame < 40; ++frame) {
            world.step();
            deepest = std::max(deepest, depth_of(body, box_corners(thing.half)));
        }
        depths.push_back(deepest);
    }
    std::ranges::sort(depths);
    std::printf("%s: nine in ten %.1f mm, all %.1f mm\n", thing.name, 1e3 * depths[180], 1e3 * depths.back());
    EXPECT_LT(depths[180], thing.most_of_nine_in_ten);
    EXPECT_LT(depths.back(), thing.most);
}

const Vec kCube = {0.05, 0.05, 0.05}, kPlate = {0.1, 0.02, 0.1};
const Tumbling kTumbling[] = {
    {"cube_2_still", kCube, {2, 0}, 0.002, 0.006},  {"cube_5_still", kCube, {5, 0}, 0.003, 0.008},
    {"cube_2_30", kCube, {2, 30}, 0.002, 0.006},    {"cube_5_30", kCube, {5, 30}, 0.003, 0.008},
    {"plate_2_still", kPlate, {2, 0}, 0.004, 0.01}, {"plate_5_still", kPlate, {5, 0}, 0.008, 0.025},
    {"plate_2_30", kPlate, {2, 30}, 0.004, 0.01},   {"plate_5_30", kPlate, {5, 30}, 0.008, 0.025},
    {"plate_2_50", kPlate, {2, 50}, 0.004, 0.036},  // one, which no contact meets in the frame of its fall
};
INSTANTIATE_TEST_SUITE_P(Each, TumblesOnBox, testing::ValuesIn(kTumbling),
                         [](const auto& thing) { return thing.param.name; });

}  // namespace
