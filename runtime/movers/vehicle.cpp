// Vehicles: a frame of one, in the order of its parts.
#include <taut/vehicle.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <taut/sleep.h>
#include <taut/world.h>

#include "api/sized.h"
#include "movers/call_parts.h"
#include "movers/drive_line.h"
#include "movers/vehicle_solve.h"

using namespace taut;

namespace {

constexpr Range kWheelRadius{0.01, 100};      // [m]
constexpr Range kWheelInertia{0, 1e9, true};  // [kg m^2]
constexpr Range kWheelTravel{0.01, 100};      // [m]
constexpr Range kWheelForce{0, 1e12};         // [N/m, N s/m]
constexpr Range kWheelFriction{0, 100};
constexpr Range kWheelPeak{0.01, 1};
constexpr Range kWheelRelaxation{0.01, 10};  // [m]
constexpr Range kWheelSteering{-1.5, 1.5};   // [rad]
constexpr Range kWheelTorque{0, 1e9};        // [N m]
constexpr Range kWheelShare{0, 1e3};
constexpr Range kWheelSpeed{-1e5, 1e5};    // [rad/s]
constexpr Range kWheelSlip{-100, 100};     // [m]
constexpr Range kEngineSpeed{0, 1e5};      // [rad/s]
constexpr Range kEngineTorque{-1e9, 1e9};  // [N m]
constexpr Range kGearRatio{0, 1e3, true};
constexpr Range kReverseRatio{0, 1e3};
constexpr Range kEngineInertia{0, 1e6};      // [kg m^2]
constexpr Range kShiftTime{0, 10};           // [s]
constexpr Range kQuietTime{0, 1e4};          // [s]
constexpr Range kDragArea{0, 1e6};           // [m^2]
constexpr Range kVehicleSeconds{1e-4, 0.1};  // [s]
constexpr uint32_t kMostTorquePoints = 64;

// Less upright ground, by the cosine, does not carry; less than the second carries as much as that.
constexpr double kLeastUpright = 0.05, kCarries = 0.3;
constexpr double kTwoPi = 6.283185307179586;

// ---------------------------------------------------------------- check

bool check_wheel_def(Check& check, const taut_wheel_def& def) {
    check.vector("position", def.position, kShapeCoordinate)
        .number("radius", def.radius, kWheelRadius)
        .number("inertia", def.inertia, kWheelInertia)
        .number("travel", def.travel, kWheelTravel)
        .number("stiffness", def.stiffness, kWheelForce)
        .number("compression_damping", def.compression_damping, kWheelForce)
        .number("extension_damping", def.extension_damping, kWheelForce)
        .number("friction", def.friction, kWheelFriction)
        .number("sliding_friction", def.sliding_friction, Range{0, std::max(double(def.friction), 0.0)})
        .number("peak_slip", def.peak_slip, kWheelPeak)
        .number("peak_slip_across", def.peak_slip_across, kWheelPeak)
        .number("relaxation", def.relaxation, kWheelRelaxation)
        .number("rolling_resistance", def.rolling_resistance, kUnitInterval)
        .number("steering", def.steering, kWheelSteering)
        .number("brake", def.brake, kWheelTorque)
        .number("handbrake", def.handbrake, kWheelTorque)
        .number("drive", def.drive, kWheelShare);
    return static_cast<bool>(check);
}

bool check_vehicle_def(Check& check, const taut_vehicle_def& def) {
    check.within("def.")
        .count("wheel_count", def.wheel_count, 1, TAUT_VEHICLE_MAX_WHEELS)
        .pointer("wheels", def.wheels)
        .vector("forward", def.forward, kDirection)
        .vector("up", def.up, kDirection)
        .count("torque_count", def.torque_count, 0, kMostTorquePoints)
        .count("gear_count", def.gear_count, 0, TAUT_VEHICLE_MAX_GEARS)
        .number("reverse_gear", def.reverse_gear, kReverseRatio)
        .number("idle_speed", def.idle_speed, kEngineSpeed)
        .number("engine_inertia", def.engine_inertia, kEngineInertia)
        .number("engine_brake", def.engine_brake, kWheelTorque)
        .number("shift_time", def.shift_time, kShiftTime)
        .number("drag_area", def.drag_area, kDragArea);
    if (def.torque_count > 0) check.pointer("torque", def.torque);
    if (def.gear_count > 0) check.pointer("gears", def.gears);
    if (!check) return false;
    const Vec3 up = to_vec(def.up).stableNormalized(), forward = to_vec(def.forward).stableNormalized();
    if (!check.require(up.cross(forward).norm() > 1e-3, "forward and up are 0 or parallel")) return false;
    char scope[32];
    for (uint32_t i = 0; i < def.wheel_count && check; ++i) {
        std::snprintf(scope, sizeof scope, "def.wheels[%u].", i);
        check_wheel_def(check.within(scope), def.wheels[i]);
    }
    for (uint32_t i = 0; i < def.torque_count && check; ++i) {
        std::snprintf(scope, sizeof scope, "def.torque[%u].", i);
        check.within(scope)
            .number("speed", def.torque[i].speed, kEngineSpeed)
            .number("torque", def.torque[i].torque, kEngineTorque)
            .require(i == 0 || def.torque[i].speed > def.torque[i - 1].speed, "speed is not above the one before");
    }
    for (uint32_t i = 0; i < def.gear_count && check; ++i) {
        std::snprintf(scope, sizeof scope, "def.gears[%u]", i);
        check.within(scope).number("", def.gears[i], kGearRatio);
    }
    check.within("");
    return static_cast<bool>(check);
}

bool check_vehicle_input(Check& check, const taut_vehicle_def& def, const taut_vehicle_input& input) {
    check.within("input.")
        .number("throttle", input.throttle, kUnitInterval)
        .number("brake", input.brake, kUnitInterval)
        .number("handbrake", input.handbrake, kUnitInterval)
        .number("steering", input.steering, Range{-1, 1})
        .zero("reserved", input.reserved)
        .require(input.gear == TAUT_VEHICLE_AUTOMATIC ||
                     (input.gear >= TAUT_VEHICLE_REVERSE && input.gear <= int32_t(def.gear_count)),
                 "gear is none of the def's")
        .within("");
    return static_cast<bool>(check);
}

bool check_vehicle(Check& check, const taut_vehicle_def& def, const taut_vehicle& vehicle) {
    check.within("vehicle.")
        .number("engine_speed", vehicle.engine_speed, kEngineSpeed)
        .number("shifting", vehicle.shifting, kShiftTime)
        .number("quiet", vehicle.quiet, kQuietTime);
    char scope[32];
    for (uint32_t i = 0; i < def.wheel_count && check; ++i) {
        std::snprintf(scope, sizeof scope, "vehicle.wheels[%u].", i);
        check.within(scope)
            .number("speed", vehicle.wheels[i].speed, kWheelSpeed)
            .number("turn", vehicle.wheels[i].turn, Range{-4, 4})
            .number("slip[0]", vehicle.wheels[i].slip[0], kWheelSlip)
            .number("slip[1]", vehicle.wheels[i].slip[1], kWheelSlip)
            .boolean("on_ground", vehicle.wheels[i].on_ground);
    }
    check.within("");
    return static_cast<bool>(check);
}

// ---------------------------------------------------------------- a frame

class Drive {
public:
    Drive(taut_world world, const taut_vehicle_def& def, const taut_query_filter& filter,
          const taut_vehicle_input& input, double seconds, const taut_vehicle& vehicle)
        : world_(world), def_(def), filter_(filter), input_(input), seconds_(seconds), out_(vehicle) {
        std::copy_n(filter.ignored_bodies, filter.ignored_body_count, ignored_.begin());
        ignored_[filter_.ignored_body_count++] = def.chassis;
        filter_.ignored_bodies = ignored_.data();
    }

