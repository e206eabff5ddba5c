#include "check/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "partition/movers.h"
#include "partition/partition.h"
#include "system/system.h"
#include "world.h"

namespace taut {
namespace {

// Counts by index, kept so that steady scenes allocate nothing.
std::vector<uint8_t>& counts(size_t size) {
    thread_local std::vector<uint8_t> counted;
    counted.assign(size, 0);
    return counted;
}

// The first of two findings.
template <class Other>
MaybeFlaw either(const MaybeFlaw& one, Other&& other) {
    return one ? one : other();
}

bool finite(const ContactForce& force) {
    return std::isfinite(force.normal) && std::isfinite(force.tangent1) && std::isfinite(force.tangent2);
}

MaybeFlaw near_flaw(const NearPairs& list, const Pairs& pairs, const Colliders& colliders) {
    uint64_t before = 0, place = 0;
    for (const NearPair& near : list) {
        if (place > 0 && near.key <= before) return Flaw{"near pairs are sorted by key", place};
        if (std::max(near.collider_a(), near.collider_b()) >= colliders.record.size())
            return Flaw{"colliders of near pairs are in range", place};
        size_t parts = 0;
        for (uint32_t at = near.pair; at != kNone; at = pairs.list[at].next)
            if (at >= pairs.list.size() || ++parts > pairs.list.size())
                return Flaw{"records of near pairs are in range", place};
        before = near.key;
        ++place;
    }
    return std::nullopt;
}

// Nodes that move twice among those of a colour; nodes_of(item) of each item.
template <class Item, class NodesOf>
MaybeFlaw colour_flaw(const Array<Item>& items, std::span<const uint32_t> colour_begin, const Nodes& nodes,
                      NodesOf&& nodes_of) {
    std::vector<uint8_t>& met = counts(nodes.slots());
    for (size_t colour = 0; colour + 2 < colour_begin.size(); ++colour) {
        const std::span of_colour(items.data() + colour_begin[colour], items.data() + colour_begin[colour + 1]);
        for (const Item& item : of_colour)
            for (const uint32_t node : nodes_of(item))
                if (moving(nodes, node) && met[node]++ > 0) return Flaw{"a colour has a moving node once", node};
        for (const Item& item : of_colour)
            for (const uint32_t node : nodes_of(item))
                if (node != kNone) met[node] = 0;
    }
    return std::nullopt;
}

// Whether the nodes of a constraint that move are of one island.
bool in_one_island(const Partition& partition, const Nodes& nodes, std::span<const uint32_t> of) {
    const uint32_t first = mover(nodes, of);
    return std::all_of(of.begin(), of.end(), [&](uint32_t node) {
        return !moving(nodes, node) || partition.island_of(node) == partition.island_of(first);
    });
}

// Moving seats twice in one lane group; sides: arrays of seats by lane.
bool meets_twice(const System& system, std::span<const uint32_t* const> sides) {
    std::array<uint32_t, kMaxNodes * kLanes> seats;
    auto end = seats.begin();
    for (const uint32_t* side : sides)
        for (int lane = 0; lane < kLanes; ++lane)
            if (system.sweep[side[lane]].mass.inv_mass > 0) *end++ = side[lane];
    std::sort(seats.begin(), end);
    return std::adjacent_find(seats.begin(), end) != end;
}

MaybeFlaw contact_lanes_flaw(const System& system, const Group& group) {
    const ContactLanes& lanes = system.contacts;
    size_t used = 0;
    for (size_t i = 0; i < lanes.group.size(); ++i) {
        const LaneGroup& g = lanes.group[i];
        const uint32_t* const sides[] = {g.a, g.b};
        if (meets_twice(system, sides)) return Flaw{"a lane group of contacts has a moving node once", i};
        used += static_cast<size_t>(kLanes - std::count(g.pair, g.pair + kLanes, kNoLanes));
    }
    if (used != group.pairs.size()) return Flaw{"lanes hold each swept pair once", used};
    return std::nullopt;
}

MaybeFlaw surface_lanes_flaw(const System& system, const Group& group) {
    const SurfaceLanes& lanes = system.surfaces;
    size_t used = 0;
    for (size_t i = 0; i < lanes.group.size(); ++i) {
        const SurfaceGroup& g = lanes.group[i];
        const uint32_t* const sides[] = {g.node[0], g.node[1], g.node[2], g.node[3]};
        if (meets_twice(system, sides)) return Flaw{"a lane group of surfaces has a moving node once", i};
        used += static_cast<size_t>(kLanes - std::count(g.contact, g.contact + kLanes, kNoLanes));
    }
    if (used != group.surfaces.size()) return Flaw{"lanes hold each swept contact of surfaces once", used};
    return std::nullopt;
}

MaybeFlaw joint_lanes_flaw(const System& system, const Group& group) {
    const JointLanes& lanes = system.joints;
    std::vector<uint8_t>& met = counts(system.rows.block.size());
    size_t used = 0;
    for (size_t i = 0; i < lanes.group.size(); ++i) {
        const JointGroup& g = lanes.group[i];
        for (const uint32_t block : g.block) {
            if (block == kNoLanes) continue;
            ++used;
            if (block < system.rows.direct || block >= system.rows.joints || met[block]++ > 0)
                return Flaw{"lanes hold swept joints once", i};
        }
        const uint32_t* sides[kMaxNodes];
        for (uint32_t n = 0; n < g.nodes; ++n) sides[n] = g.node[n];
        if (meets_twice(system, {sides, g.nodes})) return Flaw{"a lane group of joints has a moving node once", i};
    }
    if (used != group.joints.size() + group.elements.size()) return Flaw{"lanes hold each swept joint once", used};
    return std::nullopt;
}

MaybeFlaw element_lanes_flaw(const System& system, const Group& group) {
    std::vector<uint8_t>& met = counts(system.sweep.size());
    size_t used = 0;
    for (const ElementPass& pass : system.elements.pass) {
        std::vector<uint32_t> movers;
        for (uint32_t i = pass.begin; i < pass.end; ++i) {
            const ElementGroup& g = system.elements.group[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                if (g.element[lane] == kNoLanes) continue;
                ++used;
                for (const auto& node : g.node)
                    if (system.sweep[node[lane]].mass.inv_mass > 0) movers.push_back(node[lane]);
            }
        }
        for (const uint32_t node : movers)
            if (met[node]++ > 0 && !pass.overflow) return Flaw{"a pass over elements has a moving node once", node};
        for (const uint32_t node : movers) met[node] = 0;
    }
    if (used != group.fused.size()) return Flaw{"lanes hold each element of a fused sweep once", used};
    return std::nullopt;
}

// Of one point in a lane; comparisons let pass what is not finite.
const char* impulse_flaw(const float (&impulse)[3][kLanes], int lane, float friction) {
    constexpr float kRounding = 1e-4f, kTiny = 1e-20f;  // of the squares
    const float normal = impulse[0][lane], most = friction * normal;
    if (normal < 0) return "normal impulses are not negative";
    const float squared = impulse[1][lane] * impulse[1][lane] + impulse[2][lane] * impulse[2][lane];
    return squared > (1 + kRounding) * most * most + kTiny ? "friction is within its cone" : nullptr;
}

MaybeFlaw lane_impulse_flaw(const ContactLanes& lanes) {
    for (const LaneGroup& g : lanes.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.pair[lane] == kNoLanes) continue;
            for (uint32_t k = 0; k < g.points; ++k)
                if (const char* flaw = impulse_flaw(g.point[k].impulse, lane, lanes.most_friction(g, k, lane)))
                    return Flaw{flaw, g.pair[lane]};
        }
    return std::nullopt;
}

MaybeFlaw lane_impulse_flaw(const SurfaceLanes& lanes) {
    for (const SurfaceGroup& g : lanes.group)
        for (int lane = 0; lane < kLanes; ++lane)
            if (const char* flaw = impulse_flaw(g.impulse, lane, g.friction[lane])) return Flaw{flaw, g.contact[lane]};
    return std::nullopt;
}

// What holds after a stage.
struct Invariant {
    Stage after;
    MaybeFlaw (*find)(const World& world, const StageEnd& end);
};

constexpr Invariant kInvariants[] = {
    {Stage::pairs, [](const World& w, const StageEnd&) { return validate_near(w.pairs, w.colliders); }},
    {Stage::contacts, [](const World& w, const StageEnd&) { return validate_active(w.pairs, w.nodes); }},
    {Stage::partition, [](const World& w, const StageEnd&) { return validate_members(w.partition, w.nodes); }},
    {Stage::partition, [](const World& w, const StageEnd&) { return validate_pairs(w.partition, w.pairs, w.nodes); }},
    {Stage::partition,
     [](const World& w, const StageEnd&) { return validate_grains(w.partition, w.pairs.grains, w.nodes); }},
    {Stage::partition,
     [](const World& w, const StageEnd&) { return validate_surfaces(w.partition, w.pairs.surfaces, w.nodes); }},
    {Stage::partition, [](const World& w, const StageEnd&) { return validate_joints(w.partition, w.joints, w.nodes); }},
    {Stage::partition,
     [](const World& w, const StageEnd&) { return validate_elements(w.partition, w.elements, w.nodes); }},
    {Stage::partition, [](const World& w, const StageEnd&) { return validate_attachments(w.attachments, w.elements); }},
    {Stage::partition,
     [](const World& w, const StageEnd&) {
         return validate_colours(w.partition, w.pairs, w.joints, w.elements, w.nodes);
     }},
    {Stage::assemble,
     [](const World& w, const StageEnd& end) {
         const bool built = end.substep == 0 && solvers()[w.def.solver]->lanes;
         return built ? validate_lanes(w.system, w.partition.groups[end.group]) : MaybeFlaw();
     }},
    {Stage::relax, [](const World& w, const StageEnd&) { return validate_impulses(w.system); }},
    {Stage::publish, [](const World& w, const StageEnd&) { return validate_nodes(w.nodes); }},
    {Stage::publish, [](const World& w, const StageEnd&) { return validate_contact_forces(w.pairs); }},
    {Stage::publish, [](const World& w, const StageEnd&) { return validate_joint_forces(w.joints, w.elements); }},
};

[[noreturn]] void stop(const StageEnd& end, const Flaw& flaw) {
    std::fprintf(stderr, "taut: after %s (group %u, substep %u) it does not hold that %s: %llu\n", name_of(end.stage),
                 end.group, end.substep, flaw.invariant, static_cast<unsigned long long>(flaw.index));
    std::abort();
}

}  // namespace

