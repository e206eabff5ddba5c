// Walls of bricks and blocks of cubes stand, though their sweeps are soft: they take as many substeps as that needs.
#include <algorithm>

#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"
#include "starts.h"

namespace lab {
namespace {

// Bricks and where they were laid.
struct Site {
    World world;
    std::vector<taut_body> bricks;
    std::vector<Vec> laid;

    explicit Site(const std::function<void(taut_world_def&)>& change = {}) : world(change) { world.add_ground(0.6); }
    void lay(const Vec& half, const Vec& at, const Quat& rotation) {
        bricks.push_back(world.add({.shape = world.box(half),
                                    .position = at,
                                    .rotation = rotation,
                                    .mass = 2400 * 8 * half.x * half.y * half.z,
                                    .friction = 0.6}));
        laid.push_back(at);
    }
    double moved() const {  // furthest [m]
        double most = 0;
        for (size_t i = 0; i < bricks.size(); ++i) most = std::max(most, norm(position(bricks[i]) - laid[i]));
        return most;
    }
    double speed() const {  // fastest [m/s]
        double most = 0;
        for (const taut_body brick : bricks) most = std::max(most, norm(velocity(brick)));
        return most;
    }
};

// In running bond, not quite in line; half bricks at its ends.
void lay_bond(Site& site, const Vec& half, int courses, int length, double turn, std::mt19937& random) {
    for (int course = 0; course < courses; ++course)
        for (int i = 0; i < length + course % 2; ++i) {
            const bool at_end = course % 2 && (i == 0 || i == length);
            const double along = 2 * half.x * (i - 0.5 * (course % 2)) + (at_end ? (i == 0 ? 0.5 : -0.5) * half.x : 0);
            const Vec off{along + between(random, -0.01, 0.01) * half.x, half.y * (1 + 2 * course),
                          between(random, -0.05, 0.05) * half.z};
            site.lay({(at_end ? 0.49 : 0.98) * half.x, half.y, half.z}, Quat::turn({0, 1, 0}, turn).rotate(off),
                     Quat::turn({0, 1, 0}, turn + between(random, -0.01, 0.01)));
        }
}

// Whichever way it runs.
void lay_wall(Site& site, const Vec& half, int courses, int length, std::mt19937& random) {
    lay_bond(site, half, courses, length, between(random, 0, 3), random);
}

// Columns that nothing bonds.
void lay_block(Site& site, const Vec& half, int courses, int length, std::mt19937& random) {
    for (int course = 0; course < courses; ++course)
        for (int i = 0; i < length; ++i)
            for (int k = 0; k < length; ++k)
                site.lay(half,
                         {2.02 * half.x * i + between(random, -0.005, 0.005) * half.x, half.y * (1 + 2 * course),
                          2.02 * half.z * k + between(random, -0.005, 0.005) * half.z},
                         Quat());
}

// Between two posts, which hold it by its ends alone.
void lay_filling(Site& site, const Vec& half, int courses, int length, std::mt19937& random) {
    lay_bond(site, half, courses, length, 0, random);
    for (const double x : {-half.x - 0.5, half.x * (2 * length - 1) + 0.5})
        site.world.add({.kind = TAUT_BODY_STATIC, .shape = site.world.box({0.5, 5, 0.5}), .position = {x, 5, 0}});
}

struct Laid {
    const char* name;
    void (*lay)(Site& site, const Vec& half, int courses, int length, std::mt19937& random);
    Vec half;
    int courses, length;
};
void PrintTo(const Laid& laid, std::ostream* out) { *out << laid.name; }

class Laying : public testing::TestWithParam<Laid> {};

TEST_P(Laying, StandsForTenSeconds) {
    const auto& [name, lay, half, courses, length] = GetParam();
    for (uint32_t seed = 1; seed <= starts(3u); ++seed) {
        std::mt19937 random(seed);
        Site site;
        lay(site, half, courses, length, random);
        site.world.step(600);
        EXPECT_LE(site.moved(), 0.2 * half.y) << "start " << seed;
        EXPECT_LE(site.speed(), 0.01) << "start " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Masonry, Laying,
                         testing::Values(Laid{"BricksInTwelveCourses", lay_wall, {0.1, 0.05, 0.05}, 12, 10},
                                         Laid{"BricksInSixteenCourses", lay_wall, {0.1, 0.05, 0.05}, 16, 10},
                                         Laid{"BricksInThirtyCourses", lay_wall, {0.1, 0.04, 0.05}, 30, 10},
                                         Laid{"LargeBricksInTwentyFourCourses", lay_wall, {0.5, 0.25, 0.25}, 24, 10},
                                         Laid{"SmallBricksInTwelveCourses", lay_wall, {0.02, 0.01, 0.01}, 12, 10},
                                         Laid{"CubesInTwelveCourses", lay_block, {0.05, 0.05, 0.05}, 12, 5},
                                         Laid{"CubesInTwentyCourses", lay_block, {0.05, 0.05, 0.05}, 20, 4},
                                         Laid{"BetweenPosts", lay_filling, {0.1, 0.05, 0.05}, 20, 20}),
                         [](const auto& tested) { return tested.param.name; });

// Seven by seven cubes a layer, turned a little.
void drop_columns(Site& site, double side, uint32_t layers) {
    constexpr int kRow = 7;
    std::mt19937 random(1);
    for (uint32_t layer = 0; layer < layers; ++layer)
        for (int i = 0; i < kRow * kRow; ++i) {
            const Vec axis = random_direction(random);
            site.lay({0.5 * side, 0.5 * side, 0.5 * side},
                     {1.36 * side * (i % kRow), (1.2 + 1.6 * layer) * side, 1.36 * side * (i / kRow)},
                     Quat::turn(axis, between(random, 0, 0.3)));
        }
}

// Columns of cubes that fall on the ground side by side are swept, at any frame rate: direct solves of them all would
// take ten times as long, and ten times that as they land.
struct Columns {
    const char* name;
    double side;  // [m]
    uint32_t height;
    float rate;  // [Hz]
};
void PrintTo(const Columns& columns, std::ostream* out) { *out << columns.name; }

class Dropped : public testing::TestWithParam<Columns> {};

TEST_P(Dropped, AreSwept) {
    const auto& [name, side, height, rate] = GetParam();
    Site site([rate = rate](taut_world_def& def) { def.time_step = 1 / rate; });
    drop_columns(site, side, height);
    uint32_t solves = 0, substeps = 0;
    for (int frame = 0; frame < static_cast<int>(4 * rate); ++frame) {
        site.world.step();
        solves += site.world.profile().solves;
        substeps += site.world.profile().substeps;
    }
    EXPECT_LE(solves, substeps) << "one column or two, for a while";
}

INSTANTIATE_TEST_SUITE_P(Columns, Dropped,
                         testing::Values(Columns{"OfTen", 0.5, 10, 60}, Columns{"OfTenAtThirtyHertz", 0.5, 10, 30},
                                         Columns{"OfThirteen", 0.5, 13, 60}, Columns{"OfSixteen", 0.5, 16, 60},
                                         Columns{"OfTenSmallCubes", 0.1, 10, 60}),
                         [](const auto& tested) { return tested.param.name; });

// Cubes that fall into a bin are held by each other, but for columns of some that meet in the air.
TEST(Heap, OfSmallCubesTakesNoMoreSubsteps) {
    std::mt19937 random(1);
    Site site;
    constexpr double kHalf = 0.05, kBin = 0.45;
    for (int side = 0; side < 4; ++side) {
        const Quat turn = Quat::turn({0, 1, 0}, side * kPi / 2);
        site.world.add({.kind = TAUT_BODY_STATIC,
                        .shape = site.world.box({0.5, 5, kBin + 1}),
                        .position = turn.rotate({kBin + 0.5, 5, 0}),
                        .rotation = turn});
    }
    for (int i = 0; i < 900; ++i)
        site.lay({kHalf, kHalf, kHalf}, {between(random, -0.3, 0.3), 0.1 + 0.015 * i, between(random, -0.3, 0.3)},
                 Quat::turn({0, 1, 0}, between(random, 0, 3)));
    site.world.step(60);
    int more = 0;
    for (int frame = 60; frame < 300; ++frame) {
        site.world.step();
        more += site.world.profile().substeps > site.world.def.substeps;
    }
    EXPECT_LE(more, 6);
}

TEST(Heap, OfSmallCubesHasFewContacts) {
    const auto contacts = [](double side) {
        Site site;
        drop_columns(site, side, 6);
        site.world.step(240);
        return site.world.profile().touching;
    };
    const uint32_t large = contacts(0.5), small = contacts(0.03);
    EXPECT_LT(small, 2 * large);
}

}  // namespace
}  // namespace lab
