#include "simd/width.h"

namespace taut {

#if defined(__x86_64__) || defined(__i386__)
// The first processors with AVX-512, which have no VBMI, run all else slower for a while where it is used.
Width widest() {
    __builtin_cpu_init();  // this may run before all else
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vbmi")) return Width::avx512;
    return __builtin_cpu_supports("avx2") ? Width::avx2 : Width::base;
}
#else
Width widest() { return Width::base; }
#endif

std::atomic<Width> chosen_width{widest()};

void set_kernel_width(Width width) { chosen_width.store(width, std::memory_order_relaxed); }

}  // namespace taut
