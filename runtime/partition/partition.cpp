#include "partition/partition.h"

#include <algorithm>
#include <bit>

namespace taut {
namespace {

// When an island takes more substeps than the world's. A soft column sags as h^2 and buckles under its own or a
// heavy top's weight; a block of very unequal masses outruns the lag of its forces.
constexpr uint32_t kTallLevels = 12;       // more bodies above one another than this, and
constexpr uint32_t kSlenderness = 4;       // at most this many bodies a level: twice the substeps
constexpr uint32_t kSwayingLevels = 8;     // more, of broader ones, twice the sweeps: walls sway for long with one
constexpr float kHeavyOnLight = 10;        // load over support mass: four times the substeps
constexpr double kExtremeMassRatio = 3e4;  // within a block: twice the substeps

// A block takes in what touches it, as long as the smaller side of each contact and what came by contacts before stay
// below this: the cost of a direct solve grows with what loops through it. The rest of the contacts is swept.
constexpr uint32_t kMostGrown = 64;

// Contacts of what carries no more than some thirty times its own weight are as well swept, and far cheaper so:
// ragdolls in a heap. Beyond, a light body between a heavy one and an edge sinks in.
constexpr double kLoad = 300;             // force of a joint over the mass of its lighter body [m/s^2]
constexpr double kLoadedMassRatio = 100;  // a block of more unequal masses always takes them in

// Beyond these, mechanisms of joints solved by load are blocks. Their contacts stay swept.
constexpr double kSweptLoad = 1000;     // likewise [m/s^2]: such a joint yields by .4 mm at 240 substeps a second
constexpr double kSweptMassRatio = 20;  // heaviest over lightest body
// For so many frames after. A hit in a heap loads a joint for three to six frames: a hold of a second would keep half
// of it in blocks for nothing.
constexpr uint8_t kSweptFor = 15;

constexpr uint32_t kMostLoops = 2000;  // joints beyond a tree's: a net with more is swept, its direct solve would stall
constexpr uint32_t kMostTower = 60;  // bodies of a tower that is a block: a heavy load on light bodies, or many levels

constexpr uint32_t kMostPoints = 4, kKinds = 4;  // of a pair; of pairs by their points

bool moving(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.solved(node); }

// The first of some nodes that moves, or kNone.
uint32_t mover(const Nodes& nodes, std::span<const uint32_t> of) {
    for (uint32_t node : of)
        if (moving(nodes, node)) return node;
    return kNone;
}

}  // namespace

void note_loads(Joints& joints, const Nodes& nodes) {
    for (Joint& joint : joints.record) {
        if (!joint.type || asleep(nodes, joint)) continue;
        double squared = 0, lighter = 1e300;
        for (int r = 0; r < joint.type->rows; ++r)
            if (!(joint.type->angular >> r & 1)) squared += joint.lambda[r] * joint.lambda[r];
        for (uint32_t node : joint.nodes())
            if (moving(nodes, node)) lighter = std::min(lighter, nodes.mass[node].mass);
        const bool by_load = joint.solve == JointSolve::by_load;
        const double most = (by_load ? kSweptLoad : kLoad) * lighter;
        const int then = kLoadedAfter + (by_load ? kSweptFor : kLoadedFor);
        if (squared > most * most)
            joint.loaded = static_cast<uint8_t>(joint.loaded + 1 < kLoadedAfter ? joint.loaded + 1 : then);
        else
            joint.loaded = joint.loaded > kLoadedAfter ? joint.loaded - 1 : 0;
    }
}

Partition::Partition(Memory& memory)
    : groups(memory),
      blocks(memory),
      parent_(memory),
      island_of_(memory),
      level_(memory),
      island_(memory),
      component_(memory),
      core_(memory),
      pair_in_block_(memory),
      joint_in_block_(memory),
      block_of_(memory),
      spare_(memory),
      used_(memory),
      place_(memory),
      rank_(memory),
      rank_begin_(memory),
      scratch_(memory),
      queue_(memory),
      adjacency_begin_(memory),
      adjacency_(memory) {}

uint32_t Partition::find(uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
}

void Partition::unite(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
}

void Partition::unite(const Nodes& nodes, std::span<const uint32_t> all) {
    const uint32_t first = mover(nodes, all);
    for (uint32_t node : all)
        if (moving(nodes, node)) unite(first, node);
}

void Partition::build(const Nodes& nodes, const Joints& joints, const Pairs& pairs, const PartitionRules& rules) {
    connect(nodes, joints, pairs);
    measure_towers(nodes, pairs);
    if (rules.direct) find_towers();
    const bool any = std::any_of(island_.begin(), island_.end(), [](const Island& i) { return i.tower || i.jointed; });
    if (rules.direct && any) {
        build_blocks(nodes, joints, pairs);
    } else {
        blocks.clear();
        block_of_.clear();
        pair_in_block_.assign(pairs.active.size(), 0);
        joint_in_block_.assign(joints.record.size(), 0);
    }
    choose_substeps(rules);
    distribute(nodes, joints, pairs);
}

// Union-find of the joint graph alone.
void Partition::connect_joints(const Nodes& nodes, const Joints& joints, bool swept_too) {
    parent_.resize(nodes.slots());
    for (uint32_t i = 0; i < nodes.slots(); ++i) parent_[i] = i;
    for (const Joint& joint : joints.record)
        if (joint.solve != JointSolve::swept || swept_too) unite(nodes, joint.nodes());
}

// Islands without joints in which weight rests on what sweeps cannot hold.
void Partition::find_towers() {
    for (Island& island : island_) {
        const bool slender = island.levels > kTallLevels && island.nodes <= kSlenderness * island.levels;
        island.tower = !island.jointed && island.nodes <= kMostTower && (island.ratio >= kHeavyOnLight || slender);
    }
}

// False if the block would grow too much; the contact is swept then.
bool Partition::join_contact(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    if (a == b) return true;
    const Component &ca = component_[a], &cb = component_[b];
    const uint32_t grown = ca.grown + cb.grown + std::min(ca.nodes, cb.nodes);
    if (grown > kMostGrown) return false;
    const uint32_t total = ca.nodes + cb.nodes;
    const bool loaded = ca.loaded || cb.loaded;
    unite(a, b);
    component_[find(a)] = {total, 0, grown, kNone, 0, 0, loaded};
    return true;
}

// Components of the graph of direct joints and the contacts that they take in. Symbolic work happens at a block's
// first solve.
void Partition::build_blocks(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    const uint32_t slots = nodes.slots();
    connect_joints(nodes, joints, /*swept_too=*/false);
    core_.assign(slots, 0);
    component_.assign(slots, Component{});
    pair_in_block_.assign(pairs.active.size(), 0);
    for (uint32_t i = 0; i < slots; ++i) component_[i].nodes = 0;
    for (uint32_t i = 0; i < slots; ++i) {
        Component& component = component_[find(i)];
        ++component.nodes;
        if (!moving(nodes, i)) continue;
        component.least = std::min(component.least, nodes.mass[i].mass);
        component.most = std::max(component.most, nodes.mass[i].mass);
    }
    choose_direct(nodes, joints);
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        const auto ends = pairs.active[p].nodes();
        const uint32_t first = mover(nodes, ends);
        if (first == kNone) continue;  // a quarantined body at rest on a fixed one
        const bool tower = island_[island_of_[first]].tower;
        auto takes_in = [&](uint32_t node) {
            return moving(nodes, node) && core_[node] && component_[find(node)].loaded;
        };
        if (!tower && std::none_of(ends.begin(), ends.end(), takes_in)) continue;
        pair_in_block_[p] = std::all_of(
            ends.begin(), ends.end(), [&](uint32_t node) { return !moving(nodes, node) || join_contact(first, node); });
        if (tower && pair_in_block_[p]) core_[first] = 1;  // in a block, with or without a joint
    }
    fill_blocks(nodes, joints, pairs);
    recall_blocks(nodes, joints);
}

