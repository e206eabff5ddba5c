// How wide the kernels work that are built several times with the same bits.
#pragma once

#include <atomic>
#include <cstdint>

namespace taut {

constexpr int kLanes = 16;                          // floats that a kernel works on side by side
constexpr uint32_t kAllLanes = (1u << kLanes) - 1;  // a bit for each
constexpr int kDoubles = 8;                         // numbers of double precision, likewise

enum class Width : uint8_t { scalar, sse2, avx2, avx512 };

Width widest();  // that this processor runs

extern std::atomic<Width> chosen_width;
// That kernels use: the widest, unless a test asked for less.
inline Width kernel_width() { return chosen_width.load(std::memory_order_relaxed); }
// For tests that compare builds; at most widest(), and in effect from the next step of any world on.
void set_kernel_width(Width width);

}  // namespace taut
