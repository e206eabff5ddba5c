// The arithmetic that results are made with, whatever the host's threads have: rounded to nearest, with denormals and
// without traps. A game linked with -ffast-math flushes denormals in its first thread and in those that this one
// starts, not in all; one that looks for its own errors traps on not-a-number, which appears inside without harm.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <cfenv>
#endif

namespace taut {

// The thread has it while this lives, then what it had before; flags of exceptions may be raised meanwhile.
class FloatEnvironment {
public:
    FloatEnvironment() : before_(get()) {
        if (control(before_) != kStandard) set(kStandard);
    }
    ~FloatEnvironment() {
        if (control(before_) != kStandard) set(before_);
    }
    FloatEnvironment(const FloatEnvironment&) = delete;
    FloatEnvironment& operator=(const FloatEnvironment&) = delete;

private:
#if defined(__SSE2__)
    using Word = uint32_t;  // MXCSR: all exceptions masked; to nearest; neither flushes nor takes denormals for zero
    static constexpr Word kStandard = 0x1f80, kFlags = 0x3f;
    static Word get() { return _mm_getcsr(); }
    static void set(Word word) { _mm_setcsr(word); }
    static Word control(Word word) { return word & ~kFlags; }
#elif defined(__aarch64__)
    using Word = uint64_t;  // FPCR: nothing trapped; to nearest; nothing flushed
    static constexpr Word kStandard = 0;
    static Word get() {
        Word word;
        asm volatile("mrs %0, fpcr" : "=r"(word));
        return word;
    }
    static void set(Word word) { asm volatile("msr fpcr, %0" : : "r"(word)); }
    static Word control(Word word) { return word; }
#else
    using Word = int;  // the rounding alone
    static constexpr Word kStandard = FE_TONEAREST;
    static Word get() { return std::fegetround(); }
    static void set(Word word) { std::fesetround(word); }
    static Word control(Word word) { return word; }
#endif

    Word before_;
};

}  // namespace taut
