// Who is solved with whom, against brute force on random graphs, and the rules that give an island more substeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "constraints/soft_contact.h"
#include "partition/needs.h"
#include "starts.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

struct PartitionTest : testing::Test, Graph {};

// Smallest node reached from each moving node through moving nodes.
std::vector<uint32_t> components(uint32_t count, const std::vector<std::pair<uint32_t, uint32_t>>& edges) {
    std::vector<uint32_t> label(count);
    for (uint32_t i = 0; i < count; ++i) label[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : edges)
            if (label[a] != label[b]) {
                label[a] = label[b] = std::min(label[a], label[b]);
                changed = true;
            }
    }
    return label;
}

class RandomGraph : public testing::TestWithParam<uint32_t>, protected Graph {};
INSTANTIATE_TEST_SUITE_P(Seeds, RandomGraph, testing::Range(1u, 1 + starts(200u)));

TEST_P(RandomGraph, HasItsComponentsAsIslandsAndBlocks) {
    std::mt19937 engine(GetParam());
    const uint32_t count = 2 + engine() % 60;
    for (uint32_t i = 0; i < count; ++i) {
        constexpr NodeKind kKinds[] = {NodeKind::dynamic, NodeKind::dynamic, NodeKind::particle, NodeKind::fixed,
                                       NodeKind::kinematic};
        add(kKinds[engine() % 5]);
    }
    for (uint32_t dead = engine() % 4; dead > 0; --dead) {
        const uint32_t node = engine() % count;
        if (nodes.info[node].kind != NodeKind::dead) nodes.remove(node);
    }
    std::vector<std::pair<uint32_t, uint32_t>> joint_edges, contact_edges, all_edges;
    std::set<uint32_t> jointed;
    std::set<std::pair<uint32_t, uint32_t>> touched;
    for (uint32_t i = engine() % (count + 1); i > 0; --i) {
        uint32_t a = engine() % count, b = engine() % count;
        if (a == b || nodes.info[a].kind == NodeKind::dead || nodes.info[b].kind == NodeKind::dead) continue;
        if (engine() % 2) {
            if (!moving(a) && !moving(b)) continue;
            if (engine() % 6 == 0 && moving(a)) b = kNone;
            join(a, b);
            jointed.insert({a, b});
            if (moving(a) && moving(b)) joint_edges.push_back({a, b});
        } else if (moving(a) || moving(b)) {
            if (!touched.insert({std::min(a, b), std::max(a, b)}).second) continue;
            touch(a, b);
            if (moving(a) && moving(b)) contact_edges.push_back({a, b});
        }
    }
    all_edges = joint_edges;
    all_edges.insert(all_edges.end(), contact_edges.begin(), contact_edges.end());
    for (const auto& [a, b] : contact_edges)  // blocks take in what touches them
        if (jointed.count(a) || jointed.count(b)) joint_edges.push_back({a, b});
    build();

    const std::vector<uint32_t> island = components(count, all_edges), block = components(count, joint_edges);
    std::set<uint32_t> islands;
    std::map<uint32_t, std::vector<uint32_t>> block_joints, block_nodes;
    for (uint32_t i = 0; i < count; ++i)
        if (moving(i)) islands.insert(island[i]);
    for (uint32_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        block_joints[block[moving(joint.node[0]) ? joint.node[0] : joint.node[1]]].push_back(j);
    }
    for (uint32_t i = 0; i < count; ++i)
        if (moving(i) && block_joints.count(block[i])) block_nodes[block[i]].push_back(i);
    EXPECT_EQ(partition.islands, islands.size());
    ASSERT_EQ(partition.blocks.size(), block_joints.size());
    for (const Block& b : partition.blocks) {
        ASSERT_FALSE(b.nodes.empty());
        const uint32_t label = block[b.nodes[0]];
        EXPECT_TRUE(std::equal(b.nodes.begin(), b.nodes.end(), block_nodes[label].begin(), block_nodes[label].end()));
        EXPECT_TRUE(
            std::equal(b.joints.begin(), b.joints.end(), block_joints[label].begin(), block_joints[label].end()));
    }
    // Every moving node, block and pair of a moving node in one group; islands whole.
    std::map<uint32_t, uint32_t> group_of;
    size_t members = 0, grouped_blocks = 0, grouped_pairs = 0, direct_pairs = 0;
    for (uint32_t g = 0; g < partition.group_count; ++g) {
        const Group& group = partition.groups[g];
        EXPECT_TRUE(std::is_sorted(group.nodes.begin(), group.nodes.end()));
        EXPECT_TRUE(g == 0 || partition.groups[g - 1].substeps < group.substeps);
        for (uint32_t node : group.nodes) {
            const auto [at, added] = group_of.insert({island[node], g});
            EXPECT_EQ(at->second, g);
        }
        members += group.nodes.size();
        grouped_blocks += group.blocks.size();
        grouped_pairs += group.pairs.size();
        direct_pairs += group.direct_pairs.size();
    }
    size_t expected_members = 0;
    for (uint32_t i = 0; i < count; ++i) expected_members += moving(i);
    EXPECT_EQ(members, expected_members);
    EXPECT_EQ(grouped_blocks, partition.blocks.size());
    EXPECT_EQ(grouped_pairs + direct_pairs, touching.size());
    // Those of jointed nodes, and those of what these touch with the world or within the block.
    std::map<uint32_t, size_t> block_of;
    for (size_t b = 0; b < partition.blocks.size(); ++b)
        for (uint32_t node : partition.blocks[b].nodes) block_of[node] = b;
    const auto is_jointed = [&](uint32_t node) { return moving(node) && jointed.count(node) > 0; };
    const auto is_held = [&](uint32_t node) { return !moving(node) || block_of.count(node) > 0; };
    size_t expected_direct = 0;
    for (const Pair& pair : touching) {
        const uint32_t a = pair.a, b = pair.b;
        const bool within = is_held(a) && is_held(b) && (!moving(a) || !moving(b) || block_of[a] == block_of[b]);
        expected_direct += is_jointed(a) || is_jointed(b) || (within && (moving(a) || moving(b)));
    }
    EXPECT_EQ(direct_pairs, expected_direct);
}

