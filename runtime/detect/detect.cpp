#include "detect/detect.h"

#include <algorithm>

namespace taut {
namespace {

// Points further apart than this are not the same point of two frames [m].
constexpr float kSamePoint = 0.02f;
// A frame's motion counts towards the contact margin up to this [m].
constexpr double kMaxReach = 0.5;

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

// A pair's new manifold: its place and surface, and the impulses of the old one.
void adopt(const Colliders& colliders, const Pairs& pairs, const collision::Manifold& old, const Impulse* before,
           Pair& pair) {
    const uint32_t a = pair.collider_a();
    move_to_node(colliders.record[a], pairs.placement[a], pair.manifold);
    combine_surfaces(colliders.record[a], colliders.record[pair.collider_b()], pair);
    if (old.count == 0) {
        std::fill(pair.impulse, pair.impulse + 4, Impulse{});
        return;
    }
    Impulse carried[4];
    std::copy(before, before + 4, carried);
    carry_impulses(old, carried, pair.manifold, pair.impulse);
}

// Two shapes as they stand in a pair.
struct Shaped {
    const collision::Shape &a, &b;
    const collision::Placement &at_a, &at_b;
    float margin;

    Shaped(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs, const Pair& pair,
           double time)
        : a(shapes.record[colliders.record[pair.collider_a()].shape].shape),
          b(shapes.record[colliders.record[pair.collider_b()].shape].shape),
          at_a(pairs.placement[pair.collider_a()]),
          at_b(pairs.placement[pair.collider_b()]),
          margin(margin_of(nodes.motion[pair.a], nodes.motion[pair.b], time)) {}

