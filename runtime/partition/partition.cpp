#include "partition/partition.h"

#include <algorithm>

#include "partition/movers.h"

namespace taut {
namespace {

// When an island takes more substeps than the world's. A soft column sags as h^2 and buckles under its own or a
// heavy top's weight; a block of very unequal masses outruns the lag of its forces.
constexpr uint32_t kTallLevels = 12;       // more bodies above one another than this, and
constexpr uint32_t kSlenderness = 4;       // at most this many bodies a level: twice the substeps
constexpr uint32_t kSwayingLevels = 8;     // more, of broader ones, twice the sweeps: walls sway for long with one
constexpr float kHeavyOnLight = 10;        // load over support mass: four times the substeps
constexpr double kExtremeMassRatio = 3e4;  // within a block: twice the substeps

constexpr uint32_t kMostTower = 60;  // bodies of a tower that is a block: a heavy load on light bodies, or many levels

}  // namespace

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

}  // namespace taut
