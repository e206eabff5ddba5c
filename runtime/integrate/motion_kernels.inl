// The motion kernels, in vectors of four doubles. Included by one file for each build; nothing here has a name outside
// of it. Only IEEE operations, no fused multiply-add, in one order.
#pragma once

#include "integrate/motion_kernels.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed within one build alone

namespace taut {
namespace {

typedef double Four __attribute__((vector_size(kBodies * sizeof(double))));
typedef float FourFloats __attribute__((vector_size(kBodies * sizeof(float))));
constexpr Bodies kEach = (1u << kBodies) - 1;
using Mask = decltype(Four{} < Four{});

Four all(double x) { return Four{x, x, x, x}; }
Four load(const double* p) {
    Four f;
    __builtin_memcpy(&f, p, sizeof f);
    return f;
}
void store(const Four& f, double* p) { __builtin_memcpy(p, &f, sizeof f); }

Bodies bodies(const Mask& mask) {
    Bodies bits = 0;
    for (int i = 0; i < kBodies; ++i) bits |= static_cast<Bodies>(mask[i] != 0) << i;
    return bits;
}
Mask mask(Bodies bodies) { return (Mask{1, 2, 4, 8} & static_cast<long long>(bodies)) != 0; }

// Rows to columns and back.
void transpose(Four (&m)[4]) {
    const Four a = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6), b = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
    const Four c = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6), d = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
    m[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    m[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    m[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    m[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
void transpose(FourFloats (&m)[4]) {
    const FourFloats a = __builtin_shufflevector(m[0], m[1], 0, 4, 1, 5),
                     b = __builtin_shufflevector(m[0], m[1], 2, 6, 3, 7);
    const FourFloats c = __builtin_shufflevector(m[2], m[3], 0, 4, 1, 5),
                     d = __builtin_shufflevector(m[2], m[3], 2, 6, 3, 7);
    m[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    m[1] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    m[2] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    m[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

double* numbers(MotionRow& row) { return row.x; }
const double* numbers(const MotionRow& row) { return row.x; }
double* numbers(PoseRow& row) { return row.x; }
const double* numbers(const PoseRow& row) { return row.x; }
double* numbers(PairRow& row) { return row.linear; }
const double* numbers(const PairRow& row) { return row.linear; }
const double* numbers(const FoundRow& row) { return row.x; }
const double* numbers(const MassRow& row) { return &row.mass; }

// Four numbers of each row, from the one at `at` on.
struct Columns {
    Four of[4];

    template <class Row>
    Columns(Row* rows, const uint32_t (&which)[kBodies], int at) {
        for (int i = 0; i < kBodies; ++i) of[i] = load(numbers(rows[which[i]]) + at);
        transpose(of);
    }
    Columns(const MassRow* const mass[kBodies], int at) {
        for (int i = 0; i < kBodies; ++i) of[i] = load(numbers(*mass[i]) + at);
        transpose(of);
    }
    Columns(const Four& a, const Four& b, const Four& c, const Four& d) : of{a, b, c, d} {}

    template <class Row>
    void put(Row* rows, const uint32_t (&which)[kBodies], int at) {
        transpose(of);
        for (int i = 0; i < kBodies; ++i) store(of[i], numbers(rows[which[i]]) + at);
    }
};

struct Vector {
    Four x, y, z;
};
Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(const Four& s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
Four dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector choose(const Mask& mask, const Vector& yes, const Vector& no) {
    return {mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z};
}

struct Quaternion {
    Four x, y, z, w;

    Vector vector() const { return {x, y, z}; }
    Quaternion conjugate() const { return {-x, -y, -z, w}; }
};
Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {(a.w * b.x + a.y * b.z) - (a.z * b.y - a.x * b.w), (a.w * b.y + a.y * b.w) + (a.z * b.x - a.x * b.z),
            (a.w * b.z - a.y * b.x) + (a.z * b.w + a.x * b.y), (a.w * b.w - a.y * b.y) - (a.z * b.z + a.x * b.x)};
}
Vector rotated(const Quaternion& q, const Vector& a) {
    Vector t = cross(q.vector(), a);
    t = t + t;
    return a + q.w * t + cross(q.vector(), t);
}

struct Rotation {
    Vector column[3];

    explicit Rotation(const Quaternion& q) {
        const Four tx = 2 * q.x, ty = 2 * q.y, tz = 2 * q.z, wx = tx * q.w, wy = ty * q.w, wz = tz * q.w;
        const Four xx = tx * q.x, xy = ty * q.x, xz = tz * q.x, yy = ty * q.y, yz = tz * q.y, zz = tz * q.z;
        column[0] = {1 - (yy + zz), xy + wz, xz - wy};
        column[1] = {xy - wz, 1 - (xx + zz), yz + wx};
        column[2] = {xz + wy, yz - wx, 1 - (xx + yy)};
    }
    Rotation(const PoseRow* rows, const Batch& batch) {
        const Columns a(rows, batch.seat, 3), b(rows, batch.seat, 7), c(rows, batch.seat, 8);
        column[0] = {a.of[0], a.of[1], a.of[2]};
        column[1] = {a.of[3], b.of[0], b.of[1]};
        column[2] = {b.of[2], b.of[3], c.of[3]};
    }
    // Summed as Eigen sums R a.
    Vector operator*(const Vector& a) const {
        const Vector x = a.x * column[0], y = a.y * column[1], z = a.z * column[2];
        return {x.x + y.x + z.x, x.y + y.y + z.y, x.z + (y.z + z.z)};
    }
    Vector back(const Vector& a) const { return {dot(column[0], a), dot(column[1], a), dot(column[2], a)}; }
};

struct Motion {
    Columns x, q, v, w;  // x, pad; q; v, w.x; w.y, w.z, slow_v.x, slow_v.y

    Motion(const MotionRow* rows, const Batch& batch)
        : x(rows, batch.motion, 0), q(rows, batch.motion, 4), v(rows, batch.motion, 8), w(rows, batch.motion, 12) {}
    Vector place() const { return {x.of[0], x.of[1], x.of[2]}; }
    Quaternion turn() const { return {q.of[0], q.of[1], q.of[2], q.of[3]}; }
    Vector velocity() const { return {v.of[0], v.of[1], v.of[2]}; }
    Vector spin() const { return {v.of[3], w.of[0], w.of[1]}; }
};

struct Found {
    Columns x, q;

    Found(const FoundRow* rows, const Batch& batch) : x(rows, batch.seat, 0), q(rows, batch.seat, 4) {}
    Vector to(const Vector& now) const { return now - Vector{x.of[0], x.of[1], x.of[2]}; }
    Quaternion to(const Quaternion& now) const {
        return now * Quaternion{q.of[0], q.of[1], q.of[2], q.of[3]}.conjugate();
    }
};

struct Velocities {
    Vector v, w;

    Velocities(const Vector& linear, const Vector& angular) : v(linear), w(angular) {}
    Velocities(const PairRow* rows, const uint32_t (&which)[kBodies]) {
        const Columns a(rows, which, 0), b(rows, which, 2);
        v = {a.of[0], a.of[1], a.of[2]};
        w = {a.of[3], b.of[2], b.of[3]};
    }
    void put(PairRow* rows, const uint32_t (&which)[kBodies]) const {
        Columns(v.x, v.y, v.z, w.x).put(rows, which, 0);
        Columns(v.z, w.x, w.y, w.z).put(rows, which, 2);
    }
};

struct Floats {
    FourFloats of[4];

    explicit Floats(const Vector& a) : of{narrow(a.x), narrow(a.y), narrow(a.z), {}} {}
    Floats(const Vector& a, const Four& last) : of{narrow(a.x), narrow(a.y), narrow(a.z), narrow(last)} {}
    explicit Floats(const Quaternion& q) : of{narrow(q.x), narrow(q.y), narrow(q.z), narrow(q.w)} {}
    void put(FloatRow* const (&row)[kBodies], float (FloatRow::*half)[4]) {
        transpose(of);
        for (int i = 0; i < kBodies; ++i) __builtin_memcpy(row[i]->*half, &of[i], sizeof of[i]);
    }

private:
    static FourFloats narrow(const Four& x) { return __builtin_convertvector(x, FourFloats); }
};

// Inlined, or the vectors go by memory: a call here made commit() three times as slow.
template <class Linear, class Angular>
[[gnu::always_inline]] inline void put_floats(const Linear& linear, const Angular& angular,
                                              FloatRow* const (&row)[kBodies]) {
    Floats(linear).put(row, &FloatRow::linear);
    Floats(angular).put(row, &FloatRow::angular);
}
template <class Linear>
[[gnu::always_inline]] inline void put_floats(const Linear& linear, const Quaternion& angular, FloatRow* rows,
                                              const Batch& batch) {
    FloatRow* const row[kBodies] = {&rows[batch.seat[0]], &rows[batch.seat[1]], &rows[batch.seat[2]],
                                    &rows[batch.seat[3]]};
    put_floats(linear, angular, row);
}

struct Inertia {
    Four xx, yy, zz, xy, xz, yz;

    Vector operator*(const Vector& a) const {
        return {xx * a.x + xy * a.y + xz * a.z, xy * a.x + yy * a.y + yz * a.z, xz * a.x + yz * a.y + zz * a.z};
    }
};

// x of [c0 c1 c2] x = r, by Cramer's rule.
Vector solve(const Vector& c0, const Vector& c1, const Vector& c2, const Vector& r) {
    const Vector across = cross(c1, c2);
    const Four scale = 1 / dot(c0, across);
    return {scale * dot(r, across), scale * dot(c0, cross(r, c2)), scale * dot(c0, cross(c1, r))};
}

// (dF/dw)^-1 f of F(w) = I (w - w0) + h m x I m, where l = I m; dF/dw e = I e + h/2 (m x I e + e x l).
Vector newton_step(const Vector& m, const Vector& l, const Inertia& i, const Four& h, const Vector& f) {
    const Four none = {}, half = 0.5 * h;
    const auto column = [&](const Vector& own, const Vector& unit_cross_l) {
        return own + half * (cross(m, own) + unit_cross_l);
    };
    return solve(column({i.xx, i.xy, i.xz}, {none, -l.z, l.y}), column({i.xy, i.yy, i.yz}, {l.z, none, -l.x}),
                 column({i.xz, i.yz, i.zz}, {-l.y, l.x, none}), f);
}

// The step of the midpoint rule that turns a body as exp(h m) does, 2 tan(h |w| / 2) / |w| by its series, so that what
// the rule keeps in body axes stays in the world too. Beyond two radians it is that of two.
Four rule_step(const Vector& w, double h) {
    const Four squared = all(h * h) * dot(w, w), t = squared < all(4) ? squared : all(4);
    return h * (1 + t * (1.0 / 12 + t * (1.0 / 120 + t * (17.0 / 20160))));
}

// The explicit form spins thin bodies up; this one keeps w.I w and |I w| as they are. F is quadratic: what a Newton
// step d leaves of it is h/4 d x I d. Three steps solve it where a substep turns the body by less than a radian or so.
Bodies turn_freely(Vector& w, const Inertia& i, double substep) {
    constexpr double kSolved = 1e-10, kGood = 1e-6;  // of I w0
    const Four h = rule_step(w, substep);
    Vector m = w, l = i * w, f = h * cross(w, l);
    const Four scale = dot(l, l), one = all(1), zero = {};
    Four left = dot(f, f);
    for (int step = 0; step < 3; ++step) {
        // A body that is solved stays as it is, so that it does not depend on those beside it.
        const Mask asks = ~(left <= kSolved * kSolved * scale);
        if (bodies(asks) == 0) break;
        const Four takes = asks ? one : zero;
        const Vector d = (-takes) * newton_step(m, l, i, h, f), ld = i * d;
        w = w + d;
        m = m + all(0.5) * d;
        l = l + all(0.5) * ld;
        f = (1 - takes) * f + takes * (0.25 * h * cross(d, ld));
        left = dot(f, f);
    }
    return bodies(left <= kGood * kGood * scale);
}

// Of some bodies alone.
void damp(Vector& w, const Vector& w0, const Inertia& inertia, Bodies some, Bodies damped, const Prediction& terms) {
    for (int k = 0; k < kBodies; ++k) {
        if ((some >> k & 1) == 0) continue;
        const double i[6] = {inertia.xx[k], inertia.yy[k], inertia.zz[k], inertia.xy[k], inertia.xz[k], inertia.yz[k]};
        double spin[3] = {w0.x[k], w0.y[k], w0.z[k]};
        terms.damp(spin, i, terms.h, (damped >> k & 1) != 0);
        w.x[k] = spin[0], w.y[k] = spin[1], w.z[k] = spin[2];
    }
}

Bodies predict(const NodeRows& rows, const Batch& batch, const MassRow* const mass[kBodies], const Prediction& terms,
               Bodies turning, Bodies damped) {
    const Motion m(rows.motion, batch);
    const Columns masses(mass, 0), inertias(mass, 4), last(mass, 14);
    const Quaternion q = m.turn();
    const Rotation R(q);
    Columns(m.x.of[0], m.x.of[1], m.x.of[2], R.column[0].x).put(rows.pose, batch.seat, 0);
    Columns(R.column[0].y, R.column[0].z, R.column[1].x, R.column[1].y).put(rows.pose, batch.seat, 4);
    Columns(R.column[1].z, R.column[2].x, R.column[2].y, R.column[2].z).put(rows.pose, batch.seat, 8);
    Vector a = last.of[3] * Vector{all(terms.gravity[0]), all(terms.gravity[1]), all(terms.gravity[2])};
    if (rows.load) a = a + masses.of[1] * Velocities(rows.load, batch.node).v;
    Velocities u(m.velocity() + all(terms.h) * a, m.spin());
    if (turning != 0) {
        const Inertia inertia = {masses.of[2],   masses.of[3],   inertias.of[0],
                                 inertias.of[1], inertias.of[2], inertias.of[3]};
        const Vector before = R.back(u.w);
        Vector w = before;
        const Bodies others = turning & (damped | ~turn_freely(w, inertia, terms.h));
        if (others != 0) damp(w, before, inertia, others, damped, terms);
        const Vector change = R * (w - before);
        u.w = choose(mask(turning), u.w + (mask(damped) ? all(1) : all(0.5)) * change, u.w);
    }
    Velocities(m.velocity(), u.w).put(rows.start, batch.seat);
    u.put(rows.velocity, batch.seat);
    const Vector none = {};  // sweeps want no -0
    FloatRow* const sweep[kBodies] = {&rows.sweep[batch.seat[0]].velocity, &rows.sweep[batch.seat[1]].velocity,
                                      &rows.sweep[batch.seat[2]].velocity, &rows.sweep[batch.seat[3]].velocity};
    Floats(u.v + none, masses.of[1]).put(sweep, &FloatRow::linear);
    Floats(u.w + none, masses.of[1]).put(sweep, &FloatRow::angular);
    const Found found(rows.found, batch);
    const Vector moved = found.to(m.place());
    if (rows.sweep_pose) put_floats(Quaternion{moved.x, moved.y, moved.z, masses.of[1]}, q, rows.sweep_pose, batch);
    const Vector away = found.to(q).vector();
    return bodies(dot(away, away) > 0.25 * terms.turn * terms.turn);
}

// exp(theta) of some, by rotate.
[[gnu::noinline]] void rotate_each(double (&q)[4][kBodies], const double (&theta)[3][kBodies], Bodies some,
                                   Rotate rotate) {
    for (int i = 0; i < kBodies; ++i) {
        if ((some >> i & 1) == 0) continue;
        const double turn[3] = {theta[0][i], theta[1][i], theta[2][i]};
        double out[4];
        rotate(turn, out);
        for (int k = 0; k < 4; ++k) q[k][i] = out[k];
    }
}

// exp(theta): of turns below half a radian, which most are, a series in the square of half the angle y <= 1/16. What it
// leaves out is less than 2e-17.
Quaternion rotation_of(const Vector& theta, Rotate rotate) {
    const Four squared = dot(theta, theta), y = 0.25 * squared;
    const Four k =
        1.0 + y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * (1.0 / 362880 - y * (1.0 / 39916800)))));
    const Four c =
        1.0 + y * (-1.0 / 2 + y * (1.0 / 24 + y * (-1.0 / 720 +
                                                   y * (1.0 / 40320 + y * (-1.0 / 3628800 + y * (1.0 / 479001600))))));
    const Quaternion q = {0.5 * k * theta.x, 0.5 * k * theta.y, 0.5 * k * theta.z, c};
    const Bodies large = bodies(~(squared <= all(0.25)));
    if (large == 0) return q;
    double each[4][kBodies], turns[3][kBodies];
    store(q.x, each[0]), store(q.y, each[1]), store(q.z, each[2]), store(q.w, each[3]);
    store(theta.x, turns[0]), store(theta.y, turns[1]), store(theta.z, turns[2]);
    rotate_each(each, turns, large, rotate);
    return {load(each[0]), load(each[1]), load(each[2]), load(each[3])};
}

void commit(const NodeRows& rows, const Batch& batch, double h, Rotate rotate) {
    const Velocities u(rows.velocity, batch.seat);
    const Columns place(rows.motion, batch.motion, 0), turn(rows.motion, batch.motion, 4);
    const Vector x = Vector{place.of[0], place.of[1], place.of[2]} + all(h) * u.v;
    Quaternion q = rotation_of(all(h) * u.w, rotate) * Quaternion{turn.of[0], turn.of[1], turn.of[2], turn.of[3]};
    // Of a product of unit quaternions, where |q|^2 - 1 = e is some rounding: one Newton step leaves 3/8 e^2.
    const Four unit = 1.5 - 0.5 * ((q.x * q.x + q.z * q.z) + (q.y * q.y + q.w * q.w));
    q = {q.x * unit, q.y * unit, q.z * unit, q.w * unit};
    Columns(x.x, x.y, x.z, place.of[3]).put(rows.motion, batch.motion, 0);
    Columns(q.x, q.y, q.z, q.w).put(rows.motion, batch.motion, 4);
    const Found found(rows.found, batch);
    put_floats(found.to(x), found.to(q), rows.shift, batch);
}

Mask finite(const Four& x) { return x - x == all(0); }

Four root(const Four& x) {
    double each[kBodies];
    store(x, each);
    for (double& one : each) one = __builtin_sqrt(one);
    return load(each);
}

// Where I w is nearest to l of all w with w . I w <= most: w = (I + mu)^-1 l, mu by Newton's iteration on 1 / |w|_I,
// which is nearly straight in it (More and Sorensen, Computing a trust region step, 1983).
[[gnu::noinline]] Vector nearest(const Vector& l, const Inertia& i, const Four& most) {
    Four mu = {};
    Vector w = {};
    Four scale = {};
    for (int step = 0; step < 4; ++step) {
        const Vector c0 = {i.xx + mu, i.xy, i.xz}, c1 = {i.xy, i.yy + mu, i.yz}, c2 = {i.xz, i.yz, i.zz + mu};
        w = solve(c0, c1, c2, l);
        const Vector iw = i * w;
        const Four energy = dot(w, iw), floor = 1e-12 * energy, least = most > floor ? most : floor;
        scale = root(least / energy);
        if (step == 3) break;
        const Four by = (1 / scale - 1) * energy / dot(w, solve(c0, c1, c2, iw));
        mu = mu + (by > 0 ? by : all(0));
    }
    return (scale < 1 ? scale : all(1)) * w;
}

// What a substep did to a spin, in the axes of the body at its beginning [rad/s].
struct SpinStep {
    Bodies damped;                // by Prediction::damp
    Vector before, free, solved;  // w0; the spin that turns it without the solver; the one that the solver left
};

// The spin at the end of a substep, axes of the body then. The solver gave I d, d = solved - free. In the world I w is
// what it was and that: with Q the turn from the beginning, I w = Q^T I (w0 + d). Of bodies that are not damped what
// the midpoint rule misses is added, I w1 - Q*^T I w0, Q* the turn without d and w1 = 2 free - w0: none to speak of
// below a turn of two radians.
// Where a body turns far as it is hit this explicit form spins thin ones up. So the energy rises by no more than the
// work of what the solver gave, I d . (free + solved) of twice the energy. That takes off what implicit steps lose of
// the precession that a joint forces, 5 % of a gyroscope's spin in ten seconds: damped ones may keep what they had, as
// far as an impulse at the beginning of the turn, I d . (2 w0 + d), takes less.
Vector spin_after(const SpinStep& s, const Rotation& from, const Rotation& to, const Inertia& i, const Inertia& inverse,
                  const Keeping& terms) {
    const Vector change = s.solved - s.free, l0 = i * s.before;
    Vector momentum = to.back(from * (l0 + i * change));
    if (s.damped != kEach) {
        const Quaternion alone = rotation_of(all(terms.h) * s.free, terms.rotate);
        const Vector missed = i * (s.free + (s.free - s.before)) - rotated(alone.conjugate(), l0);
        momentum = choose(mask(s.damped), momentum, momentum + missed);
    }
    const Vector w = inverse * momentum, given = i * change;
    const Four work = dot(given, s.free + s.solved), none = {};
    Four early = 2 * dot(given, s.before) + dot(given, change);
    early = early < none ? early : none;
    const Four most = dot(s.before, l0) + (mask(s.damped) & (early > work) ? early : work);
    const Mask gains = dot(w, momentum) > most;
    return bodies(gains) == 0 ? w : choose(gains, nearest(momentum, i, most), w);
}

// In world axes.
Vector spins_after(const NodeRows& rows, const Batch& batch, const MassRow* const mass[kBodies], const Motion& m,
                   const Vector& free, const Vector& solved, Bodies damped, const Keeping& terms) {
    const Rotation R(rows.pose, batch);
    const Columns a(mass, 0), b(mass, 4), c(mass, 8), d(mass, 12);
    const SpinStep step = {damped, R.back(m.spin()), R.back(free), R.back(solved)};
    const Inertia inertia = {a.of[2], a.of[3], b.of[0], b.of[1], b.of[2], b.of[3]};
    const Inertia inverse = {c.of[0], c.of[1], c.of[2], c.of[3], d.of[0], d.of[1]};
    const Rotation now(m.turn());
    return now * spin_after(step, R, now, inertia, inverse, terms);
}

Bodies store_velocities(const NodeRows& rows, const Batch& batch, const MassRow* const mass[kBodies],
                        const Keeping& terms, Bodies turning, Bodies damped, Bodies slow) {
    const Velocities u(rows.velocity, batch.seat);
    const Motion m(rows.motion, batch);
    const Columns last(rows.motion, batch.motion, 16);
    const double h = terms.h;
    Vector w = u.w;
    if (turning != 0) {
        const Vector free = Velocities(rows.start, batch.seat).w;
        w = choose(mask(turning & ~damped), u.w + (free - m.spin()), u.w);
        const Mask turns = mask(turning) & (all(h * h) * dot(u.w, u.w) > terms.turn * terms.turn);
        if (bodies(turns) != 0) w = choose(turns, spins_after(rows, batch, mass, m, free, u.w, damped, terms), w);
    }
    const Four part = mask(slow) ? all(terms.kappa) : all(1);
    const Vector slow_v = {m.w.of[2], m.w.of[3], last.of[0]}, slow_w = {last.of[1], last.of[2], last.of[3]};
    const Vector next_v = slow_v + part * (u.v - slow_v), next_w = slow_w + part * (u.w - slow_w);
    Columns(u.v.x, u.v.y, u.v.z, w.x).put(rows.motion, batch.motion, 8);
    Columns(w.y, w.z, next_v.x, next_v.y).put(rows.motion, batch.motion, 12);
    Columns(next_v.z, next_w.x, next_w.y, next_w.z).put(rows.motion, batch.motion, 16);
    const Vector x = m.place();
    const Quaternion q = m.turn();
    const Mask there = finite(x.x) & finite(x.y) & finite(x.z) & finite(q.x) & finite(q.y) & finite(q.z) & finite(q.w);
    const Four most = all(terms.most * terms.most);
    return bodies(there & (dot(u.v, u.v) <= most) & (dot(w, w) <= most));
}

// ---------------------------------------------------------------- particles, one after another: a vector is a row

// Three numbers, the fourth undefined.
Four load3(const double* p) { return load(p); }
void store3(const Four& f, double* p) { p[0] = f[0], p[1] = f[1], p[2] = f[2]; }
void put_float3(const Four& f, float (&row)[4]) {
    for (int k = 0; k < 3; ++k) row[k] = static_cast<float>(f[k]);
}

void predict_points(const NodeRows& rows, const Batch& batch, const MassRow* const mass[kBodies],
                    const Prediction& terms) {
    const Four g = {terms.gravity[0], terms.gravity[1], terms.gravity[2], 0}, h = all(terms.h), none = {};
    for (uint32_t i = 0; i < batch.count; ++i) {
        const MotionRow& m = rows.motion[batch.motion[i]];
        const uint32_t at = batch.seat[i];
        Four a = mass[i]->gravity_scale * g;
        if (rows.load) a = a + mass[i]->inv_mass * load3(rows.load[batch.node[i]].linear);
        const Four x = load3(m.x), v = load3(m.v), u = v + h * a;
        store3(x, rows.pose[at].x);
        store3(v, rows.start[at].linear);
        store3(u, rows.velocity[at].linear);
        put_float3(u + none, rows.sweep[at].velocity.linear);
        if (rows.sweep_pose) put_float3(x - load3(rows.found[at].x), rows.sweep_pose[at].linear);
    }
}

void commit_points(const NodeRows& rows, const Batch& batch, double h) {
    for (uint32_t i = 0; i < batch.count; ++i) {
        MotionRow& m = rows.motion[batch.motion[i]];
        const uint32_t at = batch.seat[i];
        const Four x = load3(m.x) + all(h) * load3(rows.velocity[at].linear);
        store3(x, m.x);
        put_float3(x - load3(rows.found[at].x), rows.shift[at].linear);
    }
}

Bodies store_points(const NodeRows& rows, const Batch& batch, const Keeping& terms, Bodies slow) {
    Bodies sane = 0;
    for (uint32_t i = 0; i < batch.count; ++i) {
        MotionRow& m = rows.motion[batch.motion[i]];
        const Four u = load3(rows.velocity[batch.seat[i]].linear), s = load3(m.slow_v), x = load3(m.x);
        store3(u, m.v);
        store3(s + all((slow >> i & 1) != 0 ? terms.kappa : 1) * (u - s), m.slow_v);
        const double speed = u[0] * u[0] + u[1] * u[1] + u[2] * u[2],
                     away = (x[0] - x[0]) + (x[1] - x[1]) + (x[2] - x[2]);
        sane |= static_cast<Bodies>(away == 0 && speed <= terms.most * terms.most) << i;
    }
    return sane;
}

constexpr MotionKernels kTable = {predict, commit, store_velocities, predict_points, commit_points, store_points};

}  // namespace
}  // namespace taut
