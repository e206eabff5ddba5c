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

    // H d = -g. Where the Hessian is not positive it is solved with the positive matrix: conjugate gradients that end
    // at the negative curvature, as in the paper, leave directions that lead little down.
    void find_direction() {
        of_.linearise(x_, Hessian::exact);
        if (solve_newton(!set_.line_search)) return;
        ++report_.indefinite;
        of_.linearise(x_, Hessian::positive);
        solve_newton(true);
    }
    // By conjugate gradients from d = 0. Where that lasts it is solved directly: whether it would end with the next
    // product nobody knows, so that what is cheaper costs at most twice as much. From then on directly at once. False:
    // the matrix is not positive, and not the last one; of that the last iterate is taken, which goes downhill.
    bool solve_newton(bool is_last) {
        bool was_tried = direct_;
        if (direct_) {
            if (solve_directly()) return true;
            if (!is_last) return false;
            direct_ = false;
        }
        const double size = report_.gradient;
        if (report_.steps == 0) first_ = size;
        constexpr double kWhole = 1e-6;  // of a residual: the step without the search is Newton's own
        const double share = set_.line_search ? 0.5 : kWhole;
        const double end = std::min(share, set_.sigma * std::sqrt(std::max(size, set_.tolerance) / first_)) * size;
        std::ranges::fill(s_.direction, 0.0);
        std::ranges::transform(s_.gradient, s_.residual.begin(), [](double g) { return -g; });
        of_.precondition(s_.residual, s_.eased);
        s_.search = s_.eased;
        double square = dot_of(s_.residual, s_.eased), left = size;
        const double rent = of_.direct_cost();
        for (size_t k = 0; k < most_iterations() && left > end; ++k) {
            if (!was_tried && static_cast<double>(k) >= rent) {
                was_tried = true;
                s_.image = s_.direction;
                direct_ = solve_directly();
                if (direct_) return true;
                if (!is_last) return false;
                s_.direction = s_.image;
            }
            of_.multiply(s_.search, s_.image);
            const double curvature = dot_of(s_.search, s_.image);
            if (!is_usable(curvature)) {
                if (k == 0) s_.direction = s_.search;
                return is_last;
            }
            ++report_.iterations;
            const double part = square / curvature;
            for (size_t i = 0; i < s_.search.size(); ++i) {
                s_.direction[i] += part * s_.search[i];
                s_.residual[i] -= part * s_.image[i];
            }
            of_.precondition(s_.residual, s_.eased);
            const double next = dot_of(s_.residual, s_.eased), beta = next / square;
            for (size_t i = 0; i < s_.search.size(); ++i) s_.search[i] = s_.eased[i] + beta * s_.search[i];
            square = next;
            left = length_of(s_.residual);
        }
        return true;
    }
    // Without the search a step is -H^-1 g as it comes, be it uphill.
    bool is_usable(double curvature) const {
        return std::isfinite(curvature) && (set_.line_search ? curvature > 0 : curvature != 0);
    }
    bool solve_directly() {
        std::ranges::transform(s_.gradient, s_.direction.begin(), [](double g) { return -g; });
        const bool solved = of_.solve(s_.direction);
        if (solved) ++report_.direct;
        return solved;
    }
    // In exact arithmetic as many as there are unknowns reach the solution.
    size_t most_iterations() const { return x_.size(); }

    // No longer than l.
    void clamp_direction() {
        const double length = length_of(s_.direction);
        if (!(length > set_.longest_step)) return;
        for (double& each : s_.direction) each *= set_.longest_step / length;
    }

    LinePoint at(double part) override {
        of_.follow(x_, s_.direction, part, s_.trial, s_.way);
        LinePoint out{part, evaluate(s_.trial, s_.trial_gradient), 0};
        out.slope = dot_of(s_.trial_gradient, s_.way);
        tried_ = part;
        return out;
    }
    // False: no way down that rounding would not hide, not even along -g.
    bool step_downhill() {
        if (search()) return true;
        std::ranges::transform(s_.gradient, s_.direction.begin(), [](double g) { return -g; });
        ++report_.gradient_steps;
        return search();
    }
    bool search() {
        clamp_direction();
        const LinePoint begin{0, report_.value, dot_of(s_.direction, s_.gradient)};
        if (!(begin.slope < 0)) return false;
        of_.begin_path(x_, s_.direction);
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
        for (size_t i = 0; i < x_.size(); ++i) s_.trial[i] = x_[i] + s_.direction[i];
        take(evaluate(s_.trial, s_.trial_gradient));
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
    bool direct_ = false;  // the last matrix was solved so
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
