#include "threads/team.h"

#include <algorithm>

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#endif
#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace taut {
namespace {

constexpr uint32_t kSpins = 1000;  // looks before a thread offers its core to others, some 10 to 50 us

constexpr int kPatience = 20;  // looks before a thread takes chunks of the part of another that is at work, some 1 us

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

// How a stage is cut: into chunks that are as long but for one, and parts of as many chunks where there are enough.
struct Team::Chunks {
    uint32_t count, number, parts;

    Chunks(uint64_t stage, uint32_t team) : count(static_cast<uint32_t>(stage >> 32)), parts(team) {
        constexpr uint32_t kMost = 1u << (kChunkBits - 1);
        const uint32_t grain = std::max(static_cast<uint32_t>(stage), count / kMost + 1);
        number = count / grain + (count % grain != 0);
        if (number > parts) number -= number % parts;
    }
    uint32_t first(uint32_t part) const { return static_cast<uint32_t>((uint64_t{part} * number + parts - 1) / parts); }
    uint32_t begin(uint32_t chunk) const { return static_cast<uint32_t>(uint64_t{chunk} * count / number); }
    uint32_t end(uint32_t chunk) const { return begin(chunk + 1); }
};

Team::Team(const taut_hooks& hooks, uint32_t threads)
    : hooks_(hooks), size_(threads), stage_(threads > 1 ? kMaxStages : 0), part_(threads) {
    if (hooks_.enqueue_task) return;
    own_.reserve(threads - 1);
    try {
        for (uint32_t i = 1; i < threads; ++i) own_.emplace_back([this, i] { live(i); });
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

void Team::hand_out(std::span<const Stage> stages, RangeFn run, const void* context) {
    call_helpers();
    const uint64_t program = next_loop_;
    next_loop_ += stages.size();
    program_.store(kNone, std::memory_order_release);
    run_.store(run, std::memory_order_release);
    context_.store(context, std::memory_order_release);
    stage_count_.store(static_cast<uint32_t>(stages.size()), std::memory_order_release);
    for (size_t i = 0; i < stages.size(); ++i)
        stage_[i].store(uint64_t{stages[i].count} << 32 | stages[i].grain, std::memory_order_release);
    before_.store(finished(), std::memory_order_release);
    program_.store(program, std::memory_order_release);
    work(program, 0);
}

// Takes chunks of stage after stage. The caller, worker 0, returns when all are finished, a helper when it finds none.
void Team::work(uint64_t program, uint32_t worker) {
    const auto is_out = [&] { return program_.load(std::memory_order_acquire) == program; };
    const RangeFn run = run_.load(std::memory_order_acquire);
    const void* const context = context_.load(std::memory_order_acquire);
    const uint32_t stages = stage_count_.load(std::memory_order_acquire);
    uint64_t before = before_.load(std::memory_order_acquire);  // chunks up to the stage
    // A part has better stay with the thread that has its data in the cache.
    const auto be_patient = [&] {
        Spin spin;
        for (int i = 0; i < kPatience && finished() < before; ++i) spin.wait();
    };
    const auto wait = [&] {
        for (Spin spin; finished() < before; spin.wait())
            if (!is_out()) return;
    };
    part_[worker].joined.store(program, std::memory_order_release);
    for (uint32_t i = 0; i < stages; ++i) {
        const Chunks chunks(stage_[i].load(std::memory_order_acquire), size_);
        wait();
        if (!is_out()) return;
        before += chunks.number;
        for (uint32_t k = 0, part = worker; k < size_; ++k, part = part + 1 < size_ ? part + 1 : 0) {
            if (part != worker && part_[part].joined.load(std::memory_order_acquire) == program) {
                be_patient();
                if (finished() >= before) break;
            }
            uint64_t mine = 0;
            for (uint32_t chunk; claim(part, chunks, program + i, chunk); ++mine)
                run(context, i, chunks.begin(chunk), chunks.end(chunk));
            if (mine == 0) continue;
            std::atomic<uint64_t>& done = part_[worker].finished;
            done.store(done.load(std::memory_order_relaxed) + mine, std::memory_order_release);
        }
    }
    if (worker == 0) wait();
}

// Chunks of all programs, at least: each count only grows.
uint64_t Team::finished() const {
    uint64_t sum = 0;
    for (const Part& part : part_) sum += part.finished.load(std::memory_order_acquire);
    return sum;
}

// The next chunk of a worker's part of a loop; false: all are taken.
bool Team::claim(uint32_t part, const Chunks& chunks, uint64_t loop, uint32_t& chunk) {
    const uint32_t first = chunks.first(part), end = chunks.first(part + 1);
    if (first == end) return false;
    std::atomic<uint64_t>& cursor = part_[part].cursor;
    uint64_t at = cursor.load(std::memory_order_acquire);
    for (;;) {
        if (at >> kChunkBits > loop) return false;  // this thread is late
        chunk = at >> kChunkBits < loop ? first : static_cast<uint32_t>(at & ((1u << kChunkBits) - 1));
        if (chunk == end) return false;
        if (cursor.compare_exchange_weak(at, loop << kChunkBits | (chunk + 1), std::memory_order_acq_rel,
                                         std::memory_order_acquire))
            return true;
    }
}

void Team::call_helpers() {
    if (called_) return;
    called_ = true;
    caller_ = std::this_thread::get_id();
    keep_off_caller();
    call_.fetch_add(1, std::memory_order_release);
    if (hooks_.enqueue_task)
        token_ = hooks_.enqueue_task(help_as_task, size_ - 1, 1, this, hooks_.task_user_data);
    else
        call_.notify_all();
}

// A thread that wakes may be queued behind the one that woke it, though other cores are idle: for 4 ms, as measured on
// virtual machines whose cores tell of no common cache. So the own threads leave the caller's core alone.
void Team::keep_off_caller() {
#if defined(__linux__)
    const int core = sched_getcpu();
    cpu_set_t cores;
    if (core == caller_core_ || core < 0 || sched_getaffinity(0, sizeof cores, &cores) != 0) return;
    caller_core_ = core;
    CPU_CLR(static_cast<size_t>(core), &cores);
    if (CPU_COUNT(&cores) == 0) return;
    for (std::thread& thread : own_) pthread_setaffinity_np(thread.native_handle(), sizeof cores, &cores);
#endif
}

void Team::rest() {
    if (!called_) return;
    called_ = false;
    call_.fetch_add(1, std::memory_order_release);
    if (hooks_.enqueue_task) hooks_.finish_task(token_, hooks_.task_user_data);
}

// Works on every program until this call for help is over.
void Team::help(uint32_t call, uint32_t worker) {
    uint64_t last = kNone;
    for (Spin spin; call_.load(std::memory_order_acquire) == call; spin.wait()) {
        const uint64_t program = program_.load(std::memory_order_acquire);
        if (program == kNone || program == last) continue;
        last = program;
        work(program, worker);
        spin = {};
    }
}

void Team::live(uint32_t worker) {
    for (;;) {
        uint32_t call = call_.load(std::memory_order_acquire);
        while (call % 2 == 0) {
            call_.wait(call, std::memory_order_acquire);
            call = call_.load(std::memory_order_acquire);
        }
        if (call == kQuit) return;
        help(call, worker);
    }
}

// A host that runs tasks at once on the thread that enqueues them has no helper to give.
void Team::help_as_task(uint32_t begin, uint32_t, uint32_t, void* team) {
    Team& self = *static_cast<Team*>(team);
    if (std::this_thread::get_id() == self.caller_) return;
    const uint32_t call = self.call_.load(std::memory_order_acquire);
    if (call % 2 == 1 && call != kQuit) self.help(call, begin + 1);
}

}  // namespace taut
