// Stage times.
#pragma once

#include <chrono>

namespace taut {

class Stopwatch {
public:
    Stopwatch() : start_(now()) {}
    // Microseconds since construction or the last lap.
    float lap() {
        const auto t = now();
        const float us = std::chrono::duration<float, std::micro>(t - start_).count();
        start_ = t;
        return us;
    }

private:
    using Time = std::chrono::steady_clock::time_point;
    static Time now() { return std::chrono::steady_clock::now(); }
    Time start_;
};

}  // namespace taut
