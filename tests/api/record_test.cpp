// Recordings: what they hold, where a replay says that it parts from them, and what damaged ones come to.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "driver.h"
#include "host/recording.h"
#include "starts.h"
#include "support.h"

using namespace taut_test;

namespace {

using Bytes = std::vector<unsigned char>;

// ---------------------------------------------------------------- worlds that are recorded

taut_shape box(taut_world world, float half) {
    taut_box_def def;
    taut_box_def_init(&def);
    def.half_extents = {half, half, half};
    taut_shape out{};
    EXPECT_OK(taut_world_add_box(world, &def, &out));
    return out;
}

taut_body body(taut_world world, taut_shape shape, taut_pos position, taut_body_kind kind, uint32_t flags = 0) {
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = kind;
    def.shape = shape;
    def.position = position;
    def.density = 500;
    def.collider_flags = flags;
    taut_body out{};
    EXPECT_OK(taut_world_add_body(world, &def, &out));
    return out;
}

// A floor and a leaning pile on it.
std::vector<taut_body> pile(taut_world world, int boxes, uint32_t flags = 0) {
    const taut_shape shape = box(world, 0.5f), floor = box(world, 10.0f);
    body(world, floor, {0, -10, 0}, TAUT_BODY_STATIC);
    std::vector<taut_body> out;
    for (int i = 0; i < boxes; ++i)
        out.push_back(body(world, shape, {0.2 * i, 0.6 + 1.05 * i, 0.07 * i}, TAUT_BODY_DYNAMIC, flags));
    return out;
}

void step(taut_world world, int steps = 1) {
    for (int i = 0; i < steps; ++i) ASSERT_OK(taut_world_step(world));
}

struct Recorded {
    Bytes bytes;
    uint64_t hash = 0;  // at its end
};

// What a world of this def goes through.
Recorded record(const std::function<void(taut_world)>& history, taut_world_def def,
                taut_record_hashes hashes = TAUT_RECORD_HASH_STEPS) {
    Recording recording;
    const taut_record_def how = recording.def(hashes);
    taut_world world{};
    EXPECT_OK(taut_world_create(&def, &world));
    EXPECT_OK(taut_world_record(world, &how));
    history(world);
    const uint64_t hash = hash_of(world);
    EXPECT_OK(taut_world_destroy(world));
    return {recording.bytes, hash};
}
taut_world_def usual() {
    taut_world_def def;
    taut_world_def_init(&def);
    return def;
}
Recorded record(const std::function<void(taut_world)>& history, taut_record_hashes hashes = TAUT_RECORD_HASH_STEPS) {
    return record(history, usual(), hashes);
}

void expect_replays(const Recorded& recorded, uint64_t frames) {
    for (const uint32_t threads : {1u, 2u, 5u}) {
        Replay replay(recorded.bytes, threads);
        replay.play();
        ASSERT_TRUE(replay.is_same()) << replay.text() << ", threads " << threads;
        EXPECT_EQ(replay.state.whole, 1u);
        EXPECT_EQ(replay.state.frame, frames);
        EXPECT_EQ(hash_of(replay.world), recorded.hash);
    }
}

bool is_whole(const Replay& replay) { return replay.is_same() && replay.state.whole == 1; }

// ---------------------------------------------------------------- what replays

TEST(Recording, OfAPileReplays) {
    for (const float step_length : {1 / 30.0f, 1 / 60.0f, 1 / 240.0f}) {
        taut_world_def def = usual();
        def.time_step = step_length;
        expect_replays(record(
                           [](taut_world world) {
                               pile(world, 8);
                               step(world, 60);
                           },
                           def),
                       60);
    }
}

// What a def says is as long as it is there is taken, also where that ends amid a field.
TEST(Recording, OfDefsThatEndAnywhereReplays) {
    const auto history = [](taut_world world) {
        for (uint32_t size = 4; size <= sizeof(taut_particle_def); size += 4) {
            taut_particle_def def;
            taut_particle_def_init(&def);
            def.position = {1.5, 2.5 + size, 3.5};
            def.velocity = {1, 2, 3};
            def.struct_size = size;
            taut_body out;
            taut_world_add_particle(world, &def, &out);
        }
        for (uint32_t size = 4; size <= sizeof(taut_hinge_joint_def); size += 4) {
            taut_body first = body(world, box(world, 0.5f), {0, 9, 0}, TAUT_BODY_DYNAMIC);
            taut_hinge_joint_def def;
            taut_hinge_joint_def_init(&def);
            def.base.body_a = first;
            def.base.frame_a.position = {0.25, 0.5, 0.75};
            def.angle.mode = TAUT_AXIS_LIMITED;
            def.angle.upper = 1;
            def.struct_size = size;
            taut_joint out;
            taut_world_add_hinge_joint(world, &def, &out);
        }
        step(world, 2);
    };
    expect_replays(record(history), 2);
}

// Threads and the place in the table of worlds are not in the file.
TEST(Recording, IsTheSameFileOnAnyThreads) {
    const auto history = [](taut_world world) {
        pile(world, 6);
        step(world, 30);
    };
    taut_world_def def = usual();
    const Bytes first = record(history, def).bytes;
    for (const uint32_t threads : {2u, 5u}) {
        def.threads = threads;
        EXPECT_TRUE(record(history, def).bytes == first) << threads;
    }
}

TEST(Recording, OfAReplayIsTheSameFile) {
    const Recorded recorded = record([](taut_world world) {
        const std::vector<taut_body> bodies = pile(world, 4);
        step(world, 10);
        EXPECT_OK(taut_body_set_name(bodies[2], "third"));
        EXPECT_OK(taut_body_remove(bodies[1]));
        EXPECT_EQ(taut_body_remove(bodies[1]), TAUT_STALE_HANDLE);
        step(world, 10);
    });
    Recording again;
    {
        Replay replay(recorded.bytes);
        const taut_record_def how = again.def();
        ASSERT_OK(taut_world_record(replay.world, &how));
        ASSERT_TRUE(replay.play().is_same()) << replay.text();
    }
    ASSERT_EQ(again.bytes.size(), recorded.bytes.size());
    const auto part = std::mismatch(again.bytes.begin(), again.bytes.end(), recorded.bytes.begin());
    EXPECT_EQ(part.first - again.bytes.begin(), static_cast<std::ptrdiff_t>(again.bytes.size()));
}

// As a game with rollback does: snapshots in a ring, of which now and then one is restored.
TEST(Recording, OfRollbackReplays) {
    const Recorded recorded = record([](taut_world world) {
        const std::vector<taut_body> bodies = pile(world, 5);
        std::vector<Bytes> ring(8);
        for (uint32_t frame = 0; frame < 60; ++frame) {
            uint64_t size = 0;
            EXPECT_OK(taut_world_snapshot_size(world, &size));
            Bytes& snapshot = ring[frame % ring.size()];
            snapshot.resize(size);
            EXPECT_OK(taut_world_save(world, snapshot.data(), size, &size));
            step(world);
            if (frame % 7 != 6) continue;
            const Bytes copy = ring[(frame - 5) % ring.size()];
            EXPECT_OK(taut_world_restore(world, copy.data(), copy.size()));
            EXPECT_OK(taut_body_apply_impulse(bodies[frame % bodies.size()], {20, 0, 5}, {}));
            step(world, 5);
        }
    });
    expect_replays(recorded, 60 + 8 + 40);
}

TEST(Recording, OfDamagedSnapshotsReplays) {
    expect_replays(record([](taut_world world) {
                       pile(world, 2);
                       uint64_t size = 0;
                       EXPECT_OK(taut_world_snapshot_size(world, &size));
                       Bytes snapshot(size);
                       EXPECT_OK(taut_world_save(world, snapshot.data(), size, &size));
                       snapshot[size / 2] ^= 1;
                       EXPECT_EQ(taut_world_restore(world, snapshot.data(), size), TAUT_INVALID_ARGUMENT);
                       step(world, 3);
                   }),
                   4);
}

// Answers of the host steer the steps; a replay has them from the file.
TEST(Recording, HoldsTheAnswersOfPreSolve) {
    struct Judge {
        uint32_t state = 1, asked = 0;
    } judge;
    const Recorded recorded = record([&](taut_world world) {
        EXPECT_OK(taut_world_set_pre_solve(
            world,
            [](const taut_pre_solve*, taut_pre_solve_answer* answer, void* self) -> int32_t {
                Judge& own = *static_cast<Judge*>(self);
                own.state = own.state * 1664525u + 1013904223u;
                ++own.asked;
                answer->friction = static_cast<float>(own.state >> 24) / 256;
                return own.state >> 16 & 3 ? 1 : 0;
            },
            &judge));
        pile(world, 5, TAUT_COLLIDER_PRE_SOLVE);
        step(world, 40);
        EXPECT_OK(taut_world_set_pre_solve(world, nullptr, nullptr));
        step(world, 20);
    });
    EXPECT_GT(judge.asked, 100u);
    expect_replays(recorded, 60);
}

// Worlds whose functions change each other's are recorded each for itself.
TEST(Recording, OfAWorldThatAnotherOneChangesReplays) {
    Recorded second;
    const Recorded first = record([&](taut_world world) {
        second = record([&](taut_world other) {
            EXPECT_OK(taut_world_set_pre_solve(
                world,
                [](const taut_pre_solve*, taut_pre_solve_answer*, void* changed) -> int32_t {
                    EXPECT_OK(taut_world_step(*static_cast<taut_world*>(changed)));
                    return 1;
                },
                &other));
            pile(world, 1, TAUT_COLLIDER_PRE_SOLVE);
            pile(other, 3);
            step(world, 20);
            EXPECT_OK(taut_world_set_pre_solve(world, nullptr, nullptr));
        });
    });
    expect_replays(first, 20);
    Replay replay(second.bytes, 2);
    EXPECT_TRUE(is_whole(replay.play())) << replay.text();
    EXPECT_GT(replay.state.frame, 5u);
}

// What it says after the recording is the host's again.
TEST(Recording, LeavesPreSolveToTheHost) {
    Recording recording;
    const taut_record_def how = recording.def();
    const taut_world_def def = usual();
    taut_world world{};
    ASSERT_OK(taut_world_create(&def, &world));
    ASSERT_OK(taut_world_record(world, &how));
    uint32_t asked = 0;
    ASSERT_OK(taut_world_set_pre_solve(
        world,
        [](const taut_pre_solve*, taut_pre_solve_answer*, void* self) -> int32_t {
            ++*static_cast<uint32_t*>(self);
            return 1;
        },
        &asked));
    pile(world, 2, TAUT_COLLIDER_PRE_SOLVE);
    step(world, 5);
    ASSERT_OK(taut_world_end_recording(world));
    EXPECT_EQ(taut_world_end_recording(world), TAUT_INVALID_ARGUMENT);
    const uint32_t before = asked;
    const size_t bytes = recording.bytes.size();
    step(world, 5);
    EXPECT_GT(asked, before);
    EXPECT_EQ(recording.bytes.size(), bytes);
    ASSERT_OK(taut_world_destroy(world));
    Replay replay(recording.bytes);
    EXPECT_TRUE(replay.play().is_same()) << replay.text();
    EXPECT_EQ(replay.state.frame, 5u);
    EXPECT_EQ(replay.state.whole, 1u);
}

taut_baked baked_hill() {
    std::vector<float> heights;
    for (int i = 0; i < 81; ++i) heights.push_back(0.3f * std::sin(0.7f * static_cast<float>(i)));
    taut_height_field_def def;
    taut_height_field_def_init(&def);
    def.rows = def.columns = 9;
    def.heights = heights.data();
    taut_baked out{};
    EXPECT_OK(taut_bake_height_field(&def, nullptr, &out));
    return out;
}
void roll_on(taut_world world, taut_baked hill) {
    taut_shape shape{}, again{};
    EXPECT_OK(taut_world_add_baked(world, hill, &shape));
    EXPECT_OK(taut_world_add_baked(world, hill, &again));
    body(world, shape, {-4, 0, -4}, TAUT_BODY_STATIC);
    taut_sphere_def ball;
    taut_sphere_def_init(&ball);
    taut_shape round{};
    EXPECT_OK(taut_world_add_sphere(world, &ball, &round));
    body(world, round, {0.1, 2, 0.2}, TAUT_BODY_DYNAMIC);
    step(world, 60);
}

TEST(Recording, HoldsBakedShapesThatKeepTheirDefs) {
    ASSERT_OK(taut_bake_keep_defs(1));
    const taut_baked hill = baked_hill();
    ASSERT_OK(taut_bake_keep_defs(0));
    const Recorded recorded = record([&](taut_world world) { roll_on(world, hill); });
    ASSERT_OK(taut_baked_release(hill));
    expect_replays(recorded, 60);
}

TEST(Recording, SaysThatADefOfABakedShapeIsMissing) {
    const taut_baked hill = baked_hill();
    const Recorded recorded = record([&](taut_world world) { roll_on(world, hill); });
    ASSERT_OK(taut_baked_release(hill));
    Replay replay(recorded.bytes);
    EXPECT_FALSE(replay.next());
    EXPECT_EQ(replay.result, TAUT_UNSUPPORTED);
    EXPECT_TRUE(contains(taut_last_error(), "call 1 adds a baked shape whose def was not kept")) << taut_last_error();
    EXPECT_EQ(taut_replay_next(replay.world, &replay.state), TAUT_UNSUPPORTED) << "it goes on";
    EXPECT_EQ(taut_bake_keep_defs(2), TAUT_INVALID_ARGUMENT);
}

// Movers change the world by other calls, which are in the recording in their place, whatever filter they have.
TEST(Recording, OfACharacterAndAVehicleReplays) {
    const Recorded recorded = record([](taut_world world) {
        pile(world, 3);
        taut_wheel_def wheels[4];
        for (int i = 0; i < 4; ++i) {
            taut_wheel_def_init(&wheels[i]);
            wheels[i].position = {i % 2 ? 0.8f : -0.8f, -0.2f, i / 2 ? 1.2f : -1.2f};
            wheels[i].drive = 0.25f;
        }
        taut_vehicle_def car;
        taut_vehicle_def_init(&car);
        car.chassis = body(world, box(world, 0.6f), {4, 1.2, 0}, TAUT_BODY_DYNAMIC);
        car.wheels = wheels;
        car.wheel_count = 4;
        const taut_engine_point torque[] = {{0, 300}, {700, 300}};
        const float gears[] = {8};
        car.torque = torque, car.torque_count = 2;
        car.gears = gears, car.gear_count = 1;
        taut_vehicle vehicle;
        taut_vehicle_init(&vehicle);
        const taut_vehicle_input input{1, 0, 0, 0.3f, TAUT_VEHICLE_AUTOMATIC, 0};
        taut_character_def walker;
        taut_character_def_init(&walker);
        taut_capsule_def capsule;
        taut_capsule_def_init(&capsule);
        EXPECT_OK(taut_world_add_capsule(world, &capsule, &walker.shape));
        taut_query_filter filter;
        taut_query_filter_init(&filter);
        filter.accept = [](taut_body, taut_collider, void*) -> int32_t { return 1; };
        walker.filter = &filter;
        taut_character character;
        taut_character_init(&character);
        character.position = {-1.5, 1, 0};
        for (int i = 0; i < 90; ++i) {
            EXPECT_OK(taut_vehicle_drive(world, &car, &input, 1 / 60.0f, &vehicle));
            EXPECT_OK(taut_character_move(world, &walker, {3, 0, 0}, 0, 1 / 60.0f, &character));
            step(world);
        }
        EXPECT_GT(vehicle.forward_speed, 1.0f) << "it does not drive";
    });
    expect_replays(recorded, 90);
}

// ---------------------------------------------------------------- where it parts

TEST(Replay, NamesTheFirstFrameThatDiffers) {
    const Recorded recorded = record([](taut_world world) {
        pile(world, 3);
        step(world, 30);
    });
    for (const uint64_t disturbed : {0u, 7u, 29u}) {
        Replay replay(recorded.bytes);
        for (uint64_t frame = 0; frame < disturbed; ++frame) ASSERT_TRUE(replay.next()) << replay.text();
        if (disturbed > 0)
            ASSERT_OK(taut_world_set_gravity(replay.world, {0, -9.82f, 0}));
        else
            body(replay.world, taut_shape{}, {0, 50, 0}, TAUT_BODY_KINEMATIC);
        replay.play();
        ASSERT_OK(replay.result);
        EXPECT_EQ(replay.state.status, TAUT_REPLAY_DIFFERS);
        if (disturbed > 0) {
            EXPECT_EQ(replay.state.frame, disturbed + 1);
            EXPECT_EQ(replay.state.call, 2u + 4u + disturbed + 1);  // shapes, bodies, steps
            EXPECT_STREQ(replay.state.function, "taut_world_step");
            EXPECT_STREQ(replay.state.difference, "the hash of the state");
        } else {
            EXPECT_EQ(replay.state.frame, 0u);
            EXPECT_STREQ(replay.state.function, "taut_world_add_body");
            EXPECT_STREQ(replay.state.difference, "the handle given");
        }
        EXPECT_NE(replay.state.expected, replay.state.found);
        const taut_replay_state said = replay.state;
        replay.next();
        EXPECT_EQ(replay.state.status, TAUT_REPLAY_DIFFERS) << "it goes on";
        EXPECT_EQ(replay.state.call, said.call);
    }
}

// A process that died in the midst of a call leaves that call as the last one, without its end.
TEST(Replay, PlaysTheCallThatNeverCameBack) {
    Recording recording;
    const taut_record_def how = recording.def();
    const taut_world_def def = usual();
    taut_world world{};
    ASSERT_OK(taut_world_create(&def, &world));
    ASSERT_OK(taut_world_record(world, &how));
    struct Dying {
        Recording* recording;
        Bytes left;
    } dying{&recording, {}};
    ASSERT_OK(taut_world_set_pre_solve(
        world,
        [](const taut_pre_solve*, taut_pre_solve_answer*, void* self) -> int32_t {
            Dying& own = *static_cast<Dying*>(self);
            if (own.left.empty()) own.left = own.recording->bytes;
            return 1;
        },
        &dying));
    pile(world, 1, TAUT_COLLIDER_PRE_SOLVE);
    step(world, 30);
    ASSERT_OK(taut_world_destroy(world));
    ASSERT_FALSE(dying.left.empty());
    Replay replay(dying.left);
    replay.play();
    ASSERT_TRUE(replay.is_same() || replay.state.status == TAUT_REPLAY_DIFFERS) << replay.text();
    EXPECT_EQ(replay.state.whole, 0u);
    EXPECT_STREQ(replay.state.function, "taut_world_step");
}

// ---------------------------------------------------------------- what is refused

TEST(Recording, IsRefusedWhereItCouldNotBeReplayed) {
    Recording recording;
    taut_record_def how = recording.def();
    const taut_world_def def = usual();
    taut_world world{};
    ASSERT_OK(taut_world_create(&def, &world));
    how.write = nullptr;
    EXPECT_EQ(taut_world_record(world, &how), TAUT_NULL_POINTER);
    how = recording.def(static_cast<taut_record_hashes>(3));
    EXPECT_EQ(taut_world_record(world, &how), TAUT_INVALID_ARGUMENT);
    how = recording.def();
    how.struct_size = 0;
    EXPECT_EQ(taut_world_record(world, &how), TAUT_STRUCT_SIZE);
    EXPECT_EQ(taut_world_record(world, nullptr), TAUT_NULL_POINTER);
    recording.most = 10;
    how = recording.def();
    EXPECT_EQ(taut_world_record(world, &how), TAUT_UNSUPPORTED);
    recording = {};
    how = recording.def();
    EXPECT_OK(taut_world_record(world, &how));
    EXPECT_EQ(taut_world_record(world, &how), TAUT_INVALID_ARGUMENT);
    EXPECT_OK(taut_world_end_recording(world));
    box(world, 1);
    EXPECT_EQ(taut_world_record(world, &how), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "calls have changed the world")) << taut_last_error();
    taut_replay_state state;
    EXPECT_EQ(taut_replay_next(world, &state), TAUT_INVALID_ARGUMENT);
    ASSERT_OK(taut_world_destroy(world));
    EXPECT_EQ(taut_replay_next(world, &state), TAUT_STALE_HANDLE);
}

