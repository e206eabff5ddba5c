// Bodies that are solved directly because something presses them.
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/partition_graph.h"

namespace taut::test {
namespace {

struct PressedBodies : testing::Test, Graph {};

// A heavy and a light body on the ground, of which the one touches the other along a direction.
struct Touching {
    uint32_t heavy, light, ground;
};
Touching side_by_side(Graph& graph, const Vec3f& along, double mass = 10) {
    const Touching of = {graph.add(NodeKind::dynamic, mass), graph.add(NodeKind::dynamic), graph.add(NodeKind::fixed)};
    for (const uint32_t body : {of.heavy, of.light}) graph.touch(body, of.ground, -Vec3f::UnitY());
    graph.touch(of.heavy, of.light, along);
    return of;
}

TEST_F(PressedBodies, ByAHeavyOneAreABlockWithIt) {
    const Touching below = side_by_side(*this, -Vec3f::UnitY()), at_a_wall = side_by_side(*this, Vec3f::UnitX()),
                   at_a_box = side_by_side(*this, Vec3f::UnitX()), tied = side_by_side(*this, -Vec3f::UnitY());
    touch(at_a_wall.light, add(NodeKind::fixed), Vec3f(0.8f, 0.6f, 0));
    touch(add(NodeKind::dynamic), at_a_box.light, -Vec3f::UnitX());
    const uint32_t joint = join(tied.light, kNone);
    joints.record[joint].solve = JointSolve::by_load;
    joints.record[joint].loaded = 0;
    build();
    ASSERT_EQ(partition.blocks.size(), 4u);
    for (const Touching& of : {below, at_a_wall, at_a_box, tied}) {
        const auto block = std::ranges::find_if(
            partition.blocks, [&](const Block& one) { return std::ranges::count(one.nodes, of.light) > 0; });
        ASSERT_NE(block, partition.blocks.end()) << "node " << of.light;
        EXPECT_TRUE(std::ranges::count(block->nodes, of.heavy)) << "node " << of.light;
        EXPECT_EQ(block->nodes.size(), 2u) << "not the box at which it is pushed";
        EXPECT_EQ(block->pairs.size(), of.light == at_a_wall.light ? 4u : 3u) << "with the ground and the wall";
        EXPECT_EQ(block->joints.size(), of.light == tied.light ? 1u : 0u) << joint;
    }
}

TEST_F(PressedBodies, ThroughOthersAreABlockWithThem) {
    const Touching of = side_by_side(*this, Vec3f::UnitX());
    const uint32_t next = add(NodeKind::dynamic), last = add(NodeKind::dynamic), beside = add(NodeKind::dynamic);
    touch(of.light, next, Vec3f(0.8f, 0, 0.6f));
    touch(next, last, Vec3f(0.8f, 0, -0.6f));
    touch(last, add(NodeKind::fixed), Vec3f::UnitX());
    touch(next, beside, Vec3f::UnitZ());
    touch(beside, add(NodeKind::fixed), Vec3f::UnitZ());
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    const Block& block = partition.blocks[0];
    for (const uint32_t body : {of.heavy, of.light, next, last})
        EXPECT_TRUE(std::ranges::count(block.nodes, body)) << "node " << body;
    EXPECT_EQ(block.nodes.size(), 4u) << "not what is pushed past them";
    EXPECT_EQ(block.pairs.size(), 6u) << "three among them, two on the ground, one at the wall";
}

TEST_F(PressedBodies, AreNotWhatStandsBesideAHeavyOne) {
    side_by_side(*this, Vec3f::UnitX());                          // leans on it
    side_by_side(*this, Vec3f::UnitY());                          // lies on it
    side_by_side(*this, -Vec3f::UnitY(), 9);                      // is not so light
    const Touching corner = side_by_side(*this, Vec3f::UnitX());  // is pushed past it
    touch(corner.light, add(NodeKind::fixed), Vec3f(0.4f, 0, 0.9f));
    const Touching wide = side_by_side(*this, -Vec3f::UnitY());  // is one of many
    for (int i = 0; i < 60; ++i) touch(wide.light, tower(1)[0], Vec3f::UnitX());
    build();
    EXPECT_TRUE(partition.blocks.empty());
    EXPECT_EQ(substeps_of(wide.light), 4u);
}

// A row of equal bodies of 1 kg whose contacts bear a force, on a body `behind` to the left, with a wall to the right.
struct Row {
    Row(Graph& graph, uint32_t behind, uint32_t count, double force) : of(graph) {
        first = of.touching.size();
        for (uint32_t left = behind; bodies.size() < count; left = bodies.back()) {
            bodies.push_back(of.add(NodeKind::dynamic));
            of.touch(left, bodies.back(), Vec3f::UnitX());
        }
        of.touch(bodies.back(), of.add(NodeKind::fixed), Vec3f::UnitX());
        bear(0, count + 1, force);
    }
    // From one contact on to before another [N].
    void bear(size_t from, size_t to, double force) const {
        for (size_t i = from; i < to; ++i) {
            of.touching[first + i].force[0].normal = static_cast<float>(force);
        }
    }

