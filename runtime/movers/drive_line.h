// Engine, clutch, gears and an open differential, as far as the wheels feel them within a frame.
#pragma once

#include <taut/vehicle.h>

namespace taut {

struct DriveLine {
    double ratio = 0;       // turns of the engine for one of the wheels; negative backwards, 0: they turn freely
    double torque = 0;      // on all wheels together [N m]
    double drag = 0;        // most torque against their turning [N m]
    double inertia = 0;     // that turns with them [kg m^2]
    double most_speed = 0;  // of the driven wheels, beyond which there is no torque [rad/s]; 0: none
};

// Torque of the engine with full throttle at a speed [rad/s]; 0 beyond the last point.
double engine_torque(const taut_vehicle_def& def, double speed);
// Changes gear, gear time and engine speed of the vehicle. speed: of the driven wheels, weighted by their shares;
// rolling: what that would be if they did not slip, by which gears are chosen, as wheels that spin say nothing of it.
DriveLine drive_line(const taut_vehicle_def& def, const taut_vehicle_input& input, double speed, double rolling,
                     double seconds, taut_vehicle& vehicle);

}  // namespace taut
