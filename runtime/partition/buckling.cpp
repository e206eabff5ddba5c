// Columns and walls that sweeps of the world's substeps cannot hold: their contacts are too soft, and they buckle under
// their own weight.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "partition/footing.h"
#include "partition/partition.h"

namespace taut {
namespace {

constexpr uint32_t kLowLevels = 2;    // so many hold, however small the bodies
constexpr double kBuckling = 0.8;     // see below
constexpr uint32_t kSlenderness = 4;  // bodies a level at most of an island that may be a column
constexpr double kWallsHold = 1.5;    // times that: blocks of cubes fell from 1.9 on, walls of bricks from 2.5
constexpr double kBond = 2;           // bodies that each of a wall stands on

double cubed(double x) { return x * x * x; }

}  // namespace

// Extremes of what bodies weigh and stand on.
void Partition::weigh(const Nodes& nodes) {
    double heaviest = 0;
    lightest_ = least_footing_ = std::numeric_limits<double>::infinity();
    const NodeMass* last = nullptr;  // without a joint; many share one
    for (const uint32_t node : graph_.movers) {
        const NodeMass& body = nodes.mass[node];
        if (&body == last) continue;
        heaviest = std::max(heaviest, body.mass);
        lightest_ = std::min(lightest_, body.mass);
        if (tied_[node]) continue;
        least_footing_ = std::min(least_footing_, footing(body));
        last = &body;
    }
    heavy_on_light_ = static_cast<float>(heaviest / lightest_) >= kHeavyOnLight;
}

// A column of n bodies buckles under its own weight. What one sweep leaves of the weight m g i of the i bodies above
// sinks in by about g i h^2: as if each contact were a spring of m/h^2 to either side of a base of breadth b, which
// holds a tilt with m b^2/(4 h^2). A rod of such hinges, one every height t, of weight m g/t and height n t, buckles
// (Greenhill 1881) once
//   b^2/t < g h^2 n^3 / 1.96
// kBuckling takes the place of 1/1.96: with 0.6, cubes that start askew still leaned over at 1.07 times that.
// Shorter substeps hold it at a quarter of what a direct solve costs, which is left for what they do not hold: with all
// columns of more than twelve levels solved directly, 2550 cubes that fell in 13 layers took up to 125 ms a step.
void Partition::find_columns(const Nodes& nodes, const Pairs& pairs, const PartitionRules& rules) {
    const double h = rules.spring_substep, sag = kBuckling * rules.gravity.norm() * h * h;
    bool any = false;
    for (Island& island : island_) {
        const bool is_narrow = island.nodes <= kSlenderness * island.levels && !island.jointed;
        island.stiffness = 1;
        island.weak = false;
        island.may_be_column = is_narrow && island.nodes <= kMostTower;
        island.rises = island.levels > kLowLevels && sag * cubed(island.levels) > least_footing_;
        any = any || island.rises;
    }
    if (!any) return;
    weak_.clear();
    for (const uint32_t node : graph_.movers) {
        Island& island = island_[island_of_[node]];
        if (!island.rises || tied_[node] || level_[node] == 0) continue;
        const uint32_t above = island.levels - (island.may_be_column ? 0 : level_[node] - 1);
        const double stiffness = sag * cubed(above) / footing(nodes.mass[node]);
        if (stiffness <= 1) continue;
        if (island.may_be_column) {
            island.stiffness = std::max(island.stiffness, static_cast<float>(stiffness));
        } else {
            reserve_more(weak_, 1);
            weak_.push_back(node);
            island.weak = true;
        }
    }
    if (!weak_.empty()) find_walls(nodes, pairs, sag / kWallsHold, (-rules.gravity.normalized()).cast<float>());
}

// Likewise walls, row by row, with r n in place of n^2 for bodies that bear r others on average. Plates that taper to
// the top bear half as much, and hold 3.3 times what a rectangle does: 13 EI/q for L^3 in place of 7.84/2 (first zero
// of J_0, where EI and q grow with the way from the top); 2^1.5 by this.
void Partition::find_walls(const Nodes& nodes, const Pairs& pairs, double sag, const Vec3f& up) {
    standing_.clear();
    reserve_more(standing_, graph_.movers.size());
    std::ranges::copy_if(graph_.movers, std::back_inserter(standing_),
                         [&](uint32_t node) { return island_[island_of_[node]].weak; });
    for (const Walls::Row& row : walls_.find_rows({graph_, adjacent(), nodes, pairs, standing_, up}, weak_)) {
        const double tall = row.weights() * row.column, bond = row.bonded ? kBond : 1;
        float& stiffness = island_[island_of_[row.node]].stiffness;
        stiffness = std::max(stiffness, static_cast<float>(sag * tall * std::sqrt(tall) / (bond * row.footing)));
    }
}

}  // namespace taut