    taut_result run();
    const taut_vehicle& out() const { return out_; }

private:
    bool ok(taut_result result) {
        if (result_ == TAUT_OK) result_ = result;
        return result_ == TAUT_OK;
    }
    bool sleeps();
    void pose_wheel(uint32_t i);
    bool find_ground(uint32_t i, taut_query_hit& hit);
    void touch(uint32_t i, const taut_query_hit& hit);
    void turn_wheels();
    Vec3 air();
    void publish_wheel(uint32_t i);
    bool apply(const Vec3& drag);

    taut_world world_;
    const taut_vehicle_def& def_;
    taut_query_filter filter_;
    const taut_vehicle_input& input_;
    double seconds_;
    taut_vehicle out_;
    taut_world_def about_{};
    BodyMotion chassis_;
    Vec3 up_, forward_;  // world axes
    std::array<taut_body, TAUT_QUERY_MAX_IGNORED> ignored_{};
    std::array<WheelContact, TAUT_VEHICLE_MAX_WHEELS> wheel_{};
    std::array<Vec3, TAUT_VEHICLE_MAX_WHEELS> ahead_;  // of each wheel as steered
    taut_result result_ = TAUT_OK;
};

// Where it stands still on what is static, held by its brakes, it is left to sleep: no forces, no motion.
bool Drive::sleeps() {
    const bool held = input_.throttle == 0 && (input_.brake > 0 || input_.handbrake > 0);
    const auto stands = [&](uint32_t i) {
        taut_body_kind kind = TAUT_BODY_DYNAMIC;
        const taut_wheel& wheel = out_.wheels[i];
        return !wheel.on_ground ||
               (taut_body_is_valid(wheel.ground_body) && taut_body_get_kind(wheel.ground_body, &kind) == TAUT_OK &&
                kind == TAUT_BODY_STATIC);
    };
    bool quiet = about_.sleeping && held;
    double reach = 0;
    for (uint32_t i = 0; i < def_.wheel_count && quiet; ++i) {
        quiet = stands(i);
        reach = std::max(reach, to_vec(def_.wheels[i].position).norm());
    }
    const double fastest = chassis_.linear.norm() + reach * chassis_.angular.norm();
    if (!quiet || fastest > double(about_.sleep_speed)) {
        out_.quiet = 0;
        return false;
    }
    out_.quiet = static_cast<float>(std::min(double(out_.quiet) + seconds_, kQuietTime.hi));
    uint32_t awake = 1, may = 0;
    if (!ok(taut_body_get_awake(def_.chassis, &awake)) || !ok(taut_body_get_can_sleep(def_.chassis, &may)))
        return false;
    if (awake && may && out_.quiet >= about_.sleep_time) {
        ok(taut_body_set_awake(def_.chassis, 0));
        return true;
    }
    return !awake;
}

void Drive::pose_wheel(uint32_t i) {
    const taut_wheel_def& def = def_.wheels[i];
    taut_wheel& out = out_.wheels[i];
    const double angle = double(input_.steering) * double(def.steering);
    ahead_[i] = rotation_from_vector(angle * up_) * forward_;
    out.steering = static_cast<float>(angle);
}

// From above, as the ground may be higher than the wheel pressed in.
bool Drive::find_ground(uint32_t i, taut_query_hit& hit) {
    const taut_wheel_def& def = def_.wheels[i];
    const Vec3 centre = chassis_.origin + chassis_.rotation * to_vec(def.position);
    const double head = def.radius;
    const Vec3 from = centre + head * up_;
    double reach = head + double(def.travel);
    if (def.shape.bits != 0) {
        const Quat turn = turn_between(Vec3::UnitY(), ahead_[i].cross(up_));
        const taut_shape_cast cast = {def.shape, {to_pos(from), to_quat(turn), {0, 0}}, to_vec3(-reach * up_), 0};
        if (!ok(taut_world_cast_shape(world_, &cast, &filter_, &hit))) return false;
    } else {
        reach += double(def.radius);
        const taut_ray ray = {to_pos(from), to_vec3(-reach * up_), 0};
        if (!ok(taut_world_cast_ray(world_, &ray, &filter_, &hit))) return false;
    }
    wheel_[i].compression = (1 - double(hit.fraction)) * reach;
    return hit.body.bits != 0 && to_vec(hit.normal).dot(up_) > kLeastUpright &&
           to_vec(hit.point).norm() <= kPosition.hi;
}

void Drive::touch(uint32_t i, const taut_query_hit& hit) {
    const taut_wheel_def& def = def_.wheels[i];
    WheelContact& wheel = wheel_[i];
    taut_collider_def ground_def;
    taut_collider_def_init(&ground_def);
    BodyMotion ground;
    if (!ok(taut_collider_get_def(hit.collider, &ground_def)) || !ok(read_motion(hit.body, ground))) return;
    wheel.touches = true;
    wheel.point = to_vec(hit.point);
    const Vec3 normal = to_vec(hit.normal);
    wheel.upright = std::max(normal.dot(up_), kCarries);
    const Vec3 along = normal.cross(ahead_[i].cross(up_)).normalized();
    const Vec3 across = along.cross(normal);
    const VehicleSolve rows(chassis_, seconds_);
    wheel.load = rows.row(wheel.point, normal, ground);
    wheel.along = rows.row(wheel.point, along, ground);
    wheel.across = rows.row(wheel.point, across, ground);

    const double rough = ground_def.material.friction;
    wheel.tyre = {std::sqrt(double(def.friction) * rough),
                  std::sqrt(double(def.sliding_friction) * rough),
                  {double(def.peak_slip), double(def.peak_slip_across)},
                  double(def.relaxation)};
    const Slip goes = {rows.speed_of(wheel.along) - wheel.along.ground_speed,
                       rows.speed_of(wheel.across) - wheel.across.ground_speed};
    const double rolls = wheel.spin * double(def.radius);
    const double going = std::max(std::sqrt(goes[0] * goes[0] + goes[1] * goes[1]), std::abs(rolls));
    wheel.frame = TyreFrame(wheel.tyre, seconds_, going, to_vec(about_.gravity).norm());
    // As the step bent it, with the velocities that it came to.
    const taut_wheel& before = out_.wheels[i];
    if (before.on_ground)
        wheel.slip = {wheel.frame.bent(double(before.slip[0]), goes[0] - rolls),
                      wheel.frame.bent(double(before.slip[1]), goes[1])};
}

// The engine's torque, what brakes may do, and what turns with the wheels.
void Drive::turn_wheels() {
    double shares = 0, speed = 0, radius = 0;
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        shares += double(def_.wheels[i].drive);
        speed += double(def_.wheels[i].drive) * wheel_[i].spin;
        radius += double(def_.wheels[i].drive) * double(def_.wheels[i].radius);
    }
    if (shares > 0) speed /= shares;
    const double rolling = shares > 0 ? double(out_.forward_speed) * shares / radius : 0.0;
    DriveLine line = drive_line(def_, input_, speed, rolling, seconds_, out_);
    double gain = 0;
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        const taut_wheel_def& def = def_.wheels[i];
        WheelContact& wheel = wheel_[i];
        const double share = shares > 0 ? double(def.drive) / shares : 0.0;
        wheel.inertia = double(def.inertia) + share * line.inertia;
        wheel.brake = double(input_.brake) * double(def.brake) + double(input_.handbrake) * double(def.handbrake) +
                      share * line.drag;
        gain += share * share * seconds_ * line.torque / wheel.inertia;
    }
    // Not beyond the engine's last speed, were the wheels in the air.
    const double sign = gain < 0 ? -1 : 1;
    const double room = std::max(line.most_speed - sign * speed, 0.0);
    if (line.most_speed > 0 && sign * gain > room) line.torque *= room / (sign * gain);
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        const double share = shares > 0 ? double(def_.wheels[i].drive) / shares : 0.0;
        wheel_[i].free_spin = wheel_[i].spin + share * seconds_ * line.torque / wheel_[i].inertia;
    }
}

