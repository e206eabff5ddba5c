// Vectors, rotations and small helpers. Eigen is confined to the library's inside.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/describe.h"
#include "base/eigen_neon.h"

namespace taut {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;

// Cross-product matrix: hat(a) b = a x b.
inline Mat3 hat(const Vec3& a) {
    Mat3 m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

// Polynomials for sin(x)/x and cos(x), |x| <= pi/2: the same bits from every compiler and C library,
// which the step needs and libm does not promise. Taylor to x^18: error < 1e-14 on the range.
double sinc(double x);
double cosine(double x);

// Sine and cosine of any |x| < 1e6 [rad] within 3e-16, the same bits everywhere.
struct SineCosine {
    double sine = 0, cosine = 1;
};
SineCosine sine_cosine(double x);

// Length of the vector (x, y) within an ulp, whatever its size: the same bits everywhere.
double hypotenuse(double x, double y);

// Angle of the point (x, y) in (-pi, pi], 0 at the origin: atan2(y, x) within 4e-16, the same bits everywhere.
double angle_of(double y, double x);

// What is left of a quantity that decays at a constant rate, and its mean meanwhile, in parts of it.
struct Decay {
    double left = 1, mean = 1;
};
// Of e^-x over x >= 0: e^-x and (1 - e^-x) / x, within 1e-13, the same bits everywhere.
Decay decay_over(double x);

// Rotation by the vector theta [rad]; exact for any size (large angles are halved first).
Quat rotation_from_vector(const Vec3& theta);
// The turn from one unit vector to another by the shortest way.
Quat turn_between(const Vec3& from, const Vec3& to);

// Symmetric 3x3 in packed order xx, yy, zz, xy, xz, yz.
struct Sym3 {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

    Mat3 matrix() const {
        Mat3 m;
        m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        return m;
    }
    static Sym3 of(const Mat3& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}; }
};
template <class Visitor, Like<Sym3> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [xx, yy, zz, xy, xz, yz] = of;
    TAUT_FIELDS(visitor, xx, yy, zz, xy, xz, yz);
}

}  // namespace taut
