// Which joints are solved directly, together with which contacts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

#include "detect/approach.h"
#include "partition/movers.h"
#include "partition/needs.h"
#include "partition/partition.h"
#include "partition/price.h"
#include "partition/weights.h"

namespace taut {
namespace {

// Contacts of what carries no more than some thirty times its own weight are as well swept, and far cheaper so:
// ragdolls in a heap. Beyond, a light body between a heavy one and an edge sinks in.
constexpr double kLoad = 300;             // force of a joint over the mass of its lighter body [m/s^2]
constexpr double kLoadedMassRatio = 100;  // a block of more unequal masses always takes them in
// And what hits. Sweeps take the hit body for free, its joint stops it after them, and from substep to substep the
// impulse grows beyond what stops the other: a ball of 300 kg at 50 m/s came back from a door of 30 kg with 24 m/s.
constexpr double kHit = 0.5;  // that a contact would give a body that nothing holds [m/s]
// Or what the sweeps let sink in, as where a knee comes to its stop and drives the foot into the ground.
constexpr double kSunk = 0.005;  // [m]
// Until the impulse of the hit is none that sweeps start from.
constexpr uint8_t kHitFor = 3;  // frames

// By how much a contact that closes within a frame changes the velocities of its two sides, times their masses [N s];
// infinite where it sank in or carries what sweeps do not hold.
double hit_of(const Nodes& nodes, const Pair& pair, double borne, double time_step) {
    const RelativeMotion motion = relative_motion(nodes, pair);
    double fastest = 0;
    for (int k = 0; k < pair.manifold.count; ++k) {
        const collision::ContactPoint& point = pair.manifold.points[k];
        const double speed = static_cast<double>(motion.approach(point.position, pair.manifold.normal));
        const auto separation = static_cast<double>(point.separation);
        if (separation < -kSunk) return std::numeric_limits<double>::infinity();
        if (separation < speed * time_step) fastest = std::max(fastest, speed);
    }
    double inverse = 0;  // of the reduced mass [1/kg]
    for (const uint32_t side : {pair.a, pair.b}) inverse += moving(nodes, side) ? nodes.mass[side].inv_mass : 0;
    if (borne * inverse > kLoad) return std::numeric_limits<double>::infinity();
    return fastest > 0 && inverse > 0 ? fastest / inverse : 0;
}

// Frames under or since a load, after one more of them.
uint8_t note_load(const Nodes& nodes, const ConstraintType& type, std::span<const uint32_t> ends, const double* lambda,
                  uint8_t loaded) {
    double squared = 0, lighter = 1e300;
    for (int r = 0; r < type.rows; ++r)
        if (!(type.angular >> r & 1)) squared += lambda[r] * lambda[r];
    for (uint32_t node : ends)
        if (moving(nodes, node)) lighter = std::min(lighter, nodes.mass[node].mass);
    const double most = kLoad * lighter;
    if (squared > most * most)
        return static_cast<uint8_t>(loaded + 1 < kLoadedAfter ? loaded + 1 : kLoadedAfter + kLoadedFor);
    return loaded > kLoadedAfter ? loaded - 1 : 0;
}

// What can break needs its force exactly.
JointSolve asked_for(const Joint& joint) {
    const bool breaks = std::isfinite(joint.break_force) || std::isfinite(joint.break_torque);
    return breaks && joint.solve == JointSolve::by_load ? JointSolve::direct : joint.solve;
}

uint32_t bounded_rows(const Joint& joint) {
    uint32_t count = 0;
    for (int r = 0; joint.type && !joint.plain && r < joint.type->rows; ++r) {
        const Axis& axis = joint.axis[r];
        count += static_cast<uint32_t>(axis.mode == AxisMode::limited) + (axis.max_force > 0) + (axis.friction > 0);
    }
    return count;
}

// The nodes of a contact of a block.
void add_links(const Nodes& nodes, std::span<const uint32_t> ends, Block& block) {
    for (size_t b = 0; b < ends.size(); ++b)
        for (size_t a = 0; a < b; ++a)
            if (moving(nodes, ends[a]) && moving(nodes, ends[b])) block.links.push_back(pair_key(ends[a], ends[b]));
}

void keep_once(Array<uint64_t>& links) {
    std::ranges::sort(links);
    const auto twice = std::ranges::unique(links);
    links.erase(twice.begin(), twice.end());
}

}  // namespace

void note_loads(Joints& joints, Elements& elements, const Nodes& nodes) {
    for (Joint& joint : joints.record)
        if (joint.works() && !asleep(nodes, joint))
            joint.loaded = note_load(nodes, *joint.type, joint.nodes(), joint.lambda, joint.loaded);
    for_each_element(elements, [&](ElementSet& set, uint32_t e, std::span<const uint32_t> ends) {
        if (!asleep(nodes, ends))
            set.loaded[e] = note_load(nodes, set.type->row, ends, set.lambda_of(e), set.loaded[e]);
    });
}

// False if the block would grow too much; the contact is swept then.
bool Partition::join_contact(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    if (a == b) return true;
    const Component &ca = component_[a], &cb = component_[b];
    const bool elastic = ca.elastic || cb.elastic;
    const uint32_t grown = ca.grown + cb.grown + (elastic ? 0 : std::min(ca.nodes, cb.nodes));
    if (grown > kMostGrown) return false;
    const uint32_t total = ca.nodes + cb.nodes;
    Component both;
    both.nodes = total;
    both.grown = grown;
    both.loaded = ca.loaded || cb.loaded;
    both.hit = ca.hit || cb.hit;
    both.elastic = elastic;
    both.always = ca.always || cb.always;
    both.sags = ca.sags || cb.sags;
    unite(a, b);
    component_[find(a)] = both;
    return true;
}

// Components of the graph of direct ties and the contacts that they take in. Symbolic work happens at a block's
// first solve.
void Partition::build_blocks(const Nodes& nodes, const Joints& joints, const Elements& elements, const Pairs& pairs,
                             const PartitionRules& rules) {
    for (const uint32_t node : graph_.movers) parent_[node] = node;
    for (size_t j = 0; j < joints.record.size(); ++j)
        if (joints.record[j].solve != JointSolve::swept) unite(graph_.ties[j]);
    for (uint32_t e = 0; e < element_.size(); ++e)
        if (elements.set[element_[e].set].solve != JointSolve::swept) unite(movers_of(e));
    clear_movers(core_);
    clear_movers(component_);
    pair_in_block_.assign(pairs.active.size(), 0);
    for (const uint32_t node : graph_.movers) component_[node].nodes = 0;
    for (const uint32_t node : graph_.movers) {
        Component& component = component_[find(node)];
        ++component.nodes;
        if (nodes.mass[node].mass < component.least) {
            component.least = nodes.mass[node].mass;
            component.lightest = node;
        }
        component.most = std::max(component.most, nodes.mass[node].mass);
    }
    choose_direct(nodes, joints, elements, rules);
    find_hit(nodes, pairs, rules);
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        const auto ends = pairs.active[p].nodes();
        const uint32_t first = mover(nodes, ends);
        if (first == kNone) continue;  // a quarantined body at rest on a fixed one
        const bool tower = island_[island_of_[first]].tower;
        auto takes_in = [&](uint32_t node) {
            return moving(nodes, node) && core_[node] == kHeld && component_[find(node)].loaded;
        };
        if (!tower && std::none_of(ends.begin(), ends.end(), takes_in)) continue;
        pair_in_block_[p] = std::all_of(
            ends.begin(), ends.end(), [&](uint32_t node) { return !moving(nodes, node) || join_contact(first, node); });
        if (!pair_in_block_[p]) continue;
        for (const uint32_t node : ends)
            if (moving(nodes, node) && core_[node] == 0) core_[node] = tower ? kHeld : kTaken;
    }
    take_surfaces(pairs.surfaces);
    take_pressed();
    take_between(nodes, pairs);
    fill_blocks(nodes, joints, elements, pairs);
    recall_blocks(nodes, joints);
}

