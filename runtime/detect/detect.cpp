#include "detect/detect.h"

#include <algorithm>

namespace taut {
namespace {

// Points further apart than this are not the same point of two frames [m].
constexpr float kSamePoint = 0.02f;
// A frame's motion counts towards the contact margin up to this [m].
constexpr double kMaxReach = 0.5;
constexpr uint32_t kGrain = 64;  // colliders or pairs that a thread takes at a time

bool filters_agree(const taut_filter& a, const taut_filter& b) {
    if (a.group != 0 && a.group == b.group) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

bool may_collide(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const Pair& pair) {
    if (pair.a == pair.b) return false;
    if (!moves_by_forces(nodes.info[pair.a].kind) && !moves_by_forces(nodes.info[pair.b].kind)) return false;
    const Collider &a = colliders.record[pair.collider_a()], &b = colliders.record[pair.collider_b()];
    return filters_agree(a.filter, b.filter) &&
           !std::binary_search(pairs.joined.begin(), pairs.joined.end(), pair_key(pair.a, pair.b));
}

bool moves(const Nodes& nodes, const Collider& collider) {
    return collider.node != kNone && nodes.info[collider.node].kind != NodeKind::fixed;
}

// Keys of nodes that a joint forbids to collide, sorted.
void refresh_joined(const Joints& joints, Pairs& pairs) {
    if (pairs.joined_version == joints.version) return;
    pairs.joined.clear();
    for (const Joint& joint : joints.record) {
        if (!joint.type || joint.collide_connected || joint.node[0] == kNone || joint.node[1] == kNone) continue;
        pairs.joined.push_back(pair_key(joint.node[0], joint.node[1]));
    }
    std::sort(pairs.joined.begin(), pairs.joined.end());
    pairs.joined_version = joints.version;
}

// How far two bodies can approach each other in a frame, so that a fast pair meets its contacts before it overlaps.
float margin_of(const NodeMotion& a, const NodeMotion& b, double time_step) {
    return kContactMargin + static_cast<float>(std::min(kMaxReach, (a.v - b.v).norm() * time_step));
}

// Impulses of the old points onto the new ones: by feature, else by place; friction turned into the new tangents.
void carry_impulses(const collision::Manifold& old, const Impulse* from, const collision::Manifold& now, Impulse* to) {
    const Vec3f t1 = tangent_of(now.normal), t2 = now.normal.cross(t1);
    const Vec3f o1 = tangent_of(old.normal), o2 = old.normal.cross(o1);
    bool used[4] = {}, found[4] = {};
    auto take = [&](int i, int k) {
        const Vec3f friction = from[k].tangent1 * o1 + from[k].tangent2 * o2;
        to[i] = {from[k].normal, friction.dot(t1), friction.dot(t2), from[k].slip};
        used[k] = found[i] = true;
    };
    for (int i = 0; i < now.count; ++i)
        for (int k = 0; k < old.count && !found[i]; ++k)
            if (!used[k] && old.points[k].feature == now.points[i].feature) take(i, k);
    for (int i = 0; i < now.count; ++i) {
        if (found[i]) continue;
        to[i] = {};
        float nearest = kSamePoint * kSamePoint;
        int best = -1;
        for (int k = 0; k < old.count; ++k) {
            const float d = (old.points[k].position - now.points[i].position).squaredNorm();
            if (!used[k] && d < nearest) nearest = d, best = k;
        }
        if (best >= 0) take(i, best);
    }
}

// Two surfaces in touch: the geometric mean of their friction, the livelier restitution.
void combine_surfaces(const Collider& a, const Collider& b, Pair& pair) {
    pair.friction = std::sqrt(a.material.friction * b.material.friction);
    pair.restitution = std::max(a.material.restitution, b.material.restitution);
}

// From the origin of a collider's shape, which the narrowphase knows, to that of its node.
void move_to_node(const Collider& a, const collision::Placement& at, collision::Manifold& manifold) {
    if (a.position == Vec3::Zero()) return;
    const Mat3f body_rotation = at.rotation * a.rotation.conjugate().toRotationMatrix().cast<float>();
    const Vec3f offset = body_rotation * a.position.cast<float>();
    for (int k = 0; k < manifold.count; ++k) manifold.points[k].position += offset;
}

// Manifold of one pair at the present placements, with the impulses of the last one.
void find_points(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs, Pair& pair,
                 double time) {
    const uint32_t a = pair.collider_a(), b = pair.collider_b();
    const Collider &collider_a = colliders.record[a], &collider_b = colliders.record[b];
    const collision::Manifold old = pair.manifold;
    collision::collide(shapes.record[collider_a.shape].shape, pairs.placement[a], shapes.record[collider_b.shape].shape,
                       pairs.placement[b], margin_of(nodes.motion[pair.a], nodes.motion[pair.b], time), pair.cache,
                       pair.manifold);
    if (pair.manifold.count == 0) return;
    move_to_node(collider_a, pairs.placement[a], pair.manifold);
    combine_surfaces(collider_a, collider_b, pair);
    if (old.count == 0) {
        std::fill(pair.impulse, pair.impulse + 4, Impulse{});
        return;
    }
    Impulse before[4];
    std::copy(pair.impulse, pair.impulse + 4, before);
    carry_impulses(old, before, pair.manifold, pair.impulse);
}

}  // namespace

collision::Placement placement_of(const Nodes& nodes, const Collider& collider, double elapsed) {
    const NodeMotion& m = nodes.motion[collider.node];
    const bool ahead = nodes.info[collider.node].kind == NodeKind::kinematic && elapsed > 0;
    const Quat q = ahead ? rotation_from_vector(elapsed * m.w) * m.q : m.q;
    const Vec3 x = ahead ? Vec3(m.x + elapsed * m.v) : m.x;
    const Mat3 R = q.toRotationMatrix();
    const Vec3 origin = x - R * nodes.mass[collider.node].centre;
    if (collider.at_origin()) return {origin, R.cast<float>()};
    return {origin + R * collider.position, (R * collider.rotation.toRotationMatrix()).cast<float>()};
}

collision::Box contact_box(const Nodes& nodes, const Shapes& shapes, const Collider& collider) {
    collision::Box box = collision::bounds(shapes.record[collider.shape].shape, placement_of(nodes, collider));
    box.lo.array() -= kContactMargin;
    box.hi.array() += kContactMargin;
    return box;
}

void update_bounds(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   collision::Broadphase& broadphase, double time_step) {
    const uint32_t slots = static_cast<uint32_t>(colliders.record.size());
    pairs.reach.resize(slots);
    team.for_ranges(slots, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c) {
            const Collider& collider = colliders.record[c];
            if (!moves(nodes, collider)) continue;
            collision::Box box = contact_box(nodes, shapes, collider);
            Vec3f ahead = (time_step * nodes.motion[collider.node].v).cast<float>();
            const float length = ahead.norm();
            if (length > kMaxReach) ahead *= static_cast<float>(kMaxReach) / length;
            box.lo += ahead.cwiseMin(0.0f);
            box.hi += ahead.cwiseMax(0.0f);
            pairs.reach[c] = {box, ahead};
        }
    });
    for (uint32_t c = 0; c < slots; ++c)
        if (moves(nodes, colliders.record[c])) broadphase.update(c, pairs.reach[c].box, pairs.reach[c].ahead);
}

