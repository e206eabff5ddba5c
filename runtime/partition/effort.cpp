// How many substeps and sweeps an island takes, by what rests on what.
#include <algorithm>
#include <cmath>
#include <limits>

#include "partition/partition.h"

namespace taut {
namespace {

// When an island takes more substeps than the world's. A soft column sags as h^2 and buckles under its own or a
// heavy top's weight; a block of very unequal masses outruns the lag of its forces.
constexpr uint32_t kTallLevels = 12;       // more bodies above one another than this, and
constexpr uint32_t kSlenderness = 4;       // at most this many bodies a level: twice the substeps
constexpr uint32_t kLowLevels = 2;         // or more than this, so small that they
constexpr double kBuckling = 0.8;          // buckle: see find_slender()
constexpr uint32_t kSwayingLevels = 8;     // more, of broader ones, twice the sweeps: walls sway for long with one
constexpr double kExtremeMassRatio = 3e4;  // within a block: twice the substeps

// Of a column of such bodies, breadth^2 over height [m]: of cubes, their side. By their moments of inertia, which for
// a slab of sides b, b and t are m b^2/6 and m (b^2 + t^2)/12: exact for cubes, too small by half for thin plates.
// What does not turn, a particle, has none.
double footing(const NodeMass& body) {
    const Sym3& i = body.inertia;
    const auto [least, most] = std::minmax({i.xx, i.yy, i.zz});
    return most > 0 ? least * std::sqrt(6 / (body.mass * most)) : std::numeric_limits<double>::infinity();
}

}  // namespace

// Levels: bodies on the shortest way down to a fixed or kinematic support, by breadth-first search over contacts.
void Partition::find_levels(const Nodes&) {
    std::fill(level_.begin(), level_.end(), 0);
    std::fill(adjacency_begin_.begin(), adjacency_begin_.end(), 0);
    uint32_t reached = 0;  // in queue_
    for (const auto& [a, b] : graph_.touches) {
        for (const uint32_t node : {a, b})
            if (node != kNone) ++adjacency_begin_[node + 2];
        if (a != b && (a == kNone || b == kNone)) {
            const uint32_t node = std::min(a, b);
            if (level_[node] == 0) queue_[reached++] = node;
            level_[node] = 1;
        }
    }
    for (size_t i = 2; i < adjacency_begin_.size(); ++i) adjacency_begin_[i] += adjacency_begin_[i - 1];
    for (uint32_t p = 0; p < graph_.touches.size(); ++p)
        for (const uint32_t node : {graph_.touches[p].a, graph_.touches[p].b})
            if (node != kNone) adjacency_[adjacency_begin_[node + 1]++] = p;
    for (uint32_t head = 0; head < reached; ++head) {
        const uint32_t node = queue_[head], above = level_[node] + 1;
        for (const uint32_t p : touches_of(node)) {
            const uint32_t next = graph_.touches[p].other(node);
            if (next == kNone || level_[next] != 0) continue;
            level_[next] = above;
            queue_[reached++] = next;
        }
    }
}

// Whether any load can be a heavy one.
void Partition::weigh(const Nodes& nodes) {
    double heaviest = 0;
    lightest_ = std::numeric_limits<double>::infinity();
    for (const uint32_t node : graph_.movers) {
        heaviest = std::max(heaviest, nodes.mass[node].mass);
        lightest_ = std::min(lightest_, nodes.mass[node].mass);
    }
    heavy_on_light_ = static_cast<float>(heaviest / lightest_) >= kHeavyOnLight;
}

// Of what is a level higher than what it touches.
void Partition::find_loads(const Nodes& nodes) {
    for (Island& island : island_) island.ratio = 1;
    if (!heavy_on_light_) return;
    for (const auto& [a, b] : graph_.touches) {
        if (a == kNone || b == kNone || level_[a] == level_[b]) continue;
        const uint32_t below = level_[a] < level_[b] ? a : b, above = a + b - below;
        float& ratio = island_[island_of_[a]].ratio;
        ratio = std::max(ratio, static_cast<float>(nodes.mass[above].mass * nodes.mass[below].inv_mass));
    }
}

// A column of n bodies buckles under its own weight. What one sweep leaves of the weight m g i of the i bodies above
// sinks in by about g i h^2: as if each contact were a spring of m/h^2 to either side of a base of breadth b, which
// holds a tilt with m b^2/(4 h^2). A rod of such hinges, one every height t, of weight m g/t and height n t, buckles
// (Greenhill 1881) once
//   b^2/t < g h^2 n^3 / 1.96
// kBuckling takes the place of 1/1.96: with 0.6, cubes that start askew still leaned over at 1.07 times that.
void Partition::find_slender(const Nodes& nodes, const PartitionRules& rules) {
    const double h = rules.time_step / rules.substeps, sag = kBuckling * rules.gravity.norm() * h * h;
    const auto narrow = [](const Island& island) { return island.nodes <= kSlenderness * island.levels; };
    const auto may_buckle = [&](const Island& island) {
        return island.levels > kLowLevels && narrow(island) && !island.jointed && !island.slender;
    };
    for (Island& island : island_) island.slender = island.levels > kTallLevels && narrow(island);
    if (std::none_of(island_.begin(), island_.end(), may_buckle)) return;
    for (const uint32_t node : graph_.movers) {
        Island& island = island_[island_of_[node]];
        const double n = island.levels;
        island.slender = island.slender || (may_buckle(island) && footing(nodes.mass[node]) < sag * n * n * n);
    }
}

// Islands without joints in which weight rests on what sweeps cannot hold.
void Partition::find_towers() {
    for (Island& island : island_) {
        const bool hard = island.ratio >= kHeavyOnLight || island.slender;
        island.tower = !island.jointed && island.nodes <= kMostTower && hard;
    }
}

void Partition::choose_substeps(const PartitionRules& rules) {
    for (Island& island : island_) {
        uint32_t factor = 1;
        island.sweeps = 1;
        island.whips = false;
        if (island.tower) {
            island.substeps = rules.substeps;
            continue;
        }
        if (island.ratio >= kHeavyOnLight && !island.jointed)
            factor = 4;
        else if (island.slender)
            factor = 2;
        else if (island.levels > kSwayingLevels)
            island.sweeps = rules.fixed ? 1 : 2;
        island.substeps = rules.substeps * (rules.fixed ? 1 : factor);
    }
    if (rules.fixed) return;
    for (Block& block : blocks) {
        Island& island = island_[island_of_[block.nodes[0]]];
        if (!block.tower && (block.mass_ratio > kExtremeMassRatio || block.memory.escalated))
            island.substeps = std::max(island.substeps, 2 * rules.substeps);
        if (block.memory.whips_left > 0) {
            --block.memory.whips_left;
            island.whips = true;
        }
    }
}

}  // namespace taut
