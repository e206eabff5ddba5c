#include "detect/detect.h"

#include <algorithm>

namespace taut {
namespace {

constexpr uint32_t kGrain = 64;  // colliders that a thread takes at a time

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
    if (broadphase.refresh_pairs()) pairs.complete = false;
    if (pairs.complete) return;
    pairs.scratch.clear();
    size_t old = 0;
    const auto drop = [&](const Pair& pair) {  // it left the broadphase
        if (pair.touching && pair.part == 0) report_end(pairs, nodes, colliders, pair);
    };
    for (uint64_t key : broadphase.pairs()) {
        while (old < pairs.list.size() && pairs.list[old].key < key) drop(pairs.list[old++]);
        if (old < pairs.list.size() && pairs.list[old].key == key) {
            while (old < pairs.list.size() && pairs.list[old].key == key) pairs.scratch.push_back(pairs.list[old++]);
            continue;
        }
        Pair& pair = pairs.scratch.emplace_back();
        pair.key = key;
        pair.a = colliders.record[pair.collider_a()].node;
        pair.b = colliders.record[pair.collider_b()].node;
        pair.filtered = !may_collide(nodes, colliders, pairs, pair);
    }
    while (old < pairs.list.size()) drop(pairs.list[old++]);
    pairs.list.swap(pairs.scratch);
    pairs.complete = true;
}

}  // namespace taut
