#include "step_times.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <utility>

namespace bench {

namespace {

// The value that a share of them does not exceed.
double part_of(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    const auto index = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
    return values[std::clamp<size_t>(index, 1, values.size()) - 1];
}

std::vector<double> from(const std::vector<double>& values, size_t first) {
    return {values.begin() + static_cast<std::ptrdiff_t>(first), values.end()};
}

}  // namespace

void Spike::report(nlohmann::ordered_json& json) const {
    json["worst_step"] = step;
    json["worst_ratio"] = ratio;
    json["worst_stage"] = stage;
}

double thread_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void StepTimes::add(double milliseconds, double thread_milliseconds, std::vector<StageTime> stages) {
    whole_.push_back(milliseconds);
    thread_.push_back(thread_milliseconds);
    stages_.push_back(std::move(stages));
}

void StepTimes::keep_least(const StepTimes& other) {
    for (size_t step = 0; step < whole_.size(); ++step) {
        whole_[step] = std::min(whole_[step], other.whole_[step]);
        thread_[step] = std::min(thread_[step], other.thread_[step]);
        for (size_t i = 0; i < stages_[step].size(); ++i)
            stages_[step][i].milliseconds =
                std::min(stages_[step][i].milliseconds, other.stages_[step][i].milliseconds);
    }
}

double StepTimes::mean() const {
    return std::accumulate(whole_.begin(), whole_.end(), 0.0) / static_cast<double>(whole_.size());
}

double StepTimes::median() const { return part_of(whole_, 0.5); }

void StepTimes::report(nlohmann::ordered_json& json) const {
    constexpr size_t kLate = 60;
    json["mean_ms"] = mean();
    json["median_ms"] = median();
    json["p99_ms"] = part_of(whole_, 0.99);
    json["max_ms"] = part_of(whole_, 1);
    json["thread_mean_ms"] = std::accumulate(thread_.begin(), thread_.end(), 0.0) / static_cast<double>(thread_.size());
    json["thread_median_ms"] = part_of(thread_, 0.5);
    json["thread_max_ms"] = part_of(thread_, 1);
    json["late_ms"] = part_of(from(whole_, whole_.size() - std::min(kLate, whole_.size())), 0.5);
}

Spike StepTimes::worst_after(size_t warm_up) const {
    if (thread_.size() <= warm_up) return {};
    const auto worst = std::max_element(thread_.begin() + static_cast<std::ptrdiff_t>(warm_up), thread_.end());
    const auto step = static_cast<size_t>(worst - thread_.begin());
    return {step, *worst / part_of(from(thread_, warm_up), 0.5), slow_stage(step, warm_up)};
}

const char* StepTimes::slow_stage(size_t step, size_t warm_up) const {
    const char* slowest = "unknown";
    double most = 0;
    for (size_t i = 0; i < stages_[step].size(); ++i) {
        std::vector<double> times;
        for (size_t s = warm_up; s < stages_.size(); ++s) times.push_back(stages_[s][i].milliseconds);
        const double more = stages_[step][i].milliseconds - part_of(times, 0.5);
        if (more <= most) continue;
        most = more;
        slowest = stages_[step][i].name;
    }
    return slowest;
}

}  // namespace bench