// A disk that is full ends the recording and nothing else.
TEST(Recording, EndsWhereTheHostDoesNotWrite) {
    const auto run = [](Recording* recording, int* warnings) {
        taut_world_def def = usual();
        def.hooks.log = [](taut_log_level level, const char*, void* count) {
            *static_cast<int*>(count) += level == TAUT_LOG_WARNING;
        };
        def.hooks.log_user_data = warnings;
        taut_world world{};
        EXPECT_OK(taut_world_create(&def, &world));
        const taut_record_def how = recording ? recording->def() : taut_record_def{};
        if (recording) {
            EXPECT_OK(taut_world_record(world, &how));
        }
        pile(world, 4);
        step(world, 20);
        const uint64_t hash = hash_of(world);
        EXPECT_OK(taut_world_destroy(world));
        return hash;
    };
    int warnings = 0;
    Recording recording;
    recording.most = 5000;
    const uint64_t free = run(nullptr, &warnings);
    EXPECT_EQ(warnings, 0);
    EXPECT_EQ(run(&recording, &warnings), free);
    EXPECT_EQ(warnings, 1);
    Replay replay(recording.bytes);
    replay.play();
    EXPECT_TRUE(replay.is_same()) << replay.text();
    EXPECT_EQ(replay.state.whole, 0u);
    EXPECT_GT(replay.state.call, 3u);
}

