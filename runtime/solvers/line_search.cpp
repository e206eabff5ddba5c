#include "solvers/line_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

class WolfeSearch {
public:
    WolfeSearch(LineFunction& phi, const LinePoint& begin, const LineSettings& settings, uint32_t& trials)
        : phi_(phi), begin_(begin), set_(settings), noise_(settings.rounding * settings.terms), count_(trials) {}

    LinePoint run() {
        LinePoint last = begin_;
        for (double part = std::min(1.0, set_.longest);; part = std::min(2 * last.part, set_.longest)) {
            const LinePoint now = value_at(part);
            if (is_accepted(now)) return now;
            if (!falls(now) || (last.part > 0 && now.value >= last.value)) return zoom(last, now);
            if (now.slope >= 0) return zoom(now, last);
            if (part >= set_.longest || is_tired()) return now;
            last = now;
        }
    }

private:
    LinePoint value_at(double part) {
        ++count_;
        ++used_;
        LinePoint out = phi_.at(part);
        out.part = part;
        if (!std::isfinite(out.value) || !std::isfinite(out.slope)) out.value = std::numeric_limits<double>::infinity();
        return out;
    }
    bool is_tired() const { return used_ >= set_.most_trials; }
    bool falls(const LinePoint& at) const { return at.value <= begin_.value + set_.decrease * at.part * begin_.slope; }
    // Where the fall is less than rounding leaves of values, as is a line whose slope ends.
    bool is_accepted(const LinePoint& at) const {
        return (falls(at) || at.value <= begin_.value + noise_) && std::abs(at.slope) <= -set_.curvature * begin_.slope;
    }
    // Within a bracket: the least of the cubic through values and slopes (Nocedal and Wright 2006, eq. 3.59), a tenth
    // of it away from either end; its middle where there is none.
    static double trial_of(const LinePoint& a, const LinePoint& b) {
        const double middle = 0.5 * (a.part + b.part), width = b.part - a.part;
        if (!std::isfinite(b.value)) return middle;
        const double d1 = a.slope + b.slope - 3 * (a.value - b.value) / (a.part - b.part);
        const double square = d1 * d1 - a.slope * b.slope;
        if (!(square >= 0)) return middle;
        const double d2 = std::copysign(std::sqrt(square), width);
        const double part = b.part - width * (b.slope + d2 - d1) / (b.slope - a.slope + 2 * d2);
        const double low = std::min(a.part, b.part) + 0.1 * std::abs(width);
        const double high = std::max(a.part, b.part) - 0.1 * std::abs(width);
        return std::isfinite(part) ? std::clamp(part, low, high) : middle;
    }
    // low: of all parts that fall far enough that of the least value; its slope points to high.
    LinePoint zoom(LinePoint low, LinePoint high) {
        while (!is_tired()) {
            const LinePoint now = value_at(trial_of(low, high));
            if (is_accepted(now)) return now;
            if (!falls(now) || now.value >= low.value) {
                high = now;
                continue;
            }
            if (now.slope * (high.part - low.part) >= 0) high = low;
            low = now;
        }
        return low;
    }

    LineFunction& phi_;
    const LinePoint begin_;
    const LineSettings& set_;
    const double noise_;
    uint32_t& count_;
    uint32_t used_ = 0;
};

}  // namespace

LinePoint search_line(LineFunction& phi, const LinePoint& begin, const LineSettings& settings, uint32_t& trials) {
    return WolfeSearch(phi, begin, settings, trials).run();
}

}  // namespace taut
