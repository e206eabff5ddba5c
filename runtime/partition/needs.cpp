#include "partition/needs.h"

#include <algorithm>
#include <limits>

#include "constraints/soft_contact.h"
#include "partition/movers.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

// y / (kSeen d) of a yield y [m] and a size d [m].
double strain(double yield, double size) {
    if (yield == 0) return 0;
    return size > 0 ? yield / (kSeen * size) : std::numeric_limits<double>::infinity();
}

double strain_of(const Nodes& nodes, const ConstraintType& type, std::span<const uint32_t> ends, const double* lambda,
                 double h) {
    double squared = 0, inverse = 0, size = std::numeric_limits<double>::infinity();
    for (int r = 0; r < type.rows; ++r)
        if (!(type.angular >> r & 1)) squared += lambda[r] * lambda[r];
    for (const uint32_t node : ends) {
        if (!moving(nodes, node)) continue;
        inverse += nodes.mass[node].inv_mass;
        size = std::min(size, extent(nodes.mass[node]));
    }
    return strain(kJointYield * h * h * inverse * std::sqrt(squared), size);
}

// Whether what keeps its ends together gives way by nothing but the sweeps.
bool all_rigid(const Joint& joint) {
    const std::span<const Axis> rows(joint.axis, static_cast<size_t>(joint.type->rows));
    return joint.compliance == 0 && (joint.plain || std::ranges::all_of(rows, [](const Axis& axis) {
                                         return axis.mode != AxisMode::limited || axis.limit_compliance == 0;
                                     }));
}

double strain_of_gap(const Nodes& nodes, const Joint& joint) {
    if (!all_rigid(joint)) return 0;
    double size = std::numeric_limits<double>::infinity();
    for (const uint32_t node : joint.nodes())
        if (moving(nodes, node)) size = std::min(size, extent(nodes.mass[node]));
    return std::min(1 + static_cast<double>(kPatience / kJammed), strain(gap_of(nodes, joint), size));
}

// Seconds of strain beyond what may be seen; once it is needed, of time until it is not.
float follow(float need, double strain, double frame) {
    const auto past = static_cast<float>(frame);
    if (is_needed(need)) {
        need = strain > 1 ? 2 * kPatience : need - past;
        return is_needed(need) ? need : 0;
    }
    const double grown = static_cast<double>(need) + (strain - 1) * frame;
    return grown > static_cast<double>(kPatience) ? 2 * kPatience : std::max(0.0f, static_cast<float>(grown));
}

}  // namespace

double strain_of_weights(const NodeMass& body, double weights, double h, double gravity) {
    return strain(kJointYield * h * h * weights * gravity, extent(body));
}

double strain_of_fall(const NodeMass& body, double time, double gravity) {
    return strain(0.5 * gravity * time * time, extent(body));
}

void note_needs(Joints& joints, Elements& elements, const Nodes& nodes, double h, double frame) {
    for (Joint& joint : joints.record) {
        if (!joint.works() || joint.solve != JointSolve::by_load || asleep(nodes, joint)) continue;
        const double yields = strain_of(nodes, *joint.type, joint.nodes(), joint.lambda, h);
        joint.need = follow(joint.need, std::max(yields, strain_of_gap(nodes, joint)), frame);
    }
    for_each_element(elements, [&](ElementSet& set, uint32_t e, std::span<const uint32_t> ends) {
        if (set.solve != JointSolve::by_load || asleep(nodes, ends)) return;
        set.need[e] = follow(set.need[e], strain_of(nodes, set.type->row, ends, set.lambda_of(e), h), frame);
    });
}

}  // namespace taut
