#include "detect/pre_solve.h"

#include <algorithm>

#include "detect/approach.h"
#include "detect/drop_contacts.h"
#include "detect/surface_point.h"
#include "state/handle.h"

namespace taut {
namespace {

constexpr float kLeastCosine = 0.5f;     // between a contact's normal and a one-way direction
constexpr float kDeepestEntry = 0.005f;  // overlap at which a one-way collider still takes up a contact [m]
constexpr float kMostFriction = 100;

// Whether a collider lets a contact be whose normal, out of it, is given.
bool is_open(const Colliders& colliders, const Pairs& pairs, uint32_t collider, const Vec3f& outward) {
    const Vec3f& direction = colliders.traits[collider].one_way;
    if (direction == Vec3f::Zero()) return true;
    return (pairs.placement[collider].rotation * direction).dot(outward) >= kLeastCosine;
}

// Whether one-way colliders of a pair let the contact be. touching: the pair did in the last step.
bool from_open_side(const Colliders& colliders, const Pairs& pairs, const Pair& pair, bool touching) {
    const Vec3f& normal = pair.manifold.normal;
    if (!is_open(colliders, pairs, pair.collider_a(), normal) || !is_open(colliders, pairs, pair.collider_b(), -normal))
        return false;
    return touching || std::all_of(pair.manifold.points, pair.manifold.points + pair.manifold.count,
                                   [](const auto& point) { return point.separation >= -kDeepestEntry; });
}

taut_pre_solve question_about(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const Pair& pair,
                              bool touching) {
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), pairs.world});
    };
    const Vec3f& n = pair.manifold.normal;
    const Vec3 origin = nodes.origin(pair.a);
    const RelativeMotion motion = relative_motion(nodes, pair);
    taut_pre_solve out{};
    out.body_a = {bits(nodes.ids, pair.a)};
    out.body_b = {bits(nodes.ids, pair.b)};
    out.collider_a = {bits(colliders.ids, pair.collider_a())};
    out.collider_b = {bits(colliders.ids, pair.collider_b())};
    out.point_count = static_cast<uint32_t>(pair.manifold.count);
    out.touching = touching;
    out.normal = {n.x(), n.y(), n.z()};
    for (int k = 0; k < pair.manifold.count; ++k) {
        const collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 at = origin + point.position.cast<double>();
        out.points[k] = {{at.x(), at.y(), at.z()}, point.separation, motion.approach(point.position, n)};
    }
    return out;
}

enum class Verdict { ignored, accepted, refused };

// A number that is not one fails both comparisons.
bool within(float x, float most) { return x >= 0 && x <= most; }

// Of a pair, or a contact of surfaces: contact.
template <class Contact>
Verdict ask_host(const PreSolve& pre_solve, const taut_pre_solve& question, Contact& contact) {
    taut_pre_solve_answer answer{contact.friction, contact.restitution};
    int32_t said = -1;
    try {
        said = pre_solve.ask(&question, &answer, pre_solve.user_data);
    } catch (...) {  // half of the step is done
    }
    if (said == 0) return Verdict::ignored;
    if (said != 1 || !within(answer.friction, kMostFriction) || !within(answer.restitution, 1)) return Verdict::refused;
    taut::answer(answer.friction, answer.restitution, contact);
    return Verdict::accepted;
}

// ---------------------------------------------------------------- surfaces

// Of a contact, whose one point is midway between its sides.
taut_pre_solve question_about(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
                              const SurfaceContact& contact) {
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), pairs.world});
    };
    const bool turned = contact.collider[1] > contact.collider[0];  // a is the side of the weights above 0
    const float sign = turned ? 1.0f : -1.0f;
    const SurfaceSide a = side_of(nodes, colliders, shapes, contact, sign),
                      b = side_of(nodes, colliders, shapes, contact, -sign);
    const Vec3f n = turned ? Vec3f(-contact.normal) : contact.normal;
    const Vec3 at = 0.5 * (a.at + b.at);
    taut_pre_solve out{};
    out.body_a = {bits(nodes.ids, a.node)};
    out.body_b = {bits(nodes.ids, b.node)};
    out.collider_a = {bits(colliders.ids, contact.collider[turned ? 0 : 1])};
    out.collider_b = {bits(colliders.ids, contact.collider[turned ? 1 : 0])};
    out.point_count = 1;
    out.touching = contact.pushes() || contact.pushed > 0;
    out.normal = {n.x(), n.y(), n.z()};
    out.points[0] = {{at.x(), at.y(), at.z()}, contact.gap, closing_speed(nodes, contact)};
    return out;
}

