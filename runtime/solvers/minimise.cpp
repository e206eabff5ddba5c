#include "solvers/minimise.h"

#include <algorithm>
#include <cmath>

#include "solvers/line_search.h"

namespace taut {

// Four sums, so that one does not wait for the other.
double dot_of(std::span<const double> a, std::span<const double> b) {
    double sum[4] = {};
    size_t i = 0;
    for (; i + 4 <= a.size(); i += 4)
        for (size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

namespace {

double length_of(std::span<const double> a) { return std::sqrt(dot_of(a, a)); }

class Minimisation final : LineFunction {
public:
    Minimisation(Objective& of, std::span<double> x, const MinimiseSettings& settings, MinimiseScratch& scratch)
        : of_(of), x_(x), set_(settings), s_(scratch) {
        s_.resize(x.size());
    }

    MinimiseReport run() {
        report_.value = evaluate(x_, s_.gradient);
        for (;; ++report_.steps) {
            of_.hold(x_, s_.gradient);
            report_.gradient = length_of(s_.gradient);
            report_.converged = report_.gradient < set_.tolerance;
            if (report_.converged || report_.steps == set_.most_steps || !std::isfinite(report_.gradient)) break;
            of_.linearise(x_);
            find_direction();
            if (!(set_.line_search ? step_downhill() : step_whole())) {
                ++report_.steps;
                break;
            }
        }
        return report_;
    }

private:
    double evaluate(std::span<double> x, std::span<double> gradient) {
        ++report_.evaluations;
        return of_.evaluate(x, gradient);
    }

    // H d = -g by conjugate gradients from d = 0, which ends where the curvature p . H p is not positive: with the last
    // iterate, or with -g at the first one. Either goes downhill. Where that lasts it is solved directly: whether it
    // would end with the next product nobody knows, so that what is cheaper costs at most twice as much. From then on
    // directly at once, until a matrix is not positive.
    void find_direction() {
        bool was_tried = direct_;
        if (direct_ && solve_directly()) return;
        const double size = report_.gradient;
        if (report_.steps == 0) first_ = size;
        constexpr double kWhole = 1e-6;  // of a residual: the step without the search is Newton's own
        const double share = set_.line_search ? 0.5 : kWhole;
        const double end = std::min(share, set_.sigma * std::sqrt(std::max(size, set_.tolerance) / first_)) * size;
        std::ranges::fill(s_.direction, 0.0);
        std::ranges::transform(s_.gradient, s_.residual.begin(), [](double g) { return -g; });
        s_.search = s_.residual;
        double square = size * size;
        const double rent = of_.direct_cost();
        for (size_t k = 0; k < most_iterations() && std::sqrt(square) > end; ++k) {
            if (!was_tried && static_cast<double>(k) >= rent) {
                was_tried = true;
                s_.image = s_.direction;
                if (solve_directly()) return;
                s_.direction = s_.image;
            }
            of_.multiply(s_.search, s_.image);
            const double curvature = dot_of(s_.search, s_.image);
            if (!is_usable(curvature)) {
                if (k == 0) s_.direction = s_.residual;
                ++report_.indefinite;
                return;
            }
            ++report_.iterations;
            const double part = square / curvature;
            for (size_t i = 0; i < s_.search.size(); ++i) {
                s_.direction[i] += part * s_.search[i];
                s_.residual[i] -= part * s_.image[i];
            }
            const double next = dot_of(s_.residual, s_.residual), beta = next / square;
            for (size_t i = 0; i < s_.search.size(); ++i) s_.search[i] = s_.residual[i] + beta * s_.search[i];
            square = next;
        }
    }
    // Without the search a step is -H^-1 g as it comes, be it uphill.
    bool is_usable(double curvature) const {
        return std::isfinite(curvature) && (set_.line_search ? curvature > 0 : curvature != 0);
    }
    bool solve_directly() {
        std::ranges::transform(s_.gradient, s_.direction.begin(), [](double g) { return -g; });
        direct_ = of_.solve(s_.direction);
        if (direct_) ++report_.direct;
        return direct_;
    }
    // In exact arithmetic as many as there are unknowns reach the solution.
    size_t most_iterations() const { return x_.size(); }

    // As steep as kappa asks for, either way, else -g; no longer than l.
    void check_direction() {
        const double length = length_of(s_.direction), slope = dot_of(s_.direction, s_.gradient);
        const double least = set_.downhill * length * report_.gradient;
        if (!(slope < -least)) {
            const bool turns = slope > least;
            for (size_t i = 0; i < x_.size(); ++i) s_.direction[i] = turns ? -s_.direction[i] : -s_.gradient[i];
            if (!turns) ++report_.gradient_steps;
        }
        clamp_direction();
    }
    void clamp_direction() {
        const double length = length_of(s_.direction);
        if (!(length > set_.longest_step)) return;
        for (double& each : s_.direction) each *= set_.longest_step / length;
    }

    LinePoint at(double part) override {
        for (size_t i = 0; i < x_.size(); ++i) s_.trial[i] = x_[i] + part * s_.direction[i];
        LinePoint out{part, evaluate(s_.trial, s_.trial_gradient), 0};
        out.slope = dot_of(s_.trial_gradient, s_.direction);
        tried_ = part;
        return out;
    }
    // False: no way down that rounding would not hide, not even along -g.
    bool step_downhill() {
        check_direction();
        if (search()) return true;
        std::ranges::transform(s_.gradient, s_.direction.begin(), [](double g) { return -g; });
        ++report_.gradient_steps;
        clamp_direction();
        return search();
    }
    bool search() {
        const LinePoint begin{0, report_.value, dot_of(s_.direction, s_.gradient)};
        if (!(begin.slope < 0)) return false;
        LineSettings settings;
        settings.terms = of_.size_of_terms();
        settings.longest = std::max(1.0, set_.longest_step / length_of(s_.direction));
        const LinePoint found = search_line(*this, begin, settings, trials_);
        if (found.part == 0) return false;
        if (found.part != tried_) at(found.part);
        take(found.value);
        return true;
    }
    bool step_whole() {
        clamp_direction();
        take(at(1).value);
        return std::isfinite(report_.value);
    }
    void take(double value) {
        std::ranges::copy(s_.trial, x_.begin());
        s_.gradient.swap(s_.trial_gradient);
        report_.value = value;
    }

    Objective& of_;
    std::span<double> x_;
    const MinimiseSettings& set_;
    MinimiseScratch& s_;
    MinimiseReport report_;
    bool direct_ = false;  // the last step was solved so
    double first_ = 1;     // |dE/dx| at the first step
    double tried_ = 0;     // the part that trial and trial_gradient belong to
    uint32_t trials_ = 0;
};

}  // namespace

MinimiseReport minimise(Objective& of, std::span<double> x, const MinimiseSettings& settings,
                        MinimiseScratch& scratch) {
    return Minimisation(of, x, settings, scratch).run();
}

}  // namespace taut