// Contacts of surfaces with what takes in its contacts, as elements without multipliers always do: each is a row of the
// block with all its nodes that move. What is held by ties that are swept stays out, and so does the contact.
void Partition::take_surfaces(const SurfaceContacts& surfaces) {
    surface_in_block_.assign(surfaces.contact.size(), 0);
    for (uint32_t k = 0; k < surfaces.contact.size(); ++k) {
        const TouchGraph::Tie ends = movers_of(surfaces.contact[k]);
        const auto takes_in = [&](uint32_t end) {
            return end != kNone && core_[end] == kHeld && component_[find(end)].loaded;
        };
        const auto held = std::ranges::find_if(ends, takes_in);
        const auto may_join = [&](uint32_t end) { return end == kNone || core_[end] != 0 || tied_[end] == 0; };
        if (held == ends.end() || !std::ranges::all_of(ends, may_join)) continue;
        surface_in_block_[k] = std::ranges::all_of(
            ends, [&, first = *held](uint32_t end) { return end == kNone || join_contact(first, end); });
        if (!surface_in_block_[k]) continue;
        for (const uint32_t end : ends)
            if (end != kNone && core_[end] == 0) core_[end] = kTaken;
    }
}

// What ties of each component ask for.
void Partition::weigh_ties(const Nodes& nodes, const Joints& joints, const Elements& elements) {
    const auto weigh = [&](std::span<const uint32_t> ends, JointSolve solve, uint8_t frames_loaded, float need,
                           double sweep, uint32_t bounded, bool multiplies) {
        const uint32_t end = mover(nodes, ends);
        if (solve == JointSolve::swept || end == kNone) return;
        Component& c = component_[find(end)];
        const bool loaded = frames_loaded >= kLoadedAfter, direct = solve == JointSolve::direct;
        if (multiplies) c.sweep += sweep;
        c.ties += multiplies;
        c.elastic = c.elastic || (direct && !multiplies);
        c.loaded = c.loaded || (direct && !multiplies);
        c.bears = c.bears || loaded;
        c.direct = c.direct || is_needed(need);
        c.always = c.always || direct;
        c.bounded += bounded;
    };
    for (const Joint& joint : joints.record) {
        if (!joint.works()) continue;
        weigh(joint.nodes(), asked_for(joint), joint.loaded, joint.need, kTieCost, bounded_rows(joint), true);
    }
    for (uint32_t e = 0; e < element_.size(); ++e) {
        const ElementSet& set = elements.set[element_[e].set];
        const uint32_t at = element_[e].element;
        weigh(movers_of(e), set.solve, set.loaded[at], set.need[at], sweep_cost(*set.type), set.pulls ? 1 : 0,
              multiplies(set));
    }
    for (const Press& press : presses_)
        for (const uint32_t node : {press.light, press.by}) {
            Component& c = component_[find(node)];
            c.direct = c.direct || c.ties > 0;
        }
}

