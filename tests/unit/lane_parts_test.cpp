// Which pairs stand side by side in lanes, and which thread has them.
#include "system/lane_parts.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "integrate/integrate.h"
#include "system/reached.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

// Bodies on a line, made in the order of chance, each in touch with those near it by one to four points; on so many
// threads.
class LaneParts : public testing::TestWithParam<uint32_t>, protected Graph {
protected:
    LaneParts() : threads_(taut_hooks{}, GetParam()), system_(memory) {
        std::mt19937 engine(GetParam());
        std::vector<uint32_t> at(kCount);
        for (uint32_t& node : at) node = add(NodeKind::dynamic);
        std::shuffle(at.begin(), at.end(), engine);
        const uint32_t ground = add(NodeKind::fixed);
        for (uint32_t i = 0; i < kCount; ++i) {
            nodes.motion[at[i]].x = Vec3(0, 0, i);
            touch(ground, at[i]);
            for (uint32_t k = 1; k <= kNear && i + k < kCount; ++k) touch(at[i], at[i + k]);
        }
        rules.by_place = GetParam() > 1;
        find_active();
        for (ActivePair& pair : pairs.active) pair.points = 1 + engine() % 4;
        partition.build(threads_, nodes, joints, elements, pairs, rules);
        list_reached(nodes, joints, pairs, partition.held(), system_.reached);
        begin_frame(threads_, system_, partition, nodes, true);
        share_out(threads_, system_, pairs, partition.groups[0]);
    }
    const ContactLanes& lanes() const { return system_.contacts; }
    bool moves(uint32_t seat) const { return system_.sweep[seat].mass.inv_mass > 0; }
    std::set<uint32_t> moving_seats(const LaneGroup& g) const {
        std::set<uint32_t> seats;
        for (int lane = 0; lane < kLanes; ++lane)
            for (const uint32_t seat : {g.a[lane], g.b[lane]})
                if (moves(seat) && !seats.insert(seat).second) ADD_FAILURE() << "two pairs of a lane group meet";
        return seats;
    }
    // act(part's number, group)
    template <class Act>
    void for_groups(Act&& act) const {
        for (uint32_t i = 0; i < lanes().part.size(); ++i)
            for (uint32_t g = lanes().part[i].begin; g < lanes().part[i].end; ++g)
                act(i % lanes().parts, lanes().group[g]);
    }

    static constexpr uint32_t kCount = 4000, kNear = 4;
    Team threads_;
    System system_;
};
INSTANTIATE_TEST_SUITE_P(Threads, LaneParts, testing::Values(1u, 2u, 3u, 5u));

TEST_P(LaneParts, HaveEachPairOnceAndNoNodeTwice) {
    std::map<uint32_t, int> times;
    for_groups([&](uint32_t, const LaneGroup& g) {
        moving_seats(g);
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.pair[lane] == kNone) continue;
            ++times[g.pair[lane]];
            const ActivePair& pair = pairs.active[g.pair[lane]];  // in the same order here
            EXPECT_EQ(g.a[lane], system_.at(pair.a));
            EXPECT_EQ(g.b[lane], system_.at(pair.b));
            EXPECT_LE(pair.points, g.points);
        }
    });
    EXPECT_EQ(times.size(), pairs.active.size());
    for (const auto& [pair, count] : times) EXPECT_EQ(count, 1) << pair;
}

// Of a run of near pairs the part that sweeps most is home.
TEST_P(LaneParts, VoteForTheHomesOfTheirPairs) {
    const auto count = static_cast<uint32_t>(pairs.active.size());
    for (uint32_t i = 0; i < count; ++i) pairs.active[i].near = i;
    pairs.homes.settle(threads_.size(), count);
    share_out(threads_, system_, pairs, partition.groups[0]);
    std::map<uint32_t, std::map<uint32_t, uint32_t>> swept;  // how many of a run by which part
    for_groups([&](uint32_t part, const LaneGroup& g) {
        for (int lane = 0; lane < kLanes; ++lane)
            if (g.pair[lane] != kNone) ++swept[g.pair[lane] / Homes::kRun][part];
    });
    pairs.homes.settle(threads_.size(), count);
    for (auto& [run, by] : swept) {
        const uint32_t home = pairs.homes(run * Homes::kRun);
        for (const auto& [part, number] : by) EXPECT_LE(number, by[home]) << "run " << run << ", part " << part;
    }
}

// What other parts meet comes first, and is little; the rest lies together in memory.
TEST_P(LaneParts, MeetAtTheirBordersAlone) {
    std::map<uint32_t, std::set<uint32_t>> parts_of;  // by seat
    for_groups([&](uint32_t part, const LaneGroup& g) {
        for (const uint32_t seat : moving_seats(g)) parts_of[seat].insert(part);
    });
    size_t borders = 0, groups = 0;
    for (const LanePart& part : lanes().part) {
        for (uint32_t g = part.begin; g < part.end; ++g) {
            bool meets = false;
            for (const uint32_t seat : moving_seats(lanes().group[g])) meets = meets || parts_of[seat].size() > 1;
            EXPECT_EQ(meets, g < part.inner);
            borders += meets;
            ++groups;
        }
    }
    EXPECT_LE(borders, groups / 4);
    std::vector<double> share(lanes().parts);
    for_groups([&](uint32_t part, const LaneGroup&) { share[part] += 1.0 / static_cast<double>(groups); });
    for (const double of_part : share) EXPECT_NEAR(of_part * lanes().parts, 1, 0.25);
    size_t strangers = 0;
    uint32_t before = 0;
    for (const auto& [seat, parts] : parts_of) {  // ascending
        if (parts.size() > 1) continue;
        strangers += *parts.begin() < before;
        before = std::max(before, *parts.begin());
    }
    EXPECT_LE(strangers, kCount / 50);
}

}  // namespace
}  // namespace taut::test
