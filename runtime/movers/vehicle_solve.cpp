#include "movers/vehicle_solve.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr int kRounds = 60;         // through all rows: what is left is far below what frames are off by
constexpr double kStopShare = 0.2;  // of what is beyond the end of its travel, undone in a frame
constexpr double kStopSpeed = 3;    // and at most at this speed [m/s]

}  // namespace

WheelRow VehicleSolve::row(const Vec3& point, const Vec3& direction, const BodyMotion& ground) const {
    WheelRow out;
    out.direction = direction;
    out.turn = (point - chassis_.centre).cross(direction);
    out.response = chassis_.inv_inertia * out.turn;
    out.inv_mass = chassis_.linear_inv_mass(direction) + out.turn.dot(out.response);
    if (ground.is_pushed()) out.ground_inv_mass = ground.inv_mass_of(point, direction);
    out.ground_speed = ground.velocity_of(point).dot(direction);
    return out;
}

void VehicleSolve::push(WheelRow& row, double change) {
    row.impulse += change;
    velocity += (change * chassis_.inv_mass * row.direction).cwiseProduct(chassis_.unlocked);
    spin += change * row.response;
    impulse += change * row.direction;
    angular_impulse += change * row.turn;
}

// Along the strut x' = -u / s, with u the speed at which chassis and ground part along the normal and s the cosine
// between the two, and N s = k (x + h x') + c x', for x' as P = N h leaves it: u + W P.
void VehicleSolve::solve_load(WheelContact& wheel) {
    const taut_wheel_def& def = *wheel.def;
    WheelRow& row = wheel.load;
    const double s = wheel.upright, h = seconds_, k = def.stiffness, x = wheel.compression;
    // What dynamic ground does is felt as far as the force for it moves its mass less than that within the frame.
    const auto feel = [&](double damping) {
        const double gain = (damping + k * h) * h * row.ground_inv_mass;
        return speed_of(row) - row.ground_speed / std::max(gain, 1.0) - row.inv_mass * row.impulse;
    };
    const auto pressed = [&](double damping, double& rate) {
        const double u = feel(damping), stiff = (k * h + damping) / (s * s);
        const double wanted = std::max((k * x / s - stiff * u) / (1 / h + stiff * row.inv_mass), 0.0);
        rate = -(u + row.inv_mass * wanted) / s;
        return wanted;
    };
    double rate = 0;
    double wanted = pressed(def.compression_damping, rate);
    if (rate < 0) wanted = pressed(def.extension_damping, rate);
    const double room = double(def.travel) - x;
    const double most = room >= 0 ? room / h : std::max(kStopShare * room / h, -kStopSpeed);
    if (rate > most) wanted = (-s * most - (-s * rate - row.inv_mass * wanted)) / row.inv_mass;
    push(row, std::max(wanted, 0.0) - row.impulse);
}

// As the brake leaves it, with the along impulse that the wheel has: stopped, if that asks for no more than it can.
void VehicleSolve::spin_up(WheelContact& wheel) const {
    const double free = wheel.free_spin - wheel.along.impulse * double(wheel.def->radius) / wheel.inertia;
    const double most = brake_of(wheel);
    wheel.spin = free + std::clamp(-free * wheel.inertia, -most, most) / wheel.inertia;
}

double VehicleSolve::brake_of(const WheelContact& wheel) const {
    const double load = wheel.touches ? wheel.load.impulse : 0.0;
    return wheel.brake * seconds_ + double(wheel.def->rolling_resistance) * load * double(wheel.def->radius);
}

// F = -k a (b z + lag v), where the row's own impulse changes v by inv_mass: v is that without it.
void VehicleSolve::solve_tyre(WheelContact& wheel) {
    const double r = wheel.def->radius, load = wheel.load.impulse / seconds_;
    const auto going = [&](const WheelRow& row) { return speed_of(row) - row.ground_speed; };
    const Slip bent = {wheel.frame.bent(wheel.slip[0], going(wheel.along) - wheel.spin * r),
                       wheel.frame.bent(wheel.slip[1], going(wheel.across))};
    const auto wanted = [&](size_t axis, double v, double inv_mass) {
        const double stiff = load * wheel.tyre.stiffness(bent, axis) * wheel.frame.keep, lag = wheel.frame.lag[axis];
        return -stiff * (wheel.frame.fade[axis] * wheel.slip[axis] + lag * v) / (1 / seconds_ + stiff * lag * inv_mass);
    };
    // Tyre and brake of a light wheel are stiff against each other, and solved as one: the wheel stands, or its brake
    // does all that it can.
    WheelRow& along = wheel.along;
    const double own = along.inv_mass + along.ground_inv_mass;
    const double v = going(along) - own * along.impulse;
    double forwards = wanted(0, v, own);
    const double needed = forwards * r - wheel.free_spin * wheel.inertia, most = brake_of(wheel);
    if (std::abs(needed) > most) {
        const double braked = wheel.free_spin + std::clamp(needed, -most, most) / wheel.inertia;
        forwards = wanted(0, v - braked * r, own + r * r / wheel.inertia);
    }
    push(along, forwards - along.impulse);
    WheelRow& across = wheel.across;
    const double sideways = across.inv_mass + across.ground_inv_mass;
    push(across, wanted(1, going(across) - sideways * across.impulse, sideways) - across.impulse);
    const double size = std::sqrt(along.impulse * along.impulse + across.impulse * across.impulse);
    const double limit = wheel.tyre.peak * wheel.load.impulse;
    if (size > limit) {
        push(along, (limit / size - 1) * along.impulse);
        push(across, (limit / size - 1) * across.impulse);
    }
    spin_up(wheel);
}

void VehicleSolve::run(WheelContact* first, WheelContact* last) {
    for (WheelContact* wheel = first; wheel != last; ++wheel) spin_up(*wheel);
    for (int round = 0; round < kRounds; ++round) {
        for (WheelContact* wheel = first; wheel != last; ++wheel) {
            if (!wheel->touches) continue;
            solve_load(*wheel);
            solve_tyre(*wheel);
        }
    }
}

}  // namespace taut
