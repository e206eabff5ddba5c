// Angles in lanes (simd/lanes.h).
#pragma once

namespace taut {

// atan2(y, x), 0 at the origin; within 3e-7. atan t = pi/4 + atan((t - 1)/(t + 1)) leaves |t| <= tan(pi/8), for which
// the polynomial is that of Moshier's Cephes library (atanf.c).
template <class F>
F angle_of(const F& y, const F& x) {
    const F zero = F::all(0), tiny = F::all(1e-30f);
    const F ax = F::max(x, zero - x), ay = F::max(y, zero - y);
    const F large = F::max(ax, ay), small = F::if_greater(ay, ax, ax, ay), limit = F::all(0.41421356f) * large;
    const F over = F::if_greater(small, limit, small - large, small);
    const F under = F::if_greater(small, limit, small + large, large);
    const F t = over / F::max(under, tiny), z = t * t;
    F sum = F::all(8.05374449538e-2f) * z - F::all(1.38776856032e-1f);
    sum = (sum * z + F::all(1.99777106478e-1f)) * z - F::all(3.33329491539e-1f);
    F angle = F::if_greater(small, limit, F::all(0.78539816f), zero) + (sum * z * t + t);
    angle = F::if_greater(ay, ax, F::all(1.57079633f) - angle, angle);
    angle = F::if_greater(zero, x, F::all(3.14159265f) - angle, angle);
    return F::if_greater(zero, y, zero - angle, angle);
}

}  // namespace taut
