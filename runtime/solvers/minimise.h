// Minimisation by Newton's method with line search (Gast and Schroeder 2014, section 3.1), over any function that has a
// gradient and a product with its Hessian: it knows neither elements nor schemes. It finds a local minimum from
// anywhere: directions come from conjugate gradients that end where the Hessian is indefinite, all go downhill, and
// values that are not finite are walls.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "base/memory.h"

namespace taut {

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
    // d2E/dx2 at x, symmetric, for multiply().
    virtual void linearise(std::span<double> x) = 0;
    virtual void multiply(std::span<const double> d, std::span<double> out) = 0;
    // What solve() costs, in products: conjugate gradients that took as many give way to it. Infinite without it.
    virtual double direct_cost() const { return std::numeric_limits<double>::infinity(); }
    // x, once -dE/dx, becomes Newton's direction; false: the matrix is not positive, and x is anything.
    virtual bool solve(std::span<double>) { return false; }
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
    double downhill = 1e-2;     // kappa: least cosine of a direction against -dE/dx (ibid.)
    double longest_step = 1e3;  // l: of a direction (ibid.)
    uint32_t most_steps = 1000;
    bool line_search = true;  // else directions are taken as they are, whatever becomes of E
};

struct MinimiseReport {
    uint32_t steps = 0;              // of Newton's method: linear solves
    uint32_t iterations = 0;         // of conjugate gradients, in all of them
    uint32_t direct = 0;             // steps that were solved directly
    uint32_t evaluations = 0;        // of E with dE/dx
    uint32_t indefinite = 0;         // steps at which conjugate gradients met a negative curvature
    uint32_t gradient_steps = 0;     // that went along -dE/dx in place of that
    double value = 0, gradient = 0;  // E and |dE/dx| at the end
    bool converged = false;          // |dE/dx| < tau
};

// What it works with, kept so that steady problems allocate nothing.
struct MinimiseScratch {
    explicit MinimiseScratch(Memory& m)
        : gradient(m), direction(m), residual(m), search(m), image(m), trial(m), trial_gradient(m) {}
    void resize(size_t size) {
        for (Array<double>* each : {&gradient, &direction, &residual, &search, &image, &trial, &trial_gradient})
            each->resize(size);
    }

    Array<double> gradient, direction, residual, search, image, trial, trial_gradient;
};

// From x, which becomes the best that was found. E of x is finite.
MinimiseReport minimise(Objective& of, std::span<double> x, const MinimiseSettings& settings, MinimiseScratch& scratch);

// a . b, in one order whoever asks.
double dot_of(std::span<const double> a, std::span<const double> b);

}  // namespace taut
