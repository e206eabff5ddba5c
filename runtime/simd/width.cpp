#include "simd/width.h"

#include <atomic>

namespace taut {
namespace {

std::atomic<Width>& chosen() {
    static std::atomic<Width> width{widest()};
    return width;
}

}  // namespace

// The first processors with AVX-512, which have no VBMI, run all else slower for a while where it is used.
Width widest() {
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vbmi")) return Width::avx512;
    return __builtin_cpu_supports("avx2") ? Width::avx2 : Width::sse2;
}

Width kernel_width() { return chosen().load(std::memory_order_relaxed); }

void set_kernel_width(Width width) { chosen().store(width, std::memory_order_relaxed); }

}  // namespace taut
