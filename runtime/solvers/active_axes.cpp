// The rows of an active set that are not contacts: stops, drives and friction of joints.
#include <algorithm>
#include <cmath>

#include "solvers/active_set.h"
#include "solvers/curving.h"
#include "system/axis_rows.h"

namespace taut {
namespace {

constexpr double kAxisSoftness = 1e-6;  // of stops, rigid drives and friction
// By how much a drive between stops changes the velocity of its ends alone in a substep, at most [m/s, rad/s]: stops as
// soft as the above hold it .002 rad beyond them. One without bound goes through them from 5 rad/s on; with stops a
// hundred times as stiff, falling dolls gain energy.
constexpr double kStrongest = 1e5;
constexpr double kReach = 50;      // [m/s, rad/s] faster ones are not looked for from afar
constexpr double kAtLimit = 1e-5;  // a box this close to its limit begins there

using Kind = BoundedRow::Kind;

}  // namespace

// True if a stop of the block may be reached in this substep.
bool ActiveSet::nears_stops(const RowBlock& block) const {
    bool near = false;
    for (int row = 0; row < block.type->rows; ++row)
        for_each_axis_row(
            block, row, sys_.rows.error[block.row + static_cast<uint32_t>(row)], sys_.scheme,
            [&](const AxisRow& axis) { near = near || (axis.stop && axis.gap < kReach * sys_.scheme.h); });
    return near;
}

// A rigid stop holds at the end of the substep, where the coordinate has curved; see curving.h.
void ActiveSet::gather_stop(BoundedRow& r, const AxisRow& axis, double curved) {
    r.gap = axis.gap;
    r.speculative = axis.gap > 0;
    r.on = axis.gap < 0 || r.mu > 0;
    if (axis.physical) return;
    r.gap += axis.sign * curved;
    r.target -= axis.sign * curved / sys_.scheme.h;
}

void ActiveSet::gather_axes(uint32_t index) {
    const RowBlock& block = sys_.rows.block[index];
    if (!block.axis) return;
    double curved[kMaxRows] = {};
    if (nears_stops(block)) curving(sys_, block, curved);
    for (int row = 0; row < block.type->rows; ++row) {
        for_each_axis_row(
            block, row, sys_.rows.error[block.row + static_cast<uint32_t>(row)], sys_.scheme, [&](AxisRow axis) {
                gear(sys_, block, row, axis);
                BoundedRow& r = add(axis.stop ? Kind::push : Kind::box, index, row, axis.sign, kAxisSoftness);
                r.least = r.c = std::max(r.least, axis.compliance);
                r.physical = axis.physical;
                r.target = axis.target;
                r.relaxed_target = axis.relaxed_target;
                r.limit = axis.limit;
                r.force = axis.force;
                r.mu = sys_.scheme.impulse(*axis.force);
                if (axis.stop) {
                    gather_stop(r, axis, curved[row]);
                    return;
                }
                if (!axis.rubs() && block.axis[row].mode == AxisMode::limited)
                    r.limit = std::min(r.limit, kStrongest / r.k);
                r.on = true;
                if (std::abs(r.mu) >= (1 - kAtLimit) * r.limit) r.at_limit = r.mu > 0 ? 1 : -1;
            });
    }
}

bool ActiveSet::revise_box(BoundedRow& r) {
    const double f = (r.goal - r.rate) / r.c;
    const int8_t before = r.at_limit;
    r.at_limit = std::abs(f) <= r.limit ? 0 : f > 0 ? 1 : -1;
    return r.at_limit != before;
}

}  // namespace taut
