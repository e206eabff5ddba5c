#include "movers/drive_line.h"

#include <algorithm>

namespace taut {
namespace {

// Another gear must have so much more force to be changed to.
constexpr double kWorthAChange = 1.05;
// Speed of the engine that is left to the next gear: at its last one it is held, and would never leave the gear.
constexpr double kReserve = 1.03;
// The same of a lower gear, which is changed to only where it will last.
constexpr double kDownReserve = 1.2;

double ratio_of(const taut_vehicle_def& def, int32_t gear) {
    if (gear > 0) return double(def.gears[gear - 1]);
    return gear < 0 ? -double(def.reverse_gear) : 0.0;
}

// At the wheels with full throttle, with a slipping clutch below the idle speed.
double force_of(const taut_vehicle_def& def, int32_t gear, double speed, double reserve) {
    const double ratio = ratio_of(def, gear);
    return ratio * engine_torque(def, std::max(reserve * ratio * speed, double(def.idle_speed)));
}

int32_t best_gear(const taut_vehicle_def& def, int32_t now, double speed) {
    int32_t best = now > 0 && now <= int32_t(def.gear_count) ? now : 1;
    double most = force_of(def, best, speed, kReserve);
    double needed = now > 0 ? kWorthAChange : 1.0;
    for (int32_t gear = 1; gear <= int32_t(def.gear_count); ++gear) {
        const double force = force_of(def, gear, speed, gear < now ? kDownReserve : kReserve);
        if (gear == best || !(force > needed * most)) continue;
        best = gear;
        most = force;
        needed = 1;
    }
    // Beyond what all of them reach.
    return most > 0 || speed <= 0 ? best : int32_t(def.gear_count);
}

}  // namespace

double engine_torque(const taut_vehicle_def& def, double speed) {
    const uint32_t count = def.torque_count;
    if (count == 0 || speed > double(def.torque[count - 1].speed)) return 0;
    if (speed <= double(def.torque[0].speed)) return def.torque[0].torque;
    uint32_t i = 1;
    while (i + 1 < count && speed > double(def.torque[i].speed)) ++i;
    const taut_engine_point &a = def.torque[i - 1], &b = def.torque[i];
    const double t = (speed - double(a.speed)) / (double(b.speed) - double(a.speed));
    return double(a.torque) + t * (double(b.torque) - double(a.torque));
}

DriveLine drive_line(const taut_vehicle_def& def, const taut_vehicle_input& input, double speed, double rolling,
                     double seconds, taut_vehicle& vehicle) {
    int32_t gear = input.gear;
    if (gear == TAUT_VEHICLE_AUTOMATIC) gear = def.gear_count > 0 ? best_gear(def, vehicle.gear, rolling) : 0;
    if (gear != vehicle.gear && gear != 0) vehicle.shifting = def.shift_time;
    vehicle.gear = gear;
    const double idle = def.idle_speed, throttle = input.throttle;
    const double top = def.torque_count > 0 ? double(def.torque[def.torque_count - 1].speed) : 0.0;
    const bool shifts = vehicle.shifting > 0;
    vehicle.shifting = static_cast<float>(std::max(double(vehicle.shifting) - seconds, 0.0));

    DriveLine out;
    if (gear == 0 || shifts || def.torque_count == 0) {
        vehicle.engine_speed =
            static_cast<float>(shifts ? double(vehicle.engine_speed) : idle + throttle * std::max(top - idle, 0.0));
        return out;
    }
    out.ratio = ratio_of(def, gear);
    const double size = std::abs(out.ratio), turning = out.ratio * speed;
    const bool grips = turning >= idle;
    const double engine = std::max(turning, idle);
    vehicle.engine_speed = static_cast<float>(engine);
    out.torque = throttle * engine_torque(def, engine) * out.ratio;
    if (grips) {
        out.drag = (1 - throttle) * double(def.engine_brake) * size;
        out.inertia = double(def.engine_inertia) * size * size;
    }
    if (size > 0) out.most_speed = top / size;
    return out;
}

}  // namespace taut
