// What the calls of characters and vehicles refuse, and that they change nothing then.
#include <gtest/gtest.h>

#include "api/def_check.h"

namespace taut_test {
namespace {

const Field kCharacterFields[] = {
    FIELD(taut_character_def, gap, 1e-4, 0.1),       FIELD(taut_character_def, gravity, 0, 1e4),
    FIELD(taut_character_def, step_height, 0, 1e3),  FIELD(taut_character_def, max_slope, 0, 1.55),
    FIELD(taut_character_def, acceleration, 0, 1e6), FIELD(taut_character_def, air_acceleration, 0, 1e6),
    FIELD(taut_character_def, mass, 0, 1e6),         FIELD(taut_character_def, push_force, 0, 1e9),
};
const Field kVehicleFields[] = {
    FIELD(taut_vehicle_def, reverse_gear, 0, 1e3),   FIELD(taut_vehicle_def, idle_speed, 0, 1e5),
    FIELD(taut_vehicle_def, engine_inertia, 0, 1e6), FIELD(taut_vehicle_def, engine_brake, 0, 1e9),
    FIELD(taut_vehicle_def, shift_time, 0, 10),      FIELD(taut_vehicle_def, drag_area, 0, 1e6),
};
const Field kWheelFields[] = {
    FIELD(taut_wheel_def, radius, 0.01, 100),
    FIELD(taut_wheel_def, inertia, 0, 1e9, Field::open_below),
    FIELD(taut_wheel_def, travel, 0.01, 100),
    FIELD(taut_wheel_def, stiffness, 0, 1e12),
    FIELD(taut_wheel_def, compression_damping, 0, 1e12),
    FIELD(taut_wheel_def, extension_damping, 0, 1e12),
    FIELD(taut_wheel_def, friction, 0, 100, Field::unchecked),
    FIELD(taut_wheel_def, peak_slip, 0.01, 1),
    FIELD(taut_wheel_def, peak_slip_across, 0.01, 1),
    FIELD(taut_wheel_def, relaxation, 0.01, 10),
    FIELD(taut_wheel_def, rolling_resistance, 0, 1),
    FIELD(taut_wheel_def, steering, -1.5, 1.5),
    FIELD(taut_wheel_def, brake, 0, 1e9),
    FIELD(taut_wheel_def, handbrake, 0, 1e9),
    FIELD(taut_wheel_def, drive, 0, 1e3),
};

// Each field of a def beyond its limits, and at them, by a call that takes it.
template <class Def, size_t Count, class Call>
void check_fields(const Def& good, const Field (&fields)[Count], Call&& call) {
    EXPECT_EQ(call(good), TAUT_OK) << taut_last_error();
    for (const Field& field : fields) {
        SCOPED_TRACE(field.name);
        const double inf = std::numeric_limits<double>::infinity();
        const double low = field.edges == Field::open_below ? field.lo : below(field, field.lo);
        for (const double bad : {low, above(field, field.hi), -inf, inf, std::nan("")}) {
            EXPECT_EQ(call(with(good, field, bad)), TAUT_INVALID_ARGUMENT) << bad;
            EXPECT_TRUE(contains(taut_last_error(), field.name)) << taut_last_error();
        }
        if (field.edges == Field::unchecked) continue;
        EXPECT_EQ(call(with(good, field, field.hi)), TAUT_OK) << taut_last_error();
        if (field.edges == Field::open_below) continue;
        EXPECT_EQ(call(with(good, field, field.lo)), TAUT_OK) << taut_last_error();
    }
}

class MoverDefs : public testing::Test {
protected:
    MoverDefs() : world(make_world()) {
        taut_capsule_def capsule_def;
        taut_capsule_def_init(&capsule_def);
        EXPECT_OK(taut_world_add_capsule(world, &capsule_def, &capsule));
        box = add_box(world);
        crate = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 10, 0));
        taut_character_def_init(&character_def);
        character_def.shape = capsule;
        taut_character_init(&character);
        taut_wheel_def_init(&wheel);
        taut_vehicle_def_init(&vehicle_def);
        vehicle_def.chassis = crate;
        vehicle_def.wheels = &wheel;
        vehicle_def.wheel_count = 1;
        taut_vehicle_init(&vehicle);
    }
    ~MoverDefs() override { taut_world_destroy(world); }

