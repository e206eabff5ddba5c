// Pairs against brute force over random motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "collision/leaf_tree.h"
#include "collision_oracle.h"

namespace taut::collision {
namespace {

using oracle::Random;

constexpr int kBodies = 300;
constexpr float kFat = 0.02f, kFatOfSide = 0.1f;  // what broadphase.cpp grows boxes by: [m], of the shortest side

bool overlap(const Box& p, const Box& q) {
    return (p.lo.array() <= q.hi.array()).all() && (q.lo.array() <= p.hi.array()).all();
}

bool contains(const Box& outer, const Box& inner) {
    return (outer.lo.array() <= inner.lo.array()).all() && (outer.hi.array() >= inner.hi.array()).all();
}

Box grown(const Box& box, float by) { return {box.lo - Vec3f::Constant(by), box.hi + Vec3f::Constant(by)}; }

Box fat_of(const Box& box) { return grown(box, std::min(kFat, kFatOfSide * (box.hi - box.lo).minCoeff())); }

uint64_t key(uint32_t i, uint32_t j) { return uint64_t(std::min(i, j)) << 32 | std::max(i, j); }

struct Crowd {
    explicit Crowd(uint32_t seed) : random(seed) {
        for (int i = 0; i < kBodies; ++i) {
            centre.push_back((random.uniform(0, 4) * random.unit()).cast<float>());
            velocity.push_back((random.uniform(0, 0.1) * random.unit()).cast<float>());
            half.push_back(Vec3f(float(random.uniform(0.05, 0.4)), float(random.uniform(0.1, 0.4)), 0.2f));
            moves.push_back(random.uniform(0, 1) < 0.7);
        }
    }
    Box tight(size_t i) const { return {centre[i] - half[i], centre[i] + half[i]}; }
    void step() {
        for (size_t i = 0; i < kBodies; ++i) {
            if (!moves[i]) continue;
            if (random.uniform(0, 1) < 0.05) velocity[i] = (random.uniform(0, 0.1) * random.unit()).cast<float>();
            centre[i] += velocity[i];
            if (centre[i].norm() > 4) velocity[i] = -0.05f * centre[i].normalized();
        }
    }
    std::vector<uint64_t> pairs_of(const std::vector<Box>& boxes) const {
        std::vector<uint64_t> out;
        for (uint32_t i = 0; i < kBodies; ++i) {
            for (uint32_t j = i + 1; j < kBodies; ++j) {
                if ((moves[i] || moves[j]) && overlap(boxes[i], boxes[j])) out.push_back(key(i, j));
            }
        }
        return out;
    }

