// Laws of a block's bounded rows, projected one contact after the other (projected Gauss-Seidel): pushes, then the two
// tangents of its friction together, clipped to the disc that the push leaves them; drives and friction of joints
// within their limits.
#pragma once

#include <algorithm>
#include <cmath>

#include "solvers/active_set.h"

namespace taut {

// Sum over the pushes that load a friction, times its coefficient [N s].
inline double bound_of(std::span<const BoundedRow> rows, const BoundedRow& lead) {
    double push = 0;
    for (uint32_t k = 0; k < lead.loads; ++k) push += rows[lead.load + kContactRows * k].mu;
    return lead.limit * push;
}

// Impulses of the last substep within what bounds them now; rows that are not meant to be soft are hard.
void bound_impulses(std::span<BoundedRow> rows);
// Which rows are on by their impulses, after the last solve.
void note_state(std::span<BoundedRow> rows);

// One pass over `count` rows of which Of tells
//   row(i)               the row, tangents right after their lead
//   miss(i)              s J v + c mu - goal [m/s]
//   stiffness(i)         by how much that grows with its impulse [1/kg]
//   change(i, n, by)     n rows from i on get other impulses, and all that follows from it
// The most that a row missed its law by before [m/s].
template <class Of>
double sweep_laws(Of& of, std::span<const BoundedRow> rows, uint32_t count) {
    double most = 0;
    for (uint32_t i = 0, width; i < count; i += width) {
        const BoundedRow& lead = of.row(i);
        width = std::max<uint32_t>(1, lead.width);
        double stiff = 0, to[kContactRows], size = 0;
        for (uint32_t k = 0; k < width; ++k) stiff = std::max(stiff, of.stiffness(i + k));
        if (!(stiff > 0)) continue;
        for (uint32_t k = 0; k < width; ++k) to[k] = of.row(i + k).mu - of.miss(i + k) / stiff;
        if (lead.kind == BoundedRow::Kind::push) to[0] = std::max(0.0, to[0]);
        if (lead.kind == BoundedRow::Kind::box) to[0] = std::clamp(to[0], -lead.limit, lead.limit);
        if (lead.kind == BoundedRow::Kind::tangent) {
            const double bound = bound_of(rows, lead);
            for (uint32_t k = 0; k < width; ++k) size += to[k] * to[k];
            size = std::sqrt(size);
            for (uint32_t k = 0; k < width && size > bound; ++k) to[k] *= bound / size;
        }
        bool any = false;
        for (uint32_t k = 0; k < width; ++k) {
            BoundedRow& r = of.row(i + k);
            const double by = to[k] - r.mu;
            r.mu = to[k];
            to[k] = by;
            any = any || by != 0;
            most = std::max(most, stiff * std::abs(by));
        }
        if (any) of.change(i, width, to);
    }
    return most;
}

}  // namespace taut
