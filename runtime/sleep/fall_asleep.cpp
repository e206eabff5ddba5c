// Who falls asleep after a step.
#include <algorithm>
#include <cmath>

#include "sleep/sleep.h"
#include "sleep/wake.h"

namespace taut {
namespace {

constexpr uint32_t kGrain = 128;  // nodes that a thread takes at a time

// Distance of the furthest point from the centre of mass, at most [m]; of a body without colliders its radius of
// gyration.
double radius_of(const World& world, uint32_t node) {
    const NodeMass& mass = world.nodes.mass[node];
    double radius = std::sqrt(std::max({mass.inertia.xx, mass.inertia.yy, mass.inertia.zz}) * mass.inv_mass);
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        const collision::Box& box = world.pairs.reach[c].box;
        const Vec3 middle = (0.5f * (box.lo + box.hi)).cast<double>();
        const double half = 0.5 * static_cast<double>((box.hi - box.lo).norm());
        radius = std::max(radius, (middle - world.nodes.motion[node].x).norm() + half);
    });
    return radius;
}

// The largest speed of a point of the node, at most, |v| + |w| r [m/s]: over the step, which knows the push of
// overlaps, and now, which knows a bounce.
double speed_of(const World& world, uint32_t node) {
    const NodeMotion& m = world.nodes.motion[node];
    const NodePose& before = world.nodes.before[node];
    const double h = static_cast<double>(world.def.time_step);
    const double way = (m.x - before.position - before.rotation * world.nodes.mass[node].centre).norm();
    double moved = way / h, moves = m.v.norm();
    if (world.nodes.info[node].kind == NodeKind::dynamic) {
        const double radius = radius_of(world, node);
        moved += 2 * (m.q * before.rotation.conjugate()).vec().norm() / h * radius;
        moves += m.w.norm() * radius;
    }
    return std::max(moved, moves);
}

void measure_quiet(World& world) {
    Nodes& nodes = world.nodes;
    const std::span<const uint32_t> active = nodes.active;
    world.team.for_ranges(static_cast<uint32_t>(active.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t node : active.subspan(begin, end - begin)) {
            if (!nodes.solved(node)) continue;
            NodeSleep& sleep = nodes.sleep[node];
            const bool quiet = speed_of(world, node) <= static_cast<double>(world.def.sleep_speed);
            sleep.quiet = quiet ? sleep.quiet + static_cast<double>(world.def.time_step) : 0;
        }
    });
}

// What a moving kinematic node touches or holds has no quiet.
void disturb(World& world) {
    Nodes& nodes = world.nodes;
    const auto drives = [&](uint32_t node) {
        return node != kNone && nodes.info[node].kind == NodeKind::kinematic && nodes.rest[node] == Rest::awake;
    };
    const auto pass_on = [&](std::span<const uint32_t> ends) {
        if (std::none_of(ends.begin(), ends.end(), drives)) return;
        for (uint32_t node : ends)
            if (node != kNone) nodes.sleep[node].quiet = 0;
    };
    for (const ActivePair& active : world.pairs.active)
        if (touches_closely(world.pairs.list[active.pair])) pass_on(active.nodes());
    for (const SurfaceContact& contact : world.pairs.surfaces.contact)
        if (touches_closely(contact)) pass_on(contact.node);
    for_each_tie(world.joints, world.elements, pass_on);
}

// A kinematic node that stands still sleeps by itself, and wakes when the host moves it. True: another one moves.
bool rest_kinematic(World& world) {
    Nodes& nodes = world.nodes;
    bool moving = false;
    for (const uint32_t node : nodes.active) {
        if (nodes.info[node].kind != NodeKind::kinematic || nodes.rest[node] != Rest::awake) continue;
        NodeMotion& m = nodes.motion[node];
        if (!stands_still(m.v, m.w)) {
            moving = true;
            continue;
        }
        m.v = m.w = m.slow_v = m.slow_w = Vec3::Zero();
        nodes.set_rest(node, Rest::settling);
    }
    return moving;
}

// ---------------------------------------------------------------- islands

uint32_t find(Array<uint32_t>& root, uint32_t node) {
    while (root[node] != node) node = root[node] = root[root[node]];
    return node;
}

void unite(World& world, std::span<const uint32_t> ends) {
    Array<uint32_t>& root = world.sleep.root;
    uint32_t first = kNone;
    for (uint32_t node : ends) {
        if (node == kNone || !world.nodes.solved(node)) continue;
        if (first == kNone) first = find(root, node);
        const uint32_t other = find(root, node);
        root[std::max(first, other)] = std::min(first, other);
        first = std::min(first, other);
    }
}

// Of the nodes that forces move and that are awake.
void find_islands(World& world) {
    Array<uint32_t>& root = world.sleep.root;
    root.resize(world.nodes.slots());
    for (const uint32_t node : world.nodes.active) root[node] = node;
    for_each_tie(world.joints, world.elements, [&](std::span<const uint32_t> ends) { unite(world, ends); });
    for (const Pair& pair : world.pairs.list) {
        const uint32_t sides[] = {pair.a, pair.b, pair.a2, pair.b2};
        if (touches_closely(pair)) unite(world, sides);
    }
    for (const GrainContact& contact : world.pairs.grains.contact)
        if (touches_closely(contact)) unite(world, std::array{contact.a, contact.b});
    for (const SurfaceContact& contact : world.pairs.surfaces.contact)
        if (touches_closely(contact)) unite(world, contact.node);
}

