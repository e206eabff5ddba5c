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

// Inverses, from mass and inertia that are in range.
void complete(Check& check, NodeMass& out) {
    if (!check.require(positive_definite(out.inertia), "inertia is not positive definite")) return;
    out.inv_mass = 1 / out.mass;
    out.inv_inertia = inverse(out.inertia);
    out.isotropic = is_isotropic(out.inertia);
}

}  // namespace

Check& check_mass(Check& check, float mass, const taut_vec3& centre_of_mass, const taut_sym3& inertia) {
    return check.zero_or("mass", mass, kBodyMass)
        .vector("centre_of_mass", centre_of_mass, kShapeCoordinate)
        .number("inertia.xx", inertia.xx, kInertia)
        .number("inertia.yy", inertia.yy, kInertia)
        .number("inertia.zz", inertia.zz, kInertia)
        .number("inertia.xy", inertia.xy, kInertia)
        .number("inertia.xz", inertia.xz, kInertia)
        .number("inertia.yz", inertia.yz, kInertia);
}

// Of the parts, I = sum R I_p R^T + m_p (d.d - d d^T), d from the common centre to the part's (Steiner).
collision::MassProperties mass_of(const Shapes& shapes, std::span<const ColliderPlan> colliders) {
    if (colliders.size() == 1 && colliders[0].at_origin() && !colliders[0].sensor)
        return collision::mass_properties(shapes[colliders[0].shape].shape,
                                          static_cast<double>(colliders[0].traits.density));
    const auto part_of = [&](const ColliderPlan& c) {
        const double density = c.sensor ? 0.0 : static_cast<double>(c.traits.density);
        collision::MassProperties part = collision::mass_properties(shapes[c.shape].shape, density);
        part.centre = c.position + c.rotation * part.centre;
        return part;
    };
    collision::MassProperties out;
    for (const ColliderPlan& c : colliders) {
        const collision::MassProperties part = part_of(c);
        out.mass += part.mass;
        out.centre += part.mass * part.centre;
    }
    if (out.mass > 0) out.centre /= out.mass;
    Mat3 inertia = Mat3::Zero();
    for (const ColliderPlan& c : colliders) {
        const collision::MassProperties part = part_of(c);
        const Mat3 R = c.rotation.toRotationMatrix();
        const Vec3 d = part.centre - out.centre;
        inertia += R * part.inertia.matrix() * R.transpose() +
                   part.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
    out.inertia = Sym3::of(inertia);
    return out;
}

void set_body_mass(Check& check, const taut_body_def& def, const Shapes& shapes,
                   std::span<const ColliderPlan> colliders, NodeMass& out) {
    const bool given = !is_zero(def.inertia);
    if (colliders.empty()) {
        check.require(def.mass > 0, "mass is 0, expected [1e-06, 1e+15] for a dynamic body without colliders");
        check.require(given, "inertia is 0, expected positive definite for a dynamic body without colliders");
    }
    if (!check) return;
    const collision::MassProperties sum = mass_of(shapes, colliders);
    out.mass = def.mass > 0 ? static_cast<double>(def.mass) : sum.mass;
    if (!check.number("mass from shapes and densities", static_cast<float>(out.mass), kBodyMass)) return;
    if (given) {
        const taut_sym3& m = def.inertia;
        out.inertia = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
        out.centre = to_vec(def.centre_of_mass);
    } else {
        check.require(sum.mass > 0, "inertia is 0, expected positive definite where no collider has a density");
        if (!check) return;
        out.inertia = scaled(sum.inertia, out.mass / sum.mass);
        out.centre = sum.centre;
    }
    complete(check, out);
}

void set_body_mass(Check& check, const Shapes& shapes, std::span<const ColliderPlan> colliders, NodeMass& out) {
    const collision::MassProperties sum = mass_of(shapes, colliders);
    if (!check.number("mass of the colliders", static_cast<float>(sum.mass), kBodyMass)) return;
    out.mass = sum.mass;
    out.centre = sum.centre;
    out.inertia = sum.inertia;
    complete(check, out);
}

SpareMass put_aside(uint32_t node, NodeMass& mass) {
    const SpareMass spare{node, mass.mass, mass.inertia};
    mass.mass = mass.inv_mass = 0;
    mass.inertia = mass.inv_inertia = {};
    mass.isotropic = false;
    return spare;
}

void take_back(Check& check, const SpareMass& spare, NodeMass& mass) {
    mass.mass = spare.mass;
    mass.inertia = spare.inertia;
    complete(check, mass);
}

}  // namespace taut