TEST_F(PartitionTest, FixedAndKinematicNodesPartIslands) {
    const uint32_t ground = add(NodeKind::fixed), lift = add(NodeKind::kinematic);
    for (int i = 0; i < 3; ++i) touch(ground, add(NodeKind::dynamic));
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
    touch(lift, a);
    join(lift, b);
    build();
    EXPECT_EQ(partition.islands, 5u);
    EXPECT_EQ(partition.blocks.size(), 1u);
}

// ---------------------------------------------------------------- colours

// Ends of a swept constraint by group index, and whether each colour but the last is free of common moving nodes.
template <class Ends>
void expect_valid_colours(const Graph& test, const Array<uint32_t>& items, const Array<uint32_t>& begin, Ends ends) {
    ASSERT_EQ(begin.size(), kMaxColours + 1);
    ASSERT_EQ(begin[0], 0u);
    ASSERT_EQ(begin[kMaxColours], items.size());
    for (uint32_t c = 0; c + 1 < kMaxColours; ++c) {
        ASSERT_LE(begin[c], begin[c + 1]);
        std::set<uint32_t> used;
        for (uint32_t i = begin[c]; i < begin[c + 1]; ++i) {
            const auto [a, b] = ends(items[i]);
            for (uint32_t node : {a, b}) EXPECT_TRUE(!test.moving(node) || used.insert(node).second) << "colour " << c;
        }
    }
}

