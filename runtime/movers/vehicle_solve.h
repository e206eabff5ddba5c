// Forces of a vehicle's wheels, for the velocities at the end of a frame: springs, dampers, stops, tyres and brakes,
// row by row until they agree.
#pragma once

#include <taut/vehicle.h>

#include <array>

#include "movers/body_motion.h"
#include "movers/tyre.h"

namespace taut {

// A unit direction at a point of the chassis.
struct WheelRow {
    Vec3 direction = Vec3::Zero(), turn = Vec3::Zero();  // turn: arm x direction [m]
    Vec3 response = Vec3::Zero();                        // I^-1 turn
    double inv_mass = 0;                                 // [1/kg]
    double ground_inv_mass = 0;                          // of what is beneath, along it
    double ground_speed = 0;                             // [m/s]
    double impulse = 0;                                  // [N s]
};

struct WheelContact {
    const taut_wheel_def* def = nullptr;
    bool touches = false;
    Vec3 point = Vec3::Zero();
    double upright = 1;      // cosine between the ground's normal and the line of the suspension
    double compression = 0;  // [m]
    double spin = 0;         // [rad/s]
    double inertia = 0;      // of the wheel and what turns with it [kg m^2]
    double brake = 0;        // most torque against its turning [N m]
    double free_spin = 0;    // as the engine leaves it, without tyre and brake [rad/s]
    WheelRow load, along, across;
    Slip slip{};  // [m]
    Tyre tyre;
    TyreFrame frame;
};

class VehicleSolve {
public:
    VehicleSolve(const BodyMotion& chassis, double seconds) : chassis_(chassis), seconds_(seconds) {
        velocity = chassis.linear;
        spin = chassis.angular;
    }
    WheelRow row(const Vec3& point, const Vec3& direction, const BodyMotion& ground) const;
    double speed_of(const WheelRow& row) const { return velocity.dot(row.direction) + spin.dot(row.turn); }
    void run(WheelContact* first, WheelContact* last);

    Vec3 velocity, spin;                                          // of the chassis, as the frame will leave it
    Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero();  // of all wheels

private:
    void push(WheelRow& row, double change);
    void solve_load(WheelContact& wheel);
    void solve_tyre(WheelContact& wheel);
    void spin_up(WheelContact& wheel) const;
    double brake_of(const WheelContact& wheel) const;  // most that it does within the frame [N m s]

    const BodyMotion& chassis_;
    double seconds_;
};

}  // namespace taut
