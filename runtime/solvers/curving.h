// How the coordinates of a joint curve: what a substep in a straight line leaves out.
#pragma once

#include "system/system.h"

namespace taut {

// C(x + h v) - C(x) - h J v of each row [m or rad], at the velocities v with which the substep begins. A limb that
// whirls along the rim of its cone leaves it by this in each substep: u^2 cot(c) h^2 / 2 at the rate u, 0.6 degrees at
// 30 rad/s on a rim of 35 degrees. Of rows whose C is changed from without, 0.
void curving(const System& system, const RowBlock& block, double* out);

}  // namespace taut