bool from_open_side(const Colliders& colliders, const Pairs& pairs, const SurfaceContact& contact) {
    if (!is_open(colliders, pairs, contact.collider[1], contact.normal) ||
        !is_open(colliders, pairs, contact.collider[0], -contact.normal))
        return false;
    return contact.pushes() || contact.pushed > 0 || contact.gap >= -kDeepestEntry;
}

// Sum w_i v_i that friction drives to: the velocity of the surface with weights < 0 less that of the other, both
// against their bodies.
void set_drive(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
               SurfaceContact& contact) {
    contact.drive = Vec3f::Zero();
    for (const int side : {0, 1}) {
        const uint32_t collider = contact.collider[side];
        const ColliderTraits& traits = colliders.traits[collider];
        if (!traits.driven() || nodes.info[colliders.record[collider].node].soft != kNone) continue;
        const float sign = side == 0 ? 1.0f : -1.0f;
        const collision::Placement& at = pairs.placement[collider];
        const Vec3f arm = (side_of(nodes, colliders, shapes, contact, sign).at - at.position).cast<float>();
        const Vec3f spin = at.rotation * traits.surface_spin;
        contact.drive -= sign * (at.rotation * traits.surface_velocity + spin.cross(arm));
    }
}

}  // namespace

uint32_t filter_contacts(const Nodes& nodes, const Colliders& colliders, const PreSolve& pre_solve, Pairs& pairs) {
    const uint32_t filters = kAsksOneWay | (pre_solve.ask ? kAsksPreSolve : 0);
    const auto is_filtered = [&](const ActivePair& pair) { return (pair.asks & filters) != 0; };
    uint32_t refused = 0;
    const auto is_ignored = [&](const ActivePair& item, const NearPair& near) {
        if (!is_filtered(item)) return false;
        Pair& pair = pairs.list[item.pair];
        if ((item.asks & kAsksOneWay) && !from_open_side(colliders, pairs, pair, near.touching)) return true;
        if (!(item.asks & filters & kAsksPreSolve)) return false;
        const Verdict verdict = ask_host(pre_solve, question_about(nodes, colliders, pairs, pair, near.touching), pair);
        pair.answered = pair.answered || verdict == Verdict::accepted;
        refused += verdict == Verdict::refused;
        return verdict == Verdict::ignored;
    };
    if (std::any_of(pairs.active.begin(), pairs.active.end(), is_filtered))
        drop_contacts(nodes, colliders, pairs, is_ignored);
    return refused;
}

uint32_t filter_surfaces(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                         const PreSolve& pre_solve, const Pairs& pairs, Array<SurfaceContact>& contacts) {
    const uint32_t filters = kAsksOneWay | (pre_solve.ask ? kAsksPreSolve : 0);
    uint32_t refused = 0;
    const auto is_ignored = [&](SurfaceContact& contact) {
        const auto [one, other] = contact.collider;
        if (!colliders.ids.live(one) || !colliders.ids.live(other)) return false;
        set_drive(nodes, colliders, shapes, pairs, contact);
        const uint32_t asks = (colliders.record[one].asks | colliders.record[other].asks) & filters;
        if (asks == 0 || !is_awake(nodes, contact)) return false;
        if ((asks & kAsksOneWay) && !from_open_side(colliders, pairs, contact)) return true;
        if (!(asks & kAsksPreSolve)) return false;
        const Verdict verdict = ask_host(pre_solve, question_about(nodes, colliders, shapes, pairs, contact), contact);
        refused += verdict == Verdict::refused;
        return verdict == Verdict::ignored;
    };
    std::erase_if(contacts, is_ignored);
    return refused;
}

}  // namespace taut
