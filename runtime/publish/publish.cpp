#include "publish/publish.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "state/constraint_view.h"
#include "threads/gather.h"

namespace taut {
namespace {

taut_pose public_pose(const Vec3& position, const Quat& q) {
    taut_pose pose{};
    pose.position = {position.x(), position.y(), position.z()};
    pose.rotation = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                     static_cast<float>(q.w())};
    return pose;
}

// How much there is, and how wrong it is.
struct Tally {
    uint32_t points = 0, bodies = 0, joints = 0, elements = 0, others = 0;  // others: contacts that are no pairs
    float penetration = 0, joint_error = 0;

    static Tally sum(const Tally& a, const Tally& b) {
        return {a.points + b.points,
                a.bodies + b.bodies,
                a.joints + b.joints,
                a.elements + b.elements,
                a.others + b.others,
                std::max(a.penetration, b.penetration),
                std::max(a.joint_error, b.joint_error)};
    }
};

// add(tally, element) over a list.
template <class List, class Add>
Tally tally(Team& team, const List& list, Add&& add) {
    const auto of = [&](uint32_t begin, uint32_t end) {
        Tally part;
        for (uint32_t i = begin; i < end; ++i) add(part, list[i]);
        return part;
    };
    return reduce(team, static_cast<uint32_t>(list.size()), Tally{}, of, Tally::sum);
}

Tally tally(World& world) {
    const auto add_pair = [&](Tally& t, const ActivePair& active) {
        t.points += active.points;
        const collision::Manifold& manifold = world.pairs.list[active.pair].manifold;
        for (uint32_t k = 0; k < active.points; ++k)
            t.penetration = std::max(t.penetration, -manifold.points[k].separation);
    };
    const auto add_grains = [&](Tally& t, const GrainContact& contact) {
        if (!world.nodes.solved(contact.a) && !world.nodes.solved(contact.b)) return;
        ++t.others;
        ++t.points;
        t.penetration = std::max(t.penetration, -contact.separation);
    };
    const auto add_surfaces = [&](Tally& t, const SurfaceContact& contact) {
        const auto is_solved = [&](uint32_t node) { return node != kNone && world.nodes.solved(node); };
        if (std::ranges::none_of(contact.node, is_solved)) return;
        ++t.others;
        ++t.points;
        t.penetration = std::max(t.penetration, -contact.gap);
    };
    const auto add_node = [&](Tally& t, uint32_t node) { t.bodies += world.nodes.solved(node); };
    const auto add_joint = [&](Tally& t, const Joint& joint) {
        if (!joint.type) return;
        ++t.joints;
        if (joint.idle || asleep(world.nodes, joint)) return;
        t.joint_error = std::max(t.joint_error, static_cast<float>(gap_of(world.nodes, joint)));
    };
    const auto add_set = [&](Tally& t, const ElementSet& set) {
        for (uint32_t e = 0; set.type && e < set.size(); ++e) {
            if (!set.lives(e)) continue;
            ++t.elements;
            if (set.compliance[0] > 0 || asleep(world.nodes, set.nodes_of(e)))
                continue;  // what gives way is apart by law
            double value[kMaxRows], squared = 0;
            view_of(set, e).read(world.nodes, value);
            if (set.pulls) value[0] = std::max(0.0, value[0]);
            for (int r = 0; r < set.type->row.rows; ++r)
                if (!(set.type->row.angular >> r & 1)) squared += value[r] * value[r];
            t.joint_error = std::max(t.joint_error, static_cast<float>(std::sqrt(squared)));
        }
    };
    const Tally of_pairs = tally(world.team, world.pairs.active, add_pair);
    const Tally of_others = Tally::sum(tally(world.team, world.pairs.grains.contact, add_grains),
                                       tally(world.team, world.pairs.surfaces.contact, add_surfaces));
    const Tally of_nodes = tally(world.team, world.nodes.active, add_node);
    const Tally of_ties =
        Tally::sum(tally(world.team, world.joints.record, add_joint), tally(world.team, world.elements.set, add_set));
    return Tally::sum(Tally::sum(of_pairs, of_others), Tally::sum(of_nodes, of_ties));
}

bool has_moved(const Nodes& nodes, uint32_t node) {
    const NodeKind kind = nodes.info[node].kind;
    if (nodes.rest[node] != Rest::awake || kind == NodeKind::dead || kind == NodeKind::fixed) return false;
    const NodePose& before = nodes.before[node];
    return nodes.motion[node].q.coeffs() != before.rotation.coeffs() || nodes.origin(node) != before.position;
}

// Nodes whose move of an earlier step waits to be read, ascending.
void list_moved_before(World& world) {
    world.moved_before.clear();
    reserve_more(world.moved_before, world.moved.size());
    for (const taut_moved_event& event : world.moved) {
        HandleBits bits{};
        if (unpack_handle(event.body.bits, bits) && world.nodes.ids.live(bits.index, bits.generation))
            world.moved_before.push_back(bits.index);
    }
}

// In the order of nodes, with those whose move waits to be read.
void list_moved(World& world) {
    Array<uint32_t>& moved = world.pairs.picked;
    gather(world.team, std::span<const uint32_t>(world.nodes.active), moved,
           [&](uint32_t node) { return has_moved(world.nodes, node); });
    list_moved_before(world);
    if (world.moved_before.empty()) return;
    const size_t now = moved.size();
    reserve_more(moved, world.moved_before.size());
    std::ranges::copy_if(world.moved_before, std::back_inserter(moved), [&](uint32_t node) {
        return !std::binary_search(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(now), node);
    });
    std::ranges::sort(moved);
}

}  // namespace

void publish_motion(World& world, const Array<uint32_t>& frozen) {
    const Nodes& nodes = world.nodes;
    list_moved(world);
    write_list(
        world.team, static_cast<uint32_t>(world.pairs.picked.size()), world.moved, [](uint32_t) { return 1u; },
        [&](uint32_t i, taut_moved_event* to) {
            const uint32_t node = world.pairs.picked[i];
            *to = {world.body_handle(node), nodes.info[node].user_data,
                   public_pose(nodes.origin(node), nodes.motion[node].q)};
        });
    for (uint32_t node : frozen)
        world.quarantined.push_back({world.body_handle(node), nodes.info[node].user_data, world.window.steps,
                                     public_reason(nodes.find_frozen(node))});
}

void publish_profile(World& world) {
    taut_profile& p = world.profile;
    const Tally counts = tally(world);
    p.pairs = static_cast<uint32_t>(world.broadphase.pairs().size());
    p.touching = static_cast<uint32_t>(world.pairs.active.size()) + counts.others;
    p.points = counts.points;
    p.penetration = counts.penetration;
    p.bodies = counts.bodies + world.sleep.bodies;
    p.joints = counts.joints;
    p.elements = counts.elements;
    p.joint_error = counts.joint_error;
    p.islands = world.partition.islands;
    p.blocks = static_cast<uint32_t>(world.partition.blocks.size());
    p.colours = world.partition.colours;
    p.bytes = world.memory.bytes();
    for (const IslandReport& island : world.reports.islands) {
        p.yield = std::max(p.yield, static_cast<float>(island.yield));
        p.solve_residual = std::max(p.solve_residual, static_cast<float>(island.residual));
        p.linearisation = std::max(p.linearisation, static_cast<float>(island.linearisation));
        p.energy_gain = std::max(p.energy_gain, static_cast<float>(island.energy));
    }
}

}  // namespace taut