// A host whose function calls into the world that it writes of: no deadlock, and no recording that is not true.
TEST(Recording, EndsWhereWriteChangesTheWorld) {
    struct Meddler {
        Recording recording;
        taut_world world{};
        bool meddles = false;
    } meddler;
    taut_record_def how;
    taut_record_def_init(&how);
    how.user_data = &meddler;
    how.write = [](const void* bytes, uint64_t size, void* self) -> int32_t {
        Meddler& own = *static_cast<Meddler*>(self);
        if (own.meddles) {
            own.meddles = false;
            EXPECT_EQ(taut_world_destroy(own.world), TAUT_LOCKED);
            EXPECT_EQ(taut_world_end_recording(own.world), TAUT_LOCKED);
            EXPECT_OK(taut_world_set_gravity(own.world, {0, 1, 0}));
        }
        const taut_record_def def = own.recording.def();
        return def.write(bytes, size, &own.recording);
    };
    const taut_world_def def = usual();
    ASSERT_OK(taut_world_create(&def, &meddler.world));
    ASSERT_OK(taut_world_record(meddler.world, &how));
    step(meddler.world, 3);
    meddler.meddles = true;
    step(meddler.world, 3);
    ASSERT_OK(taut_world_destroy(meddler.world));
    Replay replay(meddler.recording.bytes);
    replay.play();
    EXPECT_TRUE(replay.is_same()) << replay.text();
    EXPECT_EQ(replay.state.frame, 4u);
    EXPECT_EQ(replay.state.whole, 0u);
}

