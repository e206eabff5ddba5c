#include "detect/lead.h"

#include <algorithm>

namespace taut {
namespace {

bool is_round(const Pace& pace) { return pace.rolls || pace.round > 0; }

}  // namespace

float patch_of(const Pairs& pairs, const PairEnds& pair) {
    constexpr float kPatch = 0.03f;
    const uint32_t a = pair.collider_a(), b = pair.collider_b();
    if (pair.a2 != kNone || pair.b2 != kNone || !(is_round(pairs.pace[a]) || is_round(pairs.pace[b]))) return 0;
    return kPatch * std::min(pairs.stance[a].size, pairs.stance[b].size);
}

double lead_of(const Detection& of, const Pair& pair) {
    constexpr float kStill = 5e-5f;  // [m], as in reuse.cpp
    if (of.lead == 0 || pair.patch == 0) return 0;
    const auto bears = [](const Impulse& impulse) { return impulse.normal > 0; };
    if (std::none_of(pair.impulse, pair.impulse + pair.manifold.count, bears)) return 0;
    const Stance &a = of.pairs.stance[pair.collider_a()], &b = of.pairs.stance[pair.collider_b()];
    const float most = kStill / static_cast<float>(of.lead);
    const auto moves = [&](const Stance& side) {
        return !((side.velocity.norm() + side.size * side.spin.norm()) <= most);
    };
    return moves(a) || moves(b) ? of.lead : 0;
}

void bring_back(const Detection& of, double lead, const Vec3f& from_a, Pair& pair) {
    const NodeMotion &a = of.nodes.motion[pair.a], &b = of.nodes.motion[pair.b];
    const double mass_a = of.nodes.mass[pair.a].inv_mass, mass_b = of.nodes.mass[pair.b].inv_mass;
    const Vec3 arm = a.x - of.nodes.origin(pair.a), arm_then = rotation_from_vector(lead * a.w) * arm;
    const Vec3 apart = lead * (b.v - a.v), n = pair.manifold.normal.cast<double>();
    const double share_of_b = mass_a + mass_b > 0 ? mass_b / (mass_a + mass_b) : 0;
    for (int k = 0; k < pair.manifold.count; ++k) {
        collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 lever_a = (point.position + from_a).cast<double>() - arm_then;
        const Vec3 lever_b = lever_a - (b.x - a.x + apart);
        point.position = (arm + lever_a - share_of_b * apart).cast<float>();
        point.separation -= static_cast<float>(n.dot(apart + lead * (b.w.cross(lever_b) - a.w.cross(lever_a))));
    }
}

}  // namespace taut