MaybeFlaw validate_nodes(const Nodes& nodes) {
    constexpr double kUnit = 1e-6;  // of a squared length
    for (uint32_t node = 0; node < nodes.slots(); ++node) {
        if (nodes.info[node].kind == NodeKind::dead) continue;
        const NodeMotion& m = nodes.motion[node];
        if (!(m.x.allFinite() && m.q.coeffs().allFinite() && m.v.allFinite() && m.w.allFinite()))
            return Flaw{"motions are finite", node};
        if (std::abs(m.q.squaredNorm() - 1) > kUnit) return Flaw{"rotations are unit quaternions", node};
    }
    return std::nullopt;
}

MaybeFlaw validate_near(const Pairs& pairs, const Colliders& colliders) {
    return either(near_flaw(pairs.near, pairs, colliders), [&] { return near_flaw(pairs.resting, pairs, colliders); });
}

MaybeFlaw validate_active(const Pairs& pairs, const Nodes& nodes) {
    for (size_t i = 0; i < pairs.active.size(); ++i) {
        const ActivePair& active = pairs.active[i];
        for (const uint32_t node : active.nodes())
            if (node != kNone && node >= nodes.slots()) return Flaw{"nodes of active pairs are in range", i};
        if (active.pair >= pairs.list.size() || active.near >= pairs.near.size())
            return Flaw{"records of active pairs are in range", i};
        if (active.points == 0 || active.points != pairs.list[active.pair].manifold.count)
            return Flaw{"active pairs have the points of their manifolds", i};
        if (i > 0 && active.near < pairs.active[i - 1].near) return Flaw{"active pairs are in the order of near", i};
    }
    return std::nullopt;
}

