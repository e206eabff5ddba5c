// A car in the laboratory's world, and what the tests measure of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "physics/lab.h"

namespace lab {

class Car {
public:
    static constexpr double kMass = 1200, kStiffness = 30000, kWheel = 0.35, kTravel = 0.3;
    static constexpr double kRest = kMass * kG / (4 * kStiffness);     // of each spring [m]
    static constexpr double kHeight = 0.2 + kTravel + kWheel - kRest;  // of its origin over the ground, at rest [m]

    // at: on the ground beneath its middle. heading about y, 0 along x.
    Car(const World& world, double hz, const Vec& at, const Quat& turn = {}, double speed = 0)
        : world_(world), seconds_(static_cast<float>(1 / hz)) {
        chassis = world.add({.shape = world.box({2, 0.25, 0.8}),
                             .position = at + turn.rotate({0, kHeight, 0}),
                             .rotation = turn,
                             .velocity = turn.rotate({speed, 0, 0}),
                             .mass = kMass});
        for (size_t i = 0; i < 4; ++i) {
            taut_wheel_def_init(&wheels[i]);
            const bool front = i < 2;
            wheels[i].position = {front ? 1.3f : -1.3f, -0.2f, i % 2 == 0 ? -0.75f : 0.75f};
            wheels[i].steering = front ? 0.6f : 0;
            wheels[i].drive = front ? 0.0f : 1.0f;
            wheels[i].handbrake = front ? 0.0f : 3000.0f;
            wheels[i].stiffness = static_cast<float>(kStiffness);
        }
        taut_vehicle_def_init(&def);
        def.wheels = wheels.data();
        def.wheel_count = 4;
        def.chassis = chassis;
        def.torque = torque.data();
        def.torque_count = static_cast<uint32_t>(torque.size());
        def.gears = gears.data();
        def.gear_count = static_cast<uint32_t>(gears.size());
        taut_vehicle_init(&vehicle);
        for (taut_wheel& wheel : vehicle.wheels) wheel.speed = static_cast<float>(speed / kWheel);
        input.gear = TAUT_VEHICLE_AUTOMATIC;
    }
    Car(const Car&) = delete;
    Car& operator=(const Car&) = delete;

    void drive() { ok(taut_vehicle_drive(world_.handle, &def, &input, seconds_, &vehicle)); }
    void step() {
        drive();
        world_.step();
    }
    void run(double time) {
        for (int i = steps(time); i > 0; --i) step();
    }
    int steps(double time) const { return static_cast<int>(std::lround(time / static_cast<double>(seconds_))); }
    BodyState now() const { return state(chassis); }
    Vec up() const { return now().rotation.rotate({0, 1, 0}); }
    Vec forward() const { return now().rotation.rotate({1, 0, 0}); }
    double speed() const { return norm(now().velocity); }

    std::array<taut_wheel_def, 4> wheels{};
    std::array<taut_engine_point, 3> torque{{{0, 200}, {300, 250}, {600, 180}}};
    std::array<float, 5> gears{13, 8, 5.5f, 4, 3.2f};
    taut_vehicle_def def{};
    taut_vehicle_input input{};
    taut_vehicle vehicle{};
    taut_body chassis{};

private:
    const World& world_;
    float seconds_;
};

}  // namespace lab
