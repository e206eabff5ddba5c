#include "threads/team.h"

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace taut {
namespace {

constexpr uint32_t kSpins = 4000;  // looks at the ticket before a thread offers its core to others, some 40 us

// One look at something that another thread will change soon.
class Spin {
public:
    void wait() {
        if (++count_ < kSpins) {
#if defined(__x86_64__) || defined(__i386__)
            _mm_pause();
#endif
        } else {
            std::this_thread::yield();
        }
    }

private:
    uint32_t count_ = 0;
};

}  // namespace

Team::Team(const taut_hooks& hooks, uint32_t threads) : hooks_(hooks), size_(threads) {
    if (hooks_.enqueue_task) return;
    own_.reserve(threads - 1);
    try {
        for (uint32_t i = 1; i < threads; ++i) own_.emplace_back([this] { live(); });
    } catch (...) {
        call_.store(kQuit, std::memory_order_release);
        call_.notify_all();
        for (std::thread& thread : own_) thread.join();
        throw;
    }
}

Team::~Team() {
    rest();
    call_.store(kQuit, std::memory_order_release);
    call_.notify_all();
    for (std::thread& thread : own_) thread.join();
}

void Team::hand_out(uint32_t count, uint32_t grain, RangeFn run, const void* context) {
    call_helpers();
    const uint32_t chunks = (count + grain - 1) / grain;
    const uint64_t loop = (ticket_.load(std::memory_order_relaxed) >> 32) + 1;
    ticket_.store(loop << 32 | kNoTicket, std::memory_order_release);
    run_.store(run, std::memory_order_release);
    context_.store(context, std::memory_order_release);
    count_.store(count, std::memory_order_release);
    grain_.store(grain, std::memory_order_release);
    left_.store(chunks, std::memory_order_release);
    chunks_.store(chunks, std::memory_order_release);
    ticket_.store(loop << 32, std::memory_order_release);
    while (take_chunk()) {
    }
    for (Spin spin; left_.load(std::memory_order_acquire) != 0;) spin.wait();
}

// Claims the next chunk of the loop that is out and runs it; false: all are taken.
bool Team::take_chunk() {
    uint64_t ticket = ticket_.load(std::memory_order_acquire);
    for (;;) {
        const uint32_t chunk = static_cast<uint32_t>(ticket), grain = grain_.load(std::memory_order_acquire),
                       count = count_.load(std::memory_order_acquire);
        const RangeFn run = run_.load(std::memory_order_acquire);
        const void* const context = context_.load(std::memory_order_acquire);
        if (chunk >= chunks_.load(std::memory_order_acquire)) return false;
        if (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel, std::memory_order_acquire))
            continue;
        const uint32_t begin = chunk * grain;
        run(context, begin, count - begin > grain ? begin + grain : count);
        left_.fetch_sub(1, std::memory_order_acq_rel);
        return true;
    }
}

void Team::call_helpers() {
    if (called_) return;
    called_ = true;
    caller_ = std::this_thread::get_id();
    call_.fetch_add(1, std::memory_order_release);
    if (hooks_.enqueue_task)
        token_ = hooks_.enqueue_task(help_as_task, size_ - 1, 1, this, hooks_.task_user_data);
    else
        call_.notify_all();
}

void Team::rest() {
    if (!called_) return;
    called_ = false;
    call_.fetch_add(1, std::memory_order_release);
    if (hooks_.enqueue_task) hooks_.finish_task(token_, hooks_.task_user_data);
}

// Takes chunks of every loop until this call for help is over.
void Team::help(uint32_t call) {
    for (Spin spin; call_.load(std::memory_order_acquire) == call; spin.wait()) {
        bool worked = false;
        while (take_chunk()) worked = true;
        if (worked) spin = {};
    }
}

void Team::live() {
    for (;;) {
        uint32_t call = call_.load(std::memory_order_acquire);
        while (call % 2 == 0) {
            call_.wait(call, std::memory_order_acquire);
            call = call_.load(std::memory_order_acquire);
        }
        if (call == kQuit) return;
        help(call);
    }
}

// A host that runs tasks at once on the thread that enqueues them has no helper to give.
void Team::help_as_task(uint32_t, uint32_t, uint32_t, void* team) {
    Team& self = *static_cast<Team*>(team);
    if (std::this_thread::get_id() == self.caller_) return;
    const uint32_t call = self.call_.load(std::memory_order_acquire);
    if (call % 2 == 1 && call != kQuit) self.help(call);
}

}  // namespace taut
