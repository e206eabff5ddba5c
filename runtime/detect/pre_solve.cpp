#include "detect/pre_solve.h"

#include "detect/drop_contacts.h"

#include <algorithm>

#include "detect/approach.h"
#include "state/handle.h"

namespace taut {
namespace {

constexpr float kLeastCosine = 0.5f;     // between a contact's normal and a one-way direction
constexpr float kDeepestEntry = 0.005f;  // overlap at which a one-way collider still takes up a contact [m]
constexpr float kMostFriction = 100;

// Whether one-way colliders of a pair let the contact be. touching: the pair did in the last step.
bool from_open_side(const Colliders& colliders, const Pairs& pairs, const Pair& pair, bool touching) {
    const auto faces = [&](uint32_t collider, const Vec3f& outward) {
        const Vec3f& direction = colliders.traits[collider].one_way;
        if (direction == Vec3f::Zero()) return true;
        return (pairs.placement[collider].rotation * direction).dot(outward) >= kLeastCosine;
    };
    if (!faces(pair.collider_a(), pair.manifold.normal) || !faces(pair.collider_b(), -pair.manifold.normal))
        return false;
    return touching || std::all_of(pair.manifold.points, pair.manifold.points + pair.manifold.count,
                                   [](const auto& point) { return point.separation >= -kDeepestEntry; });
}

taut_pre_solve question_of(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const Pair& pair,
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

Verdict ask_host(const PreSolve& pre_solve, const taut_pre_solve& question, Pair& pair) {
    taut_pre_solve_answer answer{pair.friction, pair.restitution};
    const int32_t said = pre_solve.ask(&question, &answer, pre_solve.user_data);
    if (said == 0) return Verdict::ignored;
    if (said != 1 || !within(answer.friction, kMostFriction) || !within(answer.restitution, 1)) return Verdict::refused;
    pair.friction = answer.friction;
    pair.restitution = answer.restitution;
    pair.answered = true;
    return Verdict::accepted;
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
        const Verdict verdict = ask_host(pre_solve, question_of(nodes, colliders, pairs, pair, near.touching), pair);
        refused += verdict == Verdict::refused;
        return verdict == Verdict::ignored;
    };
    if (std::any_of(pairs.active.begin(), pairs.active.end(), is_filtered))
        drop_contacts(nodes, colliders, pairs, is_ignored);
    return refused;
}

}  // namespace taut