// Into the ring of its island; the root, which is the smallest, comes first.
void settle(World& world, uint32_t node, uint32_t root) {
    Nodes& nodes = world.nodes;
    NodeMotion& m = nodes.motion[node];
    m.v = m.w = m.slow_v = m.slow_w = Vec3::Zero();
    nodes.clear_load(node);
    nodes.set_rest(node, Rest::settling);
    nodes.sleep[node].next = node == root ? node : nodes.sleep[root].next;
    nodes.sleep[root].next = node;
    world.sleep.islands += node == root;
    ++world.sleep.bodies;
    world.sleep.changed = true;
}

void settle_quiet_islands(World& world) {
    Nodes& nodes = world.nodes;
    Sleep& sleep = world.sleep;
    const auto ready = [&](uint32_t node) {
        return nodes.sleep[node].can_sleep && nodes.sleep[node].quiet >= static_cast<double>(world.def.sleep_time);
    };
    bool any = false;
    for (const uint32_t node : nodes.active) any = any || (nodes.solved(node) && ready(node));
    if (!any) return;
    find_islands(world);
    sleep.restless.resize(nodes.slots());
    for (const uint32_t node : nodes.active) sleep.restless[node] = 0;
    for (const uint32_t node : nodes.active)
        if (nodes.solved(node) && !ready(node)) sleep.restless[find(sleep.root, node)] = 1;
    for (const uint32_t node : nodes.active) {
        if (!nodes.solved(node)) continue;
        const uint32_t root = find(sleep.root, node);
        if (!sleep.restless[root]) settle(world, node, root);
    }
}

// ---------------------------------------------------------------- around the step

// Those that fell asleep before this step are all done with now, and so is what cannot move.
void finish_settling(Nodes& nodes, Array<uint32_t>& settled) {
    settled.clear();
    settled.reserve(nodes.active.size());
    for (const uint32_t node : nodes.active) {
        if (nodes.rest[node] == Rest::settling) {
            nodes.set_rest(node, Rest::asleep);
            settled.push_back(node);
        } else if (nodes.info[node].kind == NodeKind::fixed && nodes.rest[node] == Rest::awake) {
            nodes.set_rest(node, Rest::settling);
        }
    }
}

// What an awake node pushed against all expectation wakes after all.
void wake_pushed(World& world) {
    if (world.sleep.bodies == 0) return;
    for (const ActivePair& active : world.pairs.active) {
        if (!touches_closely(world.pairs.list[active.pair])) continue;
        for (uint32_t node : active.nodes())
            if (node != kNone && world.nodes.sleeps(node)) wake(world, node);
    }
    for (const GrainContact& contact : world.pairs.grains.contact) {
        if (world.nodes.sleeps(contact.a) == world.nodes.sleeps(contact.b) || !touches_closely(contact)) continue;
        wake(world, world.nodes.sleeps(contact.a) ? contact.a : contact.b);
    }
    const auto is_awake = [&](uint32_t node) {
        return node != kNone && world.nodes.info[node].kind != NodeKind::fixed && world.nodes.rest[node] == Rest::awake;
    };
    for (const SurfaceContact& contact : world.pairs.surfaces.contact) {
        if (std::ranges::none_of(contact.node, is_awake) || !touches_closely(contact)) continue;
        for (const uint32_t node : contact.node)
            if (node != kNone && world.nodes.sleeps(node)) wake(world, node);
    }
}

// Of what this step went through or woke.
void publish_sleep(World& world) {
    if (!world.sleep.changed) return;
    Nodes& nodes = world.nodes;
    nodes.list_active();
    const auto tell = [&](uint32_t node) {
        const bool now = nodes.sleeps(node);
        if (now == nodes.sleep[node].told_asleep) return;
        (now ? world.fell_asleep : world.woke)
            .push_back({world.body_handle(node), nodes.info[node].user_data, world.window.steps, 0});
        nodes.sleep[node].told_asleep = now;
    };
    auto settled = world.sleep.settled.begin();
    for (const uint32_t node : nodes.active) {
        while (settled != world.sleep.settled.end() && *settled < node) tell(*settled++);
        tell(node);
    }
    std::for_each(settled, world.sleep.settled.end(), tell);
    world.sleep.changed = false;
}

}  // namespace

void put_to_sleep(World& world, uint32_t node) {
    world.nodes.list_active();
    find_islands(world);
    const uint32_t root = find(world.sleep.root, node);
    for (const uint32_t other : world.nodes.active)
        if (world.nodes.solved(other) && find(world.sleep.root, other) == root) settle(world, other, root);
}

void update_sleep(World& world) {
    finish_settling(world.nodes, world.sleep.settled);
    if (world.def.sleeping) {
        wake_pushed(world);
        world.nodes.list_active();
        measure_quiet(world);
        if (rest_kinematic(world)) disturb(world);
        settle_quiet_islands(world);
    }
    publish_sleep(world);
    world.profile.awake = world.profile.bodies - world.sleep.bodies;
    world.profile.sleeping_islands = world.sleep.islands;
}

}  // namespace taut
