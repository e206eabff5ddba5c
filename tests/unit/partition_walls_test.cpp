// Walls and columns take as many substeps as their contacts need to hold them.
#include <gtest/gtest.h>

#include "unit/partition_graph.h"

namespace taut::test {
namespace {

constexpr double kSide = 0.1;  // of cubes [m]
const Vec3f kUp = Vec3f::UnitY();

struct Masonry : Graph {
    Masonry() { rules.gravity = {0, -9.81, 0}; }

    uint32_t cube(double side = kSide) {
        const uint32_t node = add(NodeKind::dynamic);
        NodeMass of = nodes.mass[node];
        of.inertia.xx = of.inertia.yy = of.inertia.zz = of.mass * side * side / 6;
        nodes.mass.set(node, of);
        return node;
    }
    void stand(uint32_t upper, uint32_t lower, int points = 4) {
        touch(lower, upper, kUp);
        touching.back().manifold.count = points;
    }
    std::vector<uint32_t> column(uint32_t count, double side = kSide) {
        std::vector<uint32_t> cubes;
        uint32_t below = ground;
        for (uint32_t i = 0; i < count; ++i) {
            cubes.push_back(cube(side));
            stand(cubes.back(), below);
            below = cubes.back();
        }
        return cubes;
    }
    // Columns side by side; their cubes touch where they are next to each other.
    std::vector<std::vector<uint32_t>> block(uint32_t length, uint32_t breadth, uint32_t height) {
        std::vector<std::vector<uint32_t>> columns;
        for (uint32_t i = 0; i < length * breadth; ++i) columns.push_back(column(height));
        for (uint32_t i = 0; i < length; ++i)
            for (uint32_t k = 0; k < breadth; ++k) {
                if (i > 0) lean(columns[(i - 1) * breadth + k], columns[i * breadth + k], Vec3f::UnitX());
                if (k > 0) lean(columns[i * breadth + k - 1], columns[i * breadth + k], Vec3f::UnitZ());
            }
        return columns;
    }
    void lean(const std::vector<uint32_t>& on, const std::vector<uint32_t>& one, const Vec3f& along) {
        for (size_t i = 0; i < std::min(on.size(), one.size()); ++i) touch(on[i], one[i], along);
    }
    // Bricks that stand on two each.
    std::vector<uint32_t> wall(uint32_t length, uint32_t courses) {
        std::vector<uint32_t> all, below;
        for (uint32_t course = 0; course < courses; ++course) {
            std::vector<uint32_t> bricks;
            for (uint32_t i = 0; i < length + course % 2; ++i) {
                bricks.push_back(cube());
                if (course == 0) stand(bricks.back(), ground);
                for (const uint32_t on : {i - course % 2, i + 1 - course % 2})
                    if (course > 0 && on < below.size()) stand(bricks.back(), below[on]);
            }
            below = bricks;
            all.insert(all.end(), bricks.begin(), bricks.end());
        }
        return all;
    }
    uint32_t built(uint32_t node) {
        build();
        return substeps_of(node);
    }

    uint32_t ground = add(NodeKind::fixed);
};

struct MasonryWalls : testing::Test, Masonry {};
struct MasonryColumns : testing::Test, Masonry {};

// s = 0.8 g h^2 n^3 / b, h = 1/240 s: 0.99, 1.4, 1.8, 2.4, 3.7, 4.6, 7.9, 9.3, 14.5; substeps^2 / 16 is no less.
TEST_F(MasonryColumns, TakeWhatTheyNeed) {
    for (const auto& [height, substeps] : {std::pair(9u, 4u),
                                           {10u, 6u},
                                           {11u, 6u},
                                           {12u, 8u},
                                           {14u, 8u},
                                           {15u, 12u},
                                           {18u, 12u},
                                           {19u, 16u},
                                           {22u, 16u}}) {
        Masonry fresh;
        EXPECT_EQ(fresh.built(fresh.column(height)[0]), substeps) << height;
        EXPECT_TRUE(fresh.partition.blocks.empty()) << height;
    }
}

// 16.6 and 291; no substeps give that much.
TEST_F(MasonryColumns, AreBlocksWhereSweepsDoNotHoldThem) {
    const std::vector<uint32_t> tall = column(23), taller = column(60), too_tall = column(61);
    build();
    ASSERT_EQ(partition.blocks.size(), 2u);
    for (const Block& block : partition.blocks) {
        EXPECT_TRUE(block.tower);
        EXPECT_EQ(block.pairs.size(), block.nodes.size());
        EXPECT_EQ(block.links.size(), block.nodes.size() - 1) << "the ground is no node";
    }
    EXPECT_EQ(partition.blocks[0].nodes.size(), tall.size());
    EXPECT_EQ(substeps_of(tall[0]), 4u);
    EXPECT_EQ(substeps_of(taller[0]), 4u);
    EXPECT_EQ(substeps_of(too_tall[0]), 16u) << "swept";
    EXPECT_EQ(partition.group_count, 2u);
}

TEST_F(MasonryColumns, AreBlocksWhereSubstepsAreFixed) {
    const std::vector<uint32_t> low = column(9), tall = column(10);
    rules.fixed = true;
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), tall.size());
    EXPECT_EQ(substeps_of(low[0]), 4u);
    EXPECT_EQ(substeps_of(tall[0]), 4u);
}

