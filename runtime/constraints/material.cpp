#include "constraints/material.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "constraints/positive_part.h"

namespace taut {
namespace {

bool all_positive(std::initializer_list<double> values) {
    return std::ranges::all_of(values, [](double each) { return each > 0 && std::isfinite(each); });
}

bool is_solid(const Isotropic& of) { return all_positive({of.young}) && of.poisson > -1 && of.poisson < 0.5; }
bool is_sheet(const Isotropic& of) { return all_positive({of.young}) && of.poisson > -1 && of.poisson < 1; }

double shear_of(const Isotropic& of) { return of.young / (2 * (1 + of.poisson)); }
double lame_of(const Isotropic& of) { return 2 * shear_of(of) * of.poisson / (1 - 2 * of.poisson); }

template <int Rows>
bool diagonal(const double (&values)[Rows], double (&compliance)[Rows * Rows]) {
    std::fill_n(compliance, Rows * Rows, 0.0);
    for (int r = 0; r < Rows; ++r) compliance[r * Rows + r] = 1 / values[r];
    return true;
}

}  // namespace

bool hooke_solid(const Isotropic& of, double (&compliance)[36]) {
    if (!is_solid(of)) return false;
    const double e = of.young, nu = of.poisson, shear = shear_of(of);
    return orthotropic_solid({{e, e, e}, {nu, nu, nu}, {shear, shear, shear}}, compliance);
}

bool hooke_sheet(const Isotropic& of, double (&compliance)[9]) {
    if (!is_sheet(of)) return false;
    return orthotropic_sheet({{of.young, of.young}, of.poisson, shear_of(of)}, compliance);
}

bool orthotropic_solid(const OrthotropicSolid& of, double (&compliance)[36]) {
    const auto& e = of.young;
    if (!all_positive({e[0], e[1], e[2], of.shear[0], of.shear[1], of.shear[2]})) return false;
    Eigen::Matrix3d normal;
    normal.diagonal() << 1 / e[0], 1 / e[1], 1 / e[2];
    normal(1, 2) = normal(2, 1) = -of.poisson[0] / e[1];
    normal(0, 2) = normal(2, 0) = -of.poisson[1] / e[0];
    normal(0, 1) = normal(1, 0) = -of.poisson[2] / e[0];
    const Eigen::Vector3d scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    constexpr double kLeastResistance = 1e-9;  // of a strain, against that of the axes: what an inverse can bear
    if (!is_positive<Eigen::Matrix3d>(scaled - kLeastResistance * Eigen::Matrix3d::Identity())) return false;
    std::fill_n(compliance, 36, 0.0);
    for (int r = 0; r < 3; ++r) {
        for (int s = 0; s < 3; ++s) compliance[r * 6 + s] = normal(r, s);
        compliance[(r + 3) * 6 + r + 3] = 1 / of.shear[r];
    }
    return true;
}

bool orthotropic_sheet(const OrthotropicSheet& of, double (&compliance)[9]) {
    const auto& e = of.young;
    if (!all_positive({e[0], e[1], of.shear_12})) return false;
    if (!(of.poisson_12 * of.poisson_12 < e[0] / e[1])) return false;
    const double values[3] = {e[0], e[1], of.shear_12};
    diagonal(values, compliance);
    compliance[1] = compliance[3] = -of.poisson_12 / e[0];
    return true;
}

bool hooke_stretches(const Isotropic& of, double (&compliance)[9]) {
    double solid[36];
    if (!hooke_solid(of, solid)) return false;
    for (int r = 0; r < 3; ++r) std::copy_n(solid + 6 * r, 3, compliance + 3 * r);
    return true;
}

bool fixed_corotated(const Isotropic& of, double (&compliance)[16]) {
    if (!is_solid(of) || !(lame_of(of) > 0)) return false;
    const double mu = shear_of(of);
    return diagonal({2 * mu, 2 * mu, 2 * mu, lame_of(of)}, compliance);
}

// W = mu/2 |F|^2 + L/2 (det F - alpha)^2 has the second derivative of Hooke's at F = 1 with L = lambda + mu (Smith et
// al. 2018, section 3.4).
bool neo_hookean(const Isotropic& of, double (&compliance)[4], double& alpha) {
    if (!is_solid(of)) return false;
    const double mu = shear_of(of), volume = lame_of(of) + mu;
    alpha = 1 + mu / volume;
    return diagonal({mu, volume}, compliance);
}

double plate_stiffness(const Isotropic& of, double thickness) {
    if (!is_sheet(of) || !all_positive({thickness})) return 0;
    return of.young * thickness * thickness * thickness / (12 * (1 - of.poisson * of.poisson));
}

}  // namespace taut
