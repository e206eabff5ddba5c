// The scalar rows that an axis adds to one row of its joint (constraints/axis.h), for every solver:
//   s J v + c mu = target,   mu within [0, inf) for a stop and within [-limit, limit] for drive and friction.
// Stiffness k and damping d of a drive as an implicit spring: c = 1/(t (h k + d)), t as in scheme.h,
//   target = (d speed - k (C - target)) / (h k + d); infinite d: c = 0, target = speed.
#pragma once

#include <cmath>

#include "system/system.h"

namespace taut {

constexpr double kStopRate = 0.2;  // share of an overlap that a stop or contact undoes in a substep
constexpr double kStopPush = 3;    // and the most of it [m/s or rad/s]

struct AxisRow {
    uint32_t part;          // in AxisMemory: 0 lower, 1 upper, 2 drive, kRubbing
    double sign;            // of J
    bool stop;              // pushes only
    bool physical;          // c and target are meant as they are: not to be relaxed
    double gap;             // of a stop: room that is left [m or rad]
    double target;          // [m/s or rad/s]
    double relaxed_target;  // without the push that undoes an overlap
    double compliance;      // c [1/kg]; 0: rigid
    double limit;           // largest |mu| [N s]
    float* force;           // carried [N]
    bool torque = false;    // limit and 1/c are of the torque, not of the coordinate: see gear()

    bool rubs() const { return part == kRubbing; }
};

inline AxisRow stop_row(double sign, double gap, const Axis& axis, double softness, const Scheme& scheme,
                        float* force) {
    AxisRow row{sign > 0 ? 0u : 1u, sign, true, axis.limit_compliance > 0, gap, 0, 0, 0, 1e300, force};
    const double d = double(axis.limit_compliance) * axis.limit_damping;
    row.compliance = softness * axis.limit_compliance / (scheme.act * (scheme.h + d));
    row.target = row.relaxed_target = -gap / scheme.h;
    if (gap > 0) return row;
    row.target = row.physical ? -gap / (scheme.h + d) : std::min(kStopPush, -kStopRate * gap / scheme.h);
    row.relaxed_target = row.physical ? row.target : 0;
    return row;
}

// off: C from its target.
inline AxisRow drive_row(double off, const Axis& axis, const Scheme& scheme, AxisMemory& memory) {
    AxisRow row{2,          1, false, true, 0, axis.speed, axis.speed, 0, scheme.impulse(axis.max_force), &memory.drive,
                axis.around};
    if (!std::isfinite(axis.damping)) return row;
    const double rate = scheme.h * axis.stiffness + axis.damping;
    row.compliance = 1 / (scheme.act * rate);
    row.target = row.relaxed_target = (double(axis.damping) * axis.speed - axis.stiffness * off) / rate;
    return row;
}

inline bool is_driven(const Axis& axis) { return axis.max_force > 0 && (axis.stiffness > 0 || axis.damping > 0); }

// Calls visit(AxisRow) for each scalar row on row r of a block with axes. c: an angle with stops in its turn.
template <class Visit>
void for_each_axis_row(const RowBlock& block, int r, double c, const Scheme& scheme, Visit visit) {
    const Axis& axis = block.axis[r];
    AxisMemory& memory = block.memory[r];
    if (axis.mode == AxisMode::limited) {
        const double soft = block.stop_softness;
        if (std::isfinite(axis.lower)) visit(stop_row(1, c - axis.lower, axis, soft, scheme, &memory.lower));
        if (std::isfinite(axis.upper)) visit(stop_row(-1, axis.upper - c, axis, soft, scheme, &memory.upper));
    }
    if (axis.mode == AxisMode::locked) return;
    if (is_driven(axis))
        visit(drive_row(c - (block.angular(r) ? target_angle(axis, c) : axis.target), axis, scheme, memory));
    if (axis.friction > 0)
        visit(AxisRow{kRubbing, 1, false, false, 0, 0, 0, 0, scheme.impulse(axis.friction), &memory.friction, true});
}

}  // namespace taut
