// The list of near pairs follows the broadphase's, whatever comes and goes, and who stays keeps its record.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "detect/detect.h"

namespace taut::test {
namespace {

using collision::Box;

constexpr uint32_t kBodies = 300;

// Boxes that jump about in a room.
class JumpingBoxes : public testing::TestWithParam<uint32_t> {
protected:
    JumpingBoxes() : engine_(GetParam()) {
        for (uint32_t i = 0; i < kBodies; ++i) {
            const uint32_t node = nodes.add();
            nodes.info[node].kind = NodeKind::dynamic;
            ColliderPlan collider;
            collider.node = node;
            collider.traits.filter = {1, 1, 0, 0};
            colliders.reserve_one();
            broadphase.add(colliders.add(collider), somewhere(), true);
        }
    }

    float uniform() { return std::uniform_real_distribution<float>(0, 1)(engine_); }
    Box somewhere() {
        const Vec3f lo(3 * uniform(), 3 * uniform(), 3 * uniform());
        return {lo, lo + Vec3f::Constant(0.4f)};
    }
    void jump(uint32_t count) {
        for (; count > 0; --count)
            broadphase.update(static_cast<uint32_t>(engine_() % kBodies), somewhere(), Vec3f::Zero());
    }
    void forget_some() {
        const uint32_t node = static_cast<uint32_t>(engine_() % kBodies);
        forget_pairs(pairs, nodes, colliders, ends_on(node));
        std::erase_if(known_, [&](uint64_t key) { return (key >> 32) == node || static_cast<uint32_t>(key) == node; });
    }
    // Marks what is new, finds the marks of what stayed.
    void look() {
        std::vector<uint64_t> now;
        for_near(pairs, [&](NearPair& near) {
            now.push_back(near.key);
            const bool stayed = std::ranges::binary_search(known_, near.key);
            EXPECT_EQ(near.clear, stayed ? mark(near.key) : 0) << near.key;
            near.clear = mark(near.key);
        });
        EXPECT_TRUE(std::ranges::equal(now, broadphase.pairs()));
        known_ = std::move(now);
    }

    Memory memory{taut_hooks{}};
    Nodes nodes{memory};
    Colliders colliders{memory};
    Joints joints{memory};
    Elements elements{memory};
    Pairs pairs{memory};
    collision::Broadphase broadphase{memory};

private:
    static double mark(uint64_t key) { return 1 + static_cast<double>(key % 1000003); }

    std::mt19937 engine_;
    std::vector<uint64_t> known_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, JumpingBoxes, testing::Range(1u, 13u));

TEST_P(JumpingBoxes, AreListedAsTheBroadphaseHasThem) {
    Team team{taut_hooks{}, 1 + GetParam() % 3};
    const uint32_t most[] = {0, 1, 8, kBodies, 3 * kBodies};
    for (uint32_t step = 0; step < 60 && !HasFailure(); ++step) {
        jump(most[step % 5]);
        if (step % 7 == 3) forget_some();
        update_pairs(team, nodes, colliders, joints, elements, broadphase, pairs);
        look();
        EXPECT_GT(pairs.near.size(), 300u) << "more than one block of the list";
    }
    team.rest();
}

TEST_P(JumpingBoxes, LeaveAnEmptyListAndComeBack) {
    Team team{taut_hooks{}, 2};
    update_pairs(team, nodes, colliders, joints, elements, broadphase, pairs);
    look();
    for (uint32_t i = 0; i < kBodies; ++i) {
        const Vec3f far = Vec3f(static_cast<float>(10 + 2 * i), 0, 0);
        broadphase.update(i, {far, far + Vec3f::Ones()}, Vec3f::Zero());
    }
    update_pairs(team, nodes, colliders, joints, elements, broadphase, pairs);
    EXPECT_TRUE(pairs.near.empty());
    look();
    jump(3 * kBodies);
    update_pairs(team, nodes, colliders, joints, elements, broadphase, pairs);
    look();
    team.rest();
}

}  // namespace
}  // namespace taut::test
