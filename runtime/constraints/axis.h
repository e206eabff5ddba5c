// What an instance asks of one row, whose coordinate is C [m or rad]. Without axes every row is locked.
//
//   locked    C = 0
//   limited   lower <= C <= upper, each stop pushes only
//   drive     force = -stiffness (C - target) - damping (dC/dt - speed), at most max_force either way
//   friction  at most this force against dC/dt
// Drive and friction also act within limits. Forces are N, or N m for angles, and all else accordingly.
#pragma once

#include <cstdint>

namespace taut {

enum class AxisMode : uint8_t { locked, free, limited };

struct Axis {
    AxisMode mode = AxisMode::locked;
    float lower = 0, upper = 0;                     // force of each stop [N], not negative
    float limit_compliance = 0, limit_damping = 0;  // of the stops: [m/N], [N s/m]; 0: rigid
    float stiffness = 0, damping = 0;               // of the drive: [N/m], [N s/m]; infinite damping holds the speed
    float target = 0, speed = 0;                    // of the drive: [m], [m/s]
    float max_force = 0;                            // of the drive; 0: there is none
    float friction = 0;                             // 0: there is none
};

// What a row of axes carries from substep to substep.
struct AxisMemory {
    float lower = 0, upper = 0;     // force of each stop [N], not negative
    float drive = 0, friction = 0;  // force along C [N]
};

}  // namespace taut
