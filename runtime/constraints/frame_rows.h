// Coordinates between two joint frames and their Jacobian rows: the pieces that the joint types are made of.
//
// In the world: frames A = R_a F_a and B = R_b F_b, columns X, Y, Z; anchors p = x + r, r = R s.
// A row of a function of the relative rotation has the gradient g: dC = g . (w_b - w_a), J_b = (0, g^T) = -J_a. Vectors
// turn with their bodies, da = w_a x a, so a . b has g = b x a.
// Derived here; levers as in Tournier et al. 2015, eq. 22. frame_stiffness.h holds the second derivatives.
#pragma once

#include <algorithm>
#include <cmath>

#include "constraints/constraint.h"
#include "constraints/joint_frames.h"
#include "constraints/lever.h"

namespace taut {

// Joint frames in the world.
struct FramePair {
    FramePair(const void* data, const Pose* x) {
        const auto& joint = *static_cast<const JointFrames*>(data);
        a = x[0].R * joint.frame_a.toRotationMatrix();
        b = x[1].R * joint.frame_b.toRotationMatrix();
        ra = x[0].R * joint.anchor_a;
        rb = x[1].R * joint.anchor_b;
        d = (x[1].x - x[0].x) + (rb - ra);
    }
    auto xa() const { return a.col(0); }
    auto ya() const { return a.col(1); }
    auto za() const { return a.col(2); }
    auto xb() const { return b.col(0); }
    auto yb() const { return b.col(1); }
    auto zb() const { return b.col(2); }

    Mat3 a, b;       // axes in columns
    Vec3 ra, rb, d;  // levers of the anchors, and p_b - p_a [m]
};

// A coordinate of the relative rotation.
struct Turn {
    double value;   // C [rad]
    Vec3 gradient;  // g
};

// The relative rotation by 4 sigma, sigma = tan(theta/4) n for the angle theta about n: v/(1 + w) of its quaternion (w,
// v) with w >= 0 (modified Rodrigues parameters). It is the rotation vector to first order and grows up to half a turn,
// where it is 4: zero where the frames coincide and nowhere else.  For axis k of A, sigma in the world's axes:
//   C = 4 sigma_k;  g = (1 - s^2) A_k + 2 sigma x A_k + 2 sigma_k sigma,  s = |sigma|
// which is 1 + s^2 times axis k of the frame half-way from A to B: rows are as independent at any angle.
inline Vec3 half_tangents(const FramePair& f) {  // sigma, the same in A and B
    const Quat q(Mat3(f.a.transpose() * f.b));
    return q.vec() / (q.w() < 0 ? q.w() - 1 : q.w() + 1);
}
inline Turn alignment(const FramePair& f, const Vec3& sigma, int k) {
    const Vec3 axis = f.a.col(k), turned = f.a * sigma;
    return {4 * sigma[k], (1 - sigma.squaredNorm()) * axis + 2 * turned.cross(axis) + 2 * sigma[k] * turned};
}

// Of cos(c/2) for an angle c between axes: nearer to opposed than this, within 0.6 degrees, they are taken to be that
// far from it, towards Y_a if nothing else is known. What turns about half-way axes is without bound there.
constexpr double kReversed = 5e-3;

// Half-way from X_a to X_b, of length cos(c/2).
inline Vec3 half_way(const FramePair& f) {
    const Vec3 sum = 0.5 * (f.xa() + f.xb());
    const double size = sum.norm();
    if (size > kReversed) return sum;
    return kReversed * (size > 1e-12 ? Vec3(sum / size) : Vec3(f.ya()));
}

// X_b along X_a, by 4 tan(c/4) along the swing's direction from X_a: zero where they coincide and nowhere else.
//   C = h e . X_b with e = Y_a, Z_a;  h = 2/(w + w^2),  w = cos(c/2) = sqrt((1 + X_a . X_b)/2)
//   g = X_b x (h e + h' (e . X_b) X_a),  h' = dh/d(X_a . X_b)
struct AxisAlignment {
    explicit AxisAlignment(const FramePair& f) : AxisAlignment(f.xa(), half_way(f)) {}
    AxisAlignment(const Vec3& x, const Vec3& m) : xa(x), xb(2 * m - x) {
        const double w = m.norm(), a = (1 + 2 * w) / (w * w * w * (1 + w) * (1 + w));
        h = 2 / (w + w * w);
        slope = -0.5 * a;
        bend = a / (8 * w) * (3 / w + 2 / (1 + w) - 2 / (1 + 2 * w));
    }
    Turn along(const Vec3& e) const {
        const double y = e.dot(xb);
        return {h * y, xb.cross(h * e + slope * y * xa)};
    }
    Vec3 xa, xb;
    double h, slope, bend;  // h, h', h''
};

// Twist from A to B about X, that of the swing-twist decomposition.
//   C = atan2(Y_b . Z_a - Z_b . Y_a, Y_a . Y_b + Z_a . Z_b) = 2 atan2(q_x, q_w);  g = (X_a + X_b) / (1 + X_a . X_b)
inline Vec3 twist_axis(const FramePair& f) {
    const Vec3 m = half_way(f);
    return m / m.squaredNorm();
}
inline Turn twist(const FramePair& f) {
    return {angle_of(f.yb().dot(f.za()) - f.zb().dot(f.ya()), f.ya().dot(f.yb()) + f.za().dot(f.zb())), twist_axis(f)};
}

// Angle between a unit vector of each body, in [0, pi].  C = atan2(|a x b|, a . b);  g = e = (a x b)/|a x b|, and the
// given direction across a where they are parallel.
inline Vec3 swing_axis(const Vec3& a, const Vec3& b, const Vec3& across) {
    const Vec3 v = a.cross(b);
    const double sine = v.norm();
    return sine > 1e-12 ? Vec3(v / sine) : across;
}
inline Turn swing(const Vec3& a, const Vec3& b, const Vec3& across) {
    return {angle_of(a.cross(b).norm(), a.dot(b)), swing_axis(a, b, across)};
}

// Outer angles of a relative rotation by three turns, the first about p of body a, the last about q of body b, and the
// middle one across both.  With s = p . q and k = 1 - s^2, the dual basis of p, q and p x q:
//   first  g = (p - s q)/k,   last  g = (q - s p)/k
// Where p and q are parallel only the sum or difference of the two is known; each then takes half.
struct OuterTurns {
    OuterTurns(const Vec3& p_of_a, const Vec3& q_of_b) : p(p_of_a), q(q_of_b), s(p.dot(q)) {
        constexpr double kLock = 1e-6;
        if (1 - s * s < kLock) s *= 1 - kLock;
        k = 1 - s * s;
        first = (p - s * q) / k;
        last = (q - s * p) / k;
    }
    Vec3 p, q;
    double s, k;
    Vec3 first, last;  // g
};

// One of them: the turn about `axis` of its body, whose tangent is the share of the other body's axis along `sine` over
// that along `cosine`.
template <class Vector>
struct OuterTurn {
    Vector axis, sine, cosine;
};

// Writes rows of error and Jacobian; no Jacobian where that is null. StiffnessWriter and LaneRowWriter have the same
// functions, so that a joint type says once which rows it has (frame_joint.h). r: the first row.
class RowWriter {
public:
    RowWriter(const FramePair& f, int rows, double* error, double* jacobian)
        : f_(f), rows_(rows), error_(error), jacobian_(jacobian) {}

