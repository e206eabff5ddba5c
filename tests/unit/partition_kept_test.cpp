// What a partition keeps over frames may not show: after any change it is what a new one makes of the same frame.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <random>

#include "aligned_memory.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

void expect_same(const Group& kept, const Group& fresh) {
    EXPECT_EQ(kept.substeps, fresh.substeps);
    EXPECT_EQ(kept.sweeps, fresh.sweeps);
    EXPECT_EQ(kept.nodes, fresh.nodes);
    EXPECT_EQ(kept.pairs, fresh.pairs);
    EXPECT_EQ(kept.pair_colour_begin, fresh.pair_colour_begin);
    EXPECT_EQ(kept.pair_place, fresh.pair_place);
    EXPECT_EQ(kept.joints, fresh.joints);
    EXPECT_EQ(kept.joint_colour_begin, fresh.joint_colour_begin);
    EXPECT_EQ(kept.blocks, fresh.blocks);
    EXPECT_EQ(kept.direct_pairs, fresh.direct_pairs);
    EXPECT_EQ(kept.span_pairs, fresh.span_pairs);
}

void expect_same(const Partition& kept, const Partition& fresh) {
    EXPECT_EQ(kept.islands, fresh.islands);
    EXPECT_EQ(kept.colours, fresh.colours);
    ASSERT_EQ(kept.group_count, fresh.group_count);
    for (uint32_t g = 0; g < kept.group_count; ++g) expect_same(kept.groups[g], fresh.groups[g]);
    ASSERT_EQ(kept.blocks.size(), fresh.blocks.size());
    for (size_t b = 0; b < kept.blocks.size(); ++b) {
        EXPECT_EQ(kept.blocks[b].nodes, fresh.blocks[b].nodes);
        EXPECT_EQ(kept.blocks[b].joints, fresh.blocks[b].joints);
        EXPECT_EQ(kept.blocks[b].pairs, fresh.blocks[b].pairs);
    }
}

// Bodies on a floor in columns, with some joints, and one change a frame.
class ChangingGraph : public testing::TestWithParam<uint32_t>, protected Graph {
protected:
    ChangingGraph() : engine_(GetParam()) {
        floor_ = add(NodeKind::fixed);
        for (uint32_t i = 0; i < kBodies; ++i) {
            add(i % 9 == 8 ? NodeKind::particle : NodeKind::dynamic);
            nodes.motion[1 + i].x = Vec3(i % 7, i / 7, 0);
        }
        for (uint32_t i = 0; i < 2 * kBodies; ++i) touch_or_part();
    }

    uint32_t any(uint32_t count) { return static_cast<uint32_t>(engine_() % count); }
    uint32_t body() { return 1 + any(kBodies); }

    void touch_or_part() {
        const uint32_t a = any(4) == 0 ? floor_ : body(), b = body();
        if (a == b) return;
        const auto at = std::ranges::find(touching, pair_key(a, b), &Pair::key);
        if (at == touching.end())
            touch(a, b);
        else
            touching.erase(at);
    }
    void tie_or_untie() {
        const uint32_t a = body(), b = body();
        if (joints.record.size() > 3 && joints.record[1].type)
            joints.remove(1);
        else if (a != b)
            joints.record[join(a, b)].solve = any(2) ? JointSolve::swept : JointSolve::direct;
    }
    void change() {
        const uint32_t node = body();
        switch (any(12)) {
            case 0:
                return touch_or_part();
            case 1:
                return tie_or_untie();
            case 2:
                nodes.rest[node] = nodes.rest[node] == Rest::awake ? Rest::settling : Rest::awake;
                return;
            case 3:
                return set_mass(node, nodes.mass[node].mass * (any(2) ? 30 : 1.0 / 30));
            case 4:
                nodes.motion[node].x.x() += any(20);
                return;
            case 5:
                rules.direct = !rules.direct;
                return;
            case 6:
                points_ = 1 + any(4);
                return;
            case 7:
                second_ = any(2) ? node : kNone;
                return;
            default:
                return;  // a frame like the last one
        }
    }
    void build_both(Team& helped) {
        find_active();
        for (ActivePair& pair : pairs.active) pair.points = points_;
        if (!pairs.active.empty()) pairs.active[0].a2 = second_;
        Partition fresh(memory);
        partition.build(helped, nodes, joints, elements, pairs, rules);
        fresh.build(team, nodes, joints, elements, pairs, rules);
        expect_same(partition, fresh);
    }

    static constexpr uint32_t kBodies = 40;

private:
    std::mt19937 engine_;
    uint32_t floor_ = 0, points_ = 1, second_ = kNone;
};
INSTANTIATE_TEST_SUITE_P(Seeds, ChangingGraph, testing::Range(1u, 41u));

// Memory that refuses after so many more requests.
struct Scarce {
    uint32_t left = UINT32_MAX;

    taut_hooks hooks() {
        taut_hooks hooks{};
        hooks.allocate = [](size_t size, size_t alignment, void* self) -> void* {
            uint32_t& budget = static_cast<Scarce*>(self)->left;
            if (budget == 0) return nullptr;
            --budget;
            return allocate_aligned(size, alignment);
        };
        hooks.free = [](void* at, size_t, size_t, void*) { free_aligned(at); };
        hooks.memory_user_data = this;
        return hooks;
    }
};

TEST_P(ChangingGraph, IsWholeAgainAfterMemoryRanOut) {
    Scarce scarce;
    Memory short_memory(scarce.hooks());
    Partition kept(short_memory);
    uint32_t refused = 0;
    for (int frame = 0; frame < 60 && !HasFailure(); ++frame) {
        SCOPED_TRACE(frame);
        change();
        find_active();
        scarce.left = any(frame < 3 ? 12 : 3);
        try {
            kept.build(team, nodes, joints, elements, pairs, rules);
        } catch (const std::bad_alloc&) {
            ++refused;
        }
        scarce.left = UINT32_MAX;
        kept.build(team, nodes, joints, elements, pairs, rules);
        Partition fresh(memory);
        fresh.build(team, nodes, joints, elements, pairs, rules);
        expect_same(kept, fresh);
    }
    EXPECT_GT(refused, 0u);
}

TEST_P(ChangingGraph, IsPartitionedAsIfItWereNew) {
    Team helped{taut_hooks{}, 1 + GetParam() % 3};
    for (int frame = 0; frame < 60 && !HasFailure(); ++frame) {
        SCOPED_TRACE(frame);
        change();
        build_both(helped);
        helped.rest();
    }
}

}  // namespace
}  // namespace taut::test