    bool has_parts() const { return collision::has_parts(a) || collision::has_parts(b); }
    void find_parts(collision::Parts& parts) const { collision::collide_parts(a, at_a, b, at_b, margin, parts); }
};

// Manifold of one pair at the present placements, with the impulses of the last one.
void find_points(const Shaped& shaped, const Colliders& colliders, const Pairs& pairs, Pair& pair) {
    const collision::Manifold old = pair.manifold;
    collision::collide(shaped.a, shaped.at_a, shaped.b, shaped.at_b, shaped.margin, pair.cache, pair.manifold);
    if (pair.manifold.count > 0) adopt(colliders, pairs, old, pair.impulse, pair);
}

// The record that a part takes over: its own; else, as where a body slides from facet to facet, that of a part no
// longer touched that looked about the same way. Null if there is none.
const Pair* find_old(std::span<const Pair> old, const collision::Parts& parts, const collision::PartManifold& part) {
    constexpr float kAlike = 0.95f;  // cosine between the normals
    const auto now = [&](uint32_t number) {
        const auto at = std::lower_bound(parts.found.begin(), parts.found.end(), number,
                                         [](const auto& found, uint32_t p) { return found.part < p; });
        return at != parts.found.end() && at->part == number;
    };
    const Pair* like = nullptr;
    float most = kAlike;
    for (const Pair& pair : old) {
        if (pair.part == part.part) return &pair;
        const float along = pair.manifold.normal.dot(part.manifold.normal);
        if (pair.manifold.count == 0 || along <= most || now(pair.part)) continue;
        most = along;
        like = &pair;
    }
    return like;
}

// The parts that a pair with a surface touches, into pairs.fresh; old: its records of the last frame.
void find_parts(const Shaped& shaped, const Colliders& colliders, Pairs& pairs, std::span<Pair> old) {
    Pair& first = old[0];
    first.manifold.count = 0;
    shaped.find_parts(pairs.parts);
    for (const collision::PartManifold& found : pairs.parts.found) {
        const Pair* before = find_old(old.subspan(1), pairs.parts, found);
        Pair& pair = pairs.fresh.emplace_back();
        pair.key = first.key;
        pair.a = first.a;
        pair.b = first.b;
        pair.part = found.part;
        pair.manifold = found.manifold;
        pair.touching = before && before->part == found.part && before->touching;
        adopt(colliders, pairs, before ? before->manifold : first.manifold, before ? before->impulse : first.impulse,
              pair);
    }
}

// The fresh parts in place of the old ones, and the active pairs anew.
void replace_parts(Pairs& pairs) {
    pairs.scratch.clear();
    auto next = pairs.fresh.begin();
    for (const Pair& pair : pairs.list) {
        if (pair.part != 0) continue;
        pairs.scratch.push_back(pair);
        while (next != pairs.fresh.end() && next->key == pair.key) pairs.scratch.push_back(*next++);
    }
    pairs.list.swap(pairs.scratch);
    pairs.active.clear();
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        const Pair& pair = pairs.list[i];
        if (!pair.filtered && pair.manifold.count > 0)
            pairs.active.push_back({pair.a, pair.b, i, static_cast<uint32_t>(pair.manifold.count)});
    }
}

// A part of a pair whose parts were just found again: one that is not among them loses its points.
void refresh_part(const Colliders& colliders, const Pairs& pairs, Pair& pair) {
    const collision::Manifold old = pair.manifold;
    pair.manifold.count = 0;
    for (const collision::PartManifold& found : pairs.parts.found)
        if (found.part == pair.part) pair.manifold = found.manifold;
    if (pair.manifold.count > 0) adopt(colliders, pairs, old, pair.impulse, pair);
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

void update_bounds(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                   collision::Broadphase& broadphase, double time_step) {
    for (uint32_t c = 0; c < colliders.record.size(); ++c) {
        const Collider& collider = colliders.record[c];
        if (collider.node == kNone || nodes.info[collider.node].kind == NodeKind::fixed) continue;
        collision::Box box = contact_box(nodes, shapes, collider);
        Vec3f reach = (time_step * nodes.motion[collider.node].v).cast<float>();
        const float length = reach.norm();
        if (length > kMaxReach) reach *= static_cast<float>(kMaxReach) / length;
        box.lo += reach.cwiseMin(0.0f);
        box.hi += reach.cwiseMax(0.0f);
        broadphase.update(c, box, reach);
    }
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

void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep) {
    uint64_t found = 0;  // the pair whose parts are found; its records follow one another
    for (uint32_t p : active_pairs) {
        ActivePair& active = pairs.active[p];
        Pair& pair = pairs.list[active.pair];
        for (uint32_t c : {pair.collider_a(), pair.collider_b()})
            pairs.placement[c] = placement_of(nodes, colliders.record[c], elapsed);
        const Shaped shaped(nodes, colliders, shapes, pairs, pair, substep);
        if (pair.part == 0) {
            find_points(shaped, colliders, pairs, pair);
        } else {
            if (pair.key != found) shaped.find_parts(pairs.parts);
            found = pair.key;
            refresh_part(colliders, pairs, pair);
        }
        active.points = static_cast<uint32_t>(pair.manifold.count);
    }
}

void find_contacts(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step) {
    pairs.placement.resize(colliders.record.size());
    for (uint32_t c = 0; c < colliders.record.size(); ++c)
        if (colliders.record[c].node != kNone) pairs.placement[c] = placement_of(nodes, colliders.record[c]);
    pairs.active.clear();
    pairs.fresh.clear();
    bool parts = false;
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        Pair& pair = pairs.list[i];
        parts = parts || pair.part != 0;
        if (pair.filtered || pair.part != 0) continue;
        const Shaped shaped(nodes, colliders, shapes, pairs, pair, time_step);
        const size_t fresh = pairs.fresh.size();
        if (shaped.has_parts()) {
            size_t end = i + 1;
            while (end < pairs.list.size() && pairs.list[end].part != 0) ++end;
            find_parts(shaped, colliders, pairs, std::span(pairs.list).subspan(i, end - i));
        } else {
            find_points(shaped, colliders, pairs, pair);
        }
        if (pair.manifold.count > 0) {
            pairs.active.push_back({pair.a, pair.b, i, static_cast<uint32_t>(pair.manifold.count)});
        } else if (pairs.fresh.size() == fresh && pair.touching) {
            report_end(pairs, nodes, colliders, pair);
            pair.touching = false;
        }
    }
    if (parts || !pairs.fresh.empty()) replace_parts(pairs);
}

}  // namespace taut