TEST_F(PartitionTest, NoColourHoldsAMovingNodeTwice) {
    std::mt19937 engine(4);
    rules.direct = false;
    const uint32_t ground = add(NodeKind::fixed);
    constexpr uint32_t kCount = 300;
    for (uint32_t i = 0; i < kCount; ++i) add(NodeKind::dynamic);
    std::set<std::pair<uint32_t, uint32_t>> known;
    for (int i = 0; i < 1500; ++i) {
        const uint32_t a = engine() % (kCount + 1), b = engine() % (kCount + 1);
        if (a == b || !known.insert({std::min(a, b), std::max(a, b)}).second) continue;
        if (engine() % 3)
            touch(a, b);
        else
            join(a, engine() % 10 == 0 && a != ground ? kNone : b);
    }
    build();
    EXPECT_EQ(partition.blocks.size(), 0u);
    size_t swept_joints = 0, swept_pairs = 0;
    for (uint32_t g = 0; g < partition.group_count; ++g) {
        const Group& group = partition.groups[g];
        expect_valid_colours(*this, group.pairs, group.pair_colour_begin,
                             [&](uint32_t p) { return std::pair(pairs.active[p].a, pairs.active[p].b); });
        expect_valid_colours(*this, group.joints, group.joint_colour_begin,
                             [&](uint32_t j) { return std::pair(joints.record[j].node[0], joints.record[j].node[1]); });
        swept_pairs += group.pairs.size();
        swept_joints += group.joints.size();
    }
    EXPECT_EQ(swept_pairs, touching.size());
    EXPECT_EQ(swept_joints, joints.record.size());
    EXPECT_GT(partition.colours, 4u);
    EXPECT_LT(partition.colours, kMaxColours);
}

// 63 colours for one node, what is left goes to the last, one by one.
TEST_F(PartitionTest, AHubWithAHundredContactsReachesTheLastColour) {
    const uint32_t hub = add(NodeKind::dynamic);
    for (int i = 0; i < 100; ++i) touch(hub, add(NodeKind::dynamic));
    build();
    ASSERT_EQ(partition.group_count, 1u);
    const Group& group = partition.groups[0];
    EXPECT_EQ(partition.colours, kMaxColours);
    expect_valid_colours(*this, group.pairs, group.pair_colour_begin,
                         [&](uint32_t p) { return std::pair(pairs.active[p].a, pairs.active[p].b); });
    for (uint32_t c = 0; c + 1 < kMaxColours; ++c)
        EXPECT_EQ(group.pair_colour_begin[c + 1] - group.pair_colour_begin[c], 1u);
    EXPECT_EQ(group.pair_colour_begin[kMaxColours] - group.pair_colour_begin[kMaxColours - 1], 100 - (kMaxColours - 1));
}

// Bodies on a line in the order of chance, each in touch with those near it: two threads that take half of each colour
// meet at few bodies, while halves in the order of index share half of them.
TEST_F(PartitionTest, HalvesOfTheColoursMeetAtFewNodes) {
    std::mt19937 engine(5);
    constexpr uint32_t kCount = 1000, kNear = 4;
    std::vector<uint32_t> at(kCount);
    for (uint32_t& node : at) node = add(NodeKind::dynamic);
    std::shuffle(at.begin(), at.end(), engine);
    for (uint32_t i = 0; i < kCount; ++i) {
        nodes.motion[at[i]].x = Vec3(0, 0, i);
        for (uint32_t k = 1; k <= kNear && i + k < kCount; ++k) touch(at[i], at[i + k]);
    }
    nodes.motion[at[0]].x.y() = 1e4;  // one far off
    build();
    ASSERT_EQ(partition.group_count, 1u);
    const Group& group = partition.groups[0];
    std::set<uint32_t> half[2];
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t begin = group.pair_colour_begin[c], end = group.pair_colour_begin[c + 1];
        // kinds go to and fro, that of one point fro
        EXPECT_TRUE(std::is_sorted(group.pair_place.begin() + begin, group.pair_place.begin() + end, std::greater<>()));
        if (end - begin < kCount / 10) continue;  // what is left over, anywhere
        for (uint32_t i = begin; i < end; ++i)
            for (uint32_t node : pairs.active[group.pairs[i]].sides())
                half[i >= begin + (end - begin) / 2].insert(node);
    }
    size_t shared = 0;
    for (uint32_t node : half[0]) shared += half[1].count(node);
    EXPECT_GT(half[0].size(), kCount / 3);
    EXPECT_GT(half[1].size(), kCount / 3);
    EXPECT_LT(shared, kCount / 10);
}

