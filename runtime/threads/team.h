// A team of threads for the loops inside a step: the calling thread and helpers, the world's own or the host's, that
// join while a step runs and sleep between steps. Of the own threads as many are woken as there are cores for them:
// more would take turns on these, and every stage would wait for who is off its core. The parts of those that sleep are
// dealt to the others.
//
// The calling thread hands out a loop in parts, one for each thread, and these in stages; whoever is there takes one
// stage after the other. Each thread begins with its own part, the same in each loop as long, so that what it wrote is
// still in its cache, and then helps the others. The caller never waits for a helper that is not at work on a stage, so
// a host whose workers are busy only makes the step slower. What a loop computes may not depend on who runs what:
// results follow the scene, not the team.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <type_traits>
#include <vector>

#include <taut/base.h>

#include "base/profile_scopes.h"

namespace taut {

// Where a part of [0, count) begins, of so many that are as long but for one.
constexpr uint32_t begin_of_part(uint32_t part, uint32_t parts, uint32_t count) {
    return static_cast<uint32_t>(uint64_t{part} * count / parts);
}

class Team {
public:
    // threads: of the whole team. Without task hooks it owns threads - 1 of its own. Throws std::system_error.
    Team(const taut_hooks& hooks, uint32_t threads);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    uint32_t size() const { return size_; }
    // Own threads that the last call for help woke: no more than cores beside the caller's are free to them.
    uint32_t woken() const { return woken_; }

    // run(begin, end) over ranges that cover [0, count), about grain long each, in any order and at once. Returns when
    // all have run. run may neither throw nor allocate from the world; a range of the caller alone is [0, count).
    template <class Run>
    void for_ranges(uint32_t count, uint32_t grain, Run&& run) {
        if (size_ == 1 || count < 2 * grain) {
            if (count > 0) run(0u, count);
            return;
        }
        const Chunks chunks(count, grain, size_);
        const auto chunk = [&](uint32_t stage, uint32_t part) {
            const uint32_t i = part * chunks.stages + stage;
            if (i < chunks.number) run(chunks.begin(i), chunks.begin(i + 1));
        };
        hand_out(chunks.stages, {}, chunk);
    }

    // Some runs of a loop: [k length, (k + 1) length) below count for each k.
    struct Runs {
        std::span<const uint32_t> which;
        uint32_t length, count;

        template <class Act>  // act(begin, end)
        void for_each(Act&& act) const {
            for (const uint32_t k : which) act(k * length, std::min((k + 1) * length, count));
        }
    };
    // act(Runs) over [0, count) in runs of a length, each of the part home(its begin), at most so many together; in all
    // else as for_ranges(). The caller alone takes all as one run.
    template <class Home, class Act>
    void for_runs(uint32_t count, uint32_t length, uint32_t together, Home&& home, Act&& act) {
        if (size_ == 1 || count < 2 * length) {
            constexpr uint32_t kFirst[] = {0};
            if (count > 0) act(Runs{kFirst, count, count});
            return;
        }
        length *= count / (kMostRuns * length) + 1;
        const uint32_t number = (count + length - 1) / length;
        const uint32_t most = share_runs(number, [&](uint32_t k) { return home(k * length) % size_; });
        constexpr uint32_t kLeast = 4;  // stages of a part that has as much as others: for these to help with
        together = std::clamp(number / (kLeast * size_), 1u, together);
        const auto some = [&](uint32_t stage, uint32_t part) {
            const uint32_t end = first_run_[part + 1], from = std::min(first_run_[part] + stage * together, end);
            if (from == end) return;
            act(Runs{std::span(run_at_).subspan(from, std::min(together, end - from)), length, count});
        };
        hand_out((most + together - 1) / together, {}, some);
    }

    // run(stage, part) for each of size() parts, whose stages go one after the other. A stage begins when all parts
    // have done the first after[stage] stages, at most as many as come before it; after may not fall. In all else as
    // for_ranges(), but threads go from stage to stage by themselves, some tenths of a microsecond each.
    template <class Run>
    void for_parts(std::span<const uint32_t> after, Run&& run) {
        if (size_ == 1) {
            for (uint32_t stage = 0; stage < after.size(); ++stage) run(stage, 0u);
            return;
        }
        hand_out(static_cast<uint32_t>(after.size()), after, run);
    }
    static constexpr uint32_t kMaxStages = 1024;  // of parts that go by after

    // Lets the helpers go; the next loop calls them again. At the end of a step. Waits for those that are in a scope.
    void rest();

    // Whom helpers tell of their parts of loops; null: nobody. Between steps.
    void tell_scopes(const ProfileScopes* scopes) { scopes_.store(scopes, std::memory_order_relaxed); }

private:
    using StageFn = void (*)(const void* context, uint32_t stage, uint32_t part) noexcept;

    // How a loop is cut: into chunks that are as long but for one, as many for each thread where there are enough.
    struct Chunks {
        uint32_t count, number, stages;

        Chunks(uint32_t length, uint32_t least, uint32_t parts) : count(length) {
            constexpr uint32_t kMost = 1u << (kStageBits - 1);
            const uint32_t grain = std::max(least, count / kMost + 1);
            number = count / grain + (count % grain != 0);
            if (number > parts) number -= number % parts;
            stages = (number + parts - 1) / parts;
        }
        uint32_t begin(uint32_t chunk) const { return begin_of_part(chunk, number, count); }
    };

