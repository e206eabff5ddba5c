// What an instance asks of one row, whose coordinate is C [m or rad]. Without axes every row is locked.
//
//   locked    C = 0
//   limited   lower <= C <= upper, each stop pushes only
//   drive     force = -stiffness (C - target) - damping (dC/dt - speed), at most max_force either way
//   friction  at most this force against dC/dt
// Drive and friction also act within limits. Forces are N, or N m for angles, and all else accordingly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/describe.h"

namespace taut {

enum class AxisMode : uint8_t { locked, free, limited };

struct Axis {
    AxisMode mode = AxisMode::locked;
    bool around = false;                            // of a swing's direction: damping is of the torque, as friction is
    float lower = 0, upper = 0;                     // force of each stop [N], not negative
    float limit_compliance = 0, limit_damping = 0;  // of the stops: [m/N], [N s/m]; 0: rigid
    float stiffness = 0, damping = 0;               // of the drive: [N/m], [N s/m]; infinite damping holds the speed
    float target = 0, speed = 0;                    // of the drive: [m], [m/s]
    float max_force = 0;                            // of the drive; 0: there is none
    float friction = 0;                             // 0: there is none
};
template <class Visitor, Like<Axis> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [mode, around, lower, upper, limit_compliance, limit_damping, stiffness, damping, target, speed, max_force,
           friction] = of;
    TAUT_FIELDS(visitor, mode, around, lower, upper, limit_compliance, limit_damping, stiffness, damping, target, speed,
                max_force, friction);
}

// What a row of axes carries from substep to substep.
struct AxisMemory {
    float lower = 0, upper = 0;     // force of each stop [N], not negative
    float drive = 0, friction = 0;  // force along C [N]
    // Of an angle with stops: C as it was last read, see angle_between_stops() [rad]; infinite: not yet.
    float angle = std::numeric_limits<float>::infinity();
};
template <class Visitor, Like<AxisMemory> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [lower, upper, drive, friction, angle] = of;
    TAUT_FIELDS(visitor, lower, upper, drive, friction, angle);
}

// Angle nearest to another, in whole turns from c.
inline double nearest_turn(double c, double near) {
    constexpr double kTurn = 2 * 3.14159265358979323846;
    return c - kTurn * std::round((c - near) / kTurn);
}

// Angle that C is read nearest to, where there is a stop on either side: the middle between them, as long as a quarter
// of a turn beyond the stop on whose side C was last is nearer to it than to the other side. Stops may be a whole turn
// apart, and what is beyond the one is within the other then, but for where it came from. Infinite: C is read as it is.
inline double reading_middle(const Axis& axis, const AxisMemory& memory) {
    constexpr double kQuarter = 0.5 * 3.14159265358979323846;
    const double lower = axis.lower, upper = axis.upper, middle = 0.5 * (lower + upper), last = memory.angle;
    if (!std::isfinite(middle)) return last;  // of one stop turns are counted: it is as far away as they lead
    if (!std::isfinite(last)) return middle;
    return last > middle ? std::max(middle, upper - kQuarter) : std::min(middle, lower + kQuarter);
}

// Angle with stops, in the turn that it came to; at first as it is read, if that is between them or at one of them.
inline double angle_between_stops(const Axis& axis, const AxisMemory& memory, double c) {
    constexpr double kAtStop = 1e-3;  // what is laid at a stop may be read as a little beyond it [rad]
    const bool is_first = !std::isfinite(memory.angle);
    if (is_first && c >= axis.lower - kAtStop && c <= axis.upper + kAtStop) return c;
    const double near = reading_middle(axis, memory);
    if (std::isfinite(near)) return nearest_turn(c, near);
    return nearest_turn(c, c > axis.upper ? axis.upper : axis.lower);
}

// Target of an angle's drive: between two stops if they let it, else in the turn nearest to their middle; one that they
// do not bound is reached by the shorter way from c.
inline double target_angle(const Axis& axis, double c) {
    const double target = axis.target, middle = 0.5 * (static_cast<double>(axis.lower) + axis.upper);
    if (axis.mode != AxisMode::limited || !std::isfinite(middle)) return nearest_turn(target, c);
    return target >= axis.lower && target <= axis.upper ? target : nearest_turn(target, middle);
}

}  // namespace taut
