// How a substep of row solvers goes over its rows, by taut_stepping. A pass is one problem (system/problem.h), iterated
// from the velocities that the pass before it left:
//   projection       all rows at the end of the substep                                   (Frâncu 2016, eq. 6.26)
//   velocity         all rows, linearised where it begins                                 (eq. 6.17 to 6.21)
//   links_first      joints and elements at its end, then contacts alone                  (figure 8.14)
//   velocity_first   all rows linearised and without push, which stops impacts; then projection   (section 8.3)
//   post_stabilised  the same, but the velocities kept are those of the first pass        (Cline and Pai 2003)
// After the positions moved, the passes that push go again over what velocities are left along the rows.
#pragma once

#include <span>

#include "system/problem.h"

namespace taut {

// In the order of taut_stepping.
enum class Stepping : uint8_t { projection, velocity, links_first, velocity_first, post_stabilised };

struct RowPass {
    Part part;
    bool linear, pushes;
};

inline std::span<const RowPass> passes_of(Stepping stepping) {
    static constexpr RowPass kProjection[] = {{Part::all, false, true}}, kVelocity[] = {{Part::all, true, true}},
                             kLinksFirst[] = {{Part::links, false, true}, {Part::contacts, true, true}},
                             kVelocityFirst[] = {{Part::all, true, false}, {Part::all, false, true}};
    switch (stepping) {
        case Stepping::projection:
            return kProjection;
        case Stepping::velocity:
            return kVelocity;
        case Stepping::links_first:
            return kLinksFirst;
        case Stepping::velocity_first:
        case Stepping::post_stabilised:
            break;
    }
    return kVelocityFirst;
}

}  // namespace taut
