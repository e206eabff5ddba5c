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

}  // namespace

float friction_of(const taut_material& a, const taut_material& b) {
    return combine(a.friction, b.friction, a.friction_rule, b.friction_rule,
                   [](float x, float y) { return std::sqrt(x * y); });
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