    Random random;
    std::vector<Vec3f> centre, velocity, half;
    std::vector<bool> moves;
};

std::vector<uint64_t> copy(const Broadphase& broadphase) {
    return {broadphase.pairs().begin(), broadphase.pairs().end()};
}

// As a team may do it: in short ranges, the last first.
bool refresh_by_ranges(Broadphase& broadphase) {
    for (uint32_t end = broadphase.start_refresh(), length = 7; end > 0; end -= std::min(end, length))
        broadphase.find_pairs(end - std::min(end, length), end);
    return broadphase.finish_refresh();
}

// Without displacement the fat boxes are known: each is the tight box it was made for, grown.
TEST(CollisionBroadphase, PairsAreBruteForceOnFatBoxes) {
    Crowd crowd(101);
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    std::vector<Box> fat;
    for (uint32_t i = 0; i < kBodies; ++i) {
        fat.push_back(fat_of(crowd.tight(i)));
        broadphase.add(i, crowd.tight(i), crowd.moves[i]);
    }
    std::vector<uint64_t> before;
    for (int step = 0; step < 200; ++step) {
        const bool changed = broadphase.refresh_pairs();
        const std::vector<uint64_t> want = crowd.pairs_of(fat);
        ASSERT_EQ(copy(broadphase), want) << "seed 101 step " << step;
        ASSERT_EQ(changed, want != before);
        before = want;
        crowd.step();
        for (uint32_t i = 0; i < kBodies; ++i) {
            if (!contains(fat[i], crowd.tight(i))) fat[i] = fat_of(crowd.tight(i));
            broadphase.update(i, crowd.tight(i), Vec3f::Zero());
        }
    }
    EXPECT_GT(before.size(), 150u);
}

TEST(CollisionBroadphase, OrderOfInsertionDoesNotMatterAndNothingIsMissed) {
    Crowd crowd(102);
    Memory memory(taut_hooks{});
    Broadphase forward(memory), shuffled(memory);
    std::vector<uint32_t> order(kBodies);
    std::iota(order.begin(), order.end(), 0u);
    for (uint32_t i = 0; i < kBodies; ++i) std::swap(order[i], order[size_t(crowd.random.uniform(0, kBodies - 0.5))]);
    for (uint32_t i = 0; i < kBodies; ++i) {
        forward.add(i, crowd.tight(i), crowd.moves[i]);
        shuffled.add(order[i], crowd.tight(order[i]), crowd.moves[order[i]]);
    }
    size_t reinserted = 0;
    for (int step = 0; step < 200; ++step) {
        forward.refresh_pairs();
        refresh_by_ranges(shuffled);
        const std::vector<uint64_t> pairs = copy(forward);
        ASSERT_EQ(pairs, copy(shuffled)) << "seed 102 step " << step;
        std::vector<Box> tight, reach;
        for (uint32_t i = 0; i < kBodies; ++i) {
            tight.push_back(crowd.tight(i));
            // Fat boxes: 2 cm at most on each side, the steps since, and four steps ahead.
            reach.push_back(grown(crowd.tight(i), 2 * kFat + 8 * 0.1f));
        }
        const auto must = crowd.pairs_of(tight);
        const auto may = crowd.pairs_of(reach);
        ASSERT_TRUE(std::includes(pairs.begin(), pairs.end(), must.begin(), must.end()));
        ASSERT_TRUE(std::includes(may.begin(), may.end(), pairs.begin(), pairs.end()));
        crowd.step();
        for (uint32_t i = 0; i < kBodies; ++i) {
            forward.update(i, crowd.tight(i), 4 * crowd.velocity[i]);
            shuffled.update(order[i], crowd.tight(order[i]), 4 * crowd.velocity[order[i]]);
        }
        reinserted += forward.refresh_pairs();
    }
    EXPECT_GT(reinserted, 100u);
}

// The list before, without what departed and with what arrived, is the list now.
TEST(CollisionBroadphase, TellsWhatCameAndWent) {
    Crowd crowd(107);
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    for (uint32_t i = 0; i < kBodies; ++i) broadphase.add(i, crowd.tight(i), crowd.moves[i]);
    std::vector<uint64_t> before;
    int changes = 0;
    for (int step = 0; step < 200; ++step) {
        for (uint32_t i = 0; i < kBodies; ++i) broadphase.update(i, crowd.tight(i), Vec3f::Zero());
        const bool changed = refresh_by_ranges(broadphase);
        const std::vector<uint64_t> now = copy(broadphase);
        std::vector<uint64_t> arrived, departed;
        std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(arrived));
        std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(departed));
        EXPECT_TRUE(std::ranges::equal(arrived, broadphase.arrived())) << "step " << step;
        EXPECT_TRUE(std::ranges::equal(departed, broadphase.departed())) << "step " << step;
        EXPECT_EQ(changed, !arrived.empty() || !departed.empty());
        changes += changed && !arrived.empty() && !departed.empty();
        before = now;
        crowd.step();
    }
    EXPECT_GT(changes, 50);
}

TEST(CollisionBroadphase, OneMayMeetAny) {
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    const Vec3f half = Vec3f::Constant(0.1f);
    broadphase.add(0, {Vec3f::Constant(-1), Vec3f(100, 1, 1)}, true);
    for (uint32_t i = 1; i <= 100; ++i) {
        const Vec3f centre(static_cast<float>(i - 1), 0, 0);
        broadphase.add(i, {centre - half, centre + half}, true);
    }
    EXPECT_TRUE(refresh_by_ranges(broadphase));
    EXPECT_EQ(broadphase.pairs().size(), 100u);
}

TEST(CollisionBroadphase, StaticBodiesPairWithWhatMovesAlone) {
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    const Box box{Vec3f::Constant(-1), Vec3f::Constant(1)};
    broadphase.add(3, box, false);
    broadphase.add(1, box, false);
    EXPECT_FALSE(broadphase.refresh_pairs());
    EXPECT_TRUE(broadphase.pairs().empty());
    broadphase.remove(3);
    broadphase.add(3, box, true);
    EXPECT_TRUE(broadphase.refresh_pairs());
    EXPECT_EQ(copy(broadphase), std::vector<uint64_t>{key(1, 3)});
    EXPECT_FALSE(broadphase.refresh_pairs());
    broadphase.remove(3);
    broadphase.add(3, box, false);
    EXPECT_TRUE(broadphase.refresh_pairs());
    EXPECT_TRUE(broadphase.pairs().empty());
}

