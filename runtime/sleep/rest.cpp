// Pairs of sleeping nodes, and the contacts that wake them.
#include <algorithm>

#include "sleep/sleep.h"
#include "sleep/wake.h"

namespace taut {
namespace {

// Bodies closer than this belong together, and one on its way that will be so close wakes the other [m]: more than
// gravity adds to a step's way (2.7 mm at 60 Hz), less than what lies side by side by intent.
constexpr double kClose = 0.005;

bool moves(const Nodes& nodes, uint32_t node) {
    return node != kNone && nodes.info[node].kind != NodeKind::fixed && nodes.rest[node] == Rest::awake;
}

bool some_node(std::span<const uint32_t> all, bool (*is)(const Nodes&, uint32_t), const Nodes& nodes) {
    return std::ranges::any_of(all, [&](uint32_t node) { return is(nodes, node); });
}
bool some_side(const PairEnds& pair, bool (*is)(const Nodes&, uint32_t), const Nodes& nodes) {
    const uint32_t sides[] = {pair.a, pair.b, pair.a2, pair.b2};
    return some_node(sides, is, nodes);
}

bool sleeps(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.sleeps(node); }
bool rests(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.rest[node] != Rest::awake; }

// The pairs that meet a condition from one sorted list to another; keys is scratch.
template <class Condition>
void transfer(NearPairs& from, NearPairs& to, Array<uint64_t>& keys, Condition&& condition) {
    const auto count = static_cast<size_t>(std::count_if(from.begin(), from.end(), condition));
    if (count == 0) return;
    keys.clear();
    reserve_more(keys, count);
    for (const NearPair& near : from)
        if (condition(near)) keys.push_back(near.key);
    exchange_pairs(to, {{}, keys}, [&](uint64_t key) { return *find_pair(from, key); });
    from.erase_if(condition);
    let_go(keys);
}

// How fast a point of a node, given from the origin of node a, comes towards the other side [m/s].
double speed_along(const Nodes& nodes, uint32_t node, const Vec3& point, const Vec3& normal) {
    const NodeMotion& m = nodes.motion[node];
    return (m.v + m.w.cross(point - m.x)).dot(normal);
}

bool will_touch(const World& world, const Pair& pair) {
    if (touches_closely(pair)) return true;
    const Vec3 origin = world.nodes.origin(pair.a), normal = pair.manifold.normal.cast<double>();
    for (int k = 0; k < pair.manifold.count; ++k) {
        const collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 at = origin + point.position.cast<double>();
        double closing = 0;
        for_sides(pair, [&](uint32_t a, uint32_t b) {
            closing =
                std::max(closing, speed_along(world.nodes, a, at, normal) - speed_along(world.nodes, b, at, normal));
        });
        if (static_cast<double>(point.separation) - closing * static_cast<double>(world.def.time_step) <= kClose)
            return true;
    }
    return false;
}

bool will_touch(const World& world, const GrainContact& contact) {
    const Vec3 parting = world.nodes.motion[contact.b].v - world.nodes.motion[contact.a].v;
    const double way = static_cast<double>(world.def.time_step) * parting.dot(contact.normal.cast<double>());
    return touches_closely(contact) || static_cast<double>(contact.separation) + way <= kClose;
}

bool will_touch(const World& world, const SurfaceContact& contact) {
    Vec3 parting = Vec3::Zero();
    for (int i = 0; i < kMaxEnds; ++i) {
        if (contact.node[i] == kNone) continue;
        const NodeMotion& m = world.nodes.motion[contact.node[i]];
        const Vec3 lever = i == 0 ? Vec3(contact.lever.cast<double>()) : Vec3(Vec3::Zero());
        parting += static_cast<double>(contact.weight[i]) * (m.v + m.w.cross(lever));
    }
    const double way = static_cast<double>(world.def.time_step) * parting.dot(contact.normal.cast<double>());
    return touches_closely(contact) || static_cast<double>(contact.gap) + way <= kClose;
}

}  // namespace

bool touches_closely(const Pair& pair) {
    for (int k = 0; k < pair.manifold.count; ++k)
        if (static_cast<double>(pair.manifold.points[k].separation) <= kClose || pair.force[k].normal > 0) return true;
    return false;
}

bool touches_closely(const GrainContact& contact) {
    return static_cast<double>(contact.separation) <= kClose || contact.pushes();
}

bool touches_closely(const SurfaceContact& contact) {
    return static_cast<double>(contact.gap) <= kClose || contact.pushes();
}

void recall_pairs(World& world) {
    if (!world.sleep.recall) return;
    Pairs& pairs = world.pairs;
    transfer(pairs.resting, pairs.near, pairs.departed,
             [&](const NearPair& near) { return some_side(near.ends(world.colliders), moves, world.nodes); });
    world.sleep.recall = false;
}

void retire_pairs(World& world) {
    if (world.sleep.bodies == 0) return;
    Pairs& pairs = world.pairs;
    transfer(pairs.near, pairs.resting, pairs.departed, [&](const NearPair& near) {
        const PairEnds ends = near.ends(world.colliders);
        return some_side(ends, rests, world.nodes) && !some_side(ends, moves, world.nodes);
    });
}

bool wake_touched(World& world) {
    if (world.sleep.bodies == 0) return false;
    for (const ActivePair& active : world.pairs.active) {
        const Pair& pair = world.pairs.list[active.pair];
        if (!some_side(pair, moves, world.nodes) || !some_side(pair, sleeps, world.nodes)) continue;
        if (!will_touch(world, pair)) continue;
        for (uint32_t node : active.nodes())
            if (sleeps(world.nodes, node)) wake(world, node);
    }
    for (const GrainContact& contact : world.pairs.grains.contact) {
        const uint32_t ends[] = {contact.a, contact.b};
        if (world.nodes.sleeps(contact.a) == world.nodes.sleeps(contact.b) || !will_touch(world, contact)) continue;
        for (const uint32_t node : ends)
            if (world.nodes.sleeps(node)) wake(world, node);
    }
    for (const SurfaceContact& contact : world.pairs.surfaces.contact) {
        if (!some_node(contact.node, moves, world.nodes) || !some_node(contact.node, sleeps, world.nodes)) continue;
        if (!will_touch(world, contact)) continue;
        for (const uint32_t node : contact.node)
            if (sleeps(world.nodes, node)) wake(world, node);
    }
    return world.sleep.recall;
}

void wake_met(World& world, double time, Obstacles& obstacles) {
    if (world.sleep.bodies == 0) return;
    const Nodes& nodes = world.nodes;
    const auto some = [&](const SoftShape& shape, auto&& is) {
        return std::ranges::any_of(world.softs.record[shape.soft].node, [&](uint32_t node) { return is(nodes, node); });
    };
    const auto wake_all_of = [&](const SoftShape& shape) {
        for (const uint32_t node : world.softs.record[shape.soft].node) wake(world, node);
    };
    for (const SoftMeeting& meeting : obstacles.between) {
        const SoftShape &one = obstacles.softs[meeting.one], &other = obstacles.softs[meeting.other];
        if (some(one, moves) && some(other, sleeps)) wake_all_of(other);
        if (some(other, moves) && some(one, sleeps)) wake_all_of(one);
    }
    place_obstacles(nodes, world.colliders, world.shapes, time, obstacles);
    for (const SoftShape& shape : obstacles.softs) {
        if (!some(shape, sleeps)) continue;
        const double radius = obstacles.radius[shape.soft];
        for (const Meeting& meeting : obstacles.of(shape.soft)) {
            const Obstacle& obstacle = obstacles.list[meeting.obstacle];
            if (nodes.info[obstacle.node].kind != NodeKind::kinematic || nodes.rest[obstacle.node] != Rest::awake)
                continue;
            const Vec3 way = Vec3::Constant(radius) + time * obstacle.v.cwiseAbs();
            if (shape.swept.meets({obstacle.lo - way, obstacle.hi + way})) wake_all_of(shape);
        }
    }
}

}  // namespace taut
