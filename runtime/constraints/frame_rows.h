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
    double value;   // C [rad, or 1 for misalignments]
    Vec3 gradient;  // g
};

// Misalignment of two axes that ought to be perpendicular.  C = a . b
inline Turn misalignment(const Vec3& a, const Vec3& b) { return {a.dot(b), b.cross(a)}; }

// Misalignment of the frames about axis k of three, i and j being the next two.  C = (a_j . b_i - a_i . b_j)/2, which
// is component k of sin(angle) times the axis of the relative rotation: zero at 0 and 180 degrees only.
inline Turn frame_misalignment(const FramePair& f, int k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    return {0.5 * (f.a.col(j).dot(f.b.col(i)) - f.a.col(i).dot(f.b.col(j))),
            0.5 * (f.b.col(i).cross(f.a.col(j)) - f.b.col(j).cross(f.a.col(i)))};
}

constexpr double kReversed = 1e-12;  // of 1 + X_a . X_b: where the axes oppose each other there is no twist

// Twist from A to B about X, that of the swing-twist decomposition.
//   C = atan2(Y_b . Z_a - Z_b . Y_a, Y_a . Y_b + Z_a . Z_b) = 2 atan2(q_x, q_w);  g = (X_a + X_b) / (1 + X_a . X_b)
inline Vec3 twist_axis(const FramePair& f) {
    const double n = 1 + f.xa().dot(f.xb());
    if (n < kReversed) return f.xa();
    return (f.xa() + f.xb()) / n;
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
        for (int k = 0; k < 3; ++k) turn(r + k, frame_misalignment(f_, k));
    }

    // Rows r and r+1: X_b along X_a.
    void axis_alignment(int r) {
        misalignment(r, f_.ya(), f_.xb());
        misalignment(r + 1, f_.za(), f_.xb());
    }

    void misalignment(int r, const Vec3& a, const Vec3& b) { turn(r, taut::misalignment(a, b)); }
    void twist(int r) { turn(r, taut::twist(f_)); }
    void swing(int r, const Vec3& a, const Vec3& b, const Vec3& across) { turn(r, taut::swing(a, b, across)); }

    // pi/2 - swing
    void rise(int r, const Vec3& a, const Vec3& b, const Vec3& across) {
        turn(r, {angle_of(a.dot(b), a.cross(b).norm()), -swing_axis(a, b, across)});
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
