// How many substeps and sweeps an island takes, by what rests on what.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "partition/partition.h"

namespace taut {
namespace {

// When an island takes more substeps than the world's. A soft column sags as h^2 and buckles under its own or a
// heavy top's weight; a block of very unequal masses outruns the lag of its forces.
constexpr float kUnderHeavy = 0.2f;        // stiffness for each weight on one: r of them sink in by r g h^2
constexpr uint32_t kSwayingLevels = 8;     // more, of broader ones, twice the sweeps: walls sway for long with one
constexpr double kExtremeMassRatio = 3e4;  // within a block: twice the substeps
constexpr uint32_t kMostHalves = 8;        // of the world's substeps, and
constexpr float kMostStiffness = 16;       // the stiffness that they give

// How many times the substeps, in halves, for contacts so much stiffer: stiffness grows with the square of substeps.
uint32_t halves_for(float stiffness) {
    uint32_t halves = 2;
    for (const uint32_t more : {3u, 4u, 6u, kMostHalves})
        if (static_cast<float>(halves * halves) < 4 * stiffness) halves = more;
    return halves;
}

}  // namespace

// Levels: bodies on the shortest way down to a fixed or kinematic support, by breadth-first search over contacts.
void Partition::find_levels(const Nodes&) {
    uint32_t reached = 0;  // in queue_
    for (const auto& [a, b] : graph_.touches) {
        for (const uint32_t node : {a, b})
            if (node != kNone) ++adjacent_[node].end;
        if (a != b && (a == kNone || b == kNone)) {
            const uint32_t node = std::min(a, b);
            if (level_[node] == 0) queue_[reached++] = node;
            level_[node] = 1;
        }
    }
    uint32_t all = 0;
    for (const uint32_t node : graph_.movers) {
        const uint32_t begin = std::exchange(all, all + adjacent_[node].end);
        adjacent_[node] = {begin, begin};
    }
    for (uint32_t p = 0; p < graph_.touches.size(); ++p)
        for (const uint32_t node : {graph_.touches[p].a, graph_.touches[p].b})
            if (node != kNone) adjacency_[adjacent_[node].end++] = p;
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

// Islands without joints in which weight rests on what sweeps cannot hold, however many substeps they may take.
void Partition::find_towers(const PartitionRules& rules) {
    const float most = rules.fixed ? 1 : kMostStiffness;
    for (Island& island : island_) {
        const bool buckles = island.may_be_column && island.stiffness > most;
        const bool hard = island.ratio >= kHeavyOnLight || buckles;
        island.tower = !island.jointed && island.nodes <= kMostTower && hard;
    }
}

// Of islands with swept elements that have a tolerance.
void Partition::find_strains(const Elements& elements) {
    strain_.clear();
    for (uint32_t e = 0; e < element_.size() && lanes_; ++e) {
        const ElementSet& set = elements.set[element_[e].set];
        if (element_pass_[e] == kNone || element_in_block_[e] || set.tolerance == 0) continue;
        if (strain_.empty()) strain_.resize(island_.size(), 0.0);
        const auto moves = std::ranges::find_if(movers_of(e), [](uint32_t node) { return node != kNone; });
        double& strain = strain_[island_of_[*moves]];
        strain = std::max(strain, set.yield / set.tolerance);
    }
}

// How often in a second two features that meet within the frame pass each other by half the shortest edge of either, as
// far as it is from its middle to its end: weights and normal of their contact tell nothing beyond that. 0: none has an
// edge, or they do not meet [1/s].
static double passages_of(const Nodes& nodes, const SurfaceContact& contact, double frame) {
    double speed = 0, squared = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < i; ++k) {
            if (contact.node[i] == kNone || contact.node[k] == kNone) continue;
            const NodeMotion &one = nodes.motion[contact.node[i]], &other = nodes.motion[contact.node[k]];
            if (contact.weight[i] * contact.weight[k] > 0) {
                squared = std::min(squared, (one.x - other.x).squaredNorm());
                continue;
            }
            Vec3 apart = one.v - other.v;
            if (k == 0) apart -= other.w.cross(contact.lever.cast<double>());
            speed = std::max(speed, std::abs(apart.dot(contact.normal.cast<double>())));
        }
    const bool meets = static_cast<double>(contact.gap) < frame * speed;
    return meets && squared > 0 ? 2 * speed / std::sqrt(squared) : 0;
}

// Of islands with contacts of surfaces that are swept.
void Partition::find_passages(const Nodes& nodes, const SurfaceContacts& surfaces, const PartitionRules& rules) {
    for (size_t i = 0; i < surfaces.contact.size() && lanes_; ++i) {
        if (surface_in_block_[i]) continue;
        const double rate = passages_of(nodes, surfaces.contact[i], rules.time_step);
        if (!(rate * rules.time_step > rules.substeps)) continue;
        const TouchGraph::Tie movers = movers_of(surfaces.contact[i]);
        const auto moves = std::ranges::find_if(movers, [](uint32_t node) { return node != kNone; });
        if (moves == movers.end()) continue;
        if (strain_.empty()) strain_.resize(island_.size(), 0.0);
        double& strain = strain_[island_of_[*moves]];
        strain = std::max(strain, rate * rate);
    }
}

// Of islands with contacts between grains.
void Partition::find_grain_strains(const Grains& grains) {
    grain_strain_.clear();
    if (grains.contact.empty()) return;
    grain_strain_.resize(island_.size(), 0.0);
    for (const GrainContact& contact : grains.contact) {
        const uint32_t moves = graph_.moves[contact.a] ? contact.a : contact.b;
        if (!graph_.moves[moves]) continue;
        double& strain = grain_strain_[island_of_[moves]];
        strain = std::max(strain, static_cast<double>(contact.strain));
    }
}

// Yields fall as the square of substeps.
uint32_t Partition::swept_substeps(size_t island, const PartitionRules& rules) const {
    const auto wanted = [&](const Array<double>& strain, uint32_t most) {
        const double substeps = strain.empty() ? 0 : std::ceil(rules.time_step * std::sqrt(strain[island]));
        return static_cast<uint32_t>(std::min<double>(substeps, most));
    };
    return std::max(wanted(strain_, kMostElasticSubsteps), wanted(grain_strain_, kMostHalves * rules.substeps / 2));
}

void Partition::choose_substeps(const PartitionRules& rules) {
    for (Island& island : island_) {
        uint32_t halves = halves_for(island.stiffness);
        island.sweeps = 1;
        island.whips = false;
        if (island.tower) {
            island.substeps = rules.substeps;
            continue;
        }
        const bool under_heavy = island.ratio >= kHeavyOnLight && !island.jointed;
        if (under_heavy) halves = std::max(halves, halves_for(kUnderHeavy * island.ratio));
        const bool sways = island.levels > kSwayingLevels && !(under_heavy && halves == kMostHalves);
        if (sways && !rules.fixed) island.sweeps = 2;
        island.substeps = rules.fixed ? rules.substeps : (rules.substeps * halves + 1) / 2;
    }
    if (rules.fixed) return;
    for (size_t i = 0; i < island_.size(); ++i)
        island_[i].substeps = std::max(island_[i].substeps, swept_substeps(i, rules));
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
