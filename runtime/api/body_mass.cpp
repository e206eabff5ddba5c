#include "api/body_mass.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

// Smallest pivot of an inertia as a share of its largest entry: below it the inverse is rounding.
constexpr double kLeastPivot = 1e-12;
// Principal moments as close as this leave no gyroscopic torque worth computing.
constexpr double kIsotropic = 1e-6;

bool is_zero(const taut_sym3& m) { return m.xx == 0 && m.yy == 0 && m.zz == 0 && m.xy == 0 && m.xz == 0 && m.yz == 0; }

Sym3 scaled(const Sym3& m, double k) { return {k * m.xx, k * m.yy, k * m.zz, k * m.xy, k * m.xz, k * m.yz}; }

double largest_moment(const Sym3& m) { return std::max({m.xx, m.yy, m.zz}); }

// Pivots of L D L^T; a NaN is not positive.
bool positive_definite(const Sym3& m) {
    const double least = kLeastPivot * largest_moment(m);
    if (!(m.xx > least && m.xx > 0)) return false;
    const double d1 = m.yy - m.xy * m.xy / m.xx;
    if (!(d1 > least)) return false;
    const double l21 = (m.yz - m.xy * m.xz / m.xx) / d1;
    return m.zz - m.xz * m.xz / m.xx - l21 * l21 * d1 > least;
}

// Cofactors over determinant, on entries of order 1.
Sym3 inverse(const Sym3& m) {
    const double size = largest_moment(m);
    const Sym3 a = scaled(m, 1 / size);
    const Sym3 cofactor{a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz, a.xx * a.yy - a.xy * a.xy,
                        a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy, a.xy * a.xz - a.xx * a.yz};
    const double determinant = a.xx * cofactor.xx + a.xy * cofactor.xy + a.xz * cofactor.xz;
    return scaled(cofactor, 1 / (determinant * size));
}

bool is_isotropic(const Sym3& m) {
    const double off =
        std::max({std::abs(m.xx - m.yy), std::abs(m.xx - m.zz), std::abs(m.xy), std::abs(m.xz), std::abs(m.yz)});
    return off <= kIsotropic * largest_moment(m);
}

}  // namespace

void set_body_mass(Check& check, const taut_body_def& def, const collision::Shape* shape, NodeMass& out) {
    const bool given = !is_zero(def.inertia);
    if (!shape) {
        check.require(def.mass > 0, "mass is 0, expected [1e-06, 1e+15] for a dynamic body without a shape");
        check.require(given, "inertia is 0, expected positive definite for a dynamic body without a shape");
    } else {
        check.require(shape->kind != collision::ShapeKind::plane,
                      "shape is a plane, which only static and kinematic bodies may have");
    }
    if (!check) return;

    collision::MassProperties from_shape;
    if (shape) from_shape = collision::mass_properties(*shape, def.density);
    out.mass = def.mass > 0 ? static_cast<double>(def.mass) : from_shape.mass;
    if (!check.number("mass from shape and density", static_cast<float>(out.mass), kBodyMass)) return;
    if (given) {
        const taut_sym3& m = def.inertia;
        out.inertia = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
        out.centre = to_vec(def.centre_of_mass);
    } else {
        out.inertia = scaled(from_shape.inertia, out.mass / from_shape.mass);
        out.centre = from_shape.centre;
    }
    if (!check.require(positive_definite(out.inertia), "inertia is not positive definite")) return;
    out.inv_mass = 1 / out.mass;
    out.inv_inertia = inverse(out.inertia);
    out.isotropic = is_isotropic(out.inertia);
}

}  // namespace taut
