// What sweeps of a tie cost, beside a direct solve.
#pragma once

#include "constraints/element.h"

namespace taut {

// Of a joint in a substep, in multiplications of a factor that take as long: some 250 ns, measured on ball joints.
constexpr double kTieCost = 1000;

// Of an element by the numbers of its Jacobian, of which a ball joint has 3 x 2 x 6.
inline double sweep_cost(const ElementType& type) {
    return kTieCost * type.row.rows * type.row.nodes * type.freedoms / 36;
}

}  // namespace taut
