// Long links of grids and of irregular meshes, against shortest ways along the links.
#include "models/long_links.h"

#include <gtest/gtest.h>

#include <map>
#include <queue>
#include <random>
#include <vector>

namespace taut::test {
namespace {

struct Net {
    // n x n vertices a unit apart, each moved by up to `off`; links along rows and columns.
    Net(uint32_t n, double off, uint32_t seed) {
        std::mt19937 engine(seed);
        std::uniform_real_distribution<double> away(-off, off);
        for (uint32_t i = 0; i < n; ++i)
            for (uint32_t k = 0; k < n; ++k) {
                rest.push_back({i + away(engine), away(engine), k + away(engine)});
                if (i > 0) links.push_back({(i - 1) * n + k, i * n + k});
                if (k > 0) links.push_back({i * n + k - 1, i * n + k});
            }
    }
    std::vector<LongLink> find() const {
        Memory memory{taut_hooks{}};
        Array<LongLink> out(memory);
        find_long_links(rest, links, 15, out);
        return {out.begin(), out.end()};
    }
    // Dijkstra's.
    double shortest(uint32_t from, uint32_t to) const {
        std::vector<double> distance(rest.size(), 1e30);
        std::vector<std::vector<uint32_t>> beside(rest.size());
        for (const ThreadLink& l : links) beside[l.a].push_back(l.b), beside[l.b].push_back(l.a);
        using Entry = std::pair<double, uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        queue.push({distance[from] = 0, from});
        while (!queue.empty()) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (v == to) return d;
            if (d > distance[v]) continue;
            for (const uint32_t w : beside[v])
                if (const double way = d + (rest[w] - rest[v]).norm(); way < distance[w])
                    queue.push({distance[w] = way, w});
        }
        return 1e30;
    }

    std::vector<Vec3> rest;
    std::vector<ThreadLink> links;
};

TEST(LongLinks, OfAGridAreEveryOtherVertexOfEveryOtherThread) {
    std::map<uint32_t, std::vector<LongLink>> levels;
    const Net net(17, 0, 1);
    uint32_t last = UINT32_MAX;
    for (const LongLink& link : net.find()) {
        levels[link.level].push_back(link);
        EXPECT_LE(link.level, last) << "the longest come first";
        last = link.level;
    }
    ASSERT_EQ(levels.size(), 4u);
    for (const auto& [level, links] : levels) {
        const uint32_t step = 1u << level, threads = 16 / step + 1;
        EXPECT_EQ(links.size(), 2 * threads * (threads - 1)) << level;
        for (const LongLink& link : links) {
            EXPECT_EQ(link.links, step);
            EXPECT_DOUBLE_EQ(link.length, step);
            const Vec3 along = net.rest[link.b] - net.rest[link.a];
            EXPECT_DOUBLE_EQ(along.norm(), step);
            for (const uint32_t end : {link.a, link.b})
                EXPECT_TRUE(end % 17 % step == 0 && end / 17 % step == 0) << end;
        }
    }
}

// What they never let through, the links do not either.
TEST(LongLinks, AreNoShorterThanTheWayAlongTheLinks) {
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        const Net net(14, 0.2, seed);
        const std::vector<LongLink> found = net.find();
        EXPECT_GT(found.size(), net.links.size() / 4);
        for (const LongLink& link : found) {
            EXPECT_GE(link.length, net.shortest(link.a, link.b) - 1e-12);
            EXPECT_LE(link.length, 1.5 * (net.rest[link.a] - net.rest[link.b]).norm()) << "they go straight on";
            EXPECT_GT(link.links, 1u);
        }
    }
}

TEST(LongLinks, OfOneLinkOrARingAreFewOrNone) {
    Memory memory{taut_hooks{}};
    Array<LongLink> out(memory);
    const Vec3 two[] = {{0, 0, 0}, {1, 0, 0}};
    const ThreadLink one[] = {{0, 1}};
    find_long_links(two, one, 15, out);
    EXPECT_TRUE(out.empty());

    std::vector<Vec3> ring;
    std::vector<ThreadLink> round;
    for (uint32_t i = 0; i < 12; ++i) {
        ring.push_back({std::cos(i * 0.5235987755982988), std::sin(i * 0.5235987755982988), 0});
        round.push_back({i, (i + 1) % 12});
    }
    find_long_links(ring, round, 15, out);
    for (const LongLink& link : out) EXPECT_LE((ring[link.a] - ring[link.b]).norm(), link.length + 1e-12);
}

}  // namespace
}  // namespace taut::test
