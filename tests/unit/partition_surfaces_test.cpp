// Contacts of surfaces in islands, colours and blocks, and what their validator says of planted flaws.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "check/validate.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

class SurfacePartition : public testing::Test, protected Graph {
protected:
    // Equal weights on either side.
    void surface(std::vector<uint32_t> below, std::vector<uint32_t> above) {
        SurfaceContact& contact = pairs.surfaces.contact.emplace_back();
        contact.a = pairs.surfaces.contact.size();
        contact.b = contact.a + 1;
        contact.normal = Vec3f::UnitY();
        size_t n = 0;
        for (const auto* side : {&below, &above})
            for (const uint32_t node : *side) {
                contact.node[n] = node;
                contact.weight[n++] = (side == &below ? -1.0f : 1.0f) / static_cast<float>(side->size());
            }
        ++pairs.surfaces.version;
    }
    std::vector<uint32_t> particles(size_t count) {
        std::vector<uint32_t> out;
        while (out.size() < count) out.push_back(add(NodeKind::particle));
        return out;
    }
    // Three particles with rods between each two.
    std::vector<uint32_t> triangle(JointSolve solve) {
        const std::vector<uint32_t> corner = particles(3);
        for (size_t i = 0; i < 3; ++i) joints.record[join(corner[i], corner[(i + 1) % 3], kDistance)].solve = solve;
        return corner;
    }
    const SurfaceContacts& surfaces() const { return pairs.surfaces; }
    MaybeFlaw flaw() const { return validate_surfaces(partition, surfaces(), nodes); }
    void expect_flaw(const char* invariant, uint64_t index) {
        const MaybeFlaw found = flaw();
        ASSERT_TRUE(found.has_value()) << "nothing found, expected: " << invariant;
        EXPECT_STREQ(found->invariant, invariant);
        EXPECT_EQ(found->index, index);
    }
    size_t swept() const {
        size_t count = 0;
        for (uint32_t g = 0; g < partition.group_count; ++g) count += partition.groups[g].surfaces.size();
        return count;
    }
};

TEST_F(SurfacePartition, TieAllTheirNodesIntoAnIsland) {
    const auto one = particles(3), other = particles(1), apart = particles(1);
    const uint32_t ground = add(NodeKind::fixed);
    surface(one, other);
    surface({ground}, apart);
    build();
    EXPECT_FALSE(flaw());
    EXPECT_EQ(partition.islands, 2u);
    for (const uint32_t node : one) EXPECT_EQ(partition.island_of(node), partition.island_of(other[0]));
    EXPECT_NE(partition.island_of(apart[0]), partition.island_of(other[0]));
    EXPECT_EQ(swept(), 2u);
}

TEST_F(SurfacePartition, OfNodesThatRestAreNotSolved) {
    surface({add(NodeKind::fixed)}, {add(NodeKind::kinematic)});
    build();
    EXPECT_FALSE(flaw());
    EXPECT_EQ(swept(), 0u);
}

TEST_F(SurfacePartition, OfAColourShareNoNode) {
    std::mt19937 engine(5);
    const auto all = particles(40);
    for (int i = 0; i < 300; ++i) {
        std::set<uint32_t> ends;
        while (ends.size() < 4) ends.insert(all[engine() % all.size()]);
        const std::vector<uint32_t> list(ends.begin(), ends.end());
        surface({list[0], list[1]}, {list[2], list[3]});
    }
    build();
    EXPECT_FALSE(flaw());
    EXPECT_FALSE(validate_colours(partition, pairs, joints, elements, nodes));
    EXPECT_EQ(swept(), 300u);
    auto& begin = partition.groups[0].surface_colour_begin;
    begin[1] = begin[2];
    const MaybeFlaw found = validate_colours(partition, pairs, joints, elements, nodes);
    ASSERT_TRUE(found);
    EXPECT_STREQ(found->invariant, "a colour has a moving node once");
}