// Joints that blocks own, but for nets with too many loops and for mechanisms that sweeps hold as well.
void Partition::choose_direct(const Nodes& nodes, const Joints& joints) {
    auto end = [&](const Joint& joint) { return mover(nodes, joint.nodes()); };
    auto may = [&](const Joint& joint) { return joint.solve != JointSolve::swept && end(joint) != kNone; };
    for (const Joint& joint : joints.record) {
        if (!may(joint)) continue;
        Component& c = component_[find(end(joint))];
        ++c.joints;
        const bool loaded = joint.loaded >= kLoadedAfter, direct = joint.solve == JointSolve::direct;
        c.loaded = c.loaded || (direct && loaded) || c.most >= kLoadedMassRatio * c.least;
        c.direct = c.direct || direct || loaded || c.most >= kSweptMassRatio * c.least;
    }
    auto is_block = [](const Component& c) { return c.direct && c.joints <= c.nodes + kMostLoops; };
    joint_in_block_.assign(joints.record.size(), 0);
    for (size_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        if (!may(joint) || !is_block(component_[find(end(joint))])) continue;
        joint_in_block_[j] = 1;
        for (uint32_t node : joint.nodes())
            if (moving(nodes, node)) core_[node] = 1;
    }
    for (uint32_t i = 0; i < nodes.slots(); ++i) parent_[i] = find(i);
    for (uint32_t i = nodes.slots(); i-- > 0;) {  // other nodes stand alone; their root is smallest, so last
        if (is_block(component_[parent_[i]])) continue;
        parent_[i] = i;
        component_[i] = {};
    }
}

