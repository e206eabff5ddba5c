// Line search along a direction that goes downhill: a step with the strong Wolfe conditions (Nocedal and Wright 2006,
// algorithms 3.5 and 3.6), the whole step tried first. Values that are not finite count as infinitely high.
#pragma once

#include <cstdint>

namespace taut {

// phi(part) = E(x + part d) and its slope.
struct LinePoint {
    double part = 0, value = 0, slope = 0;
};

class LineFunction {
public:
    virtual LinePoint at(double part) = 0;

protected:
    ~LineFunction() = default;
};

struct LineSettings {
    double decrease = 1e-4;     // c_1, share of the first slope by which the value falls (section 3.1)
    double curvature = 0.9;     // c_2, share of it that the slope may keep: that for Newton's method (ibid.)
    double terms = 0;           // sizes of what a value is the sum of
    double rounding = 1e-12;    // share of these within which slopes alone decide (Hager and Zhang 2005, section 4)
    double longest = 1;         // part
    uint32_t most_trials = 60;  // halves a bracket down to rounding
};

// The step taken; part 0 where no value below the first one was found. trials: grows by the evaluations.
LinePoint search_line(LineFunction& phi, const LinePoint& begin, const LineSettings& settings, uint32_t& trials);

}  // namespace taut