    Graph& of;
    std::vector<uint32_t> bodies;
    size_t first;  // of their contacts, in Graph::touching
};

constexpr double kHard = 210;  // [N]
constexpr int kFrames = 10;

TEST_F(PressedBodies, ThatBearMuchForAWhileAreABlock) {
    const Row row(*this, add(NodeKind::dynamic), 3, kHard);
    for (int frame = 1; frame < kFrames; ++frame) {
        build();
        EXPECT_TRUE(partition.blocks.empty()) << "frame " << frame;
    }
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 4u);
    EXPECT_EQ(partition.blocks[0].pairs.size(), 4u) << "the wall's as well";
}

// In a world of ten times the gravity that is no more than in another the tenth of it.
TEST_F(PressedBodies, AreMeasuredByTheirWeight) {
    rules.gravity = Vec3(0, -98.1, 0);
    const Row row(*this, add(NodeKind::dynamic), 1, 9 * kHard);
    for (int frame = 0; frame < 2 * kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
    row.bear(0, 2, 10 * kHard);
    for (int frame = 0; frame < kFrames; ++frame) build();
    EXPECT_EQ(partition.blocks.size(), 1u);
}

TEST_F(PressedBodies, ThatBearLessAreSwept) {
    const Row row(*this, add(NodeKind::dynamic), 3, 190);
    for (int frame = 0; frame < 2 * kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
}

TEST_F(PressedBodies, CountFromTheLastFrameThatBoreLess) {
    const Row row(*this, add(NodeKind::dynamic), 1, kHard);
    for (int frame = 1; frame < kFrames; ++frame) build();
    row.bear(0, 2, 0);
    build();
    row.bear(0, 2, kHard);
    for (int frame = 1; frame < kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
    build();
    EXPECT_EQ(partition.blocks.size(), 1u);
}

// A third is enough where one of the two is held, so that a row is held as a whole, and goes on being held.
TEST_F(PressedBodies, BringInWhatBearsAThirdBesideThem) {
    const Row row(*this, add(NodeKind::dynamic), 4, 80);
    row.bear(3, 5, kHard);  // the last two against the wall
    for (int frame = 0; frame < kFrames; ++frame) build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    const auto block_holds = [&] { return partition.blocks.empty() ? 0 : partition.blocks[0].nodes.size(); };
    EXPECT_EQ(block_holds(), 2u);
    for (int frame = 0; frame < 3 * kFrames; ++frame) {
        hold_blocks();
        build();
    }
    EXPECT_EQ(block_holds(), 5u);
    row.bear(0, 5, 60);
    hold_blocks();
    build();
    EXPECT_EQ(block_holds(), 0u);
}

// A column of fifteen bears as many weights where it stands, and twice that as it lands.
TEST_F(PressedBodies, OfManyBearTwiceTheirWeight) {
    const Row row(*this, add(NodeKind::dynamic), 14, 15 * 19);
    for (int frame = 0; frame < 2 * kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
    row.bear(0, 15, 15 * 20);
    for (int frame = 0; frame < kFrames; ++frame) build();
    EXPECT_EQ(partition.blocks.size(), 1u);
}

TEST_F(PressedBodies, OfLargeIslandsAreSwept) {
    const Row row(*this, add(NodeKind::dynamic), 61, 10 * kHard);
    for (int frame = 0; frame < 2 * kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
}

// There may be no room between the two that do not yield.
TEST_F(PressedBodies, BySomethingKinematicAreSwept) {
    const Row row(*this, add(NodeKind::kinematic), 3, kHard);
    for (int frame = 0; frame < 2 * kFrames; ++frame) build();
    EXPECT_TRUE(partition.blocks.empty());
}

}  // namespace
}  // namespace taut::test