// Into spare_: nodes, joints, pairs and the identity of each block's graph.
void Partition::fill_blocks(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    Memory& memory = *blocks.get_allocator().memory;
    uint32_t count = 0;
    auto block_at = [&](uint32_t node) -> Block& {
        uint32_t& block = component_[find(node)].block;
        if (block == kNone) {
            block = count++;
            if (spare_.size() < count) spare_.emplace_back(memory);
            Block& fresh = spare_[block];
            for (auto* list : {&fresh.nodes, &fresh.joints, &fresh.pairs}) list->clear();
            fresh.links.clear();
            fresh.identity.clear();
            fresh.matrix.forget();
            fresh.memory = {};
        }
        return spare_[block];
    };
    for (uint32_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        if (!joint_in_block_[j]) continue;
        Block& block = block_at(mover(nodes, joint.nodes()));
        block.joints.push_back(j);
        block.identity.push_back(joint.mark());
    }
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        if (!pair_in_block_[p]) continue;
        const auto ends = pairs.active[p].nodes();
        Block& block = block_at(mover(nodes, ends));
        block.pairs.push_back(p);
        for (size_t b = 0; b < ends.size(); ++b)
            for (size_t a = 0; a < b; ++a)
                if (moving(nodes, ends[a]) && moving(nodes, ends[b])) block.links.push_back(pair_key(ends[a], ends[b]));
    }
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (moving(nodes, i) && component_[find(i)].block != kNone) block_at(i).nodes.push_back(i);
    while (spare_.size() > count) spare_.pop_back();
    for (Block& block : spare_) {
        double least = 1e300, most = 0;
        for (uint32_t node : block.nodes) {
            least = std::min(least, nodes.mass[node].mass);
            most = std::max(most, nodes.mass[node].mass);
            block.identity.push_back(static_cast<uint64_t>(node) << 32 | nodes.ids.generation(node));
        }
        block.identity.insert(block.identity.end(), block.links.begin(), block.links.end());
        block.mass_ratio = most / least;
        block.tower = block.joints.empty();
    }
}