TEST_F(PartitionTest, AFixedHubNeedsOneColour) {
    const uint32_t ground = add(NodeKind::fixed);
    for (int i = 0; i < 100; ++i) touch(ground, add(NodeKind::dynamic));
    build();
    EXPECT_EQ(partition.colours, 1u);
    EXPECT_EQ(partition.islands, 100u);
}

// ---------------------------------------------------------------- substeps

// Where nothing weighs anything, nothing buckles.
TEST_F(PartitionTest, PilesWithoutWeightTakeNoMore) {
    std::vector<std::vector<uint32_t>> columns;
    for (int i = 0; i < 5; ++i) columns.push_back(tower(20));
    for (size_t level = 0; level < 20; ++level)
        for (size_t i = 0; i + 1 < 5; ++i) touch(columns[i][level], columns[i + 1][level]);
    build();
    EXPECT_EQ(partition.islands, 1u);
    EXPECT_EQ(substeps_of(columns[0][0]), 4u);
}

TEST_F(PartitionTest, HeavyOnLightIsABlockOrTakesMoreSubsteps) {
    auto pile = [&](double below, double above, uint32_t beside) {
        std::vector<uint32_t> boxes = tower(1, below);
        boxes.push_back(add(NodeKind::dynamic, above));
        touch(boxes[0], boxes[1]);
        for (uint32_t i = 0; i < beside; ++i) {  // on the ground, leaning on it
            const uint32_t more = tower(1, below)[0];
            touch(boxes[0], more);
        }
        return boxes[0];
    };
    const uint32_t heavy = pile(1, 11, 0), wide = pile(1, 11, 60), not_so = pile(1, 9, 0), light = pile(100, 1, 0);
    const uint32_t wider = pile(1, 19, 60), heavier = pile(1, 44, 60), heaviest = pile(1, 1000, 60);
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes[0], heavy);
    EXPECT_EQ(substeps_of(heavy), 4u);
    EXPECT_EQ(substeps_of(wide), 6u);
    EXPECT_EQ(substeps_of(wider), 8u);
    EXPECT_EQ(substeps_of(heavier), 12u);
    EXPECT_EQ(substeps_of(heaviest), 16u);
    EXPECT_EQ(substeps_of(not_so), 4u);
    EXPECT_EQ(substeps_of(light), 4u);
    rules.fixed = true;
    build();
    EXPECT_EQ(substeps_of(wide), 4u);
}

// A load that hangs in the air on a light body stands on nothing.
TEST_F(PartitionTest, LoadsCountOnlyOnASupport) {
    const uint32_t light = add(NodeKind::dynamic, 1), heavy = add(NodeKind::dynamic, 1000);
    touch(light, heavy);
    build();
    EXPECT_EQ(substeps_of(light), 4u);
}

TEST_F(PartitionTest, JointedIslandsTakeNoMore) {
    const std::vector<uint32_t> boxes = tower(1, 1);
    const uint32_t heavy = add(NodeKind::dynamic, 50);
    touch(boxes[0], heavy);
    join(heavy, kNone);
    build();
    EXPECT_EQ(substeps_of(heavy), 4u);
}

TEST_F(PartitionTest, BlocksOfExtremeMassesOrThatTrippedTakeTwice) {
    const uint32_t a = add(NodeKind::dynamic, 1), b = add(NodeKind::dynamic, 4e4);
    const uint32_t c = add(NodeKind::dynamic, 1), d = add(NodeKind::dynamic, 2e4);
    join(a, b);
    join(c, d);
    build();
    EXPECT_EQ(substeps_of(a), 8u);
    EXPECT_EQ(substeps_of(c), 4u);
    EXPECT_DOUBLE_EQ(partition.blocks[0].mass_ratio, 4e4);
    partition.blocks[1].memory.escalated = true;
    build();
    EXPECT_EQ(substeps_of(c), 8u);
    rules.fixed = true;
    build();
    EXPECT_EQ(substeps_of(a), 4u);
    EXPECT_EQ(substeps_of(c), 4u);
}

// ---------------------------------------------------------------- blocks kept

// As the first solve leaves a block behind.
void analyse(Block& block) {
    block.matrix.begin(static_cast<uint32_t>(block.nodes.size() + block.joints.size()));
    block.matrix.analyse();
    block.memory.solved = 7;
}
bool kept(const Block& block) { return block.matrix.analysed() && block.memory.solved == 7; }