// A recording does not count for what the host's allocator is told to give: without memory it ends, the call goes on.
TEST(Recording, GivesItsMemoryBack) {
    Ledger ledger;
    {
        taut_world_def def = usual();
        def.hooks = ledger.hooks();
        Recording recording;
        const taut_record_def how = recording.def();
        taut_world world{};
        ASSERT_OK(taut_world_create(&def, &world));
        ASSERT_OK(taut_world_record(world, &how));
        pile(world, 3);
        step(world, 5);
        ASSERT_OK(taut_world_destroy(world));
        taut_replay_def replay;
        taut_replay_def_init(&replay);
        replay.bytes = recording.bytes.data();
        replay.size = recording.bytes.size();
        replay.hooks = ledger.hooks();
        ASSERT_OK(taut_replay_open(&replay, &world));
        taut_replay_state state;
        do ASSERT_OK(taut_replay_next(world, &state));
        while (state.status == TAUT_REPLAY_STEPPED);
        EXPECT_EQ(state.status, TAUT_REPLAY_ENDED);
        ASSERT_OK(taut_world_destroy(world));
    }
    EXPECT_TRUE(ledger.empty());
    EXPECT_EQ(ledger.errors, 0u);
}

// ---------------------------------------------------------------- damaged and forged files

// One of everything that has arrays, texts and handles in it.
const Bytes& short_recording() {
    static const Bytes bytes = [] {
        EXPECT_OK(taut_bake_keep_defs(1));
        const taut_baked hill = baked_hill();
        EXPECT_OK(taut_bake_keep_defs(0));
        const Bytes out =
            record([&](taut_world world) {
                const std::vector<taut_body> bodies = pile(world, 2, TAUT_COLLIDER_PRE_SOLVE);
                taut_shape shape{};
                EXPECT_OK(taut_world_add_baked(world, hill, &shape));
                EXPECT_OK(taut_body_set_name(bodies[0], "name"));
                taut_collider_def parts[2];
                for (taut_collider_def& part : parts) {
                    taut_collider_def_init(&part);
                    part.shape = box(world, 0.2f);
                    part.density = 100;
                }
                taut_body_def def;
                taut_body_def_init(&def);
                def.colliders = parts;
                def.collider_count = 2;
                def.position = {3, 2, 0};
                taut_body two{};
                EXPECT_OK(taut_world_add_body(world, &def, &two));
                const taut_pos points[4] = {{5, 1, 0}, {6, 1, 0}, {5, 2, 0}, {5, 1, 1}};
                const uint32_t cell[4] = {0, 1, 2, 3}, face[3] = {0, 1, 2};
                taut_solid_def solid;
                taut_solid_def_init(&solid);
                solid.points = points, solid.point_count = 4;
                solid.cells = cell, solid.cell_count = 1;
                taut_solid made{};
                EXPECT_OK(taut_world_add_solid(world, &solid, &made));
                taut_cloth_def cloth;
                taut_cloth_def_init(&cloth);
                cloth.points = points, cloth.point_count = 3;
                cloth.triangles = face, cloth.triangle_count = 1;
                taut_cloth sheet{};
                EXPECT_OK(taut_world_add_cloth(world, &cloth, &sheet));
                taut_hinge_joint_def hinge;
                taut_hinge_joint_def_init(&hinge);
                hinge.base.body_a = bodies[0], hinge.base.body_b = two;
                taut_joint joint{};
                EXPECT_OK(taut_world_add_hinge_joint(world, &hinge, &joint));
                uint64_t size = 0;
                EXPECT_OK(taut_world_snapshot_size(world, &size));
                Bytes snapshot(size);
                EXPECT_OK(taut_world_save(world, snapshot.data(), size, &size));
                EXPECT_OK(taut_world_set_pre_solve(
                    world, [](const taut_pre_solve*, taut_pre_solve_answer*, void*) -> int32_t { return 1; }, nullptr));
                step(world);
                EXPECT_OK(taut_world_restore(world, snapshot.data(), size));
                step(world);
            }).bytes;
        EXPECT_OK(taut_baked_release(hill));
        return out;
    }();
    return bytes;
}

