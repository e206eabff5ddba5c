// Loops of a team run every index once, whoever helps: its own threads, a host's, or nobody.
#include "threads/team.h"

#include <gtest/gtest.h>

#include <functional>

namespace {

using taut::RestAfter;
using taut::Team;

// Loops of many lengths, several a call for help, as a step has them.
void expect_every_index_once(Team& team, int calls) {
    std::vector<uint32_t> hits(5000);
    for (int call = 0; call < calls; ++call) {
        const RestAfter rest(team);
        for (uint32_t count : {0u, 1u, 7u, 64u, 1000u, 5000u}) {
            for (uint32_t grain : {1u, 16u, 300u}) {
                std::fill(hits.begin(), hits.end(), 0);
                team.for_ranges(count, grain, [&](uint32_t begin, uint32_t end) {
                    for (uint32_t i = begin; i < end; ++i) ++hits[i];
                });
                for (uint32_t i = 0; i < hits.size(); ++i)
                    ASSERT_EQ(hits[i], i < count ? 1u : 0u) << "index " << i << " of " << count << ", grain " << grain;
            }
        }
    }
}

TEST(Team, OwnThreadsRunEveryIndexOnce) {
    for (uint32_t threads : {1u, 2u, 3u, 5u, 8u}) {
        Team team({}, threads);
        EXPECT_EQ(team.size(), threads);
        expect_every_index_once(team, 20);
    }
}

// Chunks that differ by one at most, as many for each thread.
TEST(Team, CutsLoopsEvenly) {
    for (uint32_t threads : {2u, 3u, 5u}) {
        Team team({}, threads);
        const RestAfter rest(team);
        for (uint32_t count : {64u, 65u, 333u, 1000u}) {
            std::vector<std::atomic<uint32_t>> length(count);  // by where a chunk begins
            team.for_ranges(count, 16, [&](uint32_t begin, uint32_t end) { length[begin] = end - begin; });
            uint32_t chunks = 0, least = count, most = 0;
            for (const auto& each : length) {
                if (each == 0) continue;
                ++chunks;
                least = std::min(least, each.load());
                most = std::max(most, each.load());
            }
            EXPECT_LE(most - least, 1u) << count << " on " << threads;
            if (chunks >= threads) {
                EXPECT_EQ(chunks % threads, 0u) << count << " on " << threads;
            }
        }
    }
}

// Each loop reads what the one before it wrote, on whatever thread that was.
TEST(Team, LoopsSeeTheOnesBeforeThem) {
    Team team({}, 4);
    const RestAfter rest(team);
    std::vector<uint64_t> a(512, 1), b(512, 1);
    for (int i = 0; i < 2000; ++i) {
        team.for_ranges(512, 8, [&](uint32_t begin, uint32_t end) {
            for (uint32_t k = begin; k < end; ++k) b[k] = a[511 - k] + 1;
        });
        a.swap(b);
    }
    for (uint64_t value : a) ASSERT_EQ(value, 2001u);
}

// Stages of many lengths, empty ones among them; each index of a stage needs what the stage before wrote everywhere.
TEST(Team, StagesRunOneAfterTheOther) {
    for (uint32_t threads : {1u, 2u, 3u, 8u}) {
        Team team({}, threads);
        for (int call = 0; call < 40; ++call) {
            const RestAfter rest(team);
            std::vector<Team::Stage> stages;
            for (uint32_t i = 0; i < Team::kMaxStages; ++i) stages.push_back({(i * 7919u + 13) % 97, 1 + i % 9});
            std::vector<std::atomic<uint32_t>> count(stages.size()), early(stages.size());
            team.for_stages(stages, [&](uint32_t stage, uint32_t begin, uint32_t end) {
                for (uint32_t before = 0; before < stage; ++before)
                    if (count[before].load(std::memory_order_relaxed) != stages[before].count) ++early[stage];
                count[stage].fetch_add(end - begin, std::memory_order_relaxed);
            });
            for (size_t i = 0; i < stages.size(); ++i) {
                ASSERT_EQ(count[i].load(), stages[i].count) << "stage " << i << ", " << threads << " threads";
                ASSERT_EQ(early[i].load(), 0u) << "stage " << i << ", " << threads << " threads";
            }
        }
    }
}

TEST(Team, OthersHelp) {
    Team team({}, 2);
    const RestAfter rest(team);
    std::atomic<bool> other{false};
    const auto caller = std::this_thread::get_id();
    for (int i = 0; i < 100000 && !other; ++i)
        team.for_ranges(64, 1, [&](uint32_t, uint32_t) {
            if (std::this_thread::get_id() != caller) other = true;
        });
    EXPECT_TRUE(other);
}

// A host's task system in three moods.
struct Host {
    enum Mood { at_once, never, on_threads } mood;
    std::vector<std::thread> threads{};
    int enqueued = 0, finished = 0;

    taut_hooks hooks(uint32_t workers) {
        taut_hooks out{};
        out.enqueue_task = [](taut_task_fn task, uint32_t count, uint32_t, void* data, void* self) -> void* {
            static_cast<Host*>(self)->enqueue(task, count, data);
            return self;
        };
        out.finish_task = [](void* token, void* self) {
            EXPECT_EQ(token, self);
            static_cast<Host*>(self)->finish();
        };
        out.task_user_data = this;
        out.worker_count = workers;
        return out;
    }
    void enqueue(taut_task_fn task, uint32_t count, void* data) {
        ++enqueued;
        late = [task, count, data] { task(0, count, 0, data); };
        if (mood == at_once) late();
        if (mood == on_threads)
            for (uint32_t i = 0; i < count; ++i) threads.emplace_back([=] { task(i, i + 1, i, data); });
    }
    void finish() {
        ++finished;
        if (mood == never) late();  // after the step: must return at once
        for (std::thread& thread : threads) thread.join();
        threads.clear();
    }
    std::function<void()> late{};
};

TEST(Team, AHostsWorkersRunEveryIndexOnce) {
    for (Host::Mood mood : {Host::at_once, Host::never, Host::on_threads}) {
        Host host{mood};
        Team team(host.hooks(3), 4);
        expect_every_index_once(team, 5);
        EXPECT_EQ(host.enqueued, 5);
        EXPECT_EQ(host.finished, 5);
    }
}

TEST(Team, SmallLoopsCallNobody) {
    Host host{Host::at_once};
    Team team(host.hooks(3), 4);
    const RestAfter rest(team);
    int ranges = 0;
    team.for_ranges(31, 16, [&](uint32_t begin, uint32_t end) {
        ++ranges;
        EXPECT_EQ(begin, 0u);
        EXPECT_EQ(end, 31u);
    });
    EXPECT_EQ(ranges, 1);
    EXPECT_EQ(host.enqueued, 0);
}

}  // namespace
