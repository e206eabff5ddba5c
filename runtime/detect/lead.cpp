#include "detect/lead.h"

#include <algorithm>

#include "state/levers.h"

namespace taut {
namespace {

bool is_round(const Pace& pace) { return pace.rolls || pace.round > 0; }

// One side of a contact that was found in a lead time.
struct LeadingSide {
    Movement moves;
    double time, round;  // the lead time [s], radius [m]
    Vec3 outward;
    Axle axle;
    bool follows;  // levers turn with it within the frame

    LeadingSide(const Detection& of, uint32_t node, double lead, const Vec3& o, float ball, const Axle& its_axle)
        : moves(movement_of(of.nodes, node, kNone)),
          time(lead),
          round(static_cast<double>(ball)),
          outward(o),
          axle(its_axle),
          follows(of.time * moves.w.norm() > kLeverTurn) {}

    // Of a point found then: of now where levers turn on from here, else as it is then.
    Lever lever(const Vec3& found) const {
        if (follows) return lever_of(found, outward, round, axle, rotation_from_vector(time * moves.w));
        return lever_of(found, outward, round, axle);
    }
    Vec3 way(const Lever& lever) const {
        return follows ? way_of(lever, outward, axle, moves, time) : time * (moves.v + moves.w.cross(lever.at));
    }
};

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
    const auto bears = [](const ContactForce& force) { return force.normal > 0; };
    if (std::none_of(pair.force, pair.force + pair.manifold.count, bears)) return 0;
    const Stance &a = of.pairs.stance[pair.collider_a()], &b = of.pairs.stance[pair.collider_b()];
    const float most = kStill / static_cast<float>(of.lead);
    const auto moves = [&](const Stance& side) {
        return !((side.velocity.norm() + side.size * side.spin.norm()) <= most);
    };
    return moves(a) || moves(b) ? of.lead : 0;
}

void bring_back(const Detection& of, double lead, const Vec3f& from_a, Pair& pair) {
    const Vec3 arm_a = of.nodes.motion[pair.a].x - of.nodes.origin(pair.a);
    const Vec3 arm_b = of.nodes.motion[pair.b].x - of.nodes.origin(pair.b);
    const Axles axles = axles_of(of.pairs, pair, arm_a, arm_b);
    const Vec3 n = pair.manifold.normal.cast<double>();
    const LeadingSide a(of, pair.a, lead, n, pair.round_a, axles.a), b(of, pair.b, lead, -n, pair.round_b, axles.b);
    const double mass_a = of.nodes.mass[pair.a].inv_mass, mass_b = of.nodes.mass[pair.b].inv_mass;
    const double share_of_b = mass_a + mass_b > 0 ? mass_b / (mass_a + mass_b) : 0;
    const Vec3 apart = b.moves.x - a.moves.x, arm_then = rotation_from_vector(lead * a.moves.w) * arm_a;
    for (int k = 0; k < pair.manifold.count; ++k) {
        collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 half = 0.5 * static_cast<double>(point.separation) * n;
        const Vec3 found = (point.position + from_a).cast<double>() - arm_then;
        const Lever lever_a = a.lever(found - half);
        const Lever lever_b = b.lever(found + half - apart - lead * (b.moves.v - a.moves.v));
        point.separation -= static_cast<float>(n.dot(b.way(lever_b) - a.way(lever_a)));
        const Vec3 on_a = lever_a.at + half, on_b = apart + lever_b.at - half;
        point.position = (arm_a + on_a + share_of_b * (on_b - on_a)).cast<float>();
    }
}

}  // namespace taut