// Where sweeps would not hold weights alone: that of the heaviest node by the lightest, or what falls until it feels
// what it hangs by. A direct solve for c times the cost of sweeps is worth it where these, with c times as many
// substeps, would not hold it either: both grow with h^2.
void Partition::weigh_bodies(const Nodes& nodes, const PartitionRules& rules) {
    const double h = rules.time_step / rules.substeps, gravity = least_gravity(rules);
    for (const uint32_t node : graph_.movers) {
        Component& c = component_[node];
        if (parent_[node] != node || c.nodes == 1) continue;
        const NodeMass& lightest = nodes.mass[c.lightest];
        const double worth = std::max(1.0, c.cost);
        c.loaded = c.loaded || c.most >= kLoadedMassRatio * c.least;
        c.sags = strain_of_weights(lightest, c.most / c.least, h, gravity) > 1 ||
                 (c.ties > 0 && strain_of_fall(lightest, c.price.depth * h, gravity) > worth * worth);
        c.direct = c.direct || c.sags;
    }
}

// Ties that blocks own, but for mechanisms whose factor is too dear and for those that sweeps hold as well.
void Partition::choose_direct(const Nodes& nodes, const Joints& joints, const Elements& elements,
                              const PartitionRules& rules) {
    weigh_ties(nodes, joints, elements);
    find_prices(nodes, joints, elements);
    weigh_bodies(nodes, rules);
    for (const uint32_t node : graph_.movers) {
        Component& c = component_[node];
        c.always = c.always || (c.exact && c.ties > 0);
        c.direct = c.direct || c.always;
        c.loaded = c.loaded || (c.always && c.bears);
    }
    auto is_block = [](const Component& c) { return c.direct && !c.dear; };
    const auto take = [&](std::span<const uint32_t> ends, JointSolve solve) -> uint8_t {
        const uint32_t end = mover(nodes, ends);
        if (solve == JointSolve::swept || end == kNone || !is_block(component_[find(end)])) return 0;
        for (uint32_t node : ends)
            if (moving(nodes, node)) core_[node] = kHeld;
        return 1;
    };
    joint_in_block_.resize(joints.record.size());
    for (size_t j = 0; j < joints.record.size(); ++j)
        joint_in_block_[j] = take(joints.record[j].nodes(), joints.record[j].solve);
    element_in_block_.resize(element_.size());
    for (uint32_t e = 0; e < element_.size(); ++e)
        element_in_block_[e] = take(movers_of(e), elements.set[element_[e].set].solve);
    for (const uint32_t node : graph_.movers) parent_[node] = find(node);
    for (const uint32_t node : std::views::reverse(graph_.movers)) {  // others stand alone; their root comes last
        if (is_block(component_[parent_[node]])) continue;
        parent_[node] = node;
        component_[node] = {};
    }
}