// Two that lean on each other are a column as one is.
TEST_F(MasonryColumns, MayBeOfSeveral) {
    const auto columns = block(2, 1, 15);
    EXPECT_EQ(built(columns[0][0]), 12u);
    EXPECT_TRUE(partition.blocks.empty());
}

// s = 0.8 / 1.5 g h^2 n^3 / b, h = 1/240 s: 0.91, 1.2, 2.0, 3.1, 4.5, 12.6, 58; substeps^2 / 16 is no less, up to 16.
TEST_F(MasonryWalls, ColumnsOfABlockTakeWhatTheyNeed) {
    for (const auto& [height, substeps] :
         {std::pair(10u, 4u), {11u, 6u}, {13u, 6u}, {15u, 8u}, {17u, 12u}, {24u, 16u}, {40u, 16u}}) {
        Masonry fresh;
        EXPECT_EQ(fresh.built(fresh.block(5, 5, height)[0][0]), substeps) << height;
    }
}

TEST_F(MasonryWalls, NoneTakesMoreWhereSubstepsAreFixed) {
    const uint32_t node = block(5, 5, 24)[0][0];
    rules.fixed = true;
    EXPECT_EQ(built(node), 4u);
}

// Walls are held by two contacts a brick.
TEST_F(MasonryWalls, BondedWallsHoldTwiceAsMuch) {
    for (const auto& [courses, substeps] :
         {std::pair(12u, 4u), {13u, 6u}, {16u, 6u}, {18u, 8u}, {20u, 8u}, {22u, 12u}}) {
        Masonry fresh;
        EXPECT_EQ(fresh.built(fresh.wall(12, courses)[0]), substeps) << courses;
    }
}

// Of four columns around it one is missing, or lower, or touches only some of its cubes.
TEST_F(MasonryWalls, ColumnsThatOthersHoldTakeNoMore) {
    struct Around {
        uint32_t height, every;
        uint32_t substeps;
    };
    for (const Around& last : {Around{20, 1, 4}, {0, 1, 12}, {10, 1, 6}, {18, 1, 4}, {20, 2, 4}, {20, 4, 12}}) {
        Masonry fresh;
        const std::vector<uint32_t> middle = fresh.column(20);
        for (const Vec3f& along : {Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(0, 0, 1)})
            fresh.lean(middle, fresh.column(20, 10), along);
        const std::vector<uint32_t> beside = fresh.column(last.height, 10);
        for (size_t i = 0; i < beside.size(); i += last.every) fresh.touch(middle[i], beside[i], -Vec3f::UnitZ());
        EXPECT_EQ(fresh.built(middle[0]), last.substeps) << last.height << ' ' << last.every;
    }
}

TEST_F(MasonryWalls, WhatLiesOnEdgesIsNoColumn) {
    const auto columns = block(5, 5, 24);
    for (Pair& pair : touching)
        if (pair.manifold.normal == kUp) pair.manifold.count = 2;
    EXPECT_EQ(built(columns[0][0]), 4u);
}

TEST_F(MasonryWalls, WhatFallsBucklesNot) {
    const auto columns = block(5, 5, 24);
    std::erase_if(touching, [&](const Pair& pair) { return pair.a == ground; });
    EXPECT_EQ(built(columns[0][0]), 4u);
}

TEST_F(MasonryWalls, StandBesideMechanismsToo) {
    const std::vector<uint32_t> doll = {cube(), cube()}, cubes = column(20);
    join(doll[0], doll[1]);
    touch(doll[0], cubes[0], Vec3f::UnitX());
    EXPECT_EQ(built(cubes[0]), 12u);
}

}  // namespace
}  // namespace taut::test