MaybeFlaw validate_members(const Partition& partition, const Nodes& nodes) {
    std::vector<uint8_t>& listed = counts(nodes.slots());
    for (uint32_t g = 0; g < partition.group_count; ++g)
        for (const uint32_t node : partition.groups[g].nodes) {
            if (node >= nodes.slots()) return Flaw{"nodes of groups are in range", node};
            ++listed[node];
        }
    for (uint32_t node = 0; node < nodes.slots(); ++node)
        if (listed[node] != (nodes.solved(node) ? 1 : 0)) return Flaw{"nodes that move are in one group", node};
    for (const Block& block : partition.blocks)
        for (const uint32_t node : block.nodes)
            if (++listed[node] > 2) return Flaw{"nodes are in one block at most", node};
    return std::nullopt;
}

MaybeFlaw validate_pairs(const Partition& partition, const Pairs& pairs, const Nodes& nodes) {
    std::vector<uint8_t>& listed = counts(pairs.active.size());
    for (uint32_t g = 0; g < partition.group_count; ++g) {
        const Group& group = partition.groups[g];
        for (const auto* list : {&group.pairs, &group.span_pairs, &group.direct_pairs})
            for (const uint32_t p : *list) {
                if (p >= pairs.active.size()) return Flaw{"pairs of groups are in range", p};
                ++listed[p];
            }
    }
    for (size_t p = 0; p < pairs.active.size(); ++p) {
        const auto ends = pairs.active[p].nodes();
        if (listed[p] != (mover(nodes, ends) != kNone ? 1 : 0))
            return Flaw{"active pairs are in one of lanes, rows and blocks", p};
        if (!in_one_island(partition, nodes, ends)) return Flaw{"pairs are within an island", p};
    }
    return std::nullopt;
}

