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

// Calls act(node of a, node of b) for all nodes of the two sides of a pair.
template <class Act>
void for_sides(const Pair& pair, Act&& act) {
    for (uint32_t a : {pair.a, pair.a2})
        for (uint32_t b : {pair.b, pair.b2})
            if (a != kNone && b != kNone) act(a, b);
}

bool may_collide(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const Pair& pair) {
    bool moves = false, tied = false;
    for_sides(pair, [&](uint32_t a, uint32_t b) {
        moves = moves || moves_by_forces(nodes.info[a].kind) || moves_by_forces(nodes.info[b].kind);
        tied = tied || a == b || std::binary_search(pairs.joined.begin(), pairs.joined.end(), pair_key(a, b));
    });
    const Collider &a = colliders.record[pair.collider_a()], &b = colliders.record[pair.collider_b()];
    return moves && !tied && filters_agree(a.filter, b.filter);
}

// Keys of nodes that a joint forbids to collide, sorted.
void refresh_joined(const Joints& joints, Pairs& pairs) {
    if (pairs.joined_version == joints.version) return;
    pairs.joined.clear();
    for (const Joint& joint : joints.record) {
        if (joint.collide_connected) continue;
        const auto nodes = joint.nodes();
        for (size_t b = 0; b < nodes.size(); ++b)
            for (size_t a = 0; a < b; ++a)
                if (nodes[a] != kNone && nodes[b] != kNone) pairs.joined.push_back(pair_key(nodes[a], nodes[b]));
    }
    std::sort(pairs.joined.begin(), pairs.joined.end());
    pairs.joined_version = joints.version;
}

// How far two bodies can approach each other in a frame, so that a fast pair meets its contacts before it overlaps.
float margin_of(const Nodes& nodes, const Pair& pair, double time_step) {
    double fastest = 0;
    for_sides(pair, [&](uint32_t a, uint32_t b) {
        fastest = std::max(fastest, (nodes.motion[a].v - nodes.motion[b].v).norm());
    });
    return kContactMargin + static_cast<float>(std::min(kMaxReach, fastest * time_step));
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
void move_to_node(const Nodes& nodes, const Collider& a, const collision::Placement& at,
                  collision::Manifold& manifold) {
    if (a.node_b == kNone && a.position == Vec3::Zero()) return;
    const Mat3f body_rotation = at.rotation * a.rotation.conjugate().toRotationMatrix().cast<float>();
    const Vec3f offset = a.node_b == kNone ? Vec3f(body_rotation * a.position.cast<float>())
                                           : Vec3f((at.position - nodes.motion[a.node].x).cast<float>());
    for (int k = 0; k < manifold.count; ++k) manifold.points[k].position += offset;
}

// Manifold of one pair at the present placements, with the impulses of the last one.
void find_points(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs, Pair& pair,
                 double time) {
    const uint32_t a = pair.collider_a(), b = pair.collider_b();
    const Collider &collider_a = colliders.record[a], &collider_b = colliders.record[b];
    const collision::Manifold old = pair.manifold;
    collision::collide(shapes.record[collider_a.shape].shape, pairs.placement[a], shapes.record[collider_b.shape].shape,
                       pairs.placement[b], margin_of(nodes, pair, time), pair.cache, pair.manifold);
    if (pair.manifold.count == 0) return;
    move_to_node(nodes, collider_a, pairs.placement[a], pair.manifold);
    combine_surfaces(collider_a, collider_b, pair);
    if (old.count == 0) {
        std::fill(pair.impulse, pair.impulse + 4, Impulse{});
        return;
    }
    Impulse before[4];
    std::copy(pair.impulse, pair.impulse + 4, before);
    carry_impulses(old, before, pair.manifold, pair.impulse);
}

// A capsule's y axis from one of its nodes to the other.
collision::Placement place_between(const Nodes& nodes, const Collider& collider) {
    const Vec3 &a = nodes.motion[collider.node].x, &b = nodes.motion[collider.node_b].x;
    const Vec3 along = b - a;
    const double length = along.norm();
    const Quat q = length > 0 ? turn_between(Vec3::UnitY(), along / length) : Quat::Identity();
    return {0.5 * (a + b), q.toRotationMatrix().cast<float>()};
}

bool moves(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.info[node].kind != NodeKind::fixed; }

// How far a node moves in a frame, for the broadphase.
Vec3f reach_of(const Nodes& nodes, uint32_t node, double time_step) {
    Vec3f reach = (time_step * nodes.motion[node].v).cast<float>();
    const float length = reach.norm();
    if (length > kMaxReach) reach *= static_cast<float>(kMaxReach) / length;
    return reach;
}

}  // namespace

collision::Placement placement_of(const Nodes& nodes, const Collider& collider, double elapsed) {
    if (collider.node_b != kNone) return place_between(nodes, collider);
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

void update_bounds(const Nodes& nodes, const Colliders& colliders, Shapes& shapes, collision::Broadphase& broadphase,
                   double time_step) {
    for (uint32_t c = 0; c < colliders.record.size(); ++c) {
        const Collider& collider = colliders.record[c];
        if (collider.node == kNone || !(moves(nodes, collider.node) || moves(nodes, collider.node_b))) continue;
        Vec3f reach = reach_of(nodes, collider.node, time_step);
        Vec3f least = reach.cwiseMin(0.0f), most = reach.cwiseMax(0.0f);
        if (collider.node_b != kNone) {
            const Vec3 along = nodes.motion[collider.node_b].x - nodes.motion[collider.node].x;
            shapes.record[collider.shape].shape.size.y() = static_cast<float>(0.5 * along.norm());
            reach = reach_of(nodes, collider.node_b, time_step);
            least = least.cwiseMin(reach);
            most = most.cwiseMax(reach);
        }
        collision::Box box = contact_box(nodes, shapes, collider);
        box.lo += least;
        box.hi += most;
        broadphase.update(c, box, reach);
    }
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
        pair.a2 = colliders.record[pair.collider_a()].node_b;
        pair.b2 = colliders.record[pair.collider_b()].node_b;
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

void find_contacts(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step) {
    pairs.placement.resize(colliders.record.size());
    for (uint32_t c = 0; c < colliders.record.size(); ++c)
        if (colliders.record[c].node != kNone) pairs.placement[c] = placement_of(nodes, colliders.record[c]);
    pairs.active.clear();
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        Pair& pair = pairs.list[i];
        if (pair.filtered) continue;
        find_points(nodes, colliders, shapes, pairs, pair, time_step);
        if (pair.manifold.count == 0) {
            if (pair.touching) report_end(pairs, nodes, colliders, pair);
            pair.touching = false;
            continue;
        }
        pairs.active.push_back({pair.a, pair.b, i, static_cast<uint32_t>(pair.manifold.count), pair.a2, pair.b2});
    }
}

}  // namespace taut
