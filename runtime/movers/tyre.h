// A tyre in the plane of its contact: bristles that the slip bends, after the single contact point model of transient
// tyres (Pacejka, Tire and Vehicle Dynamics, chapter 7). With v the velocity at which the contact slides, V that at
// which it goes or rolls, and s the length of relaxation,
//
//     dz/dt = v - V z / s        so that z -> s v / V = s times slip, and z = sum of v dt where nothing goes
//     F = -k (z + t dz/dt)       k: the secant of the friction curve at the slip z / s
//
// where damping by the time t fades as V grows. Implicit Euler makes of a frame h
//
//     z+ = a (z + h v+),   F = -k a (b z + (h + t') v+),   a = 1 / (1 + h V / s),   t' = t b,   b = 1 / (1 + t V / s)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace taut {

using Slip = std::array<double, 2>;  // along the wheel, across it

struct Tyre {
    double peak = 0, sliding = 0;       // coefficients of friction
    std::array<double, 2> peak_slip{};  // [1]
    double relaxation = 0;              // [m]

    double bend_of(const Slip& z, size_t axis) const {  // squared
        const double bend = z[axis] / (peak_slip[axis] * relaxation);
        return bend * bend;
    }
    // Share of the load that bristles bent by z give as friction, over their bend in parts of that at the peak.
    double secant(const Slip& z) const {
        const double bend = std::sqrt(bend_of(z, 0) + bend_of(z, 1));
        const double shape = 2 / (1 + bend * bend);
        // Beyond the peak it falls to the sliding friction.
        return bend <= 1 ? peak * shape : (sliding + (peak - sliding) * shape * bend) / bend;
    }
    // [1/m]: stiffness over load.
    double stiffness(const Slip& z, size_t axis) const { return secant(z) / (peak_slip[axis] * relaxation); }
    // Time by which bristles that stand are damped: half critically for the mass that the load is the weight of [s].
    double damping(size_t axis, double gravity) const {
        const double rate = 2 * peak * gravity / (peak_slip[axis] * relaxation);  // k / m [1/s^2]
        return rate > 0 ? 1 / std::sqrt(rate) : 0.0;
    }
};

// One frame of a tyre.
struct TyreFrame {
    double seconds = 0, going = 0;            // V [m/s]
    double keep = 1;                          // a
    std::array<double, 2> fade{1, 1}, lag{};  // b, h + t'

    TyreFrame() = default;
    TyreFrame(const Tyre& tyre, double seconds_, double going_, double gravity) : seconds(seconds_), going(going_) {
        keep = 1 / (1 + seconds * going / tyre.relaxation);
        for (size_t axis = 0; axis < 2; ++axis) {
            const double time = tyre.damping(axis, gravity);
            fade[axis] = 1 / (1 + time * going / tyre.relaxation);
            lag[axis] = seconds + time * fade[axis];
        }
    }
    double bent(double z, double v) const { return keep * (z + seconds * v); }
};

}  // namespace taut
