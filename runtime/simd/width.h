// How wide the kernels work that are built several times with the same bits.
#pragma once

#include <atomic>
#include <cstdint>

namespace taut {

constexpr int kLanes = 16;                          // floats that a kernel works on side by side
constexpr uint32_t kAllLanes = (1u << kLanes) - 1;  // a bit for each
constexpr int kDoubles = 8;                         // numbers of double precision, likewise

// base: what every processor of a kind has, SSE2 or NEON; of others the compiler's own.
enum class Width : uint8_t { scalar, base, avx2, avx512 };

// The builds of some kernels that there are on this kind of processor, by width.
#if defined(__x86_64__) || defined(__i386__)
constexpr bool kHasAvx = true;
#define TAUT_BUILDS(kernels) &kernels##Scalar, &kernels##Base, &kernels##Avx2, &kernels##Avx512
#else
constexpr bool kHasAvx = false;
#define TAUT_BUILDS(kernels) &kernels##Scalar, &kernels##Base
#endif

Width widest();  // that this processor runs

extern std::atomic<Width> chosen_width;
// That kernels use: the widest, unless a test asked for less.
inline Width kernel_width() { return chosen_width.load(std::memory_order_relaxed); }
// For tests that compare builds; at most widest(), and in effect from the next step of any world on.
void set_kernel_width(Width width);

}  // namespace taut
