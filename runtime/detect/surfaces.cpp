#include "detect/surfaces.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

// In the order of taut_combine, from the second.
constexpr float (*kRules[])(float, float) = {
    [](float a, float b) { return std::sqrt(a * b); }, [](float a, float b) { return 0.5f * (a + b); },
    [](float a, float b) { return std::min(a, b); },   [](float a, float b) { return a * b; },
    [](float a, float b) { return std::max(a, b); },
};

template <class Usual>
float combine(float a, float b, taut_combine rule_a, taut_combine rule_b, Usual usual) {
    const taut_combine named = std::max(rule_a, rule_b);
    return named == TAUT_COMBINE_DEFAULT ? usual(a, b) : kRules[named - TAUT_COMBINE_GEOMETRIC_MEAN](a, b);
}

// Adds the velocity of a collider's surface, whose frame has its origin at `from`, with the sign of its side.
void add_drive(const ColliderTraits& collider, const Mat3f& rotation, const Vec3f& from, float sign, Pair& pair) {
    const Vec3f spin = rotation * collider.surface_spin;
    pair.drive += sign * (rotation * collider.surface_velocity - spin.cross(from));
    pair.drive_spin += sign * spin;
}

// Whether friction torques act: on a body that turns, and not between it and a particle, which takes none.
bool can_turn(const Nodes& nodes, const Pair& pair) {
    const NodeKind kinds[2] = {nodes.info[pair.a].kind, nodes.info[pair.b].kind};
    const auto either = [&](NodeKind kind) { return kinds[0] == kind || kinds[1] == kind; };
    return either(NodeKind::dynamic) && !either(NodeKind::particle);
}

// The smallest factor of friction along a direction.
constexpr double kLeastFactor = 1e-6;

// Friction of a pair by direction. The forces of a surface with the unit direction d and the factor m are those within
// an ellipsoid, F S F <= (mu N)^2 with S = 1 + e d d^T, e = 1/m^2 - 1; on the contact's plane d is (x, y). Of two
// surfaces e d d^T adds up. With the eigenvalues s >= l >= 0 of this sum E the axes are mu / sqrt(1 + s) along its
// eigenvector and mu / sqrt(1 + l) across.
void direct_friction(const ColliderTraits& a, const ColliderTraits& b, const collision::Placement& at_a,
                     const collision::Placement& at_b, Pair& pair) {
    const Vec3 n = pair.manifold.normal.cast<double>(), t1 = tangent_of(pair.manifold.normal).cast<double>(),
               t2 = n.cross(t1);
    double x[2] = {0, 0}, y[2] = {0, 0};  // times the root of e
    const auto project = [&](const ColliderTraits& of, const collision::Placement& at, int side) {
        if (!of.directed()) return;
        const double factor = std::max(static_cast<double>(of.slide_factor), kLeastFactor);
        const Vec3 d = std::sqrt(1 / (factor * factor) - 1) * (at.rotation * of.slide_direction).cast<double>();
        x[side] = d.dot(t1), y[side] = d.dot(t2);
    };
    project(a, at_a, 0);
    project(b, at_b, 1);
    const double xx = x[0] * x[0] + x[1] * x[1], yy = y[0] * y[0] + y[1] * y[1], xy = x[0] * y[0] + x[1] * y[1];
    const double half = 0.5 * (xx + yy), diff = 0.5 * (xx - yy), root = std::sqrt(diff * diff + xy * xy);
    const double area = x[0] * y[1] - x[1] * y[0], largest = half + root;
    pair.slide_factor = 1;
    if (!(largest > 0)) return;
    const double least = std::min(area * area / largest, largest);
    const double u = diff >= 0 ? diff + root : xy, v = diff >= 0 ? xy : root - diff;
    const auto shorter = static_cast<float>(1 / std::sqrt(1 + least));
    pair.friction *= shorter;
    pair.sticking *= shorter;
    pair.slide_factor = static_cast<float>(std::sqrt((1 + least) / (1 + largest)));
    const Vec3 along = u * t1 + v * t2;
    if (root > 0)
        pair.slide_direction = along.normalized().cast<float>();
    else
        pair.slide_factor = 1;
}

}  // namespace

float friction_of(const taut_material& a, const taut_material& b) {
    return combine(a.friction, b.friction, a.friction_rule, b.friction_rule,
                   [](float x, float y) { return std::sqrt(x * y); });
}

float static_friction_of(const ColliderTraits& a, const ColliderTraits& b) {
    const auto sticking = [](const ColliderTraits& of) {
        taut_material material = of.material;
        material.friction = std::max(of.static_friction, material.friction);
        return material;
    };
    return friction_of(sticking(a), sticking(b));
}

float restitution_of(const taut_material& a, const taut_material& b) {
    return combine(a.restitution, b.restitution, a.restitution_rule, b.restitution_rule,
                   [](float x, float y) { return std::max(x, y); });
}

void combine_surfaces(const Nodes& nodes, const ColliderTraits& a, const ColliderTraits& b,
                      const collision::Placement& at_a, const collision::Placement& at_b, const Vec3f& from_a,
                      Pair& pair) {
    const taut_material &one = a.material, &other = b.material;
    pair.friction = friction_of(one, other);
    const bool sticks_better = a.static_friction > one.friction || b.static_friction > other.friction;
    pair.sticking = sticks_better ? static_friction_of(a, b) : 0;
    pair.directed = a.directed() || b.directed();
    if (pair.directed)
        direct_friction(a, b, at_a, at_b, pair);
    else
        pair.slide_factor = 1;
    pair.restitution = restitution_of(one, other);
    pair.spinning = std::max(one.spinning_friction, other.spinning_friction);
    pair.rolling = std::max(one.rolling_friction, other.rolling_friction);
    if (pair.twists() && !can_turn(nodes, pair)) pair.spinning = pair.rolling = pair.patch = 0;
    pair.driven = a.driven() || b.driven();
    if (!pair.driven) return;
    pair.drive = pair.drive_spin = Vec3f::Zero();
    add_drive(a, at_a.rotation, from_a, 1, pair);
    add_drive(b, at_b.rotation, from_a + (at_b.position - at_a.position).cast<float>(), -1, pair);
}

}  // namespace taut
