// Incidence and colours of nodes against searches through all elements, on random ones.
#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

#include "partition/incidence.h"
#include "state/nodes.h"

namespace taut::test {
namespace {

TEST(Incidence, NamesEachEndOnceAndColoursApart) {
    std::mt19937 random(7);
    Memory memory{taut_hooks{}};
    Incidence incidence(memory);  // kept: what an earlier graph left must not show
    for (int round = 0; round < 200; ++round) {
        const uint32_t slots = 1 + random() % 60, count = random() % 80;
        std::vector<uint32_t> begin{0}, nodes;
        for (uint32_t e = 0; e < count; ++e) {
            std::set<uint32_t> own;
            for (uint32_t n = 1 + random() % 8; n > 0; --n) own.insert(random() % slots);
            for (const uint32_t node : own) nodes.push_back(random() % 6 == 0 ? kNone : node);
            begin.push_back(static_cast<uint32_t>(nodes.size()));
        }
        std::vector<uint32_t> all(slots);
        std::iota(all.begin(), all.end(), 0u);
        incidence.build(all, begin, nodes);
        std::vector<uint32_t> colour(slots, kNone);
        for (uint32_t c = 0; c < incidence.colours(); ++c) {
            EXPECT_FALSE(incidence.nodes_of(c).empty());
            EXPECT_TRUE(std::ranges::is_sorted(incidence.nodes_of(c)));
            for (const uint32_t node : incidence.nodes_of(c)) {
                EXPECT_EQ(colour[node], kNone);
                colour[node] = c;
            }
        }
        for (uint32_t node = 0; node < slots; ++node) {
            std::vector<Incidence::End> ends;
            for (uint32_t e = 0; e < count; ++e)
                for (uint32_t i = begin[e]; i < begin[e + 1]; ++i)
                    if (nodes[i] == node) ends.push_back({e, i - begin[e]});
            ASSERT_TRUE(std::ranges::equal(incidence.of(node), ends));
            EXPECT_EQ(colour[node] == kNone, ends.empty());
            for (const auto& [e, at] : ends)
                for (uint32_t i = begin[e]; i < begin[e + 1]; ++i)
                    if (nodes[i] != node && nodes[i] != kNone) { EXPECT_NE(colour[nodes[i]], colour[node]); }
        }
    }
}

}  // namespace
}  // namespace taut::test