    // Rows 0-2, as the ball's.  C = p_b - p_a in world axes [m];  J_b = (I, -hat r_b) = -J_a with r_a
    void anchors() {
        Vec3::Map(error_) = f_.d;
        if (!jacobian_) return;
        set_block(jacobian_, rows_, 0, 0, -Mat3::Identity());
        set_block(jacobian_, rows_, 0, 3, hat(f_.ra));
        set_block(jacobian_, rows_, 1, 0, Mat3::Identity());
        set_block(jacobian_, rows_, 1, 3, -hat(f_.rb));
    }

    // Rows 0-2.  C = A^T (p_b - p_a) [m];  A turns with a, whose lever is therefore that of b's anchor:
    //   J_b = A^T (I, -hat r_b),  J_a = -A^T (I, -hat l),  l = p_b - x_a
    void slides() {
        Vec3::Map(error_) = f_.a.transpose() * f_.d;
        if (!jacobian_) return;
        const Vec3 l = f_.ra + f_.d;
        for (int k = 0; k < 3; ++k) {
            const Vec3 axis = f_.a.col(k);
            row(0, k) << -axis, -l.cross(axis);
            row(1, k) << axis, f_.rb.cross(axis);
        }
    }

    // Rows r to r+2: the frames coincide.
    void alignment(int r) {
        const Vec3 sigma = half_tangents(f_);
        for (int k = 0; k < 3; ++k) turn(r + k, taut::alignment(f_, sigma, k));
    }

    // Rows r and r+1: X_b along X_a.
    void axis_alignment(int r) {
        const AxisAlignment x(f_);
        turn(r, x.along(f_.ya()));
        turn(r + 1, x.along(f_.za()));
    }

    void twist(int r) { turn(r, taut::twist(f_)); }
    void swing(int r, const Vec3& a, const Vec3& b, const Vec3& across) { turn(r, taut::swing(a, b, across)); }

    // pi/2 - swing
    void rise(int r, const Vec3& a, const Vec3& b, const Vec3& across) {
        turn(r, {angle_of(a.dot(b), a.cross(b).norm()), -swing_axis(a, b, across)});
    }

    // The first of three turns alone, of an axis q of body b.
    void outer_turn(int r, const OuterTurn<Vec3>& a, const Vec3& q) {
        turn(r, {angle_of(a.sine.dot(q), a.cosine.dot(q)), OuterTurns(a.axis, q).first});
    }

    void outer_turns(int first, const OuterTurn<Vec3>& a, int last, const OuterTurn<Vec3>& b) {
        const OuterTurns t(a.axis, b.axis);
        turn(first, {angle_of(a.sine.dot(t.q), a.cosine.dot(t.q)), t.first});
        turn(last, {angle_of(t.p.dot(b.sine), t.p.dot(b.cosine)), t.last});
    }

private:
    void turn(int r, const Turn& t) {
        error_[r] = t.value;
        if (!jacobian_) return;
        row(0, r) << Vec3::Zero(), -t.gradient;
        row(1, r) << Vec3::Zero(), t.gradient;
    }

    Eigen::Map<Eigen::Matrix<double, kDof, 1>> row(int node, int r) {
        return Eigen::Map<Eigen::Matrix<double, kDof, 1>>(jacobian_ + (node * rows_ + r) * kDof);
    }

    const FramePair& f_;
    int rows_;
    double *error_, *jacobian_;
};

}  // namespace taut
