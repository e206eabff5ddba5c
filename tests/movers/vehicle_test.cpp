// Vehicles beside what mechanics says of springs, friction and power, and over hills, bumps and bridges, at 30 to 240
// Hz.
#include "movers/vehicle_lab.h"

#include "movers/character_lab.h"

namespace lab {
namespace {

class Vehicle : public testing::TestWithParam<double> {
protected:
    double hz() const { return GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(At, Vehicle, testing::Values(30.0, 60.0, 120.0, 240.0),
                         [](const auto& rate) { return std::to_string(static_cast<int>(rate.param)) + "Hz"; });

// 2 r / (1 + r^2) of what sliding leaves.
double friction_at(double peak, double sliding, double slip_over_peak) {
    return sliding + (peak - sliding) * 2 * slip_over_peak / (1 + slip_over_peak * slip_over_peak);
}

// ---------------------------------------------------------------- at rest

TEST_P(Vehicle, RestsOnItsSpringsAsItsWeightAsks) {
    const World world(at_rate(hz()));
    world.add_ground(1);
    Car car(world, hz(), {0, 0.2, 0});
    car.input.brake = 1;
    car.run(4);
    const Vec start = car.now().position;
    car.run(6);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(static_cast<double>(car.vehicle.wheels[i].compression), Car::kRest, 1e-4);
        EXPECT_NEAR(static_cast<double>(car.vehicle.wheels[i].load), Car::kMass * kG / 4, 2);
    }
    EXPECT_LT(norm(car.now().position - start), 1e-5);
    EXPECT_LT(car.speed(), 1e-4);
}

TEST_P(Vehicle, StandsOnASlopeWithItsBrakesOn) {
    for (const double degrees : {10.0, 30.0}) {
        for (const bool handbrake : {false, true}) {
            if (handbrake && degrees > 15) continue;  // two wheels do not hold there
            SCOPED_TRACE(degrees);
            const World world(at_rate(hz()));
            const Quat turn = Quat::turn({0, 0, 1}, degrees * kPi / 180);
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(), .rotation = turn, .friction = 1});
            Car car(world, hz(), {0, 0, 0}, turn);
            (handbrake ? car.input.handbrake : car.input.brake) = 1;
            car.input.gear = 0;
            car.run(4);
            const Vec start = car.now().position;
            car.run(20);
            EXPECT_LT(norm(car.now().position - start), 1e-4);
        }
    }
}

TEST_P(Vehicle, StopsAtTheEndOfItsTravelWithoutAKick) {
    const World world(at_rate(hz()));
    world.add_ground(1);
    Car car(world, hz(), {0, 2, 0});
    car.input.brake = 1;
    double highest = 0;
    bool landed = false;
    for (int i = 0; i < car.steps(4); ++i) {
        car.step();
        landed = landed || car.now().position.y < Car::kHeight;
        if (landed) highest = std::max(highest, car.now().position.y);
    }
    EXPECT_LT(highest, Car::kHeight + 0.5);
    EXPECT_NEAR(car.now().position.y, Car::kHeight, 2e-3);
}

// ---------------------------------------------------------------- friction

TEST_P(Vehicle, BrakesAsFrictionAllows) {
    const World world(at_rate(hz()));
    world.add_ground(1);
    Car car(world, hz(), {0, 0, 0}, {}, 20);
    car.def.drag_area = 0;
    for (taut_wheel_def& wheel : car.wheels) wheel.brake = 1e5f;  // locks
    car.run(0.5);
    const double start = car.now().position.x, speed = car.speed();
    car.input.brake = 1;
    for (int i = 0; i < car.steps(6) && car.speed() > 0.01; ++i) car.step();
    const double sliding = std::sqrt(0.8);  // of the tyre on ground of 1
    const double friction = friction_at(1, sliding, 1 / 0.12);
    EXPECT_NEAR(car.now().position.x - start, speed * speed / (2 * friction * kG), 0.03 * 22);
    EXPECT_LT(car.speed(), 0.02);
    EXPECT_NEAR(car.now().position.z, 0, 0.05);
}

// Steers along a circle about the origin, to the left; the largest distance from it.
double furthest_from_circle(double hz, double radius, double speed) {
    const World world(at_rate(hz));
    world.add_ground(0.49);
    Car car(world, hz, {0, 0, radius}, {}, speed);
    double furthest = 0;
    for (int i = 0; i < car.steps(12); ++i) {
        const BodyState now = car.now();
        const Vec out = unit({now.position.x, 0, now.position.z});
        const Vec ahead = cross({0, 1, 0}, out);
        const double off = norm(Vec(now.position.x, 0, now.position.z)) - radius;
        const double askew = dot(now.velocity, out) / std::max(norm(now.velocity), 1.0);
        const double wheel = 2.6 / radius + 0.05 * off + 0.5 * askew + 0.3 * (dot(car.forward(), out) - askew);
        car.input.steering = static_cast<float>(std::clamp(wheel / 0.6, -1.0, 1.0));
        car.input.throttle = static_cast<float>(std::clamp(0.5 * (speed - dot(now.velocity, ahead)) + 0.1, 0.0, 1.0));
        car.step();
        furthest = std::max(furthest, std::abs(off));
    }
    return furthest;
}

TEST_P(Vehicle, CornersAsFastAsFrictionAllows) {
    const double radius = 40, limit = std::sqrt(0.7 * kG * radius);
    EXPECT_LT(furthest_from_circle(hz(), radius, 0.85 * limit), 1.5);
    EXPECT_GT(furthest_from_circle(hz(), radius, 1.1 * limit), 4);
}

// ---------------------------------------------------------------- engine

TEST_P(Vehicle, IsAsFastAsItsPowerAllows) {
    const World world(at_rate(hz()));
    world.add_ground(1);
    Car car(world, hz(), {0, 0, 0}, {}, 33);
    car.torque = {{{0, 200}, {300, 200}, {600, 200}}};
    car.gears = {3, 3, 3, 3, 3};
    car.input.gear = 1;
    car.input.throttle = 1;
    car.def.drag_area = 2;
    car.run(60);
    const double roll = 0.012 * Car::kMass * kG, power = 200 * 3 / Car::kWheel;
    const double expected = std::sqrt((power - roll) / (0.5 * 1.2 * 2));
    EXPECT_NEAR(car.speed(), expected, 0.01 * expected);
    EXPECT_NEAR(static_cast<double>(car.vehicle.engine_speed), 3 * expected / Car::kWheel, 0.03 * 310);
    // In a lower gear the engine's speed is the limit.
    car.gears = {12, 12, 12, 12, 12};
    Car slow(world, hz(), {0, 0, 20});
    slow.gears = {12, 12, 12, 12, 12};
    slow.input.gear = 1;
    slow.input.throttle = 1;
    slow.run(15);
    EXPECT_NEAR(slow.speed(), 600 / 12.0 * Car::kWheel, 0.5);
}

TEST_P(Vehicle, ChangesGearsAndDrivesBackwards) {
    const World world(at_rate(hz()));
    world.add_ground(1);
    Car car(world, hz(), {0, 0, 0});
    car.input.throttle = 1;
    int changes = 0;
    int32_t gear = 0;
    for (int i = 0; i < car.steps(25); ++i) {
        car.step();
        EXPECT_GE(car.vehicle.gear, gear);
        changes += car.vehicle.gear != gear ? 1 : 0;
        gear = car.vehicle.gear;
    }
    EXPECT_EQ(changes, gear);
    EXPECT_GE(gear, 3);
    EXPECT_GT(car.speed(), 30);
    EXPECT_NEAR(car.now().position.z, 0, 0.1);
    Car back(world, hz(), {0, 0, 50});
    back.input.gear = TAUT_VEHICLE_REVERSE;
    back.input.throttle = 0.5f;
    back.run(4);
    EXPECT_LT(back.now().velocity.x, -3);
    EXPECT_LT(back.vehicle.forward_speed, -3);
}

// ---------------------------------------------------------------- what it drives on

TEST_P(Vehicle, GivesTheGroundWhatItTakes) {
    const World world(at_rate(hz()));
    world.add_ground(0);
    const taut_body plate = world.add({.shape = world.box({15, 0.5, 4}), .position = {0, 0.5, 0}, .mass = 3000});
    ok(taut_body_set_can_sleep(plate, 0));
    taut_material material{};
    material.friction = 1;
    ok(taut_body_set_material(plate, &material));
    Car car(world, hz(), {-8, 1, 0});
    car.def.drag_area = 0;
    car.input.brake = 1;
    car.run(1);
    car.input.brake = 0;
    car.input.throttle = 0.5f;
    car.run(2);
    const double forwards = Car::kMass * car.now().velocity.x, backwards = 3000 * velocity(plate).x;
    EXPECT_GT(forwards, 2000);
    EXPECT_NEAR(forwards + backwards, 0, 0.02 * forwards);
}

double hill(double x, double z) { return 1.5 * std::sin(0.25 * x) * std::cos(0.2 * z); }

TEST_P(Vehicle, DrivesOverHills) {
    const World world(at_rate(hz()));
    constexpr uint32_t kSide = 161;
    std::vector<float> heights(kSide * kSide);
    for (uint32_t row = 0; row < kSide; ++row)
        for (uint32_t column = 0; column < kSide; ++column)
            heights[row * kSide + column] = static_cast<float>(hill(column - 80.0, row - 80.0));
    const taut_shape field = world.shape(taut_height_field_def_init, taut_world_add_height_field, [&](auto& d) {
        d.rows = d.columns = kSide;
        d.heights = heights.data();
    });
    world.add({.kind = TAUT_BODY_STATIC, .shape = field, .position = {-80, 0, -80}, .friction = 1});
    Car car(world, hz(), {-70, hill(-70, 0) + 0.3, 0});
    car.input.throttle = 0.5f;
    double fastest = 0;
    for (int i = 0; i < car.steps(15) && std::abs(car.now().position.x) < 75; ++i) {
        car.input.throttle = car.speed() < 10 ? 0.6f : 0.0f;
        car.input.steering =
            static_cast<float>(0.3 * std::sin(0.8 * i / hz()) - 0.3 * std::clamp(car.forward().z, -1.0, 1.0) * -1);
        car.step();
        ASSERT_TRUE(finite(car.chassis));
        const Vec at = car.now().position;
        ASSERT_GT(at.y, hill(at.x, at.z) + 0.1) << "step " << i;
        ASSERT_LT(at.y, hill(at.x, at.z) + 2.5) << "step " << i;
        ASSERT_GT(car.up().y, 0.6) << "step " << i;
        fastest = std::max(fastest, car.speed());
    }
    EXPECT_GT(car.now().position.x, -30);
    EXPECT_LT(fastest, 20);
}

TEST_P(Vehicle, DrivesOverBumpsAndKerbsByRaysAndByShapes) {
    for (const bool shapes : {false, true}) {
        SCOPED_TRACE(shapes);
        const World world(at_rate(hz()));
        world.add_ground(1);
        for (int i = 0; i < 6; ++i)  // steps up and down, and kerbs
            world.add({.kind = TAUT_BODY_STATIC,
                       .shape = world.box({0.4, 0.05 * (1 + i % 2), 5}),
                       .position = {10 + 2.0 * i, 0.05 * (1 + i % 2), 0},
                       .friction = 1});
        Car car(world, hz(), {0, 0, 0}, {}, 8);
        if (shapes)
            for (taut_wheel_def& wheel : car.wheels) wheel.shape = world.cylinder(Car::kWheel, 0.1);
        double highest = 0;
        for (int i = 0; i < car.steps(4); ++i) {
            car.input.throttle = car.speed() < 8 ? 0.5f : 0.0f;
            car.step();
            ASSERT_TRUE(finite(car.chassis));
            highest = std::max(highest, car.now().position.y);
            ASSERT_GT(car.up().y, 0.85);
        }
        EXPECT_GT(car.now().position.x, 18);
        EXPECT_LT(highest, Car::kHeight + 0.6);
        car.input.throttle = 0;
        car.input.brake = 1;
        car.run(4);
        EXPECT_NEAR(car.now().position.y, Car::kHeight, 0.02);
    }
}

TEST_P(Vehicle, CrossesABridgeOfJointedBoards) {
    const World world(at_rate(hz()));
    constexpr int kBoards = 14;
    const double length = 1, sag = 0.8;
    // A parabola between two banks, boards along its chords.
    std::vector<Vec> node;
    double x = 0;
    const double span = kBoards * length * 0.985;
    const auto height = [&](double at) { return -4 * sag * at * (span - at) / (span * span); };
    node.push_back({0, 0, 0});
    for (int i = 0; i < kBoards; ++i) {
        double low = x, high = x + length;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (norm(Vec(middle, height(middle), 0) - node.back()) < length ? low : high) = middle;
        }
        x = low;
        node.push_back({x, height(x), 0});
    }
    const taut_shape board = world.box({length / 2 - 0.01, 0.05, 2});
    taut_body before{};
    std::vector<taut_joint> joints;
    std::vector<taut_body> boards;
    for (int i = 0; i < kBoards; ++i) {
        const Vec along = node[static_cast<size_t>(i) + 1] - node[static_cast<size_t>(i)];
        const Quat turn = Quat::turn({0, 0, 1}, std::atan2(along.y, along.x));
        const Vec middle = 0.5 * (node[static_cast<size_t>(i) + 1] + node[static_cast<size_t>(i)]);
        const taut_body body =
            world.add({.shape = board, .position = middle, .rotation = turn, .mass = 120, .friction = 1, .group = -1});
        for (const double side : {-1.8, 1.8}) {
            const Vec end = i == 0 ? node[0] + Vec(0, 0, side) : Vec(length / 2, 0, side);
            joints.push_back(world.ball(before, end, body, {-length / 2, 0, side}));
        }
        boards.push_back(body);
        before = body;
    }
    for (const double side : {-1.8, 1.8})
        joints.push_back(world.ball(before, {length / 2, 0, side}, {}, node.back() + Vec(0, 0, side)));
    for (const double bank : {-20.0, x + 20.0})
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = world.box({20, 0.5, 6}),
                   .position = {bank, -0.45, 0},
                   .friction = 1,
                   .group = -1});
    Car car(world, hz(), {-8, 0.05, 0}, {}, 5);
    ok(taut_world_set_contact_events(world.handle, 0));
    double fastest = 0;
    for (int i = 0; i < car.steps(9) && car.now().position.x < x + 5; ++i) {
        car.input.throttle = car.speed() < 5 ? 0.5f : 0.0f;
        car.input.steering = static_cast<float>(
            std::clamp(0.5 * car.now().position.z + 2 * std::clamp(car.forward().z, -1.0, 1.0), -1.0, 1.0));
        car.step();
        ASSERT_TRUE(finite(car.chassis));
        ASSERT_GT(car.now().position.y, -1.8) << "step " << i << " at " << car.now().position.x;
        ASSERT_GT(car.up().y, 0.7) << "step " << i << " at " << car.now().position.x;
        for (const taut_body body : boards) fastest = std::max(fastest, norm(velocity(body)));
    }
    EXPECT_GT(car.now().position.x, x + 3);
    EXPECT_LT(fastest, 8);
}

