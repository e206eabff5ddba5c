#include "constraints/plasticity.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "constraints/singular_values.h"

namespace taut {
namespace {

// Of x > 0, by Newton's method from the same start on every machine.
double cube_root(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    const int rest = ((exponent % 3) + 3) % 3;
    const double reduced = std::ldexp(mantissa, rest);  // in [1/2, 4)
    double y = 1;
    for (int i = 0; i < 8; ++i) y -= (y * y * y - reduced) / (3 * y * y);
    return std::ldexp(y, (exponent - rest) / 3);
}

Vec3 without_volume(const Vec3& stretch) { return stretch / cube_root(stretch.prod()); }

// Share of an excess that flows in some time: 1 - exp(-x), x = creep time, the same bits on every machine. Its series
// below 1/2, and from there 1 - exp(-2 x) = y (2 - y), y = 1 - exp(-x).
double flowing(const Plasticity& law, double time) {
    const double x = law.creep * time;
    if (!(x < 64)) return 1;
    int exponent = 0;
    std::frexp(x, &exponent);
    const int doublings = std::max(exponent + 1, 0);
    const double reduced = std::ldexp(x, -doublings);
    double y = 0;
    for (int k = 14; k > 0; --k) y = reduced / k * (1 - y);
    for (int k = 0; k < doublings; ++k) y *= 2 - y;
    return y;
}

// What is left of a size over its yield, as a share of it.
double excess(double size, double yield) { return size > yield ? (size - yield) / size : 0; }

// Stretches of volume 1 whose strain has that size, in the directions of these: each return to the volume leaves the
// size by the square of the strain.
Vec3 resized(Vec3 stretch, double size) {
    for (int i = 0; i < 50; ++i) {
        const Vec3 strain = stretch - Vec3::Ones();
        const double norm = strain.norm();
        if (std::abs(norm - size) <= 1e-14 * (1 + size)) break;
        stretch = without_volume(Vec3::Ones() + size / norm * strain);
    }
    return stretch;
}

// True where it was larger.
bool limit_set(double limit, Mat3& set) {
    const SingularValues<3> at = singular_values<3>(set);
    if (!((at.sigma - Vec3::Ones()).norm() > limit)) return false;
    set = at.u * resized(at.sigma, limit).asDiagonal() * at.v.transpose();
    return true;
}

double yield_after(const Plasticity& law, const double* flowed) {
    return law.yield + (flowed ? law.hardening * *flowed : 0);
}

double norm_of_rows(const double* e) {
    const Vec3 normal = Vec3::Map(e), shear = Vec3::Map(e + 3);
    return std::sqrt(normal.squaredNorm() + 0.5 * shear.squaredNorm());
}

}  // namespace

double yield_of_stress(double stress, const Isotropic& of) {
    const double mu = of.young / (2 * (1 + of.poisson));
    return stress / (std::sqrt(6.0) * mu);
}

double hardening_of_modulus(double modulus, const Isotropic& of) {
    const double mu = of.young / (2 * (1 + of.poisson));
    return modulus / (3 * mu);
}

bool flow(const Mat3& f, const Plasticity& law, double time, Mat3& set, double* flowed) {
    const SingularValues<3> at = singular_values<3>(f * set.inverse());
    if (!(at.sigma[2] > 0)) return false;
    const Vec3 stretch = without_volume(at.sigma);
    const double size = (stretch - Vec3::Ones()).norm();
    const double share = flowing(law, time) * excess(size, yield_after(law, flowed)) / (1 + law.hardening);
    if (!(share > 0)) return false;
    const Vec3 gone = stretch.cwiseQuotient(resized(stretch, (1 - share) * size));
    set = at.v * gone.asDiagonal() * at.v.transpose() * set;
    if (!limit_set(law.limit, set) && flowed) *flowed += share * size;
    return true;
}

void apply_set(const Mat3& set, const double (*g)[3], int nodes, double (*out)[3]) {
    const Mat3 back = set.inverse().transpose();
    for (int n = 0; n < nodes; ++n) {
        const Vec3 along = back * Vec3::Map(g[n]);
        Vec3::Map(out[n]) = along;
    }
}

bool flow(const double (&strain)[6], const Plasticity& law, double time, double (&offset)[6], double* flowed) {
    double elastic[6];
    for (int r = 0; r < 6; ++r) elastic[r] = strain[r] - offset[r];
    const double mean = (elastic[0] + elastic[1] + elastic[2]) / 3;
    for (int r = 0; r < 3; ++r) elastic[r] -= mean;
    const double norm = norm_of_rows(elastic);
    const double share = flowing(law, time) * excess(norm, yield_after(law, flowed)) / (1 + law.hardening);
    if (!(share > 0)) return false;
    for (int r = 0; r < 6; ++r) offset[r] += share * elastic[r];
    const double size = norm_of_rows(offset);
    if (size > law.limit)
        for (double& each : offset) each *= law.limit / size;
    else if (flowed)
        *flowed += share * norm;
    return true;
}

}  // namespace taut
