// Geometric stiffness of the rows of frame_rows.h.
//
// Rows of the relative rotation: with the torque t = sum lambda g on b, and -t on a, and w = dtheta,
//   dt = -(S + hat(t)/2) w_b + (S - hat(t)/2) w_a,   S = -sum lambda sym(dg/dw_b)   symmetric
// because turning both bodies turns t along. So, in the blocks of a and b,
//   K = [ S - hat(t)/2   -S - hat(t)/2 ]      w^T K w = (w_b - w_a)^T S (w_b - w_a) + t . (w_a x w_b)
//       [-S + hat(t)/2    S + hat(t)/2 ]
// Its positive part is bounded by that of S and that of the triple product, whose off-diagonal block hat(t)/2 has the
// positive part ([|t| T, -hat t], [hat t, |t| T])/4, T = I - t t^T/|t|^2.                              Derived here.
#pragma once

#include "constraints/frame_rows.h"

namespace taut {

constexpr double kNoForce = 1e-30;  // [N, N m]: below it squares vanish

// sym(u v^T), whose only positive eigenvalue is (u . v + |u||v|)/2, along u/|u| + v/|v|.
inline Mat3 dyad(const Vec3& u, const Vec3& v, Curvature part) {
    if (part == Curvature::raw) return 0.5 * (u * v.transpose() + v * u.transpose());
    const double uu = u.norm(), vv = v.norm();
    if (!(uu > kNoForce && vv > kNoForce)) return Mat3::Zero();
    const Vec3 e = u / uu + v / vv;
    return (0.25 * uu * vv) * e * e.transpose();
}

// (u . v)/2 I - sym(u v^T): eigenvalues -+|u||v|/2 along u/|u| +- v/|v|, and u . v / 2 across both.
inline Mat3 spread(const Vec3& u, const Vec3& v, Curvature part) {
    const double uv = 0.5 * u.dot(v);
    if (part == Curvature::raw) return uv * Mat3::Identity() - 0.5 * (u * v.transpose() + v * u.transpose());
    const double uu = u.norm(), vv = v.norm(), size = 0.5 * uu * vv;
    if (!(uu > kNoForce && vv > kNoForce)) return Mat3::Zero();
    const Vec3 uh = u / uu, vh = v / vv, d = uh - vh, n = uh.cross(vh);
    if (d.squaredNorm() < 1e-8) return size * (Mat3::Identity() - uh * uh.transpose());
    Mat3 k = size / d.squaredNorm() * d * d.transpose();
    if (uv > 0) k += uv / n.squaredNorm() * n * n.transpose();
    return k;
}

class StiffnessWriter {
public:
    // lambda: of all rows; k: 12 x 12, complete once finish() has run.
    StiffnessWriter(const FramePair& f, const double* lambda, double* k, Curvature part)
        : f_(f), lambda_(lambda), k_(k), part_(part) {
        std::fill(k, k + 12 * 12, 0.0);
    }

    // The ball's: a force at each lever.
    void anchors() {
        const Vec3 force = Vec3::Map(lambda_);
        add_block(k_, 3, 3, lever_stiffness(-force, f_.ra, part_));
        add_block(k_, 9, 9, lever_stiffness(force, f_.rb, part_));
    }

    // The force f = A lambda turns with a. With l = p_b - x_a and y = dx_b - dx_a - hat(r_b) w_b + hat(l) w_a, which is
    // A dC: the ball's form with lever l at a, and a coupling of slide and rotation,
    //   w^T K w = w_a^T lever(-f, l) w_a + w_b^T lever(f, r_b) w_b - 2 (w_a x f) . y
    void slides() {
        const Vec3 force = f_.a * Vec3::Map(lambda_), l = f_.ra + f_.d;
        if (part_ == Curvature::raw)
            turning_force(force, l, f_.rb);
        else
            turning_force_bound(force, l, f_.rb);
    }