// A block whose graph stayed keeps its elimination order; one that lost or gained something keeps its memory.
void Partition::recall_blocks(const Nodes& nodes, const Joints& joints) {
    block_of_.resize(nodes.slots(), kNone);
    auto remembers = [&](const Block& old, const Block& block) {
        const uint64_t mark = block.tower
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
            std::swap(old.matrix, block.matrix);
            std::swap(old.places, block.places);
            std::swap(old.solution, block.solution);
            std::swap(old.known, block.known);
            std::swap(old.force, block.force);
            block.looped = old.looped;
            block.memory = old.memory;
        } else if (remembers(old, block)) {
            block.memory = old.memory;
        }
    }
    blocks.swap(spare_);
    block_of_.assign(nodes.slots(), kNone);
    for (uint32_t b = 0; b < blocks.size(); ++b)
        for (uint32_t node : blocks[b].nodes) block_of_[node] = b;
}

void Partition::connect(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    const uint32_t slots = nodes.slots();
    connect_joints(nodes, joints, /*swept_too=*/true);
    island_of_.assign(slots, kNone);
    for (uint32_t i = 0; i < slots; ++i)
        if (moving(nodes, i)) island_of_[i] = 0;  // one, to be numbered
    const auto moves = [&](uint32_t node) { return node != kNone && island_of_[node] != kNone; };
    for (const ActivePair& pair : pairs.active) {
        if (pair.spans())
            unite(nodes, pair.nodes());
        else if (moves(pair.a) && moves(pair.b))
            unite(pair.a, pair.b);
    }

    island_.clear();
    for (uint32_t i = 0; i < slots; ++i) {  // roots are smallest, so each is met before its members
        if (!moves(i)) continue;
        const uint32_t root = find(i);
        if (root == i) {
            island_of_[i] = static_cast<uint32_t>(island_.size());
            island_.emplace_back();
        }
        island_of_[i] = island_of_[root];
        ++island_[island_of_[i]].nodes;
    }
    islands = static_cast<uint32_t>(island_.size());
    for (const Joint& joint : joints.record) {
        const uint32_t node = mover(nodes, joint.nodes());
        if (node != kNone) island_[island_of_[node]].jointed = true;
    }
}

// Levels: bodies on the shortest way down to a fixed or kinematic support, by breadth-first search over contacts.
void Partition::measure_towers(const Nodes& nodes, const Pairs& pairs) {
    const uint32_t slots = nodes.slots();
    const auto moves = [&](uint32_t node) { return node != kNone && island_of_[node] != kNone; };
    adjacency_begin_.assign(slots + 1, 0);
    level_.assign(slots, 0);
    queue_.clear();
    for (const ActivePair& pair : pairs.active) {
        const bool a = moves(pair.a), b = moves(pair.b);
        if (a && b) {
            ++adjacency_begin_[pair.a + 1];
            ++adjacency_begin_[pair.b + 1];
        } else if (a != b) {
            const uint32_t node = a ? pair.a : pair.b;
            if (level_[node] == 0) queue_.push_back(node);
            level_[node] = 1;
        }
    }
    for (uint32_t i = 0; i < slots; ++i) adjacency_begin_[i + 1] += adjacency_begin_[i];
    adjacency_.resize(adjacency_begin_[slots]);
    scratch_.assign(adjacency_begin_.begin(), adjacency_begin_.end());
    for (const ActivePair& pair : pairs.active) {
        if (!moves(pair.a) || !moves(pair.b)) continue;
        adjacency_[scratch_[pair.a]++] = pair.b;
        adjacency_[scratch_[pair.b]++] = pair.a;
    }
    for (size_t head = 0; head < queue_.size(); ++head) {
        const uint32_t node = queue_[head];
        Island& island = island_[island_of_[node]];
        island.levels = std::max(island.levels, level_[node]);
        for (uint32_t k = adjacency_begin_[node]; k < adjacency_begin_[node + 1]; ++k) {
            const uint32_t next = adjacency_[k];
            if (level_[next] != 0) continue;
            level_[next] = level_[node] + 1;
            queue_.push_back(next);
        }
    }
    for (uint32_t node : queue_) {
        Island& island = island_[island_of_[node]];
        for (uint32_t k = adjacency_begin_[node]; k < adjacency_begin_[node + 1]; ++k) {
            const uint32_t above = adjacency_[k];
            if (level_[above] <= level_[node]) continue;
            island.ratio =
                std::max(island.ratio, static_cast<float>(nodes.mass[above].mass * nodes.mass[node].inv_mass));
        }
    }
}