MaybeFlaw validate_grains(const Partition& partition, const Grains& grains, const Nodes& nodes) {
    std::vector<uint8_t>& listed = counts(grains.contact.size());
    for (uint32_t g = 0; g < partition.group_count; ++g)
        for (const uint32_t k : partition.groups[g].grains) {
            if (k >= grains.contact.size()) return Flaw{"contacts of grains of groups are in range", k};
            ++listed[k];
        }
    for (size_t k = 0; k < grains.contact.size(); ++k) {
        const GrainContact& contact = grains.contact[k];
        const std::array ends{contact.a, contact.b};
        if (contact.a >= contact.b || contact.b >= nodes.slots()) return Flaw{"grains that touch are in order", k};
        if (listed[k] != (mover(nodes, ends) != kNone ? 1 : 0)) return Flaw{"contacts of grains are swept once", k};
        if (!in_one_island(partition, nodes, ends)) return Flaw{"contacts of grains are within an island", k};
        if (!contact.force.allFinite()) return Flaw{"forces between grains are finite", k};
    }
    return std::nullopt;
}

namespace {

const char* surface_flaw(const SurfaceContact& contact, const Nodes& nodes) {
    constexpr float kRounding = 1e-4f;
    float sum = 0;
    for (int i = 0; i < kMaxEnds; ++i) {
        const uint32_t node = contact.node[i];
        if (node == kNone) continue;
        if (node >= nodes.slots()) return "nodes of contacts of surfaces are in range";
        if (std::find(contact.node, contact.node + i, node) != contact.node + i)
            return "nodes of a contact of surfaces differ";
        sum += contact.weight[i];
    }
    if (!(std::abs(sum) <= kRounding)) return "weights of contacts of surfaces sum to 0";
    if (!(std::abs(contact.normal.squaredNorm() - 1) <= kRounding)) return "normals of contacts of surfaces are unit";
    if (!std::isfinite(contact.gap) || !contact.lever.allFinite()) return "contacts of surfaces are finite";
    return finite(contact.force) ? nullptr : "forces of contacts of surfaces are finite";
}

}  // namespace

