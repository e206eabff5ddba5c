// Impulses of impacts that happen at once; see restitution.h.
#include <algorithm>
#include <cmath>
#include <span>

#include "solvers/restitution.h"

namespace taut {
namespace {

constexpr int kMostSweeps = 40, kFrictionSweeps = 3;
constexpr int kPressSweeps = 4;       // as many for all, so that no cluster feels another
constexpr double kCompressed = 1e-4;  // compression ends where a sweep changes no rate by this share of an approach

double rate(const Impact& impact, int row, const Array<ImpactBody>& bodies) {
    double sum = impact.known[row];
    for (const Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
        if (side->body == kNone) continue;
        sum += side->rate(row, bodies[side->body].u);
    }
    return sum;
}

void push(Impact& impact, int row, double impulse, Array<ImpactBody>& bodies) {
    impact.impulse[row] += impulse;
    for (Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
        if (side->body == kNone) continue;
        ImpactBody& body = bodies[side->body];
        const Vec3 dv = impulse * side->response[row].v;
        body.u.v += dv;
        body.u.w += impulse * side->response[row].w;
        body.moved -= body.moves * impact.time * dv;
    }
}

class Cluster {
public:
    Cluster(std::span<Impact> impacts, Array<ImpactBody>& bodies) : impacts_(impacts), bodies_(bodies) {}

    void solve() {
        compress(kMostSweeps, false);
        expand();
        for (int i = 0; i < kFrictionSweeps; ++i) rub();
    }

    // Projected Gauss-Seidel: each step takes energy.
    void compress(int most, bool supports_only) {
        double fastest = 0;
        for (const Impact& impact : impacts_) fastest = std::max(fastest, -impact.approach);
        double change = fastest;
        for (int sweep = 0; sweep < most && change > kCompressed * fastest; ++sweep) {
            change = 0;
            for (Impact& impact : impacts_) {
                if ((supports_only && !impact.supports) || !(impact.k > 0)) continue;
                const double step = std::max(-impact.impulse[0], -rate(impact, 0, bodies_) / impact.k);
                push(impact, 0, step, bodies_);
                change = std::max(change, impact.k * std::abs(step));
            }
            if (impacts_.size() == 1) break;
        }
    }

private:
    // Restitution times the impulse of compression, as supports hold. Of a part f of it the energy is f A + f^2 B.
    void expand() {
        double taken = 0, most = 0, linear = 0, square = 0;
        bool supported = false;
        for (Impact& impact : impacts_) {
            impact.stopped = rate(impact, 0, bodies_);
            impact.spent = impact.impulse[0];
            taken -= 0.5 * impact.spent * (impact.approach + impact.stopped);
            most = std::max(most, impact.restitution);
            supported = supported || impact.supports;
        }
        for (Impact& impact : impacts_) push(impact, 0, impact.restitution * impact.spent, bodies_);
        if (supported) compress(kMostSweeps, true);
        for (const Impact& impact : impacts_) {
            const double given = impact.impulse[0] - impact.spent;
            linear += given * impact.stopped;
            square += 0.5 * given * (rate(impact, 0, bodies_) - impact.stopped);
        }
        const double budget = most * most * std::max(0.0, taken);
        if (linear + square <= budget) return;
        const double part = (std::sqrt(linear * linear + 4 * square * budget) - linear) / (2 * square);
        if (!(part < 1)) return;
        for (Impact& impact : impacts_) push(impact, 0, (part - 1) * (impact.impulse[0] - impact.spent), bodies_);
    }

    // Coulomb's cone; with the larger eigenvalue each step takes energy.
    void rub() {
        for (Impact& impact : impacts_) {
            const double limit = impact.friction * impact.impulse[0];
            if (!(limit > 0 && impact.k_across > 0)) continue;
            double q[2];
            for (int t = 0; t < 2; ++t)
                q[t] = impact.impulse[1 + t] - (rate(impact, 1 + t, bodies_) - impact.drive[t]) / impact.k_across;
            const double size = hypotenuse(q[0], q[1]), part = size > limit ? limit / size : 1;
            for (int t = 0; t < 2; ++t) push(impact, 1 + t, part * q[t] - impact.impulse[1 + t], bodies_);
        }
    }

    std::span<Impact> impacts_;
    Array<ImpactBody>& bodies_;
};

}  // namespace

void solve_impacts(std::span<Impact> impacts, Array<ImpactBody>& bodies) { Cluster(impacts, bodies).solve(); }

void press_impacts(std::span<Impact> impacts, Array<ImpactBody>& bodies) {
    Cluster(impacts, bodies).compress(kPressSweeps, false);
}

}  // namespace taut