void Partition::choose_substeps(const PartitionRules& rules) {
    for (Island& island : island_) {
        uint32_t factor = 1;
        if (island.tower) {
            island.substeps = rules.substeps;
            continue;
        }
        if (island.ratio >= kHeavyOnLight && !island.jointed)
            factor = 4;
        else if (island.levels > kTallLevels && island.nodes <= kSlenderness * island.levels)
            factor = 2;
        else if (island.levels > kSwayingLevels)
            island.sweeps = rules.fixed ? 1 : 2;
        island.substeps = rules.substeps * (rules.fixed ? 1 : factor);
    }
    if (rules.fixed) return;
    for (Block& block : blocks) {
        Island& island = island_[island_of_[block.nodes[0]]];
        if (block.tower && block.memory.refused_left > 0) {
            --block.memory.refused_left;
            island.substeps = std::max(island.substeps, 4 * rules.substeps);
        }
        if (!block.tower && (block.mass_ratio > kExtremeMassRatio || block.memory.escalated))
            island.substeps = std::max(island.substeps, 2 * rules.substeps);
    }
}

void Partition::distribute(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    make_groups();
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) groups[group_of(i)].nodes.push_back(i);
    find_places(nodes);
    for (uint32_t b = 0; b < blocks.size(); ++b) {
        Group& group = groups[group_of(blocks[b].nodes[0])];
        group.blocks.push_back(b);
        group.direct_pairs.insert(group.direct_pairs.end(), blocks[b].pairs.begin(), blocks[b].pairs.end());
    }

    used_.resize(nodes.slots());
    colours = 0;
    Array<uint32_t>& items = queue_;
    for (uint32_t g = 0; g < group_count; ++g) {
        Group& group = groups[g];
        auto here = [&](std::span<const uint32_t> of) {
            for (uint32_t node : of)
                if (node != kNone && island_of_[node] != kNone) return group_of(node) == g;
            return false;
        };
        items.clear();
        for (uint32_t j = 0; j < joints.record.size(); ++j) {
            if (!joint_in_block_[j] && here(joints.record[j].nodes())) items.push_back(j);
        }
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_joints = colour(
            items, group.joint_colour_begin, [&](uint32_t j) { return joints.record[j].nodes(); },
            [](uint32_t) { return 0u; });
        group.joints.resize(items.size());
        sort_coloured(items, [&](uint32_t at, uint32_t j, uint8_t) { group.joints[at] = j; });
        items.clear();
        for (uint32_t p = 0; p < pairs.active.size(); ++p) {
            if (pair_in_block_[p] || !here(pairs.active[p].nodes())) continue;
            (pairs.active[p].spans() ? group.span_pairs : items).push_back(p);
        }
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_pairs = colour(
            items, group.pair_colour_begin, [&](uint32_t p) { return pairs.active[p].sides(); },
            [&](uint32_t p) { return kMostPoints - pairs.active[p].points; });
        group.pairs.resize(items.size());
        group.pair_place.resize(items.size());
        sort_coloured(items, [&](uint32_t at, uint32_t p, uint8_t place) {
            group.pairs[at] = p;
            group.pair_place[at] = place;
        });
        colours = std::max({colours, of_joints, of_pairs});
    }
}