MaybeFlaw validate_surfaces(const Partition& partition, const SurfaceContacts& surfaces, const Nodes& nodes) {
    for (size_t k = 0; k < surfaces.contact.size(); ++k) {
        const SurfaceContact& contact = surfaces.contact[k];
        if (const char* flaw = surface_flaw(contact, nodes)) return Flaw{flaw, k};
        if (k == 0) continue;
        const SurfaceContact& before = surfaces.contact[k - 1];
        if (std::pair(contact.a, contact.b) <= std::pair(before.a, before.b))
            return Flaw{"contacts of surfaces are in the order of their features", k};
    }
    std::vector<uint8_t>& listed = counts(surfaces.contact.size());
    for (uint32_t g = 0; g < partition.group_count; ++g)
        for (const auto* list : {&partition.groups[g].surfaces, &partition.groups[g].direct_surfaces})
            for (const uint32_t k : *list) {
                if (k >= surfaces.contact.size()) return Flaw{"contacts of surfaces of groups are in range", k};
                ++listed[k];
            }
    for (size_t k = 0; k < surfaces.contact.size(); ++k) {
        const std::span<const uint32_t> ends = surfaces.contact[k].node;
        if (listed[k] != (mover(nodes, ends) != kNone ? 1 : 0))
            return Flaw{"contacts of surfaces are in one of lanes, rows and blocks", k};
        if (!in_one_island(partition, nodes, ends)) return Flaw{"contacts of surfaces are within an island", k};
    }
    for (const Block& block : partition.blocks)
        for (const uint32_t k : block.surfaces)
            for (const uint32_t node : surfaces.contact[k].node)
                if (moving(nodes, node) && !std::ranges::binary_search(block.nodes, node))
                    return Flaw{"a block has the nodes of its contacts of surfaces", k};
    return std::nullopt;
}

MaybeFlaw validate_joints(const Partition& partition, const Joints& joints, const Nodes& nodes) {
    std::vector<uint8_t>& listed = counts(joints.record.size());
    for (uint32_t g = 0; g < partition.group_count; ++g)
        for (const uint32_t j : partition.groups[g].joints) ++listed[j];
    for (const Block& block : partition.blocks)
        for (const uint32_t j : block.joints) ++listed[j];
    for (size_t j = 0; j < joints.record.size(); ++j) {
        const auto ends = joints.record[j].nodes();
        if (listed[j] != (mover(nodes, ends) != kNone ? 1 : 0)) return Flaw{"joints are solved once", j};
        if (!in_one_island(partition, nodes, ends)) return Flaw{"joints are within an island", j};
    }
    return std::nullopt;
}

MaybeFlaw validate_elements(const Partition& partition, const Elements& elements, const Nodes& nodes) {
    std::vector<size_t> first(1, 0);
    for (const ElementSet& set : elements.set) first.push_back(first.back() + (set.type ? set.size() : 0));
    std::vector<uint8_t>& listed = counts(first.back());
    const auto list = [&](const auto& all) {
        for (const ElementRef& each : all) ++listed[first[each.set] + each.element];
    };
    for (uint32_t g = 0; g < partition.group_count; ++g) {
        list(partition.groups[g].elements);
        list(partition.groups[g].fused);
    }
    for (const Block& block : partition.blocks) {
        list(block.elements);
        list(block.elastic);
    }
    for (size_t s = 0; s < elements.set.size(); ++s) {
        const ElementSet& set = elements.set[s];
        for (uint32_t e = 0; set.type && e < set.size(); ++e) {
            const auto ends = set.nodes_of(e);
            if (listed[first[s] + e] != (mover(nodes, ends) != kNone ? 1 : 0))
                return Flaw{"elements are solved once", first[s] + e};
            if (!in_one_island(partition, nodes, ends)) return Flaw{"elements are within an island", first[s] + e};
        }
    }
    return std::nullopt;
}

MaybeFlaw validate_attachments(const Attachments& attachments, const Elements& elements) {
    for (uint32_t index = 0; index < attachments.ids.slots(); ++index) {
        if (!attachments.ids.live(index)) continue;
        const Attachment& attachment = attachments.record[index];
        const ElementSet& set = elements.set[attachment.set];
        for (uint32_t i = 0; i < attachment.elements(); ++i) {
            const uint32_t e = attachment.element[i];
            if (!set.type || e >= set.size()) return Flaw{"attachments have elements", index};
            const AttachedWay way = way_of(attachment, i);
            const auto is_end = [&](uint32_t node) {
                return std::any_of(way.term.begin(), way.term.begin() + way.count,
                                   [&](const auto& term) { return term.node == node; });
            };
            const auto nodes = set.nodes_of(e);
            if (nodes.size() != way.count || !std::ranges::all_of(nodes, is_end))
                return Flaw{"elements of an attachment are on its nodes", index};
        }
        if (attachment.limit_set == kNone) continue;
        const ElementSet& limit = elements.set[attachment.limit_set];
        if (!limit.pulls || attachment.limit_element >= limit.size() ||
            !std::ranges::equal(limit.nodes_of(attachment.limit_element), set.nodes_of(attachment.element[0])))
            return Flaw{"limits of attachments pull on their nodes", index};
    }
    return std::nullopt;
}

