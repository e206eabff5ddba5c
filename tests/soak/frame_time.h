// What a frame may take, where it is timed.
#pragma once

#include <ctime>

namespace soak {

#if defined(NDEBUG)
constexpr bool kTimed = true;
#else
constexpr bool kTimed = false;  // checked and sanitized builds are slow by design
#endif
constexpr double kBudget = 1000.0 / 60;  // of a frame [ms]

// Of this thread: what others do to the machine must not fail a soak.
inline double processor_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace soak
