// How far an active set's iterate goes towards the solution of a round, see active_set.h.
#include <algorithm>
#include <cmath>

#include "solvers/active_set.h"

namespace taut {
namespace {

// A round that takes less energy than the lightest body has at a tenth of the highest speed is the last; at rest, at
// a hundredth of what it falls by in a substep. A tenth of that fall would keep light weights on chains awake.
constexpr double kSettled = 1e-2, kSettledAtRest = 1e-4;

using Kind = BoundedRow::Kind;

// Impulse of a row's law at a rate, and how fast it falls with the rate.
double law(const BoundedRow& r, double rate, double& fall) {
    const double f = (r.goal - rate) / r.c;
    fall = 0;
    if (r.kind == Kind::push && f < 0) return 0;
    if (r.kind == Kind::tangent && !r.on) return 0;
    if (r.kind == Kind::box && std::abs(f) > r.limit) return std::copysign(r.limit, f);
    fall = 1 / r.c;
    return f;
}

}  // namespace

// dE/dt at v + t d of the iterate v and the way d to the last solution. A (v - v*) = J^T held, and is linear in t:
//   dE/dt = sum (held + t (mu - held) - law(rate + t J d)) J d
double ActiveSet::slope_of_energy(double t, double& curvature) const {
    double slope = 0;
    curvature = 0;
    for (const BoundedRow& r : rows()) {
        const double way = r.solved - r.rate, change = r.mu - r.held;
        double fall;
        slope += (r.held + t * change - law(r, r.rate + t * way, fall)) * way;
        curvature += (change + fall * way) * way;
    }
    return slope;
}

// The part of the way where the energy is least: slopes rise along it, in straight pieces.
double ActiveSet::least_energy(double start) const {
    constexpr int kTries = 30;
    constexpr double kFlat = 1e-3;  // of the slope at the start
    double t = 1, low = 0, high = 1;
    for (int i = 0; i < kTries; ++i) {
        double curvature;
        const double slope = slope_of_energy(t, curvature);
        if (std::abs(slope) <= kFlat * std::abs(start) || (t == 1 && slope <= 0)) break;
        (slope > 0 ? high : low) = t;
        const double next = t - slope / curvature;
        t = next > low && next < high ? next : 0.5 * (low + high);
    }
    return t;
}

// Energy that a round may leave where it is [J].
double ActiveSet::negligible() const {
    double least = 1e300, fastest = 0;
    for (uint32_t node : b_.nodes) {
        least = std::min(least, s_.nodes.mass[node].mass);
        fastest = std::max(fastest, sys_.start[sys_.at(node)].v.squaredNorm());
    }
    return least * (kSettledAtRest * sys_.scheme.h * sys_.scheme.h * s_.settings.gravity_squared + kSettled * fastest);
}

void ActiveSet::begin_rounds() {
    for (BoundedRow& r : rows()) r.short_rate = r.short_mu = 0;
}

double ActiveSet::advance(bool first) {
    double t = 1, curvature;
    for (BoundedRow& r : rows()) r.solved = speed(r, sys_.exact);
    settled_ = false;
    if (!first) {
        const double start = slope_of_energy(0, curvature);
        settled_ = std::abs(start) <= negligible();
        t = least_energy(start);
    }
    for (BoundedRow& r : rows()) {
        r.rate = t == 1 ? r.solved : r.rate + t * (r.solved - r.rate);
        r.held = t == 1 ? r.mu : r.held + t * (r.mu - r.held);
    }
    return t;
}

void ActiveSet::stop_short() {
    for (BoundedRow& r : rows()) {
        r.short_rate = r.rate - r.solved;
        r.short_mu = r.held - r.mu;
        r.mu = r.held;
    }
}

}  // namespace taut
