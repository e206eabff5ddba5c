#include "solvers/curving.h"

#include <cmath>

#include "system/operators.h"

namespace taut {

void curving(const System& system, const RowBlock& block, double* out) {
    constexpr double kTurn = 2 * 3.14159265358979323846;
    const double h = system.scheme.h;
    const int rows = block.type->rows;
    Pose moved[kMaxNodes];
    double straight[kMaxRows] = {};
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t node = block.node[n];
        const Velocity& u = system.place[node] == kNone ? system.exact[node] : system.start[node];
        const Pose& x = system.pose[node];
        moved[n] = {x.x + h * u.v, rotation_from_vector(h * u.w) * x.R};
        for (int r = 0; r < rows; ++r) straight[r] += h * along(row_of(system, block, n, r), u);
    }
    block.type->evaluate(block.data, moved, out, nullptr);
    for (int r = 0; r < rows; ++r) {
        out[r] -= system.rows.error[block.row + static_cast<uint32_t>(r)] + straight[r];
        if (block.angular(r)) out[r] -= kTurn * std::round(out[r] / kTurn);
        if (block.drift[r] != 0) out[r] = 0;
    }
}

}  // namespace taut