TEST_F(SurfacePartition, OfABlockTakeInWhatHasNoTies) {
    const auto corner = triangle(JointSolve::direct);
    const uint32_t box = add(NodeKind::dynamic), ground = add(NodeKind::fixed);
    surface(corner, {box});
    surface({ground}, {corner[0], corner[1]});
    touch(ground, box);
    build();
    EXPECT_FALSE(flaw());
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 4u);
    EXPECT_EQ(partition.blocks[0].surfaces.size(), 2u);
    EXPECT_EQ(partition.groups[0].direct_surfaces.size(), 2u);
    EXPECT_EQ(swept(), 0u);
    // Each two of its nodes that move are linked once.
    const auto& links = partition.blocks[0].links;
    EXPECT_EQ(std::set<uint64_t>(links.begin(), links.end()).size(), links.size());
    for (const uint32_t node : corner) EXPECT_TRUE(std::ranges::count(links, pair_key(node, box)));
}

TEST_F(SurfacePartition, BringTwoBlocksTogether) {
    const auto one = triangle(JointSolve::direct), other = triangle(JointSolve::direct);
    surface({one[0], one[1]}, {other[0], other[1]});
    build();
    EXPECT_FALSE(flaw());
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 6u);
}

TEST_F(SurfacePartition, StaySweptWhereTiesOfANodeAre) {
    const auto direct = triangle(JointSolve::direct), swept_ones = triangle(JointSolve::swept);
    surface(direct, {swept_ones[0]});
    build();
    EXPECT_FALSE(flaw());
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 3u);
    EXPECT_TRUE(partition.blocks[0].surfaces.empty());
    EXPECT_EQ(swept(), 1u);
}

TEST_F(SurfacePartition, AreSweptByASolverWithoutBlocks) {
    surface(triangle(JointSolve::direct), {add(NodeKind::dynamic)});
    rules.direct = false;
    build();
    EXPECT_FALSE(flaw());
    EXPECT_TRUE(partition.blocks.empty());
    EXPECT_EQ(swept(), 1u);
}

TEST_F(SurfacePartition, ArePartitionedAnewWhereTheyChange) {
    const auto all = particles(3);
    surface({all[0]}, {all[1]});
    build();
    EXPECT_EQ(partition.islands, 2u);
    surface({all[1]}, {all[2]});
    build();
    EXPECT_FALSE(flaw());
    EXPECT_EQ(partition.islands, 1u);
    pairs.surfaces.contact.pop_back();
    ++pairs.surfaces.version;
    build();
    EXPECT_FALSE(flaw());
    EXPECT_EQ(partition.islands, 2u);
}

TEST_F(SurfacePartition, AreSoundOrNamed) {
    const auto corner = triangle(JointSolve::direct);
    const uint32_t box = add(NodeKind::dynamic);
    surface(corner, {box});
    surface({corner[0]}, {box});
    build();
    EXPECT_FALSE(flaw());
    const SurfaceContact sound = pairs.surfaces.contact[1];
    const auto plant = [&](auto&& change, const char* invariant) {
        pairs.surfaces.contact[1] = sound;
        change(pairs.surfaces.contact[1]);
        expect_flaw(invariant, 1);
        pairs.surfaces.contact[1] = sound;
    };
    plant([&](SurfaceContact& c) { c.node[0] = nodes.slots(); }, "nodes of contacts of surfaces are in range");
    plant([](SurfaceContact& c) { c.node[0] = c.node[1]; }, "nodes of a contact of surfaces differ");
    plant([](SurfaceContact& c) { c.weight[0] = 0; }, "weights of contacts of surfaces sum to 0");
    plant([](SurfaceContact& c) { c.normal *= 1.1f; }, "normals of contacts of surfaces are unit");
    plant([](SurfaceContact& c) { c.gap = std::numeric_limits<float>::quiet_NaN(); },
          "contacts of surfaces are finite");
    plant([](SurfaceContact& c) { c.force.tangent2 = std::numeric_limits<float>::infinity(); },
          "forces of contacts of surfaces are finite");
    plant([](SurfaceContact& c) { c.a = 0; }, "contacts of surfaces are in the order of their features");
    partition.groups[0].surfaces.push_back(1);
    expect_flaw("contacts of surfaces are in one of lanes, rows and blocks", 1);
    partition.groups[0].surfaces.pop_back();
    EXPECT_FALSE(flaw());
    std::erase(partition.blocks[0].nodes, box);
    expect_flaw("a block has the nodes of its contacts of surfaces", 0);
}

}  // namespace
}  // namespace taut::test