TEST_F(PartitionTest, BlocksStayWhileTheirJointsDo) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic), c = add(NodeKind::dynamic),
                   d = add(NodeKind::dynamic);
    join(a, b);
    const uint32_t other = join(c, d);
    build();
    ASSERT_EQ(partition.blocks.size(), 2u);
    for (Block& block : partition.blocks) analyse(block);

    build();
    const uint64_t calls = memory.calls();
    build();
    EXPECT_EQ(memory.calls(), calls) << "an unchanged scene allocates nothing";
    EXPECT_TRUE(kept(partition.blocks[0]));
    EXPECT_TRUE(kept(partition.blocks[1]));

    touch(add(NodeKind::fixed), a);  // a contact with the ground changes no pattern
    build();
    EXPECT_TRUE(kept(partition.blocks[0]));

    join(d, add(NodeKind::dynamic));  // somebody else's joint
    build();
    ASSERT_EQ(partition.blocks.size(), 2u);
    EXPECT_TRUE(kept(partition.blocks[0]));
    EXPECT_FALSE(kept(partition.blocks[1]));

    joints.remove(other);
    build();
    ASSERT_EQ(partition.blocks.size(), 2u);
    EXPECT_TRUE(kept(partition.blocks[0]));
    EXPECT_FALSE(kept(partition.blocks[1]));
}

// A contact between two blocks makes them one while it lasts; each keeps what it remembers.
TEST_F(PartitionTest, ContactsMergeBlocks) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic), c = add(NodeKind::dynamic),
                   d = add(NodeKind::dynamic), free = add(NodeKind::dynamic), far = add(NodeKind::dynamic);
    join(a, b);
    join(c, d);
    touch(b, c);
    touch(d, free);
    touch(free, far);  // not with a jointed body: swept
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 5u);
    EXPECT_EQ(partition.blocks[0].pairs.size(), 2u);
    EXPECT_EQ(partition.groups[0].pairs.size(), 1u);
    analyse(partition.blocks[0]);
    touching.clear();
    build();
    ASSERT_EQ(partition.blocks.size(), 2u);
    EXPECT_EQ(partition.blocks[0].memory.solved, 7u);
    EXPECT_FALSE(partition.blocks[0].matrix.analysed());
}

// A body of 2 kg on a joint carries 100 m/s^2 times its mass for three frames: its block takes its contacts in, and for
// a second after that.
TEST_F(PartitionTest, OnlyLoadedBlocksTakeTheirContactsIn) {
    const uint32_t a = add(NodeKind::dynamic, 2), ground = add(NodeKind::fixed);
    const uint32_t j = join(a, kNone);
    joints.record[j].loaded = 0;
    touch(a, ground);
    auto taken_in = [&](double force) {
        joints.record[j].lambda[1] = force;
        note_loads(joints, elements, nodes);
        build();
        return partition.blocks[0].pairs.size();
    };
    for (int frame = 0; frame < 10; ++frame) EXPECT_EQ(taken_in(599), 0u);
    EXPECT_EQ(taken_in(-601), 0u);
    EXPECT_EQ(taken_in(601), 0u);
    EXPECT_EQ(taken_in(0), 0u) << "starts again";
    EXPECT_EQ(taken_in(601), 0u);
    EXPECT_EQ(taken_in(601), 0u);
    EXPECT_EQ(taken_in(601), 1u);
    for (int frame = 0; frame < 60; ++frame) EXPECT_EQ(taken_in(0), 1u) << frame;
    EXPECT_EQ(taken_in(0), 0u);

    const uint32_t heavy = add(NodeKind::dynamic, 200);
    joints.record[join(a, heavy)].loaded = 0;
    EXPECT_EQ(taken_in(0), 1u) << "masses of 1 to 100";
}