// Drag [N].
Vec3 Drive::air() {
    const Vec3 wind = chassis_.linear - to_vec(about_.wind);
    return -0.5 * double(about_.air_density) * double(def_.drag_area) * wind.norm() * wind;
}

void Drive::publish_wheel(uint32_t i) {
    const taut_wheel_def& def = def_.wheels[i];
    const WheelContact& wheel = wheel_[i];
    taut_wheel& out = out_.wheels[i];
    const double spin = std::clamp(wheel.spin, kWheelSpeed.lo, kWheelSpeed.hi);
    const double turn = double(out.turn) + seconds_ * spin;
    out.speed = static_cast<float>(spin);
    out.turn = static_cast<float>(turn - kTwoPi * std::floor(turn / kTwoPi + 0.5));
    out.slip[0] = static_cast<float>(std::clamp(wheel.slip[0], kWheelSlip.lo, kWheelSlip.hi));
    out.slip[1] = static_cast<float>(std::clamp(wheel.slip[1], kWheelSlip.lo, kWheelSlip.hi));
    out.on_ground = wheel.touches ? 1 : 0;
    const double compression = wheel.touches ? wheel.compression : 0.0;
    out.compression = to_float(compression);
    out.load = to_float(wheel.load.impulse / seconds_);
    const Vec3 impulse = wheel.load.impulse * wheel.load.direction + wheel.along.impulse * wheel.along.direction +
                         wheel.across.impulse * wheel.across.direction;
    out.force = to_vec3(impulse / seconds_);
    out.ground_normal = to_vec3(wheel.load.direction);
    out.ground_point = to_pos(wheel.point);
    const Vec3 pressed = chassis_.origin + chassis_.rotation * to_vec(def.position);
    const double hangs = std::max(double(def.travel) - compression, 0.0);
    Mat3 axes;
    axes << ahead_[i], up_, ahead_[i].cross(up_);
    out.pose = {to_pos(pressed - hangs * up_), to_quat(Quat(axes).normalized()), {0, 0}};
    if (!wheel.touches) out.ground_body = {}, out.ground_collider = {};
}