MaybeFlaw validate_colours(const Partition& partition, const Pairs& pairs, const Joints& joints,
                           const Elements& elements, const Nodes& nodes) {
    for (uint32_t g = 0; g < partition.group_count; ++g) {
        const Group& group = partition.groups[g];
        const MaybeFlaw found = either(colour_flaw(group.pairs, group.pair_colour_begin, nodes,
                                                   [&](uint32_t p) { return pairs.active[p].sides(); }),
                                       [&] {
                                           return colour_flaw(group.joints, group.joint_colour_begin, nodes,
                                                              [&](uint32_t j) { return joints.record[j].nodes(); });
                                       });
        if (found) return found;
        const MaybeFlaw of_elements =
            colour_flaw(group.elements, group.element_colour_begin, nodes,
                        [&](const ElementRef& of) { return elements.set[of.set].nodes_of(of.element); });
        if (of_elements) return of_elements;
        const MaybeFlaw of_grains = colour_flaw(group.grains, group.grain_colour_begin, nodes, [&](uint32_t k) {
            const GrainContact& contact = pairs.grains.contact[k];
            return std::array{contact.a, contact.b};
        });
        if (of_grains) return of_grains;
        const MaybeFlaw of_surfaces = colour_flaw(group.surfaces, group.surface_colour_begin, nodes, [&](uint32_t k) {
            return std::span<const uint32_t>(pairs.surfaces.contact[k].node);
        });
        if (of_surfaces) return of_surfaces;
    }
    return std::nullopt;
}

MaybeFlaw validate_lanes(const System& system, const Group& group) {
    const MaybeFlaw found = either(contact_lanes_flaw(system, group), [&] { return joint_lanes_flaw(system, group); });
    const MaybeFlaw of_elements = either(found, [&] { return element_lanes_flaw(system, group); });
    return either(of_elements, [&] { return surface_lanes_flaw(system, group); });
}

MaybeFlaw validate_impulses(const System& system) {
    if (const MaybeFlaw found = lane_impulse_flaw(system.contacts)) return found;
    if (const MaybeFlaw found = lane_impulse_flaw(system.surfaces)) return found;
    for (const RowBlock& block : system.rows.block)
        if (block.type->bound == Bound::cone && system.rows.impulse[block.row] < 0)
            return Flaw{"normal impulses are not negative", block.pair};
    return std::nullopt;
}

MaybeFlaw validate_contact_forces(const Pairs& pairs) {
    for (size_t i = 0; i < pairs.active.size(); ++i) {
        const Pair& pair = pairs.list[pairs.active[i].pair];
        for (int k = 0; k < pair.manifold.count; ++k) {
            if (!finite(pair.force[k])) return Flaw{"contact forces are finite", i};
            if (pair.force[k].normal < 0) return Flaw{"normal forces are not negative", i};
        }
        if (!finite(pair.torque)) return Flaw{"friction torques are finite", i};
    }
    return std::nullopt;
}

MaybeFlaw validate_joint_forces(const Joints& joints, const Elements& elements) {
    for (size_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        if (joint.type && !std::all_of(joint.lambda, joint.lambda + joint.type->rows,
                                       [](double force) { return std::isfinite(force); }))
            return Flaw{"joint forces are finite", j};
    }
    for (size_t s = 0; s < elements.set.size(); ++s)
        if (!std::ranges::all_of(elements.set[s].lambda, [](double force) { return std::isfinite(force); }))
            return Flaw{"forces of elements are finite", s};
    return std::nullopt;
}

void validate(const World& w, const StageEnd& end) {
    for (const Invariant& check : kInvariants)
        if (check.after == end.stage)
            if (const MaybeFlaw flaw = check.find(w, end)) stop(end, *flaw);
}

}  // namespace taut
