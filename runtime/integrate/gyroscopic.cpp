#include "integrate/gyroscopic.h"

#include <cmath>

#include <Eigen/LU>

namespace taut {
namespace {

// A vector in three registers. Eigen loads and stores the first two numbers of a Vec3 together, and chains like these
// then wait for memory at every step (measured: twice as long).
struct Triple {
    double x, y, z;

    explicit Triple(const Vec3& v) : x(v.x()), y(v.y()), z(v.z()) {}
    Triple(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    Vec3 vector() const { return {x, y, z}; }
};
Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Triple operator*(double s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Triple cross(const Triple& a, const Triple& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Triple operator*(const Sym3& s, const Triple& a) {
    return {s.xx * a.x + s.xy * a.y + s.xz * a.z, s.xy * a.x + s.yy * a.y + s.yz * a.z,
            s.xz * a.x + s.yz * a.y + s.zz * a.z};
}

// x of [c0 c1 c2] x = r, by Cramer's rule.
Triple solve(const Triple& c0, const Triple& c1, const Triple& c2, const Triple& r) {
    const Triple across = cross(c1, c2);
    const double scale = 1 / dot(c0, across);
    return {scale * dot(r, across), scale * dot(c0, cross(r, c2)), scale * dot(c0, cross(c1, r))};
}

// F(w) = I (w - w0) + h m x I m with m = (w + w0)/2, for any inertia ...
struct FullInertia {
    const Sym3 &i, &inverse;

    Triple times(const Triple& w) const { return i * w; }
    Triple undo(const Triple& l) const { return inverse * l; }
    // d of dF/dw d = -F, where l = I m; dF/dw e = I e + h/2 (m x I e + e x l).
    Triple newton_step(const Triple& m, const Triple& l, double h, const Triple& f) const {
        const auto column = [&](const Triple& own, const Triple& unit_cross_l) {
            return own + 0.5 * h * (cross(m, own) + unit_cross_l);
        };
        return solve(column({i.xx, i.xy, i.xz}, {0, -l.z, l.y}), column({i.xy, i.yy, i.yz}, {l.z, 0, -l.x}),
                     column({i.xz, i.yz, i.zz}, {-l.y, l.x, 0}), -1 * f);
    }
};

// ... and for one in principal axes, where m x I m = (m2 m3 (I3 - I2), ...).
struct PrincipalInertia {
    Triple i, inverse;

    Triple times(const Triple& w) const { return {i.x * w.x, i.y * w.y, i.z * w.z}; }
    Triple undo(const Triple& l) const { return {inverse.x * l.x, inverse.y * l.y, inverse.z * l.z}; }
    Triple newton_step(const Triple& m, const Triple&, double h, const Triple& f) const {
        const Triple k = 0.5 * h * Triple(i.z - i.y, i.x - i.z, i.y - i.x);
        return solve({i.x, k.y * m.z, k.z * m.y}, {k.x * m.z, i.y, k.z * m.x}, {k.x * m.y, k.y * m.x, i.z}, -1 * f);
    }
};

// In body axes, where the inertia is constant; the explicit form spins thin bodies up.
// Implicit midpoint, F(w) = 0, keeps w.I w and |I w| as they are. F is quadratic: what a Newton step d leaves of it is
// h/4 d x I d. Three steps solve it where a substep turns the body by less than a radian or so. For slow bodies, two
// steps d = -I^-1 F do, of which each leaves h/2 (d x l + m x I d) + h/4 d x I d, with l = I m.
template <class Inertia>
bool gyroscopic_midpoint(const Triple& w0, const Inertia& inertia, double h, Triple& w) {
    constexpr double kSolved = 1e-10, kGood = 1e-6, kSlow = 1e-4;  // of I w0
    const Triple l0 = inertia.times(w0);
    const double scale = dot(l0, l0);
    w = w0;
    Triple m = w0, l = l0, residual = h * cross(w0, l0);
    const auto solved = [&] { return dot(residual, residual) <= kSolved * kSolved * scale; };
    const bool slow = dot(residual, residual) <= kSlow * kSlow * scale;
    for (int step = 0; step < 2 && slow && !solved(); ++step) {
        const Triple d = -1 * inertia.undo(residual), ld = -1 * residual;
        residual = 0.5 * h * (cross(d, l + 0.5 * ld) + cross(m, ld));
        w = w + d;
        m = m + 0.5 * d;
        l = l + 0.5 * ld;
    }
    for (int step = 0; step < 3 && !solved(); ++step) {
        const Triple d = inertia.newton_step(m, l, h, residual), ld = inertia.times(d);
        w = w + d;
        m = m + 0.5 * d;
        l = l + 0.5 * ld;
        residual = 0.25 * h * cross(d, ld);
    }
    return dot(residual, residual) <= kGood * kGood * scale;
}

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

Vec3 gyroscopic(const Vec3& w0, const NodeMass& mass, double h, bool damped) {
    const Sym3 &i = mass.inertia, &inverse = mass.inv_inertia;
    if (!damped) {
        Triple w(w0);
        const bool principal = i.xy == 0 && i.xz == 0 && i.yz == 0;
        const bool solved =
            principal
                ? gyroscopic_midpoint(Triple(w0),
                                      PrincipalInertia{{i.xx, i.yy, i.zz}, {inverse.xx, inverse.yy, inverse.zz}}, h, w)
                : gyroscopic_midpoint(Triple(w0), FullInertia{i, inverse}, h, w);
        if (solved) return w.vector();
    }
    return gyroscopic_euler(w0, i.matrix(), h, damped);
}

}  // namespace taut