bool Drive::apply(const Vec3& drag) {
    Vec3 force = drag, torque = Vec3::Zero();
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        const taut_wheel& wheel = out_.wheels[i];
        if (!wheel.on_ground) continue;
        const Vec3 at_wheel = to_vec(wheel.force);
        force += at_wheel;
        torque += (wheel_[i].point - chassis_.centre).cross(at_wheel);
    }
    if (!ok(taut_body_apply_force(def_.chassis, to_vec3(force), to_vec3(torque)))) return false;
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        const taut_wheel& wheel = out_.wheels[i];
        if (wheel.on_ground && wheel_[i].load.ground_inv_mass > 0)
            ok(taut_body_apply_force_at(wheel.ground_body, to_vec3(-to_vec(wheel.force)), wheel.ground_point));
    }
    return result_ == TAUT_OK;
}

taut_result Drive::run() {
    taut_world_def_init(&about_);
    if (!ok(taut_world_get_def(world_, &about_)) || !ok(read_motion(def_.chassis, chassis_))) return result_;
    const Vec3 up = to_vec(def_.up).stableNormalized();
    const Vec3 own = to_vec(def_.forward).stableNormalized();
    up_ = chassis_.rotation * up;
    forward_ = chassis_.rotation * (own - own.dot(up) * up).normalized();
    out_.forward_speed = to_float(chassis_.linear.dot(forward_));
    for (uint32_t i = 0; i < def_.wheel_count; ++i) pose_wheel(i);
    if (sleeps() || result_ != TAUT_OK) return result_;
    for (uint32_t i = 0; i < def_.wheel_count; ++i) {
        wheel_[i].def = &def_.wheels[i];
        wheel_[i].spin = out_.wheels[i].speed;
        taut_query_hit hit{};
        if (find_ground(i, hit)) {
            touch(i, hit);
            out_.wheels[i].ground_body = hit.body;
            out_.wheels[i].ground_collider = hit.collider;
        }
        if (result_ != TAUT_OK) return result_;
    }
    turn_wheels();
    VehicleSolve solve(chassis_, seconds_);
    const Vec3 drag = air();
    solve.velocity += seconds_ * (to_vec(about_.gravity) + chassis_.inv_mass * drag).cwiseProduct(chassis_.unlocked);
    solve.run(wheel_.data(), wheel_.data() + def_.wheel_count);
    for (uint32_t i = 0; i < def_.wheel_count; ++i) publish_wheel(i);
    apply(drag);
    return result_;
}

}  // namespace

