#include "detect/detect.h"

#include <algorithm>
#include <limits>

#include "detect/impact.h"
#include "threads/gather.h"

namespace taut {
namespace {

constexpr uint32_t kGrain = 64;  // colliders that a thread takes at a time

// Keys of nodes that a joint or element forbids to collide, sorted.
void refresh_joined(const Joints& joints, const Elements& elements, Pairs& pairs) {
    const uint64_t version = joints.version + elements.version;  // neither ever falls
    if (pairs.joined_version == version) return;
    pairs.joined.clear();
    const auto join = [&](std::span<const uint32_t> nodes) {
        for (size_t b = 0; b < nodes.size(); ++b)
            for (size_t a = 0; a < b; ++a)
                if (nodes[a] != kNone && nodes[b] != kNone) pairs.joined.push_back(pair_key(nodes[a], nodes[b]));
    };
    for (const Joint& joint : joints.record)
        if (!joint.collide_connected) join(joint.nodes());
    for_each_element(elements, [&](const ElementSet& set, uint32_t, std::span<const uint32_t> nodes) {
        if (!set.collide_connected) join(nodes);
    });
    std::sort(pairs.joined.begin(), pairs.joined.end());
    pairs.joined_version = version;
}

bool moves(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.info[node].kind != NodeKind::fixed; }
bool moves(const Nodes& nodes, const Collider& collider) {
    if (collider.node == kNone || nodes.rest[collider.node] == Rest::asleep) return false;
    return moves(nodes, collider.node) || moves(nodes, collider.node_b);
}

// How far a node moves in a frame, for the broadphase; ahead of that where it is looked for along its way.
Vec3f reach_of(const Nodes& nodes, uint32_t node, double time_step, bool along_way) {
    Vec3f reach = (time_step * nodes.motion[node].v).cast<float>();
    const float length = reach.norm();
    if (length > kMaxReach) reach *= along_way ? static_cast<float>(kAhead) : static_cast<float>(kMaxReach) / length;
    return reach;
}

// Grown on all sides by the way of its furthest point, where it turns past its own thickness.
void grow_turning(const Pace& pace, collision::Box& box) {
    if (!(pace.turning > pace.thickness)) return;
    const float way = static_cast<float>(pace.turning);
    box.lo.array() -= way;
    box.hi.array() += way;
}

// What a collider did in this step with the box that was made before it: |dx|, and angle x distance of the furthest
// corner, the angle at most pi |sin(angle / 2)|.
struct BoxMotion {
    Vec3 along;    // [m]
    double swing;  // [m]