void note_strays(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                 std::span<const uint32_t> frozen, Pairs& pairs, collision::Broadphase& broadphase) {
    const uint32_t slots = static_cast<uint32_t>(colliders.record.size());
    team.for_ranges(slots, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c) {
            const Collider& collider = colliders.record[c];
            if (!moves(nodes, collider)) continue;
            const collision::Placement at = placement_of(nodes, collider);
            pairs.reach[c] = {collision::bounds(shapes.record[collider.shape].shape, at), Vec3f::Zero()};
        }
    });
    broadphase.clear_strays();
    for (uint32_t c = 0; c < slots; ++c)
        if (moves(nodes, colliders.record[c])) broadphase.note_stray(c, pairs.reach[c].box);
    for (const uint32_t node : frozen)
        for_colliders(nodes, colliders, node, [&](uint32_t c) {
            broadphase.update(c, contact_box(nodes, shapes, colliders.record[c]), Vec3f::Zero());
        });
}

void update_pairs(const Nodes& nodes, const Colliders& colliders, const Joints& joints,
                  collision::Broadphase& broadphase, Pairs& pairs) {
    refresh_joined(joints, pairs);
    const bool changed = broadphase.refresh_pairs();
    const auto keys = broadphase.pairs();
    if (!changed && keys.size() == pairs.list.size()) return;
    pairs.scratch.clear();
    size_t old = 0;
    for (uint64_t key : keys) {
        for (; old < pairs.list.size() && pairs.list[old].key < key; ++old) {  // left the broadphase
            if (pairs.list[old].touching) report_end(pairs, nodes, colliders, pairs.list[old]);
        }
        if (old < pairs.list.size() && pairs.list[old].key == key) {
            pairs.scratch.push_back(pairs.list[old++]);
            continue;
        }
        Pair& pair = pairs.scratch.emplace_back();
        pair.key = key;
        pair.a = colliders.record[pair.collider_a()].node;
        pair.b = colliders.record[pair.collider_b()].node;
        pair.filtered = !may_collide(nodes, colliders, pairs, pair);
    }
    for (; old < pairs.list.size(); ++old)
        if (pairs.list[old].touching) report_end(pairs, nodes, colliders, pairs.list[old]);
    pairs.list.swap(pairs.scratch);
}

void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep) {
    for (uint32_t p : active_pairs) {
        ActivePair& active = pairs.active[p];
        Pair& pair = pairs.list[active.pair];
        for (uint32_t c : {pair.collider_a(), pair.collider_b()})
            pairs.placement[c] = placement_of(nodes, colliders.record[c], elapsed);
        find_points(nodes, colliders, shapes, pairs, pair, substep);
        active.points = static_cast<uint32_t>(pair.manifold.count);
    }
}

void find_contacts(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step) {
    const uint32_t slots = static_cast<uint32_t>(colliders.record.size());
    pairs.placement.resize(slots);
    team.for_ranges(slots, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c)
            if (colliders.record[c].node != kNone) pairs.placement[c] = placement_of(nodes, colliders.record[c]);
    });
    team.for_ranges(static_cast<uint32_t>(pairs.list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            if (!pairs.list[i].filtered) find_points(nodes, colliders, shapes, pairs, pairs.list[i], time_step);
    });
    pairs.active.clear();
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        Pair& pair = pairs.list[i];
        if (pair.filtered) continue;
        if (pair.manifold.count == 0) {
            if (pair.touching) report_end(pairs, nodes, colliders, pair);
            pair.touching = false;
            continue;
        }
        pairs.active.push_back({pair.a, pair.b, i, static_cast<uint32_t>(pair.manifold.count)});
    }
}

}  // namespace taut
