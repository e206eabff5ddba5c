#include "threads/team.h"

#include <algorithm>

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#endif
#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

#include "base/float_environment.h"
#include "base/log.h"

namespace taut {
namespace {

constexpr uint32_t kSpins = 1000;  // looks before a thread offers its core to others, some 10 to 50 us
constexpr uint32_t kPatience =
    20;  // looks before a thread takes a stage of the part of another that is at work, some 1 us

// Looks at something that another thread will change soon.
class Spin {
public:
    void wait() {
        if (++looks_ < kSpins) {
#if defined(__x86_64__) || defined(__i386__)
            _mm_pause();
#endif
        } else {
            std::this_thread::yield();
        }
    }
    uint32_t looks() const { return looks_; }

private:
    uint32_t looks_ = 0;
};

}  // namespace

Team::Team(const taut_hooks& hooks, uint32_t threads)
    : hooks_(hooks),
      size_(threads),
      run_at_(threads > 1 ? kMostRuns : 0),
      first_run_(threads + 2),
      after_(threads > 1 ? kMaxStages : 0),
      share_(threads),
      wake_(threads) {
    if (hooks_.enqueue_task) return;
    own_.reserve(threads - 1);
    try {
        for (uint32_t i = 1; i < threads; ++i) own_.emplace_back([this, i] { live(i); });
    } catch (...) {
        quit();
        throw;
    }
}

Team::~Team() {
    rest();
    quit();
}

void Team::quit() {
    wake(static_cast<uint32_t>(own_.size()), kQuit);
    for (std::thread& thread : own_) thread.join();
}

void Team::hand_out(uint32_t stages, std::span<const uint32_t> after, StageFn run, const void* context) {
    call_helpers();
    job_.store(kNone, std::memory_order_release);
    run_.store(run, std::memory_order_release);
    context_.store(context, std::memory_order_release);
    before_.store(done_, std::memory_order_release);
    stages_.store(stages, std::memory_order_release);
    dealt_.store(shares_, std::memory_order_release);
    ordered_.store(!after.empty(), std::memory_order_release);
    for (size_t i = 0; i < after.size(); ++i) after_[i].store(after[i], std::memory_order_release);
    job_.store(++last_job_, std::memory_order_release);
    done_ += stages;
    work(job_out(last_job_), 0);
}

Team::Job Team::job_out(uint64_t number) const {
    return {number,
            before_.load(std::memory_order_acquire),
            stages_.load(std::memory_order_acquire),
            dealt_.load(std::memory_order_acquire),
            ordered_.load(std::memory_order_acquire),
            run_.load(std::memory_order_acquire),
            context_.load(std::memory_order_acquire)};
}

// Takes stages until all of the job are done.
void Team::work(Job job, uint32_t worker) {
    share_[worker].joined.store(job.number, std::memory_order_release);
    uint32_t patience = kPatience;  // looks; who needed help once may be off its core for long
    for (Spin spin;;) {
        if (advance(job, worker)) {
            spin = {};
        } else if (all_did(job, job.stages)) {
            return;
        } else if (help_others(job, worker, spin.looks() < patience)) {
            patience /= 2;
            spin = {};
        } else {
            if (!is_out(job)) return;
            spin.wait();
        }
    }
}

// Of all parts of a share.
void Team::run_share(const Job& job, uint32_t stage, uint32_t share) const {
    for (uint32_t part = share; part < size_; part += job.shares) job.run(job.context, stage, part);
}

// Runs the next stage of a share, if that may begin and nobody else did; of a loop without order all that are left.
bool Team::advance(Job& job, uint32_t share) {
    if (share >= job.shares) return false;  // of a thread that an earlier call woke
    std::atomic<uint64_t>& done = share_[share].done;
    uint32_t stage = 0;
    if (!take(job, share, stage)) return false;
    if (job.ordered) {  // nobody else writes: a store need not wait for those that look
        run_share(job, stage, share);
        done.store(job.before + stage + 1, std::memory_order_release);
        return true;
    }
    uint64_t ran = 0;
    do {
        run_share(job, stage, share);
        ++ran;
    } while (take(job, share, stage));
    done.fetch_add(ran, std::memory_order_release);
    return true;
}

bool Team::take(Job& job, uint32_t share, uint32_t& stage) {
    std::atomic<uint64_t>& taken = share_[share].taken;
    uint64_t at = taken.load(std::memory_order_acquire);
    const uint64_t of = at >> kStageBits;
    if (of > job.number) return false;  // this thread is late
    stage = of == job.number ? static_cast<uint32_t>(at & ((1u << kStageBits) - 1)) : 0;
    if (stage >= job.stages) return false;
    if (job.ordered) {
        if (share_[share].done.load(std::memory_order_acquire) != job.before + stage) return false;
        if (!all_did(job, after_[stage].load(std::memory_order_acquire))) return false;
    }
    if (!is_out(job)) return false;
    return taken.compare_exchange_strong(at, job.number << kStageBits | (stage + 1), std::memory_order_acq_rel);
}

// A share has better stay with the thread that has its data in the cache.
bool Team::help_others(Job& job, uint32_t worker, bool patient) {
    for (uint32_t k = 1; k <= job.shares; ++k) {
        const uint32_t share = (worker + k) % job.shares;
        const bool at_work = share_[share].joined.load(std::memory_order_acquire) == job.number;
        if (share != worker && !(at_work && patient) && advance(job, share)) return true;
    }
    return false;
}

bool Team::all_did(Job& job, uint32_t stages) const {
    if (stages <= job.known) return true;
    uint64_t least = UINT64_MAX;
    for (uint32_t share = 0; share < job.shares; ++share)
        least = std::min(least, share_[share].done.load(std::memory_order_acquire));
    if (least < job.before + stages) return false;
    job.known = static_cast<uint32_t>(least - job.before);
    return true;
}

void Team::call_helpers() {
    if (called_) return;
    called_ = true;
    caller_ = std::this_thread::get_id();
    const uint32_t call = call_.fetch_add(1, std::memory_order_release) + 1;
    if (hooks_.enqueue_task) {
        deal(size_);
        return enqueue();
    }
    woken_ = keep_off_caller();
    deal(woken_ + 1);
    wake(woken_, call);
}

// Between jobs.
void Team::deal(uint32_t shares) {
    if (shares == shares_) return;
    shares_ = shares;
    for (Share& share : share_) share.done.store(done_, std::memory_order_release);
}

// A host that throws has enqueued nothing: there is nothing to finish, and the caller goes on alone.
void Team::enqueue() {
    try {
        token_ = hooks_.enqueue_task(help_as_task, size_ - 1, 1, this, hooks_.task_user_data);
        enqueued_ = true;
    } catch (...) {
        log_line(hooks_, TAUT_LOG_WARNING,
                 "enqueue_task threw an exception: the step goes on without the host's workers");
    }
}

void Team::wake(uint32_t helpers, uint32_t call) {
    for (uint32_t worker = 1; worker <= helpers; ++worker) wake_[worker].set(call);
}

#if defined(__linux__)
void Team::Wake::set(uint32_t call) {
    call_.store(call, std::memory_order_release);
    call_.notify_one();
}

uint32_t Team::Wake::other_than(uint32_t last) {
    call_.wait(last, std::memory_order_acquire);
    return call_.load(std::memory_order_acquire);
}
#else
// Where the system has no futex, atomics of libstdc++ 12 lose wake-ups: they look at the value before they take the
// lock.
void Team::Wake::set(uint32_t call) {
    {
        const std::lock_guard lock(mutex_);
        call_.store(call, std::memory_order_release);
    }
    changed_.notify_one();
}

uint32_t Team::Wake::other_than(uint32_t last) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return call_.load(std::memory_order_acquire) != last; });
    return call_.load(std::memory_order_acquire);
}
#endif

