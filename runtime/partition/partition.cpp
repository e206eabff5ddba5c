#include "partition/partition.h"

#include <algorithm>
#include <bit>

namespace taut {
namespace {

// When an island takes more substeps than the world's. A soft column sags as h^2 and buckles under its own or a
// heavy top's weight; a block of very unequal masses outruns the lag of its forces.
constexpr uint32_t kTallLevels = 12;       // more bodies above one another than this, and
constexpr uint32_t kSlenderness = 4;       // at most this many bodies a level: twice the substeps
constexpr float kHeavyOnLight = 10;        // load over support mass: four times the substeps
constexpr double kExtremeMassRatio = 3e4;  // within a block: twice the substeps

bool moving(const Nodes& nodes, uint32_t node) { return node != kNone && moves_by_forces(nodes.info[node].kind); }

}  // namespace

Partition::Partition(Memory& memory)
    : groups(memory),
      blocks(memory),
      parent_(memory),
      island_of_(memory),
      level_(memory),
      island_(memory),
      used_(memory),
      colour_of_(memory),
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

void Partition::build(const Nodes& nodes, const Joints& joints, const Pairs& pairs, const PartitionRules& rules) {
    if (!rules.direct_joints)
        blocks.clear();
    else if (joints_version_ != joints.version)
        build_blocks(nodes, joints);
    joints_version_ = joints.version;
    connect(nodes, joints, pairs);
    measure_towers(nodes, pairs);
    choose_substeps(rules);
    distribute(nodes, joints, pairs, rules);
}

// Union-find of the joint graph alone.
void Partition::connect_joints(const Nodes& nodes, const Joints& joints) {
    parent_.resize(nodes.slots());
    for (uint32_t i = 0; i < nodes.slots(); ++i) parent_[i] = i;
    for (const Joint& joint : joints.record)
        if (joint.type && moving(nodes, joint.node[0]) && moving(nodes, joint.node[1]))
            unite(joint.node[0], joint.node[1]);
}

// Components of the joint graph. Symbolic work happens at a block's first solve.
void Partition::build_blocks(const Nodes& nodes, const Joints& joints) {
    const uint32_t slots = nodes.slots();
    connect_joints(nodes, joints);
    Memory& memory = *blocks.get_allocator().memory;
    Array<Block> old(memory);
    old.swap(blocks);
    island_of_.assign(slots, kNone);  // here: block of a root
    for (uint32_t j = 0; j < joints.record.size(); ++j) {
        const Joint& joint = joints.record[j];
        if (!joint.type) continue;
        const uint32_t end = moving(nodes, joint.node[0]) ? joint.node[0] : joint.node[1];
        if (!moving(nodes, end)) continue;
        uint32_t& block = island_of_[find(end)];
        if (block == kNone) {
            block = static_cast<uint32_t>(blocks.size());
            blocks.emplace_back(memory);
        }
        blocks[block].joints.push_back(j);
    }
    for (uint32_t i = 0; i < slots; ++i) {
        if (!moving(nodes, i) || island_of_[find(i)] == kNone) continue;
        blocks[island_of_[find(i)]].nodes.push_back(i);
    }
    for (Block& block : blocks) {
        double least = 1e300, most = 0;
        for (uint32_t node : block.nodes) {
            least = std::min(least, nodes.mass[node].mass);
            most = std::max(most, nodes.mass[node].mass);
        }
        block.mass_ratio = most / least;
        for (uint32_t j : block.joints) block.identity.push_back(joints.record[j].serial);
        for (uint32_t node : block.nodes)
            block.identity.push_back(static_cast<uint64_t>(node) << 32 | nodes.ids.generation(node));
        for (Block& before : old) {  // unchanged blocks keep their order and their memory
            if (before.identity != block.identity) continue;
            block = std::move(before);
            break;
        }
    }
}

void Partition::connect(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    const uint32_t slots = nodes.slots();
    connect_joints(nodes, joints);
    for (const ActivePair& pair : pairs.active)
        if (moving(nodes, pair.a) && moving(nodes, pair.b)) unite(pair.a, pair.b);

    island_of_.assign(slots, kNone);
    island_.clear();
    for (uint32_t i = 0; i < slots; ++i) {  // roots are smallest, so each is met before its members
        if (!moving(nodes, i)) continue;
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
        if (!joint.type) continue;
        for (uint32_t node : joint.node)
            if (moving(nodes, node)) island_[island_of_[node]].jointed = true;
    }
}

// Levels: bodies on the shortest way down to a fixed or kinematic support, by breadth-first search over contacts.
void Partition::measure_towers(const Nodes& nodes, const Pairs& pairs) {
    const uint32_t slots = nodes.slots();
    adjacency_begin_.assign(slots + 1, 0);
    level_.assign(slots, 0);
    queue_.clear();
    for (const ActivePair& pair : pairs.active) {
        const bool a = moving(nodes, pair.a), b = moving(nodes, pair.b);
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
        if (!moving(nodes, pair.a) || !moving(nodes, pair.b)) continue;
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
        if (island.ratio > kHeavyOnLight && !island.jointed)
            factor = 4;
        else if (island.levels > kTallLevels && island.nodes <= kSlenderness * island.levels)
            factor = 2;
        else if (island.levels > kTallLevels)
            island.sweeps = rules.fixed ? 1 : 2;
        island.substeps = rules.substeps * (rules.fixed ? 1 : factor);
    }
    if (rules.fixed) return;
    for (const Block& block : blocks) {
        if (block.mass_ratio <= kExtremeMassRatio && !block.memory.escalated) continue;
        Island& island = island_[island_of_[block.nodes[0]]];
        island.substeps = std::max(island.substeps, 2 * rules.substeps);
    }
}

void Partition::distribute(const Nodes& nodes, const Joints& joints, const Pairs& pairs, const PartitionRules& rules) {
    make_groups();
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) groups[group_of(i)].nodes.push_back(i);
    for (uint32_t b = 0; b < blocks.size(); ++b) groups[group_of(blocks[b].nodes[0])].blocks.push_back(b);