// One group for each effort that occurs, in ascending order.
void Partition::make_groups() {
    Memory& memory = *groups.get_allocator().memory;
    scratch_.clear();
    for (const Island& island : island_) {
        const auto at = std::lower_bound(scratch_.begin(), scratch_.end(), island.effort());
        if (at == scratch_.end() || *at != island.effort()) scratch_.insert(at, island.effort());
    }
    group_count = static_cast<uint32_t>(scratch_.size());
    while (groups.size() < group_count) groups.emplace_back(memory);
    for (uint32_t g = 0; g < group_count; ++g) {
        groups[g].nodes.clear();
        groups[g].blocks.clear();
        groups[g].direct_pairs.clear();
        groups[g].span_pairs.clear();
    }
    for (Island& island : island_) {
        island.group = static_cast<uint32_t>(std::lower_bound(scratch_.begin(), scratch_.end(), island.effort()) -
                                             scratch_.begin());
        groups[island.group].substeps = island.substeps;
        groups[island.group].sweeps = island.sweeps;
    }
}

// Along the axis on which what moves is spread widest, by mean distance from the middle: a few nodes far out take no
// more than a few places.
void Partition::find_places(const Nodes& nodes) {
    Vec3 middle = Vec3::Zero(), spread = Vec3::Zero();
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) middle += nodes.motion[i].x, ++count;
    middle /= std::max(count, 1u);
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) spread += (nodes.motion[i].x - middle).cwiseAbs();
    int axis = 0;
    const double mean = spread.maxCoeff(&axis) / std::max(count, 1u);
    constexpr double kReach = 3;  // times the mean distance; a row of bodies ends at twice of it
    const double per_length = kSlices / (2 * kReach * std::max(mean, 1e-30));
    place_.resize(nodes.slots());
    for (uint32_t i = 0; i < nodes.slots(); ++i) {
        if (island_of_[i] == kNone) continue;
        const double at = kSlices / 2 + per_length * (nodes.motion[i].x[axis] - middle[axis]);
        place_[i] = at > 0 ? static_cast<uint8_t>(std::min(at, kSlices - 1.0)) : 0;  // not a number: 0
    }
}

// Greedy: each item takes the first colour that none of its nodes has; what finds none goes to the last colour.
template <class Ends, class Kind>
uint32_t Partition::colour(const Array<uint32_t>& items, Array<uint32_t>& begin, Ends ends, Kind kind) {
    constexpr uint32_t kOfColour = kKinds * kSlices;
    rank_.resize(items.size());
    rank_begin_.assign(1, 0);
    uint32_t most = 0;  // colours
    for (size_t i = 0; i < items.size(); ++i) {
        const auto nodes = ends(items[i]);
        uint64_t taken = uint64_t{1} << (kMaxColours - 1);
        uint32_t place = kSlices - 1;
        for (uint32_t node : nodes) {
            if (node == kNone || island_of_[node] == kNone) continue;
            taken |= used_[node];
            place = std::min<uint32_t>(place, place_[node]);
        }
        uint32_t c = kMaxColours - 1;
        if (~taken != 0) {
            c = static_cast<uint32_t>(std::countr_zero(~taken));
            for (uint32_t node : nodes)
                if (node != kNone && island_of_[node] != kNone) used_[node] |= uint64_t{1} << c;
        } else {
            place = 0;
        }
        if (c >= most) rank_begin_.resize((most = c + 1) * kOfColour + 1, 0);
        rank_[i] = c * kOfColour + kind(items[i]) * kSlices + place;
        ++rank_begin_[rank_[i] + 1];
    }
    for (uint32_t r = 0; r < most * kOfColour; ++r) rank_begin_[r + 1] += rank_begin_[r];
    begin.resize(kMaxColours + 1);
    for (uint32_t c = 0; c <= kMaxColours; ++c) begin[c] = rank_begin_[std::min(c, most) * kOfColour];
    return most;
}

// Calls take(at, item, place) for what colour() went through last.
template <class Take>
void Partition::sort_coloured(const Array<uint32_t>& items, Take&& take) {
    for (size_t i = 0; i < items.size(); ++i)
        take(rank_begin_[rank_[i]]++, items[i], static_cast<uint8_t>(rank_[i] % kSlices));
}

}  // namespace taut
