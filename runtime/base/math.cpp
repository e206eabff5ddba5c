#include "base/math.h"

#include <cmath>

namespace taut {

double sinc(double x) {
    const double y = x * x;
    // sum (-y)^k / (2k+1)!
    return 1.0 +
           y * (-1.0 / 6 +
                y * (1.0 / 120 + y * (-1.0 / 5040 +
                                      y * (1.0 / 362880 + y * (-1.0 / 39916800 +
                                                               y * (1.0 / 6227020800.0 +
                                                                    y * (-1.0 / 1307674368000.0 +
                                                                         y * (1.0 / 355687428096000.0 +
                                                                              y * (-1.0 / 121645100408832000.0)))))))));
}

double cosine(double x) {
    const double y = x * x;
    // sum (-y)^k / (2k)!
    return 1.0 +
           y * (-1.0 / 2 +
                y * (1.0 / 24 +
                     y * (-1.0 / 720 + y * (1.0 / 40320 + y * (-1.0 / 3628800 +
                                                               y * (1.0 / 479001600.0 +
                                                                    y * (-1.0 / 87178291200.0 +
                                                                         y * (1.0 / 20922789888000.0 +
                                                                              y * (-1.0 / 6402373705728000.0)))))))));
}

// Less the nearest multiple of pi/2, of which the first two parts have 33 bits each, so that their multiples are exact
// (Cody and Waite 1980).
SineCosine sine_cosine(double x) {
    constexpr double kHalfPi[3] = {1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21};
    const double quarters = std::round(x * 0.63661977236758134);  // 2/pi
    const double rest = ((x - quarters * kHalfPi[0]) - quarters * kHalfPi[1]) - quarters * kHalfPi[2];
    const double s = rest * sinc(rest), c = cosine(rest);
    switch (static_cast<int64_t>(quarters) & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

// The root of the sum of squares, its error taken off by one step of Newton's method with the residual that squares of
// differences leave (Borges 2021, ACM TOMS 47(1), without fused arithmetic). Where squares would leave the range of
// numbers, of a vector scaled by a power of two.
double hypotenuse(double x, double y) {
    const double ax = std::abs(x), ay = std::abs(y);
    const double large = ax < ay ? ay : ax, small = ax < ay ? ax : ay;
    if (!(small > large * 0x1p-54)) return large + small;  // the square below half an ulp; or not-a-number
    const double scale = large > 0x1p+511 ? 0x1p-600 : small < 0x1p-459 ? 0x1p+600 : 1;
    const double a = large * scale, b = small * scale;
    const double length = std::sqrt(a * a + b * b);
    double residual;  // length^2 - a^2 - b^2
    if (length <= 2 * b) {
        const double over = length - b;
        residual = a * (2 * over - a) + (over - 2 * (a - b)) * over;
    } else {
        const double over = length - a;
        residual = 2 * over * (a - 2 * b) + ((4 * over - b) * b + over * over);
    }
    return (length - residual / (2 * length)) / scale;
}

// atan t = atan c + atan((t - c) / (1 + t c)) with c = 0, 1/2 or 1 leaves |t| <= 1/4; Taylor to t^27: error < 1e-17.
double angle_of(double y, double x) {
    const double ax = std::abs(x), ay = std::abs(y);
    const double large = ax < ay ? ay : ax, small = ax < ay ? ax : ay;
    if (large == 0) return 0;
    double c = 0, angle = 0;
    if (small > 0.75 * large)
        c = 1, angle = 0.78539816339744831;
    else if (small > 0.25 * large)
        c = 0.5, angle = 0.46364760900080612;
    const double t = (small - c * large) / (large + c * small), z = t * t, zz = z * z;
    double even = 0, odd = 0;  // of sum (-z)^k / (2k+1), side by side
    for (int k = 12; k >= 0; k -= 2) {
        even = 1.0 / (2 * k + 1) + zz * even;
        odd = 1.0 / (2 * k + 3) + zz * odd;
    }
    angle += t * (even - z * odd);
    if (ax < ay) angle = 1.57079632679489662 - angle;
    if (x < 0) angle = 3.14159265358979324 - angle;
    return y < 0 ? -angle : angle;
}

// In the implicit form e^-x = 1 / (1 + E), E = e^x - 1, of which every term is positive: by its series, y^k / k! to
// y^15 for y <= 1/2, which leaves out less than 1e-18, and E(2y) = E(y) (E(y) + 2). Of large x, E is infinite.
Decay decay_over(double x) {
    if (!(x > 0)) return {};
    double y = x;
    int doublings = 0;
    for (; y > 0.5; y *= 0.5) ++doublings;
    double series = 0;
    for (int k = 15; k >= 1; --k) series = (1 + series) * y / k;
    for (; doublings > 0; --doublings) series *= series + 2;
    const double left = 1 / (1 + series);
    return {left, (series < 1 ? series * left : 1 - left) / x};
}

namespace {

// Turns below half a radian, which most are: the same series, from the square of half the angle y <= 1/16. What they
// leave out is less than 2e-17.
Quat small_rotation(const Vec3& theta, double y) {
    const double k =
        1.0 + y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * (1.0 / 362880 - y * (1.0 / 39916800)))));
    const double c =
        1.0 + y * (-1.0 / 2 + y * (1.0 / 24 + y * (-1.0 / 720 +
                                                   y * (1.0 / 40320 + y * (-1.0 / 3628800 + y * (1.0 / 479001600))))));
    return Quat(c, 0.5 * k * theta.x(), 0.5 * k * theta.y(), 0.5 * k * theta.z());
}

}  // namespace

Quat rotation_from_vector(const Vec3& theta) {
    const double squared = theta.squaredNorm();
    if (squared <= 0.25) return small_rotation(theta, 0.25 * squared);
    double half = 0.5 * std::sqrt(squared);
    if (half <= 1.5) {
        const double k = 0.5 * sinc(half);
        return Quat(cosine(half), k * theta.x(), k * theta.y(), k * theta.z());
    }
    if (!std::isfinite(half)) return Quat(half, half, half, half);  // for quarantine to find
    const Quat q = rotation_from_vector(0.5 * theta);
    return (q * q).normalized();  // else each doubling doubles what rounding adds to its length
}

Quat turn_between(const Vec3& from, const Vec3& to) {
    const double c = from.dot(to);
    if (c < -1 + 1e-9) {  // about any axis across
        const Vec3 axis = std::abs(from.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitZ();
        const Vec3 across = from.cross(axis).normalized();
        return Quat(0, across.x(), across.y(), across.z());
    }
    const Vec3 v = from.cross(to);
    return Quat(1 + c, v.x(), v.y(), v.z()).normalized();
}

}  // namespace taut