    BoxMotion(const Nodes& nodes, const Collider& collider, const collision::Box& box) {
        const NodePose& before = nodes.before[collider.node];
        const double sine = (nodes.motion[collider.node].q * before.rotation.conjugate()).vec().norm();
        const Vec3 middle = (0.5f * (box.lo + box.hi)).cast<double>(), arm = middle - before.position;
        along = nodes.origin(collider.node) - before.position;
        swing = 3.15 * sine * (arm.norm() + 0.5 * static_cast<double>((box.hi - box.lo).norm()));
    }
    // By no more than what is left of its margin: it cannot have left the box.
    bool is_small(float margin) const { return along.norm() + swing <= (1 - kBoxLag) * static_cast<double>(margin); }
    // The box, less the motion foreseen, wherever it went.
    collision::Box after(const Reach& reach) const {
        const Vec3f way = along.cast<float>(), all = Vec3f::Constant(static_cast<float>(swing));
        return {reach.box.lo - reach.ahead.cwiseMin(0.0f) + way - all,
                reach.box.hi - reach.ahead.cwiseMax(0.0f) + way + all};
    }
};

// Whether a step kept a collider in its leaf; its box is that of where it is now, or at most a larger one.
bool keep_in_leaf(const Nodes& nodes, const Collider& collider, const Shapes& shapes, uint32_t c,
                  const collision::Broadphase& broadphase, Reach& reach) {
    if (collider.node_b == kNone) {
        const BoxMotion motion(nodes, collider, reach.box);
        if (motion.is_small(shapes[collider.shape].margin)) return true;
        reach = {motion.after(reach), Vec3f::Zero()};
        if (broadphase.holds(c, reach.box)) return true;
    }
    reach = {collision::bounds(shapes[collider.shape].shape, placement_of(nodes, collider)), Vec3f::Zero()};
    return broadphase.holds(c, reach.box);
}

// What came and went: as the broadphase tells, or, where records were forgotten before, found anew.
void find_news(const collision::Broadphase& broadphase, bool was_complete, Pairs& pairs) {
    const std::span<const uint64_t> keys = broadphase.pairs();
    constexpr size_t kFew = 64;  // of what comes or goes in a step: for so many the first step takes the memory
    for (Array<uint64_t>* each : {&pairs.arrived, &pairs.departed}) {
        each->clear();
        each->reserve(kFew);
    }
    if (was_complete) {
        pairs.arrived.assign(broadphase.arrived().begin(), broadphase.arrived().end());
        pairs.departed.assign(broadphase.departed().begin(), broadphase.departed().end());
    } else {
        for (const uint64_t key : keys)
            if (!find_pair(pairs.near, key)) pairs.arrived.push_back(key);
        for (const NearPair& near : pairs.near)
            if (!std::binary_search(keys.begin(), keys.end(), near.key)) pairs.departed.push_back(near.key);
    }
    std::erase_if(pairs.arrived, [&](uint64_t key) { return find_pair(pairs.resting, key) != nullptr; });
}

// Of the keys that have left the broadphase, those without a record are none of ours; the others' records have no
// points any more.
void end_departed(const Nodes& nodes, const Colliders& colliders, Pairs& pairs) {
    pairs.picked.clear();
    reserve_more(pairs.picked, pairs.departed.size());
    size_t ends = 0;
    std::erase_if(pairs.departed, [&](uint64_t key) {
        const auto at = std::ranges::lower_bound(pairs.near, key, {}, &NearPair::key);
        if (at == pairs.near.end() || at->key != key) return true;
        if (at->pair != kNone || at->touching) pairs.picked.push_back(static_cast<uint32_t>(at.index));
        ends += at->touching;
        return false;
    });
    reserve_more(pairs.ended, ends);
    for (const uint32_t index : pairs.picked) {
        NearPair& near = pairs.near[index];
        if (near.touching) report_end(pairs, nodes, colliders, near);
        give_slots(pairs, near);
    }
}

// Of a body's centre of mass; kinematic bodies move at the end of the frame.
struct CentrePose {
    Vec3 x;
    Quat q;
};
CentrePose pose_of(const Nodes& nodes, uint32_t node, double elapsed) {
    const NodeMotion& m = nodes.motion[node];
    if (nodes.info[node].kind != NodeKind::kinematic || elapsed == 0) return {m.x, m.q};
    return {m.x + elapsed * m.v, rotation_from_vector(elapsed * m.w) * m.q};
}

// How far apart a collider gets contact points [m]. One that spans two nodes is as thin as a cable is, and as long.
float margin_of(const Shapes& shapes, const Collider& collider) {
    return collider.node_b == kNone ? shapes[collider.shape].margin : kContactMargin;
}

// How far a collider may get in the frame, linear way and turning.
void look_ahead(const Nodes& nodes, const Shapes& shapes, const Collider& collider, const Pace& pace,
                const Stance& stance, double time_step, Travel& travel) {
    travel.margin = margin_of(shapes, collider);
    travel.ahead = static_cast<float>(time_step * nodes.motion[collider.node].v.norm() + pace.turning);
    travel.thickness = static_cast<float>(pace.thickness);
    const bool yields = moves_by_forces(nodes.info[collider.node].kind);
    travel.swing = yields ? swing_of(stance, static_cast<float>(time_step)) : 0;
}

collision::Box grown(collision::Box box, float margin) {
    box.lo.array() -= margin;
    box.hi.array() += margin;
    return box;
}

// Whether a box that was made before holds its collider where it is and gets to in the frame.
bool box_holds(const Reach& reach, const Travel& travel) {
    return std::abs(travel.way - reach.made) + static_cast<double>(travel.ahead) <=
           kBoxLag * static_cast<double>(travel.margin);
}

void make_box(const Nodes& nodes, const Collider& collider, uint32_t c, Shapes& shapes, Pairs& pairs,
              double time_step) {
    const bool spans = collider.node_b != kNone;
    const bool along_way = std::isfinite(pairs.pace[c].thickness);
    Vec3f ahead = reach_of(nodes, collider.node, time_step, along_way);
    Vec3f least = ahead.cwiseMin(0.0f), most = ahead.cwiseMax(0.0f);
    if (spans) {
        const Vec3 along = nodes.motion[collider.node_b].x - nodes.motion[collider.node].x;
        shapes[collider.shape].shape.size.y() = static_cast<float>(0.5 * along.norm());
        const Vec3f ahead_b = reach_of(nodes, collider.node_b, time_step, along_way);
        least = least.cwiseMin(ahead_b);
        most = most.cwiseMax(ahead_b);
        ahead = 0.5f * (ahead + ahead_b);
    }
    const collision::Box tight = collision::bounds(shapes[collider.shape].shape, pairs.placement[c]);
    collision::Box box = grown(tight, pairs.travel[c].margin);
    box.lo += least;
    box.hi += most;
    if (!spans) grow_turning(pairs.pace[c], box);  // else its ends tell
    pairs.reach[c].box = box;
    pairs.reach[c].ahead = ahead;
    pairs.reach[c].made = std::numeric_limits<double>::infinity();
    if (!spans) pairs.reach[c].made = pairs.travel[c].way;
}

}  // namespace

NodePose pose_between(const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double length = along.norm();
    return {0.5 * (from + to), length > 0 ? turn_between(Vec3::UnitY(), along / length) : Quat::Identity()};
}

collision::Placement placement_of(const NodePose& pose) {
    return {pose.position, pose.rotation.toRotationMatrix().cast<float>()};
}

collision::Placement placement_of(const Nodes& nodes, const Collider& collider, double elapsed) {
    if (collider.node_b != kNone)
        return placement_of(pose_between(nodes.motion[collider.node].x, nodes.motion[collider.node_b].x));
    const CentrePose pose = pose_of(nodes, collider.node, elapsed);
    const Mat3 R = pose.q.toRotationMatrix();
    const Vec3 origin = pose.x - R * nodes.mass[collider.node].centre;
    if (collider.at_origin()) return {origin, R.cast<float>()};
    return {origin + R * collider.position, (R * collider.rotation.toRotationMatrix()).cast<float>()};
}

// The chord of a turn between unit quaternions p and q, of a point at radius r: 2 r sin(angle / 2) <= 2 r |p - q|.
void place_collider(const Nodes& nodes, const Shapes& shapes, const Collider& collider, double elapsed, Pairs& pairs,
                    uint32_t index) {
    collision::Placement& at = pairs.placement[index];
    Stance& stance = pairs.stance[index];
    const Vec3 was_at = at.position;
    const Quatf was = stance.turn;
    at = placement_of(nodes, collider, elapsed);
    if (collider.node_b != kNone) return;
    const CentrePose pose = pose_of(nodes, collider.node, elapsed);
    const NodeMotion& m = nodes.motion[collider.node];
    stance.turn = (collider.at_origin() ? pose.q : pose.q * collider.rotation).cast<float>();
    stance.velocity = (m.v + m.w.cross(at.position - pose.x)).cast<float>();
    stance.spin = m.w.cast<float>();
    stance.from_node = collider.at_origin() ? Vec3f(Vec3f::Zero()) : Vec3f((pose.q * collider.position).cast<float>());
    stance.reach = static_cast<float>(shapes[collider.shape].reach);
    stance.size = shapes[collider.shape].size;
    const float turned = 2 * stance.reach * (stance.turn.coeffs() - was.coeffs()).norm();
    if (stance.placed) pairs.travel[index].way += (at.position - was_at).norm() + static_cast<double>(turned);
    stance.placed = true;
}

collision::Box contact_box(const Nodes& nodes, const Shapes& shapes, const Collider& collider) {
    return grown(collision::bounds(shapes[collider.shape].shape, placement_of(nodes, collider)),
                 margin_of(shapes, collider));
}

void update_bounds(Team& team, const Nodes& nodes, const Colliders& colliders, Shapes& shapes, Pairs& pairs,
                   collision::Broadphase& broadphase, double time_step) {
    const std::span<const uint32_t> active = colliders.active;
    pairs.make_room(colliders.record.size());
    pairs.picked.resize(active.size());  // nothing may fail between a new box and the broadphase's
    team.for_ranges(static_cast<uint32_t>(active.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t c : active.subspan(begin, end - begin)) {
            const Collider& collider = colliders.record[c];
            pairs.reach[c].left = false;
            pairs.pace[c] = pace_of(nodes, collider, shapes[collider.shape], time_step);
            if (nodes.rest[collider.node] != Rest::asleep) place_collider(nodes, shapes, collider, 0, pairs, c);
            look_ahead(nodes, shapes, collider, pairs.pace[c], pairs.stance[c], time_step, pairs.travel[c]);
            if (!moves(nodes, collider) || box_holds(pairs.reach[c], pairs.travel[c])) continue;
            make_box(nodes, collider, c, shapes, pairs, time_step);
            pairs.reach[c].left = !broadphase.holds(c, pairs.reach[c].box);
        }
    });
    gather(team, active, pairs.picked, [&](uint32_t c) { return pairs.reach[c].left; });
    for (const uint32_t c : pairs.picked) broadphase.update(c, pairs.reach[c].box, pairs.reach[c].ahead);
}

