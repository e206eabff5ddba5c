// Random worlds that fall asleep and are woken over and over: nothing is lost, nothing becomes non-finite.
#include <map>
#include <random>

#include "sleep/sleep_lab.h"

namespace {

using namespace lab;

// Integers alone: distributions of the standard library differ between its makers.
class Dice {
public:
    explicit Dice(uint32_t seed) : bits_(seed) {}
    double between(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(bits_()) / 4294967296.0; }
    size_t below(size_t count) { return static_cast<size_t>(between(0, static_cast<double>(count))); }

private:
    std::mt19937 bits_;
};

struct Zoo {
    World world;
    Dice dice;
    std::vector<taut_body> bodies;
    taut_body platform;

    Zoo(uint32_t seed, uint32_t threads)
        : world([&](taut_world_def& def) { let_sleep(def), def.threads = threads; }), dice(seed) {
        world.add_ground();
        platform = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.box({1, 0.1, 1}), .position = {0, 1, 0}});
        const taut_shape shapes[] = {world.box({0.2, 0.2, 0.2}), world.box({0.4, 0.1, 0.2}), world.sphere(0.2)};
        for (int i = 0; i < 40; ++i) bodies.push_back(throw_in(shapes[dice.below(3)], 0.5));
        for (int i = 0; i + 1 < 8; ++i)
            if (i % 4 != 3) tie(bodies[static_cast<size_t>(i)], bodies[static_cast<size_t>(i) + 1]);
    }
    Vec place(double height) { return {dice.between(-2, 2), dice.between(0.5, height), dice.between(-2, 2)}; }
    taut_body throw_in(taut_shape shape, double speed) {
        const Vec axis(dice.between(-1, 1), dice.between(-1, 1), 1.1);
        return world.add({.shape = shape,
                          .position = place(4),
                          .rotation = Quat::turn(axis, dice.between(0, 3)),
                          .velocity = {dice.between(-speed, speed), 0, dice.between(-speed, speed)}});
    }
    void tie(taut_body a, taut_body b) { world.rod(a, {}, b, {}, std::max(0.3, norm(position(a) - position(b)))); }

    void disturb() {
        const size_t which = dice.below(bodies.size());
        const taut_body body = bodies[which];
        switch (dice.below(6)) {
            case 0:
                ok(taut_body_apply_impulse(body, {0, static_cast<float>(dice.between(10, 100)), 0}, {}));
                break;
            case 1:
                bodies.push_back(throw_in(world.sphere(0.1), 20));
                break;
            case 2:
                ok(taut_body_remove(body));
                bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(which));
                break;
            case 3:
                ok(taut_body_set_velocity(platform, {static_cast<float>(dice.between(-0.3, 0.3)), 0, 0}, {}));
                break;
            case 4:
                ok(taut_body_set_velocity(platform, {}, {}));
                ok(taut_body_set_awake(body, 0));
                break;
            default:
                ok(taut_world_wake_box(world.handle, (position(body) - Vec(1, 1, 1)).pos(), position(body).pos()));
        }
    }
};

class RandomSleep : public testing::TestWithParam<uint32_t> {};

TEST_P(RandomSleep, StaysWholeAndTellsTheTruth) {
    Zoo zoo(GetParam(), 1);
    std::map<uint64_t, bool> told;  // asleep, by what the events said
    uint32_t fell_asleep = 0, woke = 0;
    for (int step = 0; step < 1500; ++step) {
        if (step > 200 && step % 40 == 0) zoo.disturb();
        zoo.world.step();
        const taut_events events = events_of(zoo.world.handle);
        ASSERT_EQ(events.quarantined_count, 0u);
        for (uint32_t i = 0; i < events.fell_asleep_count; ++i) told[events.fell_asleep[i].body.bits] = true;
        for (uint32_t i = 0; i < events.woke_count; ++i) told[events.woke[i].body.bits] = false;
        fell_asleep += events.fell_asleep_count;
        woke += events.woke_count;
        uint32_t awake_now = 0;
        for (taut_body body : zoo.bodies) {
            ASSERT_TRUE(finite(body)) << step;
            ASSERT_GT(position(body).y, -0.5) << step;
            ASSERT_EQ(awake(body), !told[body.bits]) << step;
            awake_now += awake(body);
        }
        ASSERT_EQ(zoo.world.profile().awake, awake_now) << step;
    }
    EXPECT_GT(fell_asleep, 20u);
    EXPECT_GT(woke, 10u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSleep, testing::Range(101u, 117u));

TEST(SleepAndThreads, GiveTheSameBits) {
    const auto hashes = [](uint32_t threads) {
        Zoo zoo(77, threads);
        std::vector<uint64_t> out;
        for (int step = 0; step < 900; ++step) {
            if (step > 200 && step % 40 == 0) zoo.disturb();
            zoo.world.step();
            ok(taut_world_get_state_hash(zoo.world.handle, &out.emplace_back()));
        }
        return out;
    };
    const std::vector<uint64_t> alone = hashes(1);
    for (uint32_t threads : {2u, 3u, 8u}) EXPECT_EQ(hashes(threads), alone) << threads;
}

// Once it has slept and woken for a first time, a world sleeps and wakes without memory.
TEST(SleepAndMemory, TakeNoneAfterTheFirstTime) {
    scenes::Scene scene = scenes::make_scene("pyramid10");
    scene.world.sleeping = 1;
    const scenes::TautWorld world(scene);
    uint32_t fell_asleep = 0;
    for (int round = 0; round < 4; ++round) {
        for (int step = 0; step < 120; ++step) {
            ok(taut_world_step(world.world));
            fell_asleep += events_of(world.world).fell_asleep_count;
            ASSERT_TRUE(round < 2 || world.profile().allocations == 0) << round << ", " << step;
        }
        EXPECT_EQ(world.profile().awake, 0u);
        ok(taut_world_wake_box(world.world, {-99, -99, -99}, {99, 99, 99}));
    }
    EXPECT_EQ(fell_asleep, 4 * 55u);
}

}  // namespace
