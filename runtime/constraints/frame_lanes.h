// The rows of frame_rows.h for kLanes joints at once, in floats: the same coordinates and gradients, from anchors and
// rotations relative to the nodes, so that no figure is larger than the joint. Errors are some 1e-7 of a lever, and of
// a radian.
#pragma once

#include "constraints/frame_rows.h"
#include "constraints/joint_lanes.h"
#include "constraints/sweep_side.inl"
#include "simd/angle.h"

namespace taut {

template <class F>
Vec3Lanes<F> operator-(const Vec3Lanes<F>& a) {
    const F zero = F::all(0);
    return {zero - a.x, zero - a.y, zero - a.z};
}

template <class F>
struct QuatLanes {
    using V = Vec3Lanes<F>;
    V v;
    F w;

    friend QuatLanes operator*(const QuatLanes& a, const QuatLanes& b) {
        return {a.w * b.v + b.w * a.v + cross(a.v, b.v), a.w * b.w - dot(a.v, b.v)};
    }
    V turn(const V& a) const {
        const V t = cross(v + v, a);
        return a + w * t + cross(v, t);
    }
};

// Columns of a rotation.
template <class F>
struct AxesLanes {
    Vec3Lanes<F> x, y, z;

    explicit AxesLanes(const QuatLanes<F>& q) {
        const F one = F::all(1);
        const Vec3Lanes<F> twice = q.v + q.v, w = q.w * twice;
        const F xx = q.v.x * twice.x, yy = q.v.y * twice.y, zz = q.v.z * twice.z;
        const F xy = q.v.x * twice.y, xz = q.v.x * twice.z, yz = q.v.y * twice.z;
        x = {one - (yy + zz), xy + w.z, xz - w.y};
        y = {xy - w.z, one - (xx + zz), yz + w.x};
        z = {xz + w.y, yz - w.x, one - (xx + yy)};
    }
};

// As FramePair.
template <class F>
class FramePairLanes {
public:
    using V = Vec3Lanes<F>;

    FramePairLanes(const LaneFrames& joint, const float* const (&pose)[2][kLanes])
        : FramePairLanes(joint, Node(pose[0]), Node(pose[1])) {}

    const V& xa() const { return a_.x; }
    const V& ya() const { return a_.y; }
    const V& za() const { return a_.z; }
    const V& xb() const { return b_.x; }
    const V& yb() const { return b_.y; }
    const V& zb() const { return b_.z; }

    // sigma, as half_tangents().
    V half_tangents() const {
        const QuatLanes<F> q = QuatLanes<F>{-turn_a_.v, turn_a_.w} * turn_b_;
        const F zero = F::all(0), one = F::all(1);
        return (one / F::if_greater(zero, q.w, q.w - one, q.w + one)) * q.v;
    }

    V ra, rb, d;

private:
    struct Node {  // what a SweepPose says
        explicit Node(const float* const (&pose)[kLanes]) {
            F part[8];
            F::transpose(pose, part);
            dx = {part[0], part[1], part[2]};
            q = {{part[4], part[5], part[6]}, part[7]};
        }
        V dx;
        QuatLanes<F> q;
    };

    FramePairLanes(const LaneFrames& joint, const Node& a, const Node& b)
        : ra(a.q.turn(load(joint.anchor[0]))),
          rb(b.q.turn(load(joint.anchor[1]))),
          d(load(joint.apart) + (b.dx - a.dx) + (rb - ra)),
          turn_a_(a.q * frame(joint, 0)),
          turn_b_(b.q * frame(joint, 1)),
          a_(turn_a_),
          b_(turn_b_) {}

    static V load(const float (&from)[3][kLanes]) { return {F::load(from[0]), F::load(from[1]), F::load(from[2])}; }
    static QuatLanes<F> frame(const LaneFrames& joint, int end) {
        const float(&q)[4][kLanes] = joint.frame[end];
        return {{F::load(q[0]), F::load(q[1]), F::load(q[2])}, F::load(q[3])};
    }

    QuatLanes<F> turn_a_, turn_b_;
    AxesLanes<F> a_, b_;
};

// As RowWriter.
template <class F>
class LaneRowWriter {
public:
    using V = Vec3Lanes<F>;

    LaneRowWriter(const FramePairLanes<F>& f, int rows, LaneScalar* error, LaneScalar* jacobian)
        : f_(f), rows_(rows), error_(error), jacobian_(jacobian) {}

    void anchors() {
        store(f_.d, error_);
        for (int node = 0; node < 2; ++node) {
            const F sign = F::all(node == 0 ? -1 : 1);
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) (i == k ? sign : F::all(0)).store(row(node, k)[i].value);
        }
        store_hat(0, f_.ra);
        store_hat(1, -f_.rb);
    }

    void slides() {
        const V l = f_.ra + f_.d;
        const V axis[3] = {f_.xa(), f_.ya(), f_.za()};
        for (int k = 0; k < 3; ++k) {
            dot(axis[k], f_.d).store(error_[k].value);
            store(-axis[k], row(0, k));
            store(-cross(l, axis[k]), row(0, k) + 3);
            store(axis[k], row(1, k));
            store(cross(f_.rb, axis[k]), row(1, k) + 3);
        }
    }