void taut_vehicle_input_init(taut_vehicle_input* input) {
    if (!input) return;
    *input = {};
    input->gear = TAUT_VEHICLE_AUTOMATIC;
}

void taut_wheel_def_init(taut_wheel_def* def) {
    if (!def) return;
    *def = {};
    def->radius = 0.35f;
    def->inertia = 1.2f;
    def->travel = 0.3f;
    def->stiffness = 30000;
    def->compression_damping = def->extension_damping = 3000;
    def->friction = 1;
    def->sliding_friction = 0.8f;
    def->peak_slip = 0.12f;
    def->peak_slip_across = 0.14f;
    def->relaxation = 0.3f;
    def->rolling_resistance = 0.012f;
    def->brake = 3000;
}

void taut_vehicle_def_init_sized(taut_vehicle_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_vehicle_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.forward = {1, 0, 0};
        own.up = {0, 1, 0};
        own.reverse_gear = 12;
        own.idle_speed = 90;
        own.engine_inertia = 0.2f;
        own.engine_brake = 40;
        own.shift_time = 0.2f;
        own.drag_area = 0.7f;
    });
}

void taut_vehicle_init_sized(taut_vehicle* vehicle, uint32_t size) {
    give_defaults(vehicle, size, [](taut_vehicle& own) {
        own = {};
        own.struct_size = sizeof own;
        for (taut_wheel& wheel : own.wheels) wheel.pose.rotation = {0, 0, 0, 1};
    });
}