    // With the torque t = sum lambda g, S = (sigma . t)/2 I - sym(sigma t^T): zero where the frames coincide.
    void alignment(int r) {
        const Vec3 local = half_tangents(f_), sigma = f_.a * local, force = Vec3::Map(lambda_ + r);
        const Vec3 torque =
            f_.a * ((1 - local.squaredNorm()) * force + 2 * local.cross(force)) + 2 * local.dot(force) * sigma;
        torque_ += torque;
        s_ += spread(sigma, torque, part_);
    }

    // sum lambda C = h f . X_b,  f = lambda_r Y_a + lambda_r+1 Z_a: with x = X_a . X_b, the force h f + h' (f . X_b)
    // X_a at the lever X_b, and what h adds, -sym(u (h'' (f . X_b) u + 2 h' v)^T) with the gradients u of x, v of f .
    // X_b.
    void axis_alignment(int r) {
        const AxisAlignment x(f_);
        const Vec3 force = lambda_[r] * f_.ya() + lambda_[r + 1] * f_.za();
        const double along = force.dot(x.xb);
        const Vec3 u = x.xb.cross(x.xa), v = x.xb.cross(force);
        bilinear(x.h * force + x.slope * along * x.xa, x.xb);
        s_ += dyad(-u, x.bend * along * u + 2 * x.slope * v, part_);
    }

    // sym(dg/dw_b) = sym(g v^T)/n,  v = X_a x X_b,  n = 1 + X_a . X_b = 2/|g|^2
    void twist(int r) {
        const Vec3 g = twist_axis(f_), v = f_.xa().cross(f_.xb());
        torque_ += lambda_[r] * g;
        s_ += dyad(-0.5 * lambda_[r] * g.squaredNorm() * g, v, part_);
    }

    void swing(int r, const Vec3& a, const Vec3& b, const Vec3& across) { bend(a, b, across, lambda_[r]); }
    void rise(int r, const Vec3& a, const Vec3& b, const Vec3& across) { bend(a, b, across, -lambda_[r]); }

    // With m = q x p:  sym(dg/dw_b) = sym((2 s g - q) m^T)/k of the first, sym((2 s g - p) m^T)/k of the last
    void outer_turn(int r, const OuterTurn<Vec3>& a, const Vec3& q) {
        const OuterTurns t(a.axis, q);
        torque_ += lambda_[r] * t.first;
        s_ += dyad(-lambda_[r] / t.k * (2 * t.s * t.first - t.q), t.q.cross(t.p), part_);
    }

    void outer_turns(int first, const OuterTurn<Vec3>& a, int last, const OuterTurn<Vec3>& b) {
        const OuterTurns t(a.axis, b.axis);
        const Vec3 u = lambda_[first] * (2 * t.s * t.first - t.q) + lambda_[last] * (2 * t.s * t.last - t.p);
        torque_ += lambda_[first] * t.first + lambda_[last] * t.last;
        s_ += dyad(-u / t.k, t.q.cross(t.p), part_);
    }

    void finish() {
        if (part_ == Curvature::raw) {
            const Mat3 half = 0.5 * hat(torque_);
            rotations(s_ - half, -s_ - half, -s_ + half, s_ + half);
            return;
        }
        rotations(s_, -s_, -s_, s_);
        const double size = torque_.norm();
        if (!(size > kNoForce)) return;
        const Mat3 across = 0.25 * (size * Mat3::Identity() - torque_ / size * torque_.transpose());
        const Mat3 turned = 0.25 * hat(torque_);
        rotations(across, -turned, turned, across);
    }

private:
    // Over the swing c, with m halfway from a to b and p = e x m:
    //   sym(dg/dw_b) = (cot(c/2) p p^T - tan(c/2) m m^T)/2
    void bend(const Vec3& a, const Vec3& b, const Vec3& across, double lambda) {
        constexpr double kSmall = 1e-12;
        const Vec3 e = swing_axis(a, b, across), t = e.cross(a);
        const double cosine = 0.5 * (a + b).norm(), sine = 0.5 * (b - a).norm();  // of c/2
        const Vec3 m = cosine * a + sine * t, p = cosine * t - sine * a;
        double along_m = 0.5 * lambda * sine / std::max(cosine, kReversed);
        double along_p = -0.5 * lambda * cosine / std::max(sine, kSmall);
        if (part_ == Curvature::positive) along_m = std::max(along_m, 0.0), along_p = std::max(along_p, 0.0);
        torque_ += lambda * e;
        s_ += along_m * m * m.transpose() + along_p * p * p.transpose();
    }