    void alignment(int r) {
        const F two = F::all(2);
        const V axis[3] = {f_.xa(), f_.ya(), f_.za()}, local = f_.half_tangents();
        const F sigma[3] = {local.x, local.y, local.z}, along = F::all(1) - dot(local, local);
        const V turned = sigma[0] * axis[0] + sigma[1] * axis[1] + sigma[2] * axis[2];
        for (int k = 0; k < 3; ++k)
            turn(r + k, F::all(4) * sigma[k], along * axis[k] + two * (cross(turned, axis[k]) + sigma[k] * turned));
    }

    void axis_alignment(int r) {
        const F one = F::all(1), two = F::all(2);
        const V m = half_way(), xb = two * m - f_.xa();
        const F w = F::sqrt(dot(m, m)), h = two / (w + w * w);
        const F slope = (F::all(-0.5f) * (one + w + w)) / (w * w * w * ((one + w) * (one + w)));
        const V e[2] = {f_.ya(), f_.za()};
        for (int k = 0; k < 2; ++k) {
            const F y = dot(e[k], xb);
            turn(r + k, h * y, cross(xb, h * e[k] + slope * y * f_.xa()));
        }
    }

    void twist(int r) {
        const V m = half_way();
        const F y = dot(f_.yb(), f_.za()) - dot(f_.zb(), f_.ya()), x = dot(f_.ya(), f_.yb()) + dot(f_.za(), f_.zb());
        turn(r, angle_of(y, x), (F::all(1) / dot(m, m)) * m);
    }

    void swing(int r, const V& a, const V& b, const V& across) {
        const Swing s(a, b, across);
        turn(r, angle_of(s.sine, s.cosine), s.axis);
    }

    void rise(int r, const V& a, const V& b, const V& across) {
        const Swing s(a, b, across);
        turn(r, angle_of(s.cosine, s.sine), -s.axis);
    }

    void outer_turn(int r, const OuterTurn<V>& a, const V& q) {
        const F one = F::all(1), s = unlocked(dot(a.axis, q));
        turn(r, angle_of(dot(a.sine, q), dot(a.cosine, q)), (one / (one - s * s)) * (a.axis - s * q));
    }

    void outer_turns(int first, const OuterTurn<V>& a, int last, const OuterTurn<V>& b) {
        const F one = F::all(1);
        const V &p = a.axis, &q = b.axis;
        const F s = unlocked(dot(p, q)), inverse = one / (one - s * s);
        turn(first, angle_of(dot(a.sine, q), dot(a.cosine, q)), inverse * (p - s * q));
        turn(last, angle_of(dot(p, b.sine), dot(p, b.cosine)), inverse * (q - s * p));
    }

private:
    // Below what floats tell from 0 no axis is known.
    static constexpr float kParallel = 1e-6f, kLock = 1e-5f;

    struct Swing {
        Swing(const V& a, const V& b, const V& across) : cosine(dot(a, b)) {
            const V v = cross(a, b);
            sine = F::sqrt(dot(v, v));
            const F least = F::all(kParallel);
            axis = if_greater(sine, least, (F::all(1) / F::max(sine, least)) * v, across);
        }
        F cosine, sine;
        V axis;
    };

    static F unlocked(const F& s) { return F::if_greater(F::all(kLock), F::all(1) - s * s, F::all(1 - kLock) * s, s); }
    // As half_way().
    V half_way() const {
        const V sum = F::all(0.5f) * (f_.xa() + f_.xb());
        const F size = F::sqrt(dot(sum, sum)), reversed = F::all(float(kReversed)), least = F::all(kParallel);
        const V bent = if_greater(size, least, (reversed / F::max(size, least)) * sum, reversed * f_.ya());
        return if_greater(size, reversed, sum, bent);
    }

    static V if_greater(const F& a, const F& b, const V& yes, const V& no) {
        return {F::if_greater(a, b, yes.x, no.x), F::if_greater(a, b, yes.y, no.y), F::if_greater(a, b, yes.z, no.z)};
    }
    static void store(const V& v, LaneScalar* to) {
        v.x.store(to[0].value);
        v.y.store(to[1].value);
        v.z.store(to[2].value);
    }
    LaneScalar* row(int node, int r) { return jacobian_ + (node * rows_ + r) * kDof; }
    void store_hat(int node, const V& r) {
        const F zero = F::all(0);
        store({zero, zero - r.z, r.y}, row(node, 0) + 3);
        store({r.z, zero, zero - r.x}, row(node, 1) + 3);
        store({zero - r.y, r.x, zero}, row(node, 2) + 3);
    }
    void turn(int r, const F& value, const V& gradient) {
        value.store(error_[r].value);
        store(-gradient, row(0, r) + 3);
        store(gradient, row(1, r) + 3);
    }

    const FramePairLanes<F>& f_;
    int rows_;
    LaneScalar *error_, *jacobian_;
};

}  // namespace taut
