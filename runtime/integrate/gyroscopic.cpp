#include "integrate/gyroscopic.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace taut {
namespace {

constexpr double kSolved = 1e-10, kGood = 1e-6;  // of I w0

// A number of each body.
typedef double Pair __attribute__((vector_size(kSpins * sizeof(double))));

struct Triple {
    Pair x, y, z;
};
Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Triple operator*(double s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
Triple operator*(const Pair& s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
Pair dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Triple cross(const Triple& a, const Triple& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Inertia {
    Pair xx, yy, zz, xy, xz, yz;

    Triple operator*(const Triple& a) const {
        return {xx * a.x + xy * a.y + xz * a.z, xy * a.x + yy * a.y + yz * a.z, xz * a.x + yz * a.y + zz * a.z};
    }
};

// x of [c0 c1 c2] x = r, by Cramer's rule.
Triple solve(const Triple& c0, const Triple& c1, const Triple& c2, const Triple& r) {
    const Triple across = cross(c1, c2);
    const Pair scale = 1 / dot(c0, across);
    return {scale * dot(r, across), scale * dot(c0, cross(r, c2)), scale * dot(c0, cross(c1, r))};
}

// F(w) = I (w - w0) + h m x I m with m = (w + w0)/2, in body axes, where the inertia is constant; the explicit form
// spins thin bodies up. Implicit midpoint, F(w) = 0, keeps w.I w and |I w| as they are. F is quadratic: what a Newton
// step d leaves of it is h/4 d x I d. Three steps solve it where a substep turns the body by less than a radian or so.
struct Midpoint {
    Triple w;
    Pair left, scale;  // |F|^2 and |I w0|^2

    Midpoint(const Triple& w0, const Inertia& i, double h) : w(w0) {
        Triple m = w0, l = i * w0, f = h * cross(w0, l);
        scale = dot(l, l);
        left = dot(f, f);
        for (int step = 0; step < 3; ++step) {
            // A body that is solved stays as it is, so that it does not depend on the one beside it.
            const Pair asks = {is_within(kSolved, 0) ? 0.0 : 1.0, is_within(kSolved, 1) ? 0.0 : 1.0};
            if (asks[0] + asks[1] == 0) break;
            const Triple d = (-asks) * newton_step(m, l, i, h, f), ld = i * d;
            w = w + d;
            m = m + 0.5 * d;
            l = l + 0.5 * ld;
            f = (1 - asks) * f + asks * (0.25 * h * cross(d, ld));
            left = dot(f, f);
        }
    }
    bool is_within(double part, size_t k) const { return left[k] <= part * part * scale[k]; }

private:
    // (dF/dw)^-1 f, where l = I m; dF/dw e = I e + h/2 (m x I e + e x l).
    static Triple newton_step(const Triple& m, const Triple& l, const Inertia& i, double h, const Triple& f) {
        const Pair none = {};
        const auto column = [&](const Triple& own, const Triple& unit_cross_l) {
            return own + 0.5 * h * (cross(m, own) + unit_cross_l);
        };
        return solve(column({i.xx, i.xy, i.xz}, {none, -l.z, l.y}), column({i.xy, i.yy, i.yz}, {l.z, none, -l.x}),
                     column({i.xz, i.yz, i.zz}, {-l.y, l.x, none}), f);
    }
};

// One Newton step of implicit Euler, I (w - w0) + h w x I w = 0: damps, but goes astray where a substep turns the body
// by radians (measured: a plate at 1000 rad/s gained 9400 times its energy). So w.I w does not rise, and of a body that
// is to keep it |I w| does not fall further than that asks.
Vec3 gyroscopic_euler(const Vec3& w0, const Mat3& inertia, double h, bool damped) {
    const Vec3 l0 = inertia * w0;
    const Mat3 derivative = inertia + h * (hat(w0) * inertia - hat(l0));
    const Vec3 w = w0 - derivative.inverse() * (h * w0.cross(l0)), l = inertia * w;
    const double before = w0.dot(l0), after = w.dot(l), scale = damped ? 1 : std::sqrt(l0.dot(l0) / l.dot(l));
    return (scale * scale * after > before ? std::sqrt(before / after) : scale) * w;
}

}  // namespace

void gyroscopic(std::span<FreeSpin> spins, double h) {
    const FreeSpin &a = spins.front(), &b = spins.back();
    const Sym3 &ia = a.mass->inertia, &ib = b.mass->inertia;
    const Triple w0 = {{a.w.x(), b.w.x()}, {a.w.y(), b.w.y()}, {a.w.z(), b.w.z()}};
    const Inertia inertia = {{ia.xx, ib.xx}, {ia.yy, ib.yy}, {ia.zz, ib.zz},
                             {ia.xy, ib.xy}, {ia.xz, ib.xz}, {ia.yz, ib.yz}};
    const Midpoint found(w0, inertia, h);
    for (size_t k = 0; k < spins.size(); ++k) {
        FreeSpin& spin = spins[k];
        if (spin.damped || !found.is_within(kGood, k))
            spin.w = gyroscopic_euler(spin.w, spin.mass->inertia.matrix(), h, spin.damped);
        else
            spin.w = {found.w.x[k], found.w.y[k], found.w.z[k]};
    }
}

}  // namespace taut
