// What sweeps make of a joint: soft under a great load, rigid if its compliance is lost in what they leave over.
#include "check/lint_context.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

constexpr double kSoftLoad = 10;  // weights of its lighter end
// Below this share of h^2 J W J^T a compliance is lost in what sweeps leave over.
constexpr double kLeastCompliance = 1e-3;

void load_on(const LintContext& context, uint32_t j, const JointReading& reading) {
    const Joint& joint = context.joints.record[j];
    const uint32_t light = context.lightest_of(joint);
    const double weight = context.mass(light) * context.gravity().norm();
    if (weight > 0)
        context.add_above(TAUT_LINT_SOFT_LOAD, light, j, wrench_of(joint, reading).force.norm() / weight, kSoftLoad);
}

void lost_compliance(const LintContext& context, uint32_t j, const JointReading& reading) {
    const Joint& joint = context.joints.record[j];
    const double h = context.world.spring_substep;
    double least = kLeastCompliance;
    for (int row = 0; row < joint.type->rows; ++row) {
        if (!is_locked(joint, row)) continue;
        const double c = row_compliance(joint, row), inverse_mass = inverse_mass_of(context.nodes, joint, reading, row);
        if (c > 0 && inverse_mass > 0) least = std::min(least, c / (h * h * inverse_mass));
    }
    if (least < kLeastCompliance) context.add(TAUT_LINT_SOFT_COMPLIANCE, kNone, j, least, kLeastCompliance);
}

}  // namespace

void lint_softness(const LintContext& context) {
    context.for_joints([&](uint32_t j, const Joint& joint) {
        if (context.direct(joint)) return;
        const JointReading reading = read_joint(context.nodes, joint);
        load_on(context, j, reading);
        lost_compliance(context, j, reading);
    });
}

}  // namespace taut