// Boxes in a row, of which each comes next to the last one: a tree that puts them there is as deep as the row.
TEST(CollisionBroadphase, TreesStayShallow) {
    constexpr uint32_t kMany = 4096;
    Memory memory(taut_hooks{});
    for (const uint32_t at_once : {1u, 50u, kMany}) {
        LeafTree tree(memory);
        for (uint32_t i = 0; i < kMany; ++i) {
            const auto x = static_cast<float>(i);
            tree.add(btDbvtVolume::FromMM({x, 0, 0}, {x + 1, 1, 1}), i);
            if ((i + 1) % at_once == 0) tree.settle();
        }
        tree.settle();
        uint32_t leaves = 0, deepest = 0;
        const auto visit = [&](auto&& self, const btDbvtNode* node, uint32_t depth) -> void {
            if (node->isleaf()) {
                ++leaves;
                deepest = std::max(deepest, depth);
                return;
            }
            for (const btDbvtNode* child : node->childs) {
                EXPECT_EQ(child->parent, node);
                EXPECT_TRUE(node->volume.Contain(child->volume));
                self(self, child, depth + 1);
            }
        };
        visit(visit, tree.root(), 0);
        EXPECT_EQ(leaves, kMany);
        EXPECT_LE(deepest, 26u) << at_once << " at once";  // 2 log2 of as many
    }
}

// What waits is seen, moves and goes as what has its place does.
TEST(CollisionBroadphase, ProbesSeeWhatCameSinceTheLastStep) {
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> place(-20, 20);
    std::map<uint32_t, Box> boxes;
    const auto random_box = [&] {
        const Vec3f middle(place(engine), place(engine), place(engine));
        return Box{middle - Vec3f::Constant(0.5f), middle + Vec3f::Constant(0.5f)};
    };
    for (uint32_t round = 0; round < 400; ++round) {
        const uint32_t id = engine() % 200;
        if (boxes.contains(id) && engine() % 3 == 0) {
            broadphase.remove(id);
            boxes.erase(id);
        } else if (boxes.contains(id)) {
            broadphase.update(id, boxes[id] = random_box(), Vec3f::Zero());
        } else {
            broadphase.add(id, boxes[id] = random_box(), id % 3 == 0, id % 3 == 1);
        }
        if (round % 37 == 36) broadphase.refresh_pairs();
        const Box probe = random_box();
        struct Seen final : Visitor {
            std::set<uint32_t> ids;
            void visit(uint32_t one, Probe&) override { EXPECT_TRUE(ids.insert(one).second); }
        } seen;
        const Vec3 middle = (0.5f * (probe.lo + probe.hi)).cast<double>(), half = Vec3::Constant(0.5);
        broadphase.visit({middle, Vec3::Zero(), -half, half}, seen);
        for (const auto& [other, box] : boxes)
            EXPECT_TRUE(!overlap(probe, box) || seen.ids.contains(other)) << "round " << round;
        for (const uint32_t other : seen.ids) EXPECT_TRUE(boxes.contains(other));
    }
}

// What one leaf that meets thousands was given in a step is not given to thousands in the next.
TEST(CollisionBroadphase, OneThatMeetsAllTakesNoRoomForEach) {
    constexpr uint32_t kMany = 3000;
    Memory memory(taut_hooks{});
    Broadphase broadphase(memory);
    const auto box_of = [](uint32_t i, float x) {
        const Vec3f low(float(i), x, 0);
        return Box{low, low + Vec3f::Constant(0.5f)};
    };
    const auto sweeper = [](float x) { return Box{Vec3f(-1, x, -1), Vec3f(float(kMany + 1), x + 3, 1)}; };
    for (uint32_t i = 1; i <= kMany; ++i) broadphase.add(i, box_of(i, 0), true);
    broadphase.add(0, sweeper(-1), true);
    broadphase.refresh_pairs();
    broadphase.update(0, sweeper(-0.5f), Vec3f::Zero());
    broadphase.refresh_pairs();
    const uint64_t before = memory.bytes();
    for (uint32_t i = 1; i <= kMany; ++i) broadphase.update(i, box_of(i, 0.2f), Vec3f::Zero());
    broadphase.find_pairs(0, broadphase.start_refresh());
    EXPECT_LT(memory.bytes(), before + 1000 * kMany);
    broadphase.finish_refresh();
    EXPECT_EQ(broadphase.pairs().size(), kMany);
}

TEST(CollisionBroadphase, RemovedIdsLeaveAndMayComeBack) {
    Memory memory(taut_hooks{});
    {
        Broadphase broadphase(memory);
        const Box box{Vec3f::Constant(-1), Vec3f::Constant(1)};
        const Box away{Vec3f::Constant(5), Vec3f::Constant(6)};
        for (const uint32_t id : {0u, 1u, 2u}) broadphase.add(id, box, true);
        broadphase.refresh_pairs();
        EXPECT_EQ(broadphase.pairs().size(), 3u);
        broadphase.remove(1);
        EXPECT_TRUE(broadphase.refresh_pairs());
        EXPECT_EQ(copy(broadphase), std::vector<uint64_t>{key(0, 2)});
        broadphase.remove(2);
        broadphase.add(2, away, true);  // a new body under the old id
        broadphase.add(1, box, true);
        EXPECT_TRUE(broadphase.refresh_pairs());
        EXPECT_EQ(copy(broadphase), std::vector<uint64_t>{key(0, 1)});
    }
}

}  // namespace
}  // namespace taut::collision