TEST(DamagedRecording, AsWrittenIsWhole) {
    Replay replay(short_recording());
    EXPECT_TRUE(is_whole(replay.play())) << replay.text();
}

TEST(DamagedRecording, OfAnyByteIsFound) {
    const Bytes& bytes = short_recording();
    for (size_t i = 0; i < bytes.size(); ++i) {
        Bytes damaged = bytes;
        damaged[i] ^= static_cast<unsigned char>(1u << i % 8);
        Replay replay(damaged);
        ASSERT_FALSE(is_whole(replay.play())) << "byte " << i;
        ASSERT_TRUE(replay.result == TAUT_INVALID_ARGUMENT || replay.result == TAUT_UNSUPPORTED) << "byte " << i;
    }
}

TEST(DamagedRecording, CutAnywhereIsFound) {
    const Bytes& bytes = short_recording();
    for (size_t size = 1; size < bytes.size(); ++size) {
        const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        Replay replay(cut);
        ASSERT_FALSE(is_whole(replay.play())) << size << " bytes";
        ASSERT_TRUE(replay.result == TAUT_OK || replay.result == TAUT_INVALID_ARGUMENT) << replay.text();
        if (replay.result == TAUT_OK) {
            ASSERT_EQ(replay.state.status, TAUT_REPLAY_ENDED) << replay.text();
        }
    }
}

