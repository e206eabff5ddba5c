// How long the steps of a run took: their distribution, and which stage made the worst one.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine.h"

namespace bench {

// [ms] that the calling thread has worked: other programs on the machine do not lengthen it, as they do a clock's time.
double thread_ms();

// The slowest step against the median of those that it is looked for among, by the calling thread's time.
struct Spike {
    size_t step = 0;
    double ratio = 0;
    const char* stage = "unknown";  // that took most more than it does in the median

    void report(nlohmann::ordered_json& json) const;
};

class StepTimes {
public:
    void add(double milliseconds, double thread_milliseconds, std::vector<StageTime> stages);
    // Of each step the less that this run and another of the same scene took: what the machine did beside is in neither
    // of them, or in one.
    void keep_least(const StepTimes& other);
    double mean() const;    // [ms]
    double median() const;  // [ms]
    void report(nlohmann::ordered_json& json) const;
    Spike worst_after(size_t warm_up) const;  // steps; all zero if there are no others

private:
    const char* slow_stage(size_t step, size_t warm_up) const;

    std::vector<double> whole_, thread_;  // [ms] by step
    std::vector<std::vector<StageTime>> stages_;
};

}  // namespace bench