    taut_result move(const taut_character_def* def) {
        taut_character copy = character;
        return taut_character_move(world, def, {1, 0, 0}, 0, 0.01f, &copy);
    }
    taut_result drive(const taut_vehicle_def* def) {
        taut_vehicle copy = vehicle;
        return taut_vehicle_drive(world, def, &input, 0.01f, &copy);
    }
    void expect_text(taut_result result, taut_result expected, const char* part) {
        EXPECT_EQ(result, expected) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), part)) << taut_last_error();
    }

    taut_world world;
    taut_shape capsule{}, box{};
    taut_body crate{};
    taut_character_def character_def{};
    taut_character character{};
    taut_wheel_def wheel{};
    taut_vehicle_def vehicle_def{};
    taut_vehicle_input input{};
    taut_vehicle vehicle{};
};

TEST_F(MoverDefs, RangesOfCharactersAreChecked) {
    check_fields(character_def, kCharacterFields, [&](const taut_character_def& def) { return move(&def); });
}

TEST_F(MoverDefs, RangesOfVehiclesAreChecked) {
    check_fields(vehicle_def, kVehicleFields, [&](const taut_vehicle_def& def) { return drive(&def); });
    check_fields(wheel, kWheelFields, [&](const taut_wheel_def& one) {
        taut_vehicle_def def = vehicle_def;
        def.wheels = &one;
        return drive(&def);
    });
}

