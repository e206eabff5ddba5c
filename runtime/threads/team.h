// A team of threads for the loops inside a step: the calling thread and helpers, the world's own or the host's, that
// join while a step runs and sleep between steps.
//
// The calling thread hands out a loop as chunks and works on them itself; whoever else is there takes chunks too. It
// never waits for a helper that has not taken one, so a host whose workers are busy only makes the step slower. What a
// loop computes may not depend on who runs which chunk: results follow the scene, not the team.
#pragma once

#include <atomic>
#include <memory>
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
        using Held = std::remove_reference_t<Run>;
        hand_out(
            count, grain,
            [](const void* context, uint32_t begin, uint32_t end) noexcept {
                (*const_cast<Held*>(static_cast<const Held*>(context)))(begin, end);
            },
            std::addressof(run));
    }

    // Lets the helpers go; the next loop calls them again. At the end of a step.
    void rest();

private:
    using RangeFn = void (*)(const void* context, uint32_t begin, uint32_t end) noexcept;

    void hand_out(uint32_t count, uint32_t grain, RangeFn run, const void* context);
    bool take_chunk();
    void call_helpers();
    void help(uint32_t call);
    void live();
    static void help_as_task(uint32_t begin, uint32_t end, uint32_t worker, void* team);

    taut_hooks hooks_;
    uint32_t size_;
    std::vector<std::thread> own_;
    void* token_ = nullptr;  // of the host's task
    bool called_ = false;    // helpers are there, or on their way
    std::thread::id caller_;

    // The loop that is out, written while no ticket is. A helper that comes late may read a mixture of two loops, but
    // then the ticket has changed and its claim fails: stores release and loads acquire for that.
    static constexpr uint64_t kNoTicket = UINT32_MAX;
    std::atomic<RangeFn> run_{nullptr};
    std::atomic<const void*> context_{nullptr};
    std::atomic<uint32_t> count_{0}, grain_{1}, chunks_{0};
    std::atomic<uint32_t> left_{0};            // chunks that have not finished
    std::atomic<uint64_t> ticket_{kNoTicket};  // loop number << 32 | next chunk

    // Odd: helpers are wanted; even: they sleep. kQuit: they end.
    static constexpr uint32_t kQuit = UINT32_MAX;
    std::atomic<uint32_t> call_{0};
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
