// Thin bodies in joints, which turn them about their thin axis with next to no inertia.
#include <cmath>
#include <utility>

#include "check/lint_context.h"

namespace taut {
namespace {

constexpr double kThinness = 100;  // largest over smallest principal inertia: above, a rod spins up about its axis

// Eigenvalues by Jacobi's rotations, largest element first; a few rounds reach rounding.
Vec3 principal_of(Mat3 m) {
    for (int round = 0; round < 24; ++round) {
        int p = 0, q = 1;
        for (const auto& [i, j] : {std::pair(0, 2), std::pair(1, 2)})
            if (std::abs(m(i, j)) > std::abs(m(p, q))) p = i, q = j;
        if (!(std::abs(m(p, q)) > 1e-15 * m.trace())) break;
        const double half = 0.5 * (m(q, q) - m(p, p)) / m(p, q);
        const double t = (half >= 0 ? 1 : -1) / (std::abs(half) + std::sqrt(half * half + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        Mat3 turn = Mat3::Identity();
        turn(p, p) = turn(q, q) = c;
        turn(p, q) = s, turn(q, p) = -s;
        m = (turn.transpose() * m * turn).eval();
    }
    return m.diagonal();
}

}  // namespace

void lint_thin(const LintContext& context) {
    const Nodes& nodes = context.nodes;
    Array<uint8_t> jointed(nodes.slots(), uint8_t{0}, context.memory);
    context.for_joints([&](uint32_t, const Joint& joint) {
        for (uint32_t node : joint.nodes())
            if (node != kNone) jointed[node] = 1;
    });
    for (uint32_t node = 0; node < nodes.slots(); ++node) {
        if (!jointed[node] || nodes.info[node].kind != NodeKind::dynamic) continue;
        const Vec3 principal = principal_of(nodes.mass[node].inertia.matrix());
        context.add_above(TAUT_LINT_THIN_INERTIA, node, kNone, principal.maxCoeff() / principal.minCoeff(), kThinness);
    }
}

}  // namespace taut