// Beyond 64 bodies that came by contacts the rest is swept; contacts with the ground always belong to the block.
TEST_F(PartitionTest, BlocksGrowOnlySoFar) {
    const uint32_t ground = add(NodeKind::fixed), hub = add(NodeKind::dynamic);
    join(hub, kNone);
    touch(ground, hub);
    for (int i = 0; i < 100; ++i) touch(hub, add(NodeKind::dynamic));
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 65u);
    EXPECT_EQ(partition.blocks[0].pairs.size(), 65u);
    EXPECT_EQ(partition.groups[0].pairs.size(), 36u);
}

TEST_F(PartitionTest, SoftJointsAreSwept) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic), c = add(NodeKind::dynamic);
    join(a, b);
    joints.record[join(b, c)].solve = JointSolve::swept;
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 2u);
    EXPECT_EQ(partition.islands, 1u);
    ASSERT_EQ(partition.groups[0].joints.size(), 1u);
}

// A joint with drives and friction, for which a direct solve costs several times what sweeps do; solved by need.
uint32_t need_based(Joints& joints, uint32_t index) {
    Joint& joint = joints.record[index];
    joint.solve = JointSolve::by_load;
    joint.loaded = 0;
    joint.plain = false;
    for (int r = 0; r < joint.type->rows; ++r) joint.axis[r].max_force = joint.axis[r].friction = 1;
    return index;
}

// At a strain of 3 a quarter of a second of what is beyond 1 takes an eighth, at any length of frames and substeps; a
// quarter of a second after, sweeps have it back.
TEST_F(PartitionTest, JointsAreABlockOnlyWhileTheyNeedIt) {
    constexpr double kSide = 0.5;  // [m]
    for (const auto& [rate, substeps] : {std::pair{30, 8u}, {60, 4u}, {120, 2u}, {240, 1u}, {240, 16u}}) {
        SCOPED_TRACE(testing::Message() << rate << " Hz, " << substeps << " substeps");
        rules.time_step = 1.0 / rate;
        rules.substeps = substeps;
        rules.spring_substep = rules.time_step / substeps;
        const double h = rules.spring_substep;
        const uint32_t a = add_cube(1, kSide), b = add_cube(1, kSide), box = add_cube(1, kSide);
        const uint32_t joint = need_based(joints, join(a, b));
        touch(a, box);
        const auto blocks_after = [&](double seconds, double strain) {
            const double yield = kSeen * extent(nodes.mass[a]);  // [m] at a strain of 1, of 2/m |f|
            joints.record[joint].lambda[1] = strain * yield / (kJointYield * h * h * 2);
            const long frames = std::lround(seconds * rate);
            for (long i = 0; i < frames; ++i) note_needs(joints, elements, nodes, h, rules.time_step);
            build();
            EXPECT_EQ(partition.groups[0].pairs.size(), 1u) << "contacts stay swept";
            return partition.blocks.size();
        };
        EXPECT_EQ(blocks_after(1, 0.99), 0u);
        EXPECT_EQ(blocks_after(0.1, 3), 0u);
        EXPECT_EQ(blocks_after(0.3, 0), 0u);
        EXPECT_EQ(blocks_after(0.1, 3), 0u) << "starts again";
        EXPECT_EQ(blocks_after(0.0667, 3), 1u);
        EXPECT_EQ(blocks_after(0.2, 0.99), 1u);
        EXPECT_EQ(blocks_after(0.1, 0.99), 0u);
        EXPECT_EQ(blocks_after(1.0 / rate, 1000), 1u) << "one frame of a great one is enough";
        EXPECT_EQ(blocks_after(0.3, 0), 0u);
        joints.record[joint].solve = JointSolve::direct;
        EXPECT_EQ(blocks_after(0, 0), 1u);
        joints.remove(joint);
        touching.clear();
        for (const uint32_t node : {a, b, box}) nodes.remove(node);
    }
}

// What would give way by more than is seen under the weight of its heaviest body by its lightest is direct from the
// start: at short substeps sweeps hold more.
TEST_F(PartitionTest, UnevenMechanismsAreBlocksFromTheStart) {
    const uint32_t light = add_cube(1, 0.1), heavy = add_cube(75, 0.5);
    need_based(joints, join(light, heavy));
    EXPECT_LT(strain_of_weights(nodes.mass[light], 75, 1.0 / 240, 9.81), 1);
    build();
    EXPECT_EQ(partition.blocks.size(), 0u);
    set_mass(heavy, 150);
    build();
    EXPECT_EQ(partition.blocks.size(), 1u);
    rules.substeps = 16;
    build();
    EXPECT_EQ(partition.blocks.size(), 0u);
}