// As the library checks records: FNV-1a over words with a shift.
uint32_t check_of(const unsigned char* bytes, size_t size) {
    uint64_t value = 0xcbf29ce484222325ull;
    const auto add = [&](uint64_t word) {
        value = (value ^ word) * 0x100000001b3ull;
        value ^= value >> 29;
    };
    add(size);
    for (; size >= 8; size -= 8, bytes += 8) {
        uint64_t word;
        std::memcpy(&word, bytes, 8);
        add(word);
    }
    uint64_t rest = 0;
    if (size > 0) std::memcpy(&rest, bytes, size);
    add(rest);
    return static_cast<uint32_t>(value ^ value >> 32);
}

// Records of a file, each with its checks made anew, as a forger would.
struct Forged {
    struct Piece {
        uint32_t kind;
        Bytes bytes;
    };
    std::vector<Piece> pieces;

    explicit Forged(const Bytes& file) {
        for (size_t at = 8; at + 12 <= file.size();) {
            uint32_t prefix[2];
            std::memcpy(prefix, &file[at], sizeof prefix);
            const auto first = file.begin() + static_cast<std::ptrdiff_t>(at + 12);
            pieces.push_back({prefix[0], Bytes(first, first + prefix[1])});
            at += 12 + prefix[1] + 4;
        }
    }
    Bytes file() const {
        Bytes out = {'T', 'A', 'U', 'T', 'R', 'E', 'C', '\n'};
        const auto put = [&](const void* from, size_t size) {
            const auto* const first = static_cast<const unsigned char*>(from);
            out.insert(out.end(), first, first + size);
        };
        for (const Piece& piece : pieces) {
            const uint32_t prefix[2] = {piece.kind, static_cast<uint32_t>(piece.bytes.size())};
            const uint32_t checks[2] = {check_of(reinterpret_cast<const unsigned char*>(prefix), 8),
                                        check_of(piece.bytes.data(), piece.bytes.size())};
            put(prefix, sizeof prefix);
            put(&checks[0], 4);
            put(piece.bytes.data(), piece.bytes.size());
            put(&checks[1], 4);
        }
        return out;
    }
};

