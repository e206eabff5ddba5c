// Records of pairs that lie about in memory are brought into the order of their pairs, and nothing else changes.
#include "state/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace taut::test {
namespace {

// Pairs of one to three parts in random slots among free ones, some of them resting.
struct Scattered {
    Memory memory{taut_hooks{}};
    Pairs pairs{memory};

    explicit Scattered(uint32_t seed) {
        std::mt19937 random(seed);
        constexpr uint32_t kPairs = 300;
        std::vector<uint32_t> slots(3 * kPairs);
        for (uint32_t i = 0; i < slots.size(); ++i) slots[i] = i;
        std::ranges::shuffle(slots, random);
        while (pairs.list.size() < slots.size()) pairs.list.emplace_back();
        for (uint32_t i = 0; i < kPairs; ++i) {
            NearPair near;
            near.key = pair_key(i, i + 1 + random() % 9);
            uint32_t* link = &near.pair;
            for (uint32_t part = 0, parts = random() % 4; part < parts; ++part) {
                Pair& pair = pairs.list[*link = slots.back()];
                slots.pop_back();
                pair.key = near.key;
                pair.part = part;
                link = &pair.next;
            }
            (random() % 8 == 0 ? pairs.resting : pairs.near).emplace_back() = near;
        }
        for (uint32_t slot : slots) pairs.free.push_back(slot);
        list();
    }
    void list() {
        pairs.active.clear();
        for (const NearPair& near : pairs.near)
            for (uint32_t slot = near.pair; slot != kNone; slot = pairs.list[slot].next)
                pairs.active.push_back({0, 0, slot, 1});
    }
    // Key and part of all records in their order.
    std::vector<std::pair<uint64_t, uint32_t>> records() const {
        std::vector<std::pair<uint64_t, uint32_t>> all;
        for_pairs(pairs, [&](const Pair& pair) { all.emplace_back(pair.key, pair.part); });
        return all;
    }
    // Each slot is free or of one record.
    void expect_all_slots_once() const {
        std::vector<int> uses(pairs.list.size());
        for (uint32_t slot : pairs.free) ++uses[slot];
        for (const NearPairs* of : {&pairs.near, &pairs.resting})
            for (const NearPair& near : *of)
                for (uint32_t slot = near.pair; slot != kNone; slot = pairs.list[slot].next) ++uses[slot];
        EXPECT_TRUE(std::ranges::all_of(uses, [](int n) { return n == 1; }));
    }
    uint32_t most_away() const {
        uint32_t most = 0;
        for (uint32_t i = 0; i < pairs.active.size(); ++i) {
            const uint32_t slot = pairs.active[i].pair;
            most = std::max(most, std::max(slot, i) - std::min(slot, i));
        }
        return most;
    }
};

TEST(OrderSlots, BringsRecordsToTheOrderOfTheirPairs) {
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Scattered scattered(seed);
        const auto before = scattered.records();
        EXPECT_GT(scattered.most_away(), 100u);
        for (int frame = 0; frame < 60; ++frame) {
            order_slots(scattered.pairs);
            scattered.list();
        }
        EXPECT_LE(scattered.most_away(), 16u);
        EXPECT_EQ(scattered.records(), before);
        scattered.expect_all_slots_once();
    }
}

// The list of the frame before may name slots that were given back since.
TEST(OrderSlots, TakesSlotsThatWereGivenBack) {
    Scattered scattered(7);
    for (NearPair& near : scattered.pairs.near)
        if (near.key % 3 == 0) give_slots(scattered.pairs, near);
    const auto before = scattered.records();
    for (int frame = 0; frame < 60; ++frame) order_slots(scattered.pairs);
    EXPECT_EQ(scattered.records(), before);
    scattered.expect_all_slots_once();
}

TEST(Pair, LeavesABlockWithoutItsForces) {
    Pair pair, swept;
    for (Pair* each : {&pair, &swept}) {
        for (ContactForce& force : each->force) force.normal = 500;
        each->torque.tangent1 = 1;
    }
    pair.in_block = true;
    for (Pair* each : {&pair, &swept}) leave_block(*each);
    EXPECT_FALSE(pair.in_block);
    EXPECT_EQ(pair.torque.tangent1, 0);
    EXPECT_EQ(swept.torque.tangent1, 1);
    for (const ContactForce& force : pair.force) EXPECT_EQ(force.normal, 0);
    for (const ContactForce& force : swept.force) EXPECT_EQ(force.normal, 500);
}

}  // namespace
}  // namespace taut::test