// Nets of particles, whose joints have no size to yield by, are direct while that costs less than sweeps of the most
// substeps would; of each tied to each, few. What is not is swept, and its contacts with blocks are theirs.
TEST_F(PartitionTest, WhatADirectSolveCostsTooMuchForIsSwept) {
    const auto net = [&](uint32_t side) {
        const uint32_t first = nodes.slots();
        for (uint32_t i = 0; i < side * side; ++i) add(NodeKind::particle);
        for (uint32_t i = 0; i < side; ++i)
            for (uint32_t k = 0; k < side; ++k) {
                if (k + 1 < side) join(first + i * side + k, first + i * side + k + 1);
                if (i + 1 < side) join(first + i * side + k, first + (i + 1) * side + k);
            }
        return first;
    };
    const auto clique = [&](uint32_t count) {
        const uint32_t first = nodes.slots();
        for (uint32_t i = 0; i < count; ++i) add(NodeKind::dynamic);
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = 0; k < i; ++k) join(first + i, first + k);
        return first;
    };
    const uint32_t direct = net(20), swept = clique(40), few = clique(6), link = add(NodeKind::dynamic);
    join(link, kNone);
    touch(link, swept + 7);
    build();
    ASSERT_EQ(partition.blocks.size(), 3u);
    EXPECT_EQ(partition.blocks[0].nodes[0], direct);
    EXPECT_EQ(partition.blocks[0].nodes.size(), 400u);
    EXPECT_EQ(partition.blocks[1].nodes[0], few);
    EXPECT_EQ(partition.blocks[2].nodes.size(), 2u) << "a link and what it touches";
    ASSERT_EQ(partition.group_count, 1u);
    EXPECT_EQ(partition.groups[0].joints.size(), 780u);
    build();
    const uint64_t calls = memory.calls();
    build();
    EXPECT_EQ(memory.calls(), calls) << "prices are known: nothing is analysed again";
}

// Joints that two bodies share are rows of one column: a few are direct, a thousand swept.
TEST_F(PartitionTest, ManyJointsBetweenTwoBodiesAreSwept) {
    for (const uint32_t count : {20u, 1000u}) {
        const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
        for (uint32_t i = 0; i < count; ++i) join(a, b);
    }
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_EQ(partition.blocks[0].joints.size(), 20u);
    EXPECT_EQ(partition.groups[0].joints.size(), 1000u);
}

// A joint's slot is used again at once, by a joint between other nodes of the same block or of another type: the
// numbers in the block are the same, its matrix is not.
TEST_F(PartitionTest, AReusedSlotIsAnotherJoint) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic), c = add(NodeKind::dynamic);
    join(a, b);
    uint32_t last = join(b, c);
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);

    analyse(partition.blocks[0]);
    joints.remove(last);
    ASSERT_EQ(join(a, c), last);
    build();
    ASSERT_EQ(partition.blocks.size(), 1u);
    EXPECT_FALSE(kept(partition.blocks[0])) << "joined elsewhere";

    analyse(partition.blocks[0]);
    joints.remove(last);
    ASSERT_EQ(join(a, c, kDistance), last);
    build();
    EXPECT_FALSE(kept(partition.blocks[0])) << "of another type";
}

TEST_F(PartitionTest, AReusedSlotIsAnotherNode) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
    const uint32_t joint = join(a, b);
    build();
    analyse(partition.blocks[0]);
    joints.remove(joint);
    nodes.remove(b);
    ASSERT_EQ(add(NodeKind::particle, 50), b);
    ASSERT_EQ(join(a, b), joint);
    build();
    EXPECT_FALSE(kept(partition.blocks[0])) << "three freedoms instead of six";
    EXPECT_DOUBLE_EQ(partition.blocks[0].mass_ratio, 50);
}

}  // namespace
}  // namespace taut::test