// A thread that wakes may be queued behind the one that woke it, though other cores are idle: for 4 ms, as measured on
// virtual machines whose cores tell of no common cache. So the own threads leave the caller's core alone. Returns how
// many of them have a core.
uint32_t Team::keep_off_caller() {
    const auto all = static_cast<uint32_t>(own_.size());
#if defined(__linux__)
    const int core = sched_getcpu();
    cpu_set_t cores;
    if (core < 0 || all == 0 || sched_getaffinity(0, sizeof cores, &cores) != 0) return all;
    CPU_CLR(static_cast<size_t>(core), &cores);
    auto free = static_cast<uint32_t>(CPU_COUNT(&cores));
    if (free == 0) {  // the caller is tied to its core; own threads stay where they may be
        if (pthread_getaffinity_np(own_[0].native_handle(), sizeof cores, &cores) != 0) return all;
        CPU_CLR(static_cast<size_t>(core), &cores);
        return std::min(all, static_cast<uint32_t>(CPU_COUNT(&cores)));
    }
    if (core != caller_core_ || free != free_cores_)
        for (std::thread& thread : own_) pthread_setaffinity_np(thread.native_handle(), sizeof cores, &cores);
    caller_core_ = core;
    free_cores_ = free;
    return std::min(all, free);
#else
    return all;
#endif
}

void Team::rest() {
    if (!called_) return;
    called_ = false;
    call_.fetch_add(1, std::memory_order_seq_cst);
    if (scopes_.load(std::memory_order_relaxed))
        for (Spin spin; in_scope_.load(std::memory_order_seq_cst) > 0;) spin.wait();
    if (!enqueued_) return;
    enqueued_ = false;
    try {
        hooks_.finish_task(token_, hooks_.task_user_data);
    } catch (...) {  // the step is over, and scopes end: nobody is there to hear of it
    }
}

// Works on every job until this call for help is over.
void Team::help(uint32_t call, uint32_t worker) {
    const FloatEnvironment standard;
    uint64_t last = kNone;
    for (Spin spin; call_.load(std::memory_order_acquire) == call; spin.wait()) {
        const uint64_t number = job_.load(std::memory_order_acquire);
        if (number == kNone || number == last) continue;
        last = number;
        const Job job = job_out(number);
        const ProfileScopes* const scopes = scopes_.load(std::memory_order_relaxed);
        if (is_out(job)) scopes ? work_in_scope(*scopes, job, call, worker) : work(job, worker);
        spin = {};
    }
}

// Either this sees that the call is over, or rest() that a helper is in a scope: both look after they have written.
void Team::work_in_scope(const ProfileScopes& scopes, const Job& job, uint32_t call, uint32_t worker) {
    in_scope_.fetch_add(1, std::memory_order_seq_cst);
    if (call_.load(std::memory_order_seq_cst) == call) {
        const ProfileScope scope(scopes, "work", worker);
        work(job, worker);
    }
    in_scope_.fetch_sub(1, std::memory_order_release);
}

void Team::live(uint32_t worker) {
    for (uint32_t call = 0;;) {
        call = wake_[worker].other_than(call);
        if (call == kQuit) return;
        help(call, worker);
    }
}

// A host that runs tasks at once on the thread that enqueues them has no helper to give.
void Team::help_as_task(uint32_t begin, uint32_t, uint32_t, void* team) {
    Team& self = *static_cast<Team*>(team);
    if (std::this_thread::get_id() == self.caller_) return;
    const uint32_t call = self.call_.load(std::memory_order_acquire);
    if (call % 2 == 1) self.help(call, begin + 1);
}

}  // namespace taut