void note_strays(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                 std::span<const uint32_t> frozen, Pairs& pairs, collision::Broadphase& broadphase) {
    const std::span<const uint32_t> active = colliders.active;
    team.for_ranges(static_cast<uint32_t>(active.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t c : active.subspan(begin, end - begin)) {
            const Collider& collider = colliders.record[c];
            pairs.reach[c].left =
                moves(nodes, collider) && !keep_in_leaf(nodes, collider, shapes, c, broadphase, pairs.reach[c]);
        }
    });
    broadphase.clear_strays();
    gather(team, active, pairs.picked, [&](uint32_t c) { return pairs.reach[c].left; });
    for (const uint32_t c : pairs.picked) broadphase.note_stray(c);
    for (const uint32_t node : frozen)
        for_colliders(nodes, colliders, node, [&](uint32_t c) {
            broadphase.update(c, contact_box(nodes, shapes, colliders.record[c]), Vec3f::Zero());
        });
}

bool may_collide(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const PairEnds& pair) {
    bool moves = false, tied = false;
    for_sides(pair, [&](uint32_t a, uint32_t b) {
        moves = moves || moves_by_forces(nodes.info[a].kind) || moves_by_forces(nodes.info[b].kind);
        tied = tied || a == b || std::binary_search(pairs.joined.begin(), pairs.joined.end(), pair_key(a, b));
    });
    const Collider &a = colliders.record[pair.collider_a()], &b = colliders.record[pair.collider_b()];
    return moves && !tied && !a.sensor && !b.sensor &&
           filters_agree(colliders.traits[pair.collider_a()].filter, colliders.traits[pair.collider_b()].filter);
}