TEST(ForgedRecording, IsReadAsTheLibraryWritesIt) {
    EXPECT_TRUE(Forged(short_recording()).file() == short_recording());
}

class ForgedRecording : public testing::TestWithParam<uint64_t> {};

// Bytes of anything in place of arguments, and records in another order: no crash, no read beyond, and no more memory
// than some times the file and what its calls may ask for.
TEST_P(ForgedRecording, BreaksNothing) {
    ByteSource random = random_source(GetParam());
    const auto below = [&](size_t end) {
        uint32_t value = 0;
        random(&value, sizeof value);
        return end > 0 ? value % end : 0;
    };
    const Forged original(short_recording());
    for (int round = 0; round < 200; ++round) {
        Forged forged = original;
        for (size_t edits = 1 + below(4); edits > 0; --edits) {
            Forged::Piece& piece = forged.pieces[below(forged.pieces.size())];
            const size_t at = below(piece.bytes.size()), length = 1 + below(8);
            switch (below(6)) {
                case 0:
                case 1:
                    if (!piece.bytes.empty()) random(&piece.bytes[at], std::min(length, piece.bytes.size() - at));
                    break;
                case 2:
                    piece.bytes.resize(at);
                    break;
                case 3:
                    piece.bytes.insert(piece.bytes.end(), length, static_cast<unsigned char>(below(256)));
                    break;
                case 4:
                    std::swap(piece, forged.pieces[below(forged.pieces.size())]);
                    break;
                case 5: {
                    const Forged::Piece again = piece;
                    forged.pieces.insert(forged.pieces.begin() + static_cast<std::ptrdiff_t>(below(5)), again);
                    break;
                }
            }
        }
        const Bytes file = forged.file();
        Replay replay(file);
        for (int frame = 0; frame < 5 && replay.next(); ++frame) {
        }
        EXPECT_TRUE(replay.result == TAUT_OK || *taut_last_error() != 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ForgedRecording, testing::Range<uint64_t>(1, 31));

// ---------------------------------------------------------------- the random host

class RecordedHost : public testing::TestWithParam<uint64_t> {};

TEST_P(RecordedHost, ReplaysOnAnyThreads) {
    if (few_starts() && GetParam() % 4 != 0) GTEST_SKIP() << "takes long with sanitizers";
    std::vector<std::unique_ptr<Recording>> recordings;
    {
        ASSERT_OK(taut_bake_keep_defs(1));
        Driver driver(
            random_source(GetParam()),
            [](const char* call, const char* what) { ADD_FAILURE() << call << ": " << what; },
            [&](taut_world world) {
                recordings.push_back(std::make_unique<Recording>());
                const taut_record_def how = recordings.back()->def(TAUT_RECORD_HASH_CALLS);
                ASSERT_OK(taut_world_record(world, &how));
            });
        for (int number = 0; number < 1000; ++number) driver.call();
        ASSERT_OK(taut_bake_keep_defs(0));
    }
    uint64_t calls = 0, frames = 0;
    for (size_t i = 0; i < recordings.size(); ++i)
        for (const uint32_t threads : {1u, 2u, 5u}) {
            Replay replay(recordings[i]->bytes, threads);
            ASSERT_TRUE(is_whole(replay.play()))
                << replay.text() << ", threads " << threads << ": see "
                << recordings[i]->leave("host_" + std::to_string(GetParam()) + "_" + std::to_string(i));
            calls += replay.state.call;
            frames += replay.state.frame;
        }
    EXPECT_GT(calls, 1000u);
    EXPECT_GT(frames, 100u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RecordedHost, testing::Range<uint64_t>(1, 21));

}  // namespace
