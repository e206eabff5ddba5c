// A team of threads for the loops inside a step: the calling thread and helpers, the world's own or the host's, that
// join while a step runs and sleep between steps.
//
// The calling thread hands out loops as chunks and works on them itself; whoever else is there takes chunks too. Each
// thread begins with chunks of its own part of a loop, the same part in each loop as long, so that what it wrote is
// still in its cache, and then helps the others. The caller never waits for a helper that has not taken a chunk, so a
// host whose workers are busy only makes the step slower. What a loop computes may not depend on who runs which chunk:
// results follow the scene, not the team.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <thread>
#include <type_traits>
#include <vector>

#include <taut/base.h>

namespace taut {

class Team {
public:
    // threads: of the whole team. Without task hooks it owns threads - 1 of its own. Throws std::system_error.
    Team(const taut_hooks& hooks, uint32_t threads);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    uint32_t size() const { return size_; }

    // run(begin, end) over ranges that cover [0, count), about grain long each, in any order and at once. Returns when
    // all have run. run may neither throw nor allocate from the world; a range of the caller alone is [0, count).
    template <class Run>
    void for_ranges(uint32_t count, uint32_t grain, Run&& run) {
        if (size_ == 1 || count < 2 * grain) {
            if (count > 0) run(0u, count);
            return;
        }
        const Stage stage{count, grain};
        for_stages({&stage, 1}, [&](uint32_t, uint32_t begin, uint32_t end) { run(begin, end); });
    }

    struct Stage {
        uint32_t count, grain;
    };
    static constexpr uint32_t kMaxStages = 512;

    // Loops one after the other: run(stage, begin, end) over ranges of [0, count) of each stage, which begins when the
    // one before is over. As for_ranges(), but the helpers go from stage to stage by themselves, some tenths of a
    // microsecond each. At most kMaxStages.
    template <class Run>
    void for_stages(std::span<const Stage> stages, Run&& run) {
        if (size_ == 1) {
            for (uint32_t i = 0; i < stages.size(); ++i)
                if (stages[i].count > 0) run(i, 0u, stages[i].count);
            return;
        }
        using Held = std::remove_reference_t<Run>;
        hand_out(
            stages,
            [](const void* context, uint32_t stage, uint32_t begin, uint32_t end) noexcept {
                (*const_cast<Held*>(static_cast<const Held*>(context)))(stage, begin, end);
            },
            std::addressof(run));
    }

    // Lets the helpers go; the next loop calls them again. At the end of a step.
    void rest();

private:
    using RangeFn = void (*)(const void* context, uint32_t stage, uint32_t begin, uint32_t end) noexcept;
    struct Chunks;

    void hand_out(std::span<const Stage> stages, RangeFn run, const void* context);
    void work(uint64_t program, uint32_t worker);
    uint64_t finished() const;
    bool claim(uint32_t part, const Chunks& chunks, uint64_t loop, uint32_t& chunk);
    void call_helpers();
    void keep_off_caller();
    void help(uint32_t call, uint32_t worker);
    void live(uint32_t worker);
    static void help_as_task(uint32_t begin, uint32_t end, uint32_t worker, void* team);

    taut_hooks hooks_;
    uint32_t size_;
    std::vector<std::thread> own_;
    void* token_ = nullptr;  // of the host's task
    bool called_ = false;    // helpers are there, or on their way
    std::thread::id caller_;
    int caller_core_ = -1;  // where the own threads do not run
    uint64_t next_loop_ = 1;

    // The program that is out: the number of its first loop, a stage being a loop; kNone while the rest is written. A
    // helper that comes late may read a mixture of two programs, but then the number has changed, at which it looks
    // before it claims anything: stores release and loads acquire for that.
    static constexpr uint64_t kNone = 0;
    static constexpr uint32_t kChunkBits = 20;
    alignas(64) std::atomic<uint64_t> program_{kNone};  // alone: helpers look at it all the time
    alignas(64) std::atomic<RangeFn> run_{nullptr};
    std::atomic<const void*> context_{nullptr};
    std::atomic<uint32_t> stage_count_{0};
    std::vector<std::atomic<uint64_t>> stage_;  // count << 32 | grain
    std::atomic<uint64_t> before_{0};           // chunks of all programs before
    struct alignas(64) Part {
        std::atomic<uint64_t> cursor{0};  // loop << kChunkBits | its next chunk; of an earlier loop: none is taken yet
        // What the worker alone writes: a count that all add to would travel to each of them at each stage.
        alignas(64) std::atomic<uint64_t> finished{0};  // chunks, of all programs
        std::atomic<uint64_t> joined{0};                // the last program that it came to
    };
    std::vector<Part> part_;  // by worker

    // Odd: helpers are wanted; even: they sleep. kQuit: they end.
    static constexpr uint32_t kQuit = UINT32_MAX;
    alignas(64) std::atomic<uint32_t> call_{0};
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