    used_.resize(nodes.slots());
    colours = 0;
    Array<uint32_t>& items = queue_;
    for (uint32_t g = 0; g < group_count; ++g) {
        Group& group = groups[g];
        auto here = [&](uint32_t a, uint32_t b) {
            const uint32_t node = moving(nodes, a) ? a : b;
            return moving(nodes, node) && group_of(node) == g;
        };
        items.clear();
        if (!rules.direct_joints)
            for (uint32_t j = 0; j < joints.record.size(); ++j) {
                const Joint& joint = joints.record[j];
                if (joint.type && here(joint.node[0], joint.node[1])) items.push_back(j);
            }
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_joints = colour(items, group.joints, group.joint_colour_begin, [&](uint32_t j) {
            return std::pair(joints.record[j].node[0], joints.record[j].node[1]);
        });
        items.clear();
        for (uint32_t p = 0; p < pairs.active.size(); ++p)
            if (here(pairs.active[p].a, pairs.active[p].b)) items.push_back(p);
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_pairs = colour(items, group.pairs, group.pair_colour_begin,
                                         [&](uint32_t p) { return std::pair(pairs.active[p].a, pairs.active[p].b); });
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
    }
    for (Island& island : island_) {
        island.group = static_cast<uint32_t>(std::lower_bound(scratch_.begin(), scratch_.end(), island.effort()) -
                                             scratch_.begin());
        groups[island.group].substeps = island.substeps;
        groups[island.group].sweeps = island.sweeps;
    }
}

// Greedy: each item takes the first colour that neither of its nodes has; what finds none goes to the last colour.
template <class Ends>
uint32_t Partition::colour(const Array<uint32_t>& items, Array<uint32_t>& sorted, Array<uint32_t>& begin, Ends ends) {
    colour_of_.resize(items.size());
    begin.assign(kMaxColours + 1, 0);
    uint32_t most = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        const auto [a, b] = ends(items[i]);
        uint64_t taken = uint64_t{1} << (kMaxColours - 1);
        for (uint32_t node : {a, b})
            if (node != kNone && island_of_[node] != kNone) taken |= used_[node];
        uint32_t c = kMaxColours - 1;
        if (~taken != 0) {
            c = static_cast<uint32_t>(std::countr_zero(~taken));
            for (uint32_t node : {a, b})
                if (node != kNone && island_of_[node] != kNone) used_[node] |= uint64_t{1} << c;
        }
        colour_of_[i] = static_cast<uint8_t>(c);
        ++begin[c + 1];
        most = std::max(most, c + 1);
    }
    for (uint32_t c = 0; c < kMaxColours; ++c) begin[c + 1] += begin[c];
    scratch_.assign(begin.begin(), begin.end());
    sorted.resize(items.size());
    for (size_t i = 0; i < items.size(); ++i) sorted[scratch_[colour_of_[i]]++] = items[i];
    return most;
}

}  // namespace taut
