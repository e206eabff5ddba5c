// How joints fit the present poses, and how much room their stops leave.
#include <algorithm>
#include <cmath>

#include "check/lint_context.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

// Of joints and stops: what closes without being seen [m], [rad].
constexpr double kGap = 0.01, kMisalignment = 0.1;
// Room in which a stop is met in every step [m], [rad].
constexpr double kNarrowGap = 1e-3, kNarrowAngle = 1e-2;

constexpr struct {
    taut_lint_kind apart, overrun, narrow;
    double far, least_room;
} kUnit[2] = {
    {TAUT_LINT_JOINT_APART, TAUT_LINT_STOP_OVERRUN, TAUT_LINT_NARROW_STOPS, kGap, kNarrowGap},
    {TAUT_LINT_JOINT_MISALIGNED, TAUT_LINT_STOP_OVERRUN_ANGLE, TAUT_LINT_NARROW_STOPS_ANGLE, kMisalignment,
     kNarrowAngle},
};

// The first end with locked axes of a row that moves nothing for them; kNone: it moves something, or none is locked.
uint32_t blocked_by(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    const auto ends = joint.nodes();
    const auto end =
        std::ranges::find_if(ends, [&](uint32_t node) { return node != kNone && nodes.locks_of(node).any(); });
    return end != ends.end() && is_blocked(nodes, joint, reading, row) ? *end : kNone;
}

// Of the rows of one unit [m or rad].
struct Fit {
    double off = 0;  // of what is rigid, squared
    double overrun = 0, room = 1e300;
};

}  // namespace

void lint_poses(const LintContext& context) {
    context.for_joints([&](uint32_t j, const Joint& joint) {
        const JointReading reading = read_joint(context.nodes, joint);
        Fit fit[2];
        for (int row = 0; row < joint.type->rows; ++row) {
            Fit& of = fit[is_angle(joint, row)];
            const Axis& axis = joint.axis[row];
            if (is_rigid(joint, row)) of.off += reading.value[row] * reading.value[row];
            if (const double error = std::abs(reading.value[row]), far = kUnit[is_angle(joint, row)].far;
                is_rigid(joint, row) && error > far) {
                const uint32_t locked = blocked_by(context.nodes, joint, reading, row);
                if (locked != kNone) context.add(TAUT_LINT_JOINT_LOCKED, locked, j, error, far);
            }
            if (axis.mode != AxisMode::limited) continue;
            if (axis.limit_compliance == 0) of.overrun = std::max(of.overrun, overrun_of(joint, reading.value, row));
            of.room = std::min(of.room, static_cast<double>(axis.upper) - axis.lower);
        }
        for (int angle = 0; angle < 2; ++angle) {
            const auto& unit = kUnit[angle];
            context.add_above(unit.apart, kNone, j, std::sqrt(fit[angle].off), unit.far);
            context.add_above(unit.overrun, kNone, j, fit[angle].overrun, unit.far);
            if (fit[angle].room < unit.least_room) context.add(unit.narrow, kNone, j, fit[angle].room, unit.least_room);
        }
    });
    context.for_attachments([&](uint32_t index, const Attachment& attachment) {
        const double gap = gap_of(context.nodes, context.world.elements, attachment);
        if (attachment.compliance == 0 && gap > kGap)
            context.add(TAUT_LINT_JOINT_APART, context.world.attachment_handle(index), gap, kGap);
    });
}

}  // namespace taut