TEST_F(MoverDefs, WhatACharacterDoesNotTakeIsRefused) {
    const Watch watch(world);
    expect_text(move(nullptr), TAUT_NULL_POINTER, "def is null");
    expect_text(taut_character_move(world, &character_def, {0, 0, 0}, 0, 0.01f, nullptr), TAUT_NULL_POINTER,
                "character is null");
    taut_character_def def = character_def;
    def.struct_size = 0;
    expect_text(move(&def), TAUT_STRUCT_SIZE, "struct_size");
    def = character_def;
    def.shape = box;
    expect_text(move(&def), TAUT_INVALID_ARGUMENT, "taut_character_move");
    def.shape = {0};
    expect_text(move(&def), TAUT_STALE_HANDLE, "taut_character_move");
    def = character_def;
    def.body = crate;
    expect_text(move(&def), TAUT_INVALID_ARGUMENT, "def.body is not kinematic");
    def = character_def;
    def.up = {0, 0, 0};
    expect_text(move(&def), TAUT_INVALID_ARGUMENT, "up is 0");
    expect_text(taut_character_move({0}, &character_def, {0, 0, 0}, 0, 0.01f, &character), TAUT_STALE_HANDLE,
                "taut_character_move");
    expect_text(taut_character_move(world, &character_def, {NAN, 0, 0}, 0, 0.01f, &character), TAUT_INVALID_ARGUMENT,
                "walk.x");
    expect_text(taut_character_move(world, &character_def, {0, 0, 0}, -1, 0.01f, &character), TAUT_INVALID_ARGUMENT,
                "jump");
    expect_text(taut_character_move(world, &character_def, {0, 0, 0}, 0, 2, &character), TAUT_INVALID_ARGUMENT,
                "seconds");
    taut_character bad = character;
    bad.position.x = NAN;
    expect_text(taut_character_move(world, &character_def, {0, 0, 0}, 0, 0.01f, &bad), TAUT_INVALID_ARGUMENT,
                "character.position");
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    filter.kinds = 99;
    def = character_def;
    def.filter = &filter;
    expect_text(move(&def), TAUT_INVALID_ARGUMENT, "filter.kinds");
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(MoverDefs, WhatAVehicleDoesNotTakeIsRefused) {
    const Watch watch(world);
    expect_text(drive(nullptr), TAUT_NULL_POINTER, "def is null");
    expect_text(taut_vehicle_drive(world, &vehicle_def, nullptr, 0.01f, &vehicle), TAUT_NULL_POINTER, "input is null");
    expect_text(taut_vehicle_drive(world, &vehicle_def, &input, 0.01f, nullptr), TAUT_NULL_POINTER, "vehicle is null");
    expect_text(taut_vehicle_drive(world, &vehicle_def, &input, 0, &vehicle), TAUT_INVALID_ARGUMENT, "seconds");
    taut_vehicle_def def = vehicle_def;
    def.wheel_count = 17;
    expect_text(drive(&def), TAUT_INVALID_ARGUMENT, "wheel_count");
    def = vehicle_def;
    def.wheels = nullptr;
    expect_text(drive(&def), TAUT_NULL_POINTER, "wheels is null");
    def = vehicle_def;
    def.chassis = add_body(world, body_def(TAUT_BODY_STATIC, box, 50, 0, 0));
    const Watch later(world);
    expect_text(drive(&def), TAUT_INVALID_ARGUMENT, "def.chassis is not dynamic");
    def.chassis = {0};
    expect_text(drive(&def), TAUT_STALE_HANDLE, "taut_vehicle_drive");
    def = vehicle_def;
    def.forward = {0, 2, 0};
    expect_text(drive(&def), TAUT_INVALID_ARGUMENT, "forward and up");
    def = vehicle_def;
    const taut_engine_point torque[] = {{100, 1}, {50, 1}};
    def.torque = torque;
    def.torque_count = 2;
    expect_text(drive(&def), TAUT_INVALID_ARGUMENT, "def.torque[1].speed is not above");
    input.gear = 1;
    expect_text(drive(&vehicle_def), TAUT_INVALID_ARGUMENT, "gear is none");
    input.gear = 0;
    input.throttle = 2;
    expect_text(drive(&vehicle_def), TAUT_INVALID_ARGUMENT, "input.throttle");
    input.throttle = 0;
    wheel.sliding_friction = 1.5f;
    expect_text(drive(&vehicle_def), TAUT_INVALID_ARGUMENT, "def.wheels[0].sliding_friction");
    wheel.sliding_friction = 0.5f;
    vehicle.wheels[0].slip[1] = NAN;
    expect_text(drive(&vehicle_def), TAUT_INVALID_ARGUMENT, "vehicle.wheels[0].slip[1]");
    EXPECT_TRUE(later.unchanged());
}

TEST_F(MoverDefs, TakeNoMemory) {
    Ledger ledger;
    const taut_world own = make_world(ledger.hooks());
    taut_shape shape{};
    taut_capsule_def capsule_def;
    taut_capsule_def_init(&capsule_def);
    ASSERT_OK(taut_world_add_capsule(own, &capsule_def, &shape));
    add_body(own, body_def(TAUT_BODY_STATIC, add_plane(own)));
    const taut_body body = add_body(own, body_def(TAUT_BODY_DYNAMIC, add_box(own), 0, 1, 0));
    character_def.shape = shape;
    character.position = {1.0, 1, 0};
    vehicle_def.chassis = body;
    const auto frame = [&] {
        ASSERT_OK(taut_vehicle_drive(own, &vehicle_def, &input, 1 / 60.0f, &vehicle));
        ASSERT_OK(taut_world_step(own));
        ASSERT_OK(taut_character_move(own, &character_def, {-2, 0, 0}, 0, 1 / 60.0f, &character));
    };
    for (int i = 0; i < 60; ++i) frame();
    const uint64_t calls = ledger.calls;
    for (int i = 0; i < 60; ++i) frame();
    EXPECT_EQ(ledger.calls, calls);
    EXPECT_GT(character.pushed + vehicle.wheels[0].on_ground, 0u);
    taut_world_destroy(own);
}

}  // namespace
}  // namespace taut_test