    // Lists the runs of each part; how many the one with the most has.
    template <class HomeOf>
    uint32_t share_runs(uint32_t number, HomeOf&& home_of) {
        std::ranges::fill(first_run_, 0);
        for (uint32_t i = 0; i < number; ++i) ++first_run_[home_of(i) + 2];
        const uint32_t most = std::ranges::max(first_run_);
        for (uint32_t part = 0; part < size_; ++part) first_run_[part + 2] += first_run_[part + 1];
        for (uint32_t i = 0; i < number; ++i) run_at_[first_run_[home_of(i) + 1]++] = i;
        return most;
    }

    // A loop as a worker sees it.
    struct Job {
        uint64_t number;
        uint64_t before;  // stages of each share in all jobs before
        uint32_t stages;  // of each share
        uint32_t shares;  // into which the parts are dealt
        bool ordered;     // by after_
        StageFn run;
        const void* context;
        uint32_t known = 0;  // stages that all shares have done, as far as the worker saw
    };

    template <class Run>
    void hand_out(uint32_t stages, std::span<const uint32_t> after, Run& run) {
        hand_out(
            stages, after,
            [](const void* context, uint32_t stage, uint32_t part) noexcept {
                (*const_cast<Run*>(static_cast<const Run*>(context)))(stage, part);
            },
            std::addressof(run));
    }
    void hand_out(uint32_t stages, std::span<const uint32_t> after, StageFn run, const void* context);
    void work(Job job, uint32_t worker);
    bool advance(Job& job, uint32_t share);
    bool take(Job& job, uint32_t share, uint32_t& stage);
    void run_share(const Job& job, uint32_t stage, uint32_t share) const;
    bool help_others(Job& job, uint32_t worker, bool patient);
    bool all_did(Job& job, uint32_t stages) const;
    bool is_out(const Job& job) const { return job_.load(std::memory_order_acquire) == job.number; }
    Job job_out(uint64_t number) const;
    void call_helpers();
    uint32_t keep_off_caller();
    void enqueue();
    void deal(uint32_t shares);
    void wake(uint32_t helpers, uint32_t call);
    void quit();
    void help(uint32_t call, uint32_t worker);
    void work_in_scope(const ProfileScopes& scopes, const Job& job, uint32_t call, uint32_t worker);
    void live(uint32_t worker);
    static void help_as_task(uint32_t begin, uint32_t end, uint32_t worker, void* team);

    static constexpr uint32_t kMostRuns = 1024;

    taut_hooks hooks_;
    uint32_t size_;
    std::vector<uint32_t> run_at_, first_run_;  // of the loop that is out: runs by part, and where each begins
    std::vector<std::thread> own_;
    void* token_ = nullptr;  // of the host's task
    bool called_ = false;    // helpers are there, or on their way
    bool enqueued_ = false;  // the host has a task to finish
    std::thread::id caller_;
    int caller_core_ = -1;     // where the own threads do not run
    uint32_t free_cores_ = 0;  // that the own threads may run on
    uint32_t woken_ = 0;
    uint32_t shares_ = 0;  // of the parts: one for each thread that is there, which takes every so manieth part
    uint64_t last_job_ = 0;
    uint64_t done_ = 0;  // stages of each part in all jobs so far
    std::atomic<const ProfileScopes*> scopes_{nullptr};
    std::atomic<uint32_t> in_scope_{0};  // helpers

    // The number of the job that is out; kNone while the rest is written. A helper that comes late may read a mixture
    // of two jobs, but then the number has changed, at which it looks before it takes a stage: stores release and loads
    // acquire for that.
    static constexpr uint64_t kNone = 0;
    static constexpr uint32_t kStageBits = 20;
    alignas(64) std::atomic<uint64_t> job_{kNone};  // alone: helpers look at it all the time
    alignas(64) std::atomic<StageFn> run_{nullptr};
    std::atomic<const void*> context_{nullptr};
    std::atomic<uint64_t> before_{0};
    std::atomic<uint32_t> stages_{0};
    std::atomic<uint32_t> dealt_{0};  // Job::shares
    std::atomic<bool> ordered_{false};
    std::vector<std::atomic<uint32_t>> after_;
    struct alignas(64) Share {
        std::atomic<uint64_t> taken{0};  // job << kStageBits | its stages that were begun; of an earlier job: none yet
        // What others look at: stages done in all jobs, and the last job that the share's own worker came to.
        alignas(64) std::atomic<uint64_t> done{0};
        std::atomic<uint64_t> joined{0};
    };
    std::vector<Share> share_;  // by worker

    // Odd: helpers are wanted; even: they sleep.
    alignas(64) std::atomic<uint32_t> call_{0};
    // The last call that an own thread was woken for. kQuit: it ends.
    static constexpr uint32_t kQuit = UINT32_MAX;
    class alignas(64) Wake {
    public:
        void set(uint32_t call);
        uint32_t other_than(uint32_t last);  // sleeps until there is one

    private:
        std::atomic<uint32_t> call_{0};
#if !defined(__linux__)
        std::mutex mutex_;
        std::condition_variable changed_;
#endif
    };
    std::vector<Wake> wake_;  // by worker
};

// Lets a team rest at the end of a scope, however that is left.
class RestAfter {
public:
    explicit RestAfter(Team& team) : team_(team) {}
    ~RestAfter() { team_.rest(); }
    RestAfter(const RestAfter&) = delete;
    RestAfter& operator=(const RestAfter&) = delete;

private:
    Team& team_;
};

}  // namespace taut