// What lies between a mechanism or a heavy body that takes it in and the world: its contact with the world as well,
// lest a press go through what it presses.
void Partition::take_between(const Nodes& nodes, const Pairs& pairs) {
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        if (pair_in_block_[p]) continue;
        const auto ends = pairs.active[p].nodes();
        const auto is_held = [&](uint32_t node) { return !moving(nodes, node) || core_[node] == kTaken; };
        if (mover(nodes, ends) == kNone || !std::all_of(ends.begin(), ends.end(), is_held)) continue;
        const uint32_t block = find(mover(nodes, ends));
        pair_in_block_[p] = std::all_of(ends.begin(), ends.end(),
                                        [&](uint32_t node) { return !moving(nodes, node) || find(node) == block; });
    }
}

// What is hit takes in its contacts, from this frame on.
void Partition::find_hit(const Nodes& nodes, const Pairs& pairs, const PartitionRules& rules) {
    for (const Block& block : blocks)  // of the last frame
        if (block.memory.hit_left > 0 && moving(nodes, block.nodes[0])) component_[find(block.nodes[0])].loaded = true;
    for (const ActivePair& pair : pairs.active) {
        const auto waits = [&](uint32_t node) {
            return moving(nodes, node) && component_[find(node)].always && !component_[find(node)].hit;
        };
        if (!waits(pair.a) && !waits(pair.b)) continue;
        const double hit = hit_of(nodes, pairs.list[pair.pair], static_cast<double>(pair.borne), rules.time_step);
        for (const uint32_t node : {pair.a, pair.b})
            if (waits(node) && hit > kHit * nodes.mass[node].mass)
                component_[find(node)].loaded = component_[find(node)].hit = true;
    }
}

// The block of a node's component, in spare_.
Block& Partition::block_at(uint32_t node) {
    uint32_t& block = component_[find(node)].block;
    if (block == kNone) {
        block = filled_++;
        if (spare_.size() < filled_) spare_.emplace_back(*blocks.get_allocator().memory);
        Block& fresh = spare_[block];
        for (auto* list : {&fresh.nodes, &fresh.joints, &fresh.pairs}) list->clear();
        fresh.surfaces.clear();
        fresh.elements.clear();
        fresh.elastic.clear();
        fresh.links.clear();
        fresh.identity.clear();
        fresh.order.clear();
        fresh.matrix.forget();
        fresh.memory = {};
    }
    return spare_[block];
}

// Elements into their blocks, each marked once with the sets that it has elements of.
void Partition::fill_elements(const Elements& elements) {
    for (uint32_t e = 0; e < element_.size(); ++e) {
        const ElementSet& set = elements.set[element_[e].set];
        if (!element_in_block_[e]) continue;
        const auto ends = movers_of(e);
        const uint32_t node = *std::ranges::find_if(ends, [](uint32_t end) { return end != kNone; });
        Block& block = block_at(node);
        (multiplies(set) ? block.elements : block.elastic).push_back(element_[e]);
        if (std::exchange(component_[find(node)].set, element_[e].set) != element_[e].set)
            block.identity.push_back(set.serial << 32 | (set.version & UINT32_MAX));
    }
}