NearPair new_pair(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, uint64_t key) {
    NearPair near;
    near.key = key;
    const PairEnds ends = near.ends(colliders);
    near.filtered = !may_collide(nodes, colliders, pairs, ends);
    near.against_fixed = is_against_fixed(nodes, ends);
    return near;
}

void update_pairs(Team& team, const Nodes& nodes, const Colliders& colliders, const Joints& joints,
                  const Elements& elements, collision::Broadphase& broadphase, Pairs& pairs) {
    refresh_joined(joints, elements, pairs);
    team.for_ranges(broadphase.start_refresh(), kGrain,
                    [&](uint32_t begin, uint32_t end) { broadphase.find_pairs(begin, end); });
    const bool was_complete = pairs.complete;
    if (broadphase.finish_refresh()) pairs.complete = false;
    if (pairs.complete) return;
    find_news(broadphase, was_complete, pairs);
    pairs.near.reserve(pairs.near.size() + pairs.arrived.size());
    grow_to(pairs.met, colliders.record.size());
    end_departed(nodes, colliders, pairs);
    exchange_pairs(pairs.near, {pairs.departed, pairs.arrived}, [&](uint64_t key) {
        const NearPair near = new_pair(nodes, colliders, pairs, key);
        pairs.met[near.collider_a()] = pairs.met[near.collider_b()] = 1;
        return near;
    });
    pairs.complete = true;
    let_go(pairs.arrived);
    let_go(pairs.departed);
    broadphase.let_go();
}

}  // namespace taut