    // f . r with f of body a and r of body b: S = sym of the lever's.
    void bilinear(const Vec3& f, const Vec3& r) {
        const Mat3 lever = lever_stiffness(f, r, part_);
        torque_ += r.cross(f);
        s_ += 0.5 * (lever + lever.transpose());
    }

    void rotations(const Mat3& aa, const Mat3& ab, const Mat3& ba, const Mat3& bb) {
        add_block(k_, 3, 3, aa);
        add_block(k_, 3, 9, ab);
        add_block(k_, 9, 3, ba);
        add_block(k_, 9, 9, bb);
    }

    // Exact, by df = w_a x f and dl = dx_b - dx_a - hat(r_b) w_b in (f, r_b x f) on b and -(f, l x f) on a.
    void turning_force(const Vec3& force, const Vec3& l, const Vec3& rb) {
        const Mat3 f = hat(force), fr = f * hat(rb);
        add_block(k_, 0, 3, -f);
        add_block(k_, 6, 3, f);
        add_block(k_, 3, 0, f);
        add_block(k_, 3, 6, -f);
        rotations(-hat(l) * f, fr, fr.transpose(), lever_stiffness(force, rb, Curvature::raw));
    }

    // The coupling -2 (w_a x f) . y = -2 w_a . (f x y) is at most the sum of |f| kSize |w_a|^2/2 + |f|/kSize |y|^2/2,
    // both across f, and half of itself. kSize weighs rotation against slide and ought to be like a body's radius of
    // gyration, which a constraint does not know.
    void turning_force_bound(const Vec3& force, const Vec3& l, const Vec3& rb) {
        constexpr double kSize = 0.5;  // [m]
        add_block(k_, 3, 3, lever_stiffness(-force, l, Curvature::positive));
        add_block(k_, 9, 9, lever_stiffness(force, rb, Curvature::positive));
        const double size = force.norm();
        if (!(size > kNoForce)) return;
        // The bound is z^T c z,  z = y + kSize f/|f| x w_a = -dx_a + ea w_a + dx_b + eb w_b
        const Mat3 c = 0.5 / kSize * (size * Mat3::Identity() - force / size * force.transpose());
        const Mat3 ea = hat(l) + kSize / size * hat(force), eb = -hat(rb), cea = c * ea, ceb = c * eb;
        add_block(k_, 0, 0, c);
        add_block(k_, 6, 6, c);
        add_mirrored(0, 6, -c);
        add_mirrored(0, 3, -cea);
        add_mirrored(6, 3, cea);
        add_mirrored(0, 9, -ceb);
        add_mirrored(6, 9, ceb);
        add_mirrored(3, 9, ea.transpose() * ceb);
        add_block(k_, 3, 3, ea.transpose() * cea);
        add_block(k_, 9, 9, eb.transpose() * ceb);
    }

    void add_mirrored(int row, int column, const Mat3& block) {
        add_block(k_, row, column, block);
        add_block(k_, column, row, block.transpose());
    }

    const FramePair& f_;
    const double* lambda_;
    double* k_;
    Curvature part_;
    Vec3 torque_ = Vec3::Zero();
    Mat3 s_ = Mat3::Zero();
};

}  // namespace taut
