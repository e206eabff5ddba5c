// Minimisation by Newton's method with line search (Gast and Schroeder 2014, section 3.1), over any function that has a
// gradient and a product with its Hessian: it knows neither elements nor schemes. It finds a local minimum from
// anywhere: where the Hessian shows a negative curvature a positive matrix takes its place, so that all directions go
// downhill, and values that are not finite are walls.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "base/memory.h"

namespace taut {

enum class Hessian { exact, positive };

class Objective {
public:
    virtual uint32_t size() const = 0;
    // E(x) and, unless empty, dE/dx; they may be not finite. Where E(x) = E'(P(x)), of a projection P onto what is
    // allowed, x becomes P(x).
    virtual double evaluate(std::span<double> x, std::span<double> gradient) = 0;
    // At the place of the last evaluation, which a Newton step begins from: settles what P takes to the edge in that
    // step; the gradient becomes that of E as it is then (Gast and Schroeder 2014, section 3.2: active set).
    virtual void hold(std::span<double> x, std::span<double> gradient) {
        static_cast<void>(x), static_cast<void>(gradient);
    }
    // H at x for multiply(), symmetric: d2E/dx2, or a matrix near it that has no negative curvature.
    virtual void linearise(std::span<double> x, Hessian which) = 0;
    virtual void multiply(std::span<const double> d, std::span<double> out) = 0;
    // out = M^-1 r, M positive and near H: preconditioner of conjugate gradients.
    virtual void precondition(std::span<const double> r, std::span<double> out) { std::ranges::copy(r, out.begin()); }
    // What solve() costs, in products: conjugate gradients that took as many give way to it. Infinite without it.
    virtual double direct_cost() const { return std::numeric_limits<double>::infinity(); }
    // x, once -dE/dx, becomes Newton's direction; false: the matrix is not positive, and x is anything.
    virtual bool solve(std::span<double>) { return false; }
    // Path c of a line search, c(0) = x, c'(0) = d: place = c(part), way = c'(part). begin_path() comes first.
    virtual void begin_path(std::span<const double> x, std::span<const double> d) {
        static_cast<void>(x), static_cast<void>(d);
    }
    virtual void follow(std::span<const double> x, std::span<const double> d, double part, std::span<double> place,
                        std::span<double> way) {
        for (size_t i = 0; i < x.size(); ++i) place[i] = x[i] + part * d[i];
        std::ranges::copy(d, way.begin());
    }
    // Sum of the sizes of the terms of E, as last evaluated: what rounding leaves of E goes by that.
    virtual double size_of_terms() const = 0;

protected:
    ~Objective() = default;
};

struct MinimiseSettings {
    double tolerance = 1e-8;  // tau: of |dE/dx|, where it ends
    // sigma: conjugate gradients end at min(1/2, sigma sqrt(max(|dE/dx|, tau))) of their residual (ibid.), with the
    // first |dE/dx| for a unit.
    double sigma = 1;
    double longest_step = 1e3;  // l: of a direction (ibid.)
    uint32_t most_steps = 1000;
    bool line_search = true;  // else directions are taken as they are, whatever becomes of E
};

struct MinimiseReport {
    uint32_t steps = 0;              // of Newton's method: linear solves
    uint32_t iterations = 0;         // of conjugate gradients, in all of them
    uint32_t direct = 0;             // steps that were solved directly
    uint32_t evaluations = 0;        // of E with dE/dx
    uint32_t indefinite = 0;         // steps at which d2E/dx2 showed a negative curvature
    uint32_t gradient_steps = 0;     // that went along -dE/dx in place of Newton's direction
    double value = 0, gradient = 0;  // E and |dE/dx| at the end
    bool converged = false;          // |dE/dx| < tau
};

// What it works with, kept so that steady problems allocate nothing.
struct MinimiseScratch {
    explicit MinimiseScratch(Memory& m)
        : gradient(m), direction(m), residual(m), eased(m), search(m), image(m), trial(m), trial_gradient(m), way(m) {}
    void resize(size_t size) {
        for (Array<double>* each :
             {&gradient, &direction, &residual, &eased, &search, &image, &trial, &trial_gradient, &way})
            each->resize(size);
    }

    Array<double> gradient, direction;
    Array<double> residual, eased, search, image;  // of conjugate gradients: r, M^-1 r, p, H p
    Array<double> trial, trial_gradient, way;
};

// From x, which becomes the best that was found. E of x is finite.
MinimiseReport minimise(Objective& of, std::span<double> x, const MinimiseSettings& settings, MinimiseScratch& scratch);

// a . b, in one order whoever asks.
double dot_of(std::span<const double> a, std::span<const double> b);

}  // namespace taut
