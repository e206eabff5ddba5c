// Each validator is silent about a sound world and names a planted flaw.
#include <gtest/gtest.h>

#include <limits>

#include "check/validate.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

void expect_flaw(const MaybeFlaw& found, const char* invariant, uint64_t index) {
    ASSERT_TRUE(found.has_value()) << "nothing found, expected: " << invariant;
    EXPECT_STREQ(found->invariant, invariant);
    EXPECT_EQ(found->index, index);
}

// Two towers of three boxes, the first with a joint beside its contacts.
class Validate : public testing::Test, protected Graph {
protected:
    Validate() {
        first = tower(3);
        second = tower(3);
        joint = join(first[1], first[2]);
        rules.direct = false;
        build();
        for (ActivePair& active : pairs.active) {
            pairs.near.emplace_back().key = pairs.list[active.pair].key;
            active.near = static_cast<uint32_t>(pairs.near.size() - 1);
        }
        colliders.record.resize(nodes.slots());
    }
    Group& group() { return partition.groups[0]; }

    Colliders colliders{memory};
    std::vector<uint32_t> first, second;
    uint32_t joint = 0;
};

TEST_F(Validate, SoundWorldHasNoFlaw) {
    EXPECT_FALSE(validate_nodes(nodes));
    EXPECT_FALSE(validate_near(pairs, colliders));
    EXPECT_FALSE(validate_active(pairs, nodes));
    EXPECT_FALSE(validate_members(partition, nodes));
    EXPECT_FALSE(validate_pairs(partition, pairs, nodes));
    EXPECT_FALSE(validate_joints(partition, joints, nodes));
    EXPECT_FALSE(validate_colours(partition, pairs, joints, elements, nodes));
    EXPECT_FALSE(validate_contact_forces(pairs));
    EXPECT_FALSE(validate_joint_forces(joints, elements));
}

TEST_F(Validate, NodesAreFiniteAndUnit) {
    nodes.motion[first[1]].q.coeffs() *= 1.01;
    expect_flaw(validate_nodes(nodes), "rotations are unit quaternions", first[1]);
    nodes.motion[first[0]].w.y() = static_cast<double>(kNotANumber);
    expect_flaw(validate_nodes(nodes), "motions are finite", first[0]);
}

TEST_F(Validate, NearPairsAreSortedAndInRange) {
    pairs.near[2].pair = static_cast<uint32_t>(pairs.list.size());
    expect_flaw(validate_near(pairs, colliders), "records of near pairs are in range", 2);
    pairs.near[2].pair = 0;
    pairs.list[0].next = 0;
    expect_flaw(validate_near(pairs, colliders), "records of near pairs are in range", 2);
    std::swap(pairs.near[0].key, pairs.near[1].key);
    expect_flaw(validate_near(pairs, colliders), "near pairs are sorted by key", 1);
    colliders.record.clear();
    expect_flaw(validate_near(pairs, colliders), "colliders of near pairs are in range", 0);
}

TEST_F(Validate, ActivePairsAreSound) {
    pairs.active[3].near = 0;
    expect_flaw(validate_active(pairs, nodes), "active pairs are in the order of near", 3);
    pairs.active[2].points = 4;
    expect_flaw(validate_active(pairs, nodes), "active pairs have the points of their manifolds", 2);
    pairs.active[1].pair = 1000;
    expect_flaw(validate_active(pairs, nodes), "records of active pairs are in range", 1);
    pairs.active[0].b = nodes.slots();
    expect_flaw(validate_active(pairs, nodes), "nodes of active pairs are in range", 0);
}

TEST_F(Validate, NodesAreInOneGroupAndBlock) {
    Block& block = partition.blocks.emplace_back(memory);
    block.nodes = {first[0]};
    EXPECT_FALSE(validate_members(partition, nodes));
    partition.blocks.emplace_back(memory).nodes = {first[0]};
    expect_flaw(validate_members(partition, nodes), "nodes are in one block at most", first[0]);
    group().nodes.push_back(second[2]);
    expect_flaw(validate_members(partition, nodes), "nodes that move are in one group", second[2]);
}

TEST_F(Validate, PairsAreSolvedOnce) {
    const uint32_t last = group().pairs.back();
    group().pairs.pop_back();
    expect_flaw(validate_pairs(partition, pairs, nodes), "active pairs are in one of lanes, rows and blocks", last);
    group().pairs.push_back(last);
    group().direct_pairs.push_back(last);
    expect_flaw(validate_pairs(partition, pairs, nodes), "active pairs are in one of lanes, rows and blocks", last);
}

TEST_F(Validate, PairsAreWithinAnIsland) {
    pairs.active[1].b = second[1];
    expect_flaw(validate_pairs(partition, pairs, nodes), "pairs are within an island", 1);
}

TEST_F(Validate, JointsAreSolvedOnceWithinAnIsland) {
    joints.record[joint].node[1] = second[0];
    expect_flaw(validate_joints(partition, joints, nodes), "joints are within an island", joint);
    partition.blocks.emplace_back(memory).joints = {joint};
    expect_flaw(validate_joints(partition, joints, nodes), "joints are solved once", joint);
}

TEST_F(Validate, ColoursHaveNodesOnce) {
    auto& begin = group().pair_colour_begin;
    ASSERT_LT(begin[1], begin[2]) << "a tower takes two colours";
    begin[1] = begin[2];
    const MaybeFlaw found = validate_colours(partition, pairs, joints, elements, nodes);
    ASSERT_TRUE(found);
    EXPECT_STREQ(found->invariant, "a colour has a moving node once");
}

TEST_F(Validate, ForcesAreFiniteAndPush) {
    pairs.list[pairs.active[1].pair].force[0].normal = -1;
    expect_flaw(validate_contact_forces(pairs), "normal forces are not negative", 1);
    pairs.list[pairs.active[0].pair].force[0].tangent2 = kNotANumber;
    expect_flaw(validate_contact_forces(pairs), "contact forces are finite", 0);
    joints.record[joint].lambda[2] = static_cast<double>(kNotANumber);
    expect_flaw(validate_joint_forces(joints, elements), "joint forces are finite", joint);
}

}  // namespace
}  // namespace taut::test