// Into spare_: nodes, ties, pairs and the identity of each block's graph.
void Partition::fill_blocks(const Nodes& nodes, const Joints& joints, const Elements& elements, const Pairs& pairs) {
    filled_ = 0;
    for (uint32_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        if (!joint_in_block_[j]) continue;
        Block& block = block_at(mover(nodes, joint.nodes()));
        block.joints.push_back(j);
        block.identity.push_back(joint.mark());
    }
    fill_elements(elements);
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        if (!pair_in_block_[p]) continue;
        const auto ends = pairs.active[p].nodes();
        Block& block = block_at(mover(nodes, ends));
        block.pairs.push_back(p);
        if (block.elastic.empty()) add_links(nodes, ends, block);
    }
    for (uint32_t k = 0; k < pairs.surfaces.contact.size(); ++k) {
        if (!surface_in_block_[k]) continue;
        const std::span<const uint32_t> ends = pairs.surfaces.contact[k].node;
        Block& block = block_at(mover(nodes, ends));
        block.surfaces.push_back(k);
        if (block.elastic.empty()) add_links(nodes, ends, block);
    }
    for (const uint32_t node : graph_.movers)
        if (component_[find(node)].block != kNone) block_at(node).nodes.push_back(node);
    while (spare_.size() > filled_) spare_.pop_back();
    for (Block& block : spare_) {
        double least = 1e300, most = 0;
        for (uint32_t node : block.nodes) {
            least = std::min(least, nodes.mass[node].mass);
            most = std::max(most, nodes.mass[node].mass);
            block.identity.push_back(static_cast<uint64_t>(node) << 32 | nodes.ids.generation(node));
            if (const Locks locks = nodes.locks_of(node); locks.any())  // which no other mark is
                block.identity.push_back(~(static_cast<uint64_t>(node) << 8 | locks.axes));
        }
        if (!block.surfaces.empty()) keep_once(block.links);  // the same nodes meet in many contacts
        block.identity.insert(block.identity.end(), block.links.begin(), block.links.end());
        block.mass_ratio = most / least;
        block.tower = block.joints.empty() && block.elements.empty() && block.elastic.empty();
        const Component& component = component_[find(block.nodes[0])];
        block.passing = !block.tower && !component.always && !component.sags;
    }
}

// A block whose graph stayed keeps its elimination order; one that lost or gained something keeps its memory.
void Partition::recall_blocks(const Nodes& nodes, const Joints& joints) {
    block_of_.resize(nodes.slots(), kNone);
    auto remembers = [&](const Block& old, const Block& block) {
        const uint64_t mark = block.joints.empty()
                                  ? static_cast<uint64_t>(block.nodes[0]) << 32 | nodes.ids.generation(block.nodes[0])
                                  : joints.record[block.joints[0]].mark();
        return old.tower == block.tower &&
               std::find(old.identity.begin(), old.identity.end(), mark) != old.identity.end();
    };
    for (Block& block : spare_) {
        const uint32_t at = block_of_[block.nodes[0]];
        if (at == kNone || at >= blocks.size()) continue;
        Block& old = blocks[at];
        if (old.identity == block.identity) {
            std::swap(old.order, block.order);
            std::swap(old.matrix, block.matrix);
            std::swap(old.places, block.places);
            std::swap(old.part, block.part);
            std::swap(old.hold, block.hold);
            block.stride = old.stride;
            std::swap(old.solution, block.solution);
            std::swap(old.known, block.known);
            std::swap(old.force, block.force);
            block.looped = old.looped;
            block.memory = old.memory;
        } else if (remembers(old, block)) {
            block.memory = old.memory;
        }
    }
    for (Block& block : spare_) {
        uint8_t& left = block.memory.hit_left;
        if (component_[find(block.nodes[0])].hit)
            left = kHitFor;
        else if (left > 0)
            --left;
    }
    unmark(blocks);
    blocks.swap(spare_);
    mark_blocks();
}

void Partition::unmark(const Array<Block>& of_last) {
    for (const Block& block : of_last)
        for (const uint32_t node : block.nodes) block_of_[node] = kNone;
}

void Partition::mark_blocks() {
    for (uint32_t b = 0; b < blocks.size(); ++b)
        for (uint32_t node : blocks[b].nodes) block_of_[node] = b;
}

}  // namespace taut
