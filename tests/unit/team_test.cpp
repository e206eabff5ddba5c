// Loops of a team run every index once, whoever helps: its own threads, a host's, or nobody.
#include "threads/team.h"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#if defined(__linux__)
#include <sched.h>
#endif

namespace {

using taut::RestAfter;
using taut::Team;

// That this thread may run on.
uint32_t cores() {
#if defined(__linux__)
    cpu_set_t all;
    if (sched_getaffinity(0, sizeof all, &all) == 0) return static_cast<uint32_t>(CPU_COUNT(&all));
#endif
    return std::thread::hardware_concurrency();
}

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

// Runs of a length, each once, whoever has which: all parts, one alone, one that is not there.
TEST(Team, RunsEveryRunOnce) {
    for (uint32_t threads : {1u, 2u, 3u, 8u}) {
        Team team({}, threads);
        const RestAfter rest(team);
        std::vector<uint32_t> hits(200000);
        for (uint32_t count : {0u, 1u, 63u, 128u, 1000u, 200000u})
            for (uint32_t home : {0u, 1u, 2u, 13u}) {
                const uint32_t together = 1 + home;
                std::fill(hits.begin(), hits.end(), 0);
                const auto home_of = [&](uint32_t begin) { return home == 0 ? begin / 7 : home; };
                const auto hit = [&](uint32_t begin, uint32_t end) {
                    EXPECT_EQ(begin % 64, 0u);
                    for (uint32_t i = begin; i < end; ++i) ++hits[i];
                };
                team.for_runs(count, 64, together, home_of, [&](const Team::Runs& runs) {
                    EXPECT_LE(runs.which.size(), together);
                    runs.for_each(hit);
                });
                for (uint32_t i = 0; i < hits.size(); ++i)
                    ASSERT_EQ(hits[i], i < count ? 1u : 0u) << "index " << i << " of " << count << ", home " << home;
            }
    }
}

// Two threads each begin with what is their own, and wait there for the other.
TEST(Team, RunsBeginAtTheirHomes) {
    if (cores() < 2) GTEST_SKIP() << "nobody helps on one core";
    constexpr uint32_t kRuns = 20;
    Team team({}, 2);
    const RestAfter rest(team);
    const std::thread::id caller = std::this_thread::get_id();
    const auto home_of = [](uint32_t begin) { return begin / 64 % 3 == 0 ? 1u : 0u; };
    std::atomic<uint32_t> ran{0};
    std::vector<uint32_t> homes[2];  // of what a thread ran
    team.for_runs(kRuns * 64, 64, 1, home_of, [&](const Team::Runs& runs) {
        runs.for_each([&](uint32_t begin, uint32_t) {
            homes[std::this_thread::get_id() == caller ? 0 : 1].push_back(home_of(begin));
            ++ran;
        });
        while (ran < 2) std::this_thread::yield();
    });
    EXPECT_EQ(ran, kRuns);
    EXPECT_EQ(homes[0].size() + homes[1].size(), kRuns);
    for (uint32_t part : {0u, 1u}) {
        ASSERT_FALSE(homes[part].empty());
        EXPECT_EQ(homes[part].front(), part);
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

// after[stage] up to that many stages back, and never falling.
std::vector<uint32_t> orders(uint32_t stages, uint32_t back) {
    std::vector<uint32_t> after;
    for (uint32_t i = 0; i < stages; ++i) {
        const uint32_t least = after.empty() ? 0 : after.back(), late = i * 7919u % (back + 1);
        after.push_back(std::max(least, i - std::min(i, late)));
    }
    return after;
}

// Each stage of each part runs once, after the part's own ones before and as many of all parts as it asks for, whose
// writes it sees.
TEST(Team, PartsKeepTheirOrder) {
    for (uint32_t threads : {1u, 2u, 3u, 8u}) {
        Team team({}, threads);
        for (int call = 0; call < 40; ++call) {
            const RestAfter rest(team);
            const std::vector<uint32_t> after = orders(Team::kMaxStages, static_cast<uint32_t>(call) % 5);
            std::vector<uint32_t> hits(after.size() * threads), early(threads), out_of_turn(threads);
            team.for_parts(after, [&](uint32_t stage, uint32_t part) {
                for (uint32_t k = 0; k < threads; ++k)
                    if (after[stage] > 0 && hits[(after[stage] - 1) * threads + k] != 1) ++early[part];
                if (stage > 0 && hits[(stage - 1) * threads + part] != 1) ++out_of_turn[part];
                ++hits[stage * threads + part];
            });
            for (uint32_t count : hits) ASSERT_EQ(count, 1u) << threads << " threads, call " << call;
            for (uint32_t k = 0; k < threads; ++k) {
                ASSERT_EQ(early[k], 0u) << "part " << k << " of " << threads << ", call " << call;
                ASSERT_EQ(out_of_turn[k], 0u) << "part " << k << " of " << threads << ", call " << call;
            }
        }
    }
}

// Parts that need not wait for each other run on; those that must, do.
TEST(Team, PartsRunAheadAsFarAsTheyMay) {
    if (cores() < 2) GTEST_SKIP() << "nobody helps on one core";
    Team team({}, 2);
    const RestAfter rest(team);
    const std::vector<uint32_t> after = {0, 0, 0, 3};
    std::atomic<uint32_t> begun{0};
    bool together = false;
    for (int i = 0; i < 10000 && !together; ++i) {
        std::atomic<bool> waits{false}, ahead{false};
        begun = 0;
        team.for_parts(after, [&](uint32_t stage, uint32_t part) {
            ++begun;
            if (stage == 2 && part == 0 && waits) ahead = true;
            if (stage > 0 || part == 0) return;
            waits = true;  // in its first stage, until the other part is through its third or a while is over
            for (int look = 0; look < 100000 && !ahead; ++look) std::atomic_signal_fence(std::memory_order_seq_cst);
            waits = false;
        });
        together = ahead;
        ASSERT_EQ(begun, 8u);
    }
    EXPECT_TRUE(together);
}

TEST(Team, OthersHelp) {
    if (cores() < 2) GTEST_SKIP() << "nobody helps on one core";
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

// A host that throws as it is asked for help is asked again in the next step, and has no task to finish.
TEST(Team, AHostThatThrowsHasNothingToFinish) {
    Host host{Host::at_once};
    taut_hooks hooks = host.hooks(3);
    hooks.enqueue_task = [](taut_task_fn, uint32_t, uint32_t, void*, void* self) -> void* {
        Host& of = *static_cast<Host*>(self);
        if (of.enqueued++ % 2 == 1) throw std::runtime_error("no worker");
        return self;
    };
    Team team(hooks, 4);
    expect_every_index_once(team, 6);
    EXPECT_EQ(host.enqueued, 6);
    EXPECT_EQ(host.finished, 3);
}

#if defined(__linux__)
// Threads beyond the cores that the caller may run on stay asleep.
TEST(Team, WakesNoMoreThreadsThanItHasCoresFor) {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    for (uint32_t threads : {2u, 3u, 16u, 64u}) {
        Team team({}, threads);
        expect_every_index_once(team, 2);
        EXPECT_EQ(team.woken(), std::min(threads, cores()) - 1);
    }
    CPU_ZERO(&one);
    CPU_SET(static_cast<size_t>(sched_getcpu()), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    {
        Team team({}, 8);
        expect_every_index_once(team, 2);
        EXPECT_EQ(team.woken(), 0u);
        ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
        expect_every_index_once(team, 2);
        EXPECT_EQ(team.woken(), std::min(8u, cores()) - 1);
    }
}
#endif

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