taut_result taut_vehicle_drive(taut_world world, const taut_vehicle_def* given, const taut_vehicle_input* input,
                               float seconds, taut_vehicle* vehicle) {
    Check check(__func__);
    return contain(check.call(), [&] {
        taut_vehicle_def def;
        taut_vehicle state;
        taut_query_filter filter;
        if (!take_def(check, given, taut_vehicle_def_init, def)) return check.result();
        if (!check.pointer("input", input).pointer("vehicle", vehicle) ||
            !take_def(check.within("vehicle."), vehicle, taut_vehicle_init, state, ""))
            return check.result();
        check.within("").number("seconds", seconds, kVehicleSeconds);
        if (!check_vehicle_def(check, def) || !check_vehicle_input(check, def, *input) ||
            !check_vehicle(check, def, state) ||
            !take_filter(check, def.filter, TAUT_QUERY_MAX_IGNORED - 1, TAUT_QUERY_MAX_IGNORED, filter))
            return check.result();
        taut_body_kind kind = TAUT_BODY_STATIC;
        const taut_result found = taut_body_get_kind(def.chassis, &kind);
        if (found != TAUT_OK) return refuse_as(check, found);
        if (!check.require(kind == TAUT_BODY_DYNAMIC, "def.chassis is not dynamic")) return check.result();
        Drive drive(world, def, filter, *input, seconds, state);
        const taut_result done = drive.run();
        if (done != TAUT_OK) return refuse_as(check, done);
        give_def(drive.out(), vehicle);
        return TAUT_OK;
    });
}