// ---------------------------------------------------------------- the state

TEST_P(Vehicle, HasTheSameBitsEachTimeAndAfterARestoration) {
    taut_vehicle first{};
    for (int time = 0; time < 2; ++time) {
        const World world(at_rate(hz()));
        world.add_ground(1);
        Car car(world, hz(), {0, 0, 0});
        car.input.throttle = 1;
        car.input.steering = 0.3f;
        car.run(2);
        uint64_t size = 0;
        ok(taut_world_snapshot_size(world.handle, &size));
        std::vector<unsigned char> bytes(size);
        ok(taut_world_save(world.handle, bytes.data(), size, &size));
        const taut_vehicle saved = car.vehicle;
        for (int again = 0; again < 2; ++again) {
            ok(taut_world_restore(world.handle, bytes.data(), size));
            car.vehicle = saved;
            car.run(2);
            if (time == 0 && again == 0) first = car.vehicle;
            // All but handles, which are of this world.
            for (size_t i = 0; i < 4; ++i) {
                car.vehicle.wheels[i].ground_body = first.wheels[i].ground_body;
                car.vehicle.wheels[i].ground_collider = first.wheels[i].ground_collider;
            }
            EXPECT_EQ(std::memcmp(&car.vehicle, &first, sizeof first), 0);
        }
    }
}

TEST_P(Vehicle, SleepsWhereItStandsAndWakesToDrive) {
    const World world([&](taut_world_def& def) {
        at_rate(hz())(def);
        def.sleeping = 1;
    });
    world.add_ground(1);
    Car car(world, hz(), {0, 0, 0});
    car.input.handbrake = 1;
    car.run(5);
    uint32_t awake = 1;
    ok(taut_body_get_awake(car.chassis, &awake));
    EXPECT_EQ(awake, 0u);
    car.input.handbrake = 0;
    car.input.throttle = 0.5f;
    car.run(2);
    EXPECT_GT(car.speed(), 2);
}

}  // namespace
}  // namespace lab
