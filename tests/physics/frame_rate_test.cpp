// The host's frames are not the world's steps: what a host does once a frame by taut_world_advance means the same at
// any rate of frames.
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "physics/contact_lab.h"

namespace {

using namespace lab;

// Lengths of a host's frames [s]: all alike, or of rate 0 from 4 to 60 ms in no order.
class Frames {
public:
    explicit Frames(int rate) : rate_(rate) {}
    double next() { return rate_ > 0 ? 1.0 / rate_ : any_(random_); }

private:
    int rate_;
    std::mt19937 random_{20240611};
    std::uniform_real_distribution<double> any_{0.004, 0.06};
};

class AtEveryRate : public testing::TestWithParam<int> {
protected:
    // Calls act(time, seconds) before each frame, [time, time + seconds] of the host, and then seen(end, advance).
    template <class Act, class Seen>
    double play(const World& world, double until, Act&& act, Seen&& seen) {
        Frames frames(GetParam());
        double time = 0;
        while (time < until) {
            const double seconds = frames.next();
            act(time, seconds);
            taut_advance done{};
            ok(taut_world_advance(world.handle, seconds, &done));
            EXPECT_EQ(done.dropped, 0);
            steps += done.steps;
            time += seconds;
            seen(time, done);
        }
        return time;
    }

    uint32_t steps = 0;
};

INSTANTIATE_TEST_SUITE_P(Frames, AtEveryRate, testing::Values(24, 30, 60, 144, 240, 0),
                         [](const auto& rate) { return rate.param ? std::to_string(rate.param) + "Hz" : "Irregular"; });

// ---------------------------------------------------------------- forces

// Momentum is F times the host's time, but for what no step has taken yet, and that comes with the next one.
TEST_P(AtEveryRate, AForceGivesItsImpulseOverTheTime) {
    World world([](auto& def) { def.gravity = {0, 0, 0}; });
    const taut_body cart = world.add({.shape = world.box({0.5, 0.4, 0.3}), .mass = 2.5});
    const taut_body grain = world.particle(0.5, {5, 0, 0});
    const taut_body wheel = world.add({.shape = world.sphere(0.5), .position = {0, 5, 0}, .mass = 4});
    const double inertia = 0.4 * 4 * 0.25, frame = world.frame();
    double time = play(
        world, 3,
        [&](double, double) {
            ok(taut_body_apply_force(cart, {3, -2, 1}, {0, 0, 0}));
            ok(taut_body_apply_force(grain, {0, 0.25f, 0}, {0, 0, 0}));
            ok(taut_body_apply_force_at(wheel, {0, 0, -1}, {1.5, 5, 0}));  // 1.5 N m about y
        },
        [&](double now, const taut_advance&) {
            const double taken = steps * frame;
            ASSERT_NEAR(velocity(cart).x, 3 / 2.5 * taken, 2e-6 * (1 + now));
            ASSERT_NEAR(velocity(wheel).z, -0.25 * taken, 2e-6 * (1 + now));
        });
    ok(taut_world_advance(world.handle, frame, nullptr));  // without a force: what is left comes
    EXPECT_NEAR(velocity(cart).x, 3 / 2.5 * time, 1e-5);
    EXPECT_NEAR(velocity(cart).y, -2 / 2.5 * time, 1e-5);
    EXPECT_NEAR(velocity(grain).y, 0.5 * time, 1e-5);
    EXPECT_NEAR(state(wheel).spin.y, 1.5 / inertia * time, 1e-4);
    const Vec last = velocity(cart);
    ok(taut_world_advance(world.handle, 3 * frame, nullptr));
    EXPECT_EQ(norm(velocity(cart) - last), 0) << "no more than that";
}

// A thrust that holds a body up against gravity holds it at any rate, and one that varies gives the integral.
TEST_P(AtEveryRate, AForceThatVariesGivesItsIntegral) {
    World world([](auto& def) { def.gravity = {0, 0, 0}; });
    const taut_body body = world.add({.shape = world.sphere(0.2), .mass = 1});
    double impulse = 0, owed = 0;
    play(
        world, 2,
        [&](double time, double seconds) {
            const float force = static_cast<float>(5 * std::sin(4 * time));
            ok(taut_body_apply_force(body, {0, force, 0}, {0, 0, 0}));
            impulse += static_cast<double>(force) * seconds;
            owed = static_cast<double>(force);
        },
        [&](double, const taut_advance&) {});
    EXPECT_NEAR(velocity(body).y, impulse, 5 * world.frame());
    ok(taut_world_advance(world.handle, world.frame(), nullptr));
    EXPECT_NEAR(velocity(body).y, impulse, 1e-6);
}

// ---------------------------------------------------------------- kinematic bodies

// Led on evenly, a platform is where the host's time has come to in each step, what stands on it never slips, and when
// the host stops it stops at its target.
TEST_P(AtEveryRate, AKinematicBodyIsLedEvenly) {
    World world;
    const Vec speed(1.5, 0, -0.8);
    const double spin = 0.6, frame = world.frame();
    const taut_body platform = world.add(
        {.kind = TAUT_BODY_KINEMATIC, .shape = world.box({3, 0.25, 3}), .position = {0, -0.25, 0}, .friction = 0.5});
    const taut_body box =
        world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {0.5, 0.25, 0}, .mass = 20, .friction = 0.5});
    const auto target_at = [&](double time) {
        return taut_pose{(Vec(0, -0.25, 0) + time * speed).pos(), Quat::turn({0, 1, 0}, spin * time).narrow(), {0, 0}};
    };
    world.step(30);
    const Vec seat = position(box) - position(platform);
    const Vec along = speed + cross({0, spin, 0}, seat);
    ok(taut_body_set_velocity(box, along.narrow(), {0, static_cast<float>(spin), 0}));
    Vec last = position(platform);
    double most_slip = 0, most_jump = 0;
    const double time = play(
        world, 2,
        [&](double now, double seconds) {
            const taut_pose target = target_at(now + seconds);
            ok(taut_body_move_kinematic(platform, &target));
        },
        [&](double now, const taut_advance& done) {
            const double taken = steps * frame;
            const BodyState at = state(platform);
            ASSERT_NEAR(norm(at.position - Vec(target_at(taken).position)), 0, 2e-6) << now;
            ASSERT_NEAR(std::abs(at.rotation.y), std::abs(std::sin(spin * taken / 2)), 2e-6) << now;
            ASSERT_NEAR(norm(at.velocity - speed), 0, 1e-6) << now;
            ASSERT_NEAR(at.spin.y, spin, 1e-4) << now;  // targets are of single precision
            if (done.steps == 0) return;
            ASSERT_NEAR(norm(1 / (done.steps * frame) * (at.position - last) - speed), 0, 1e-5) << now;
            last = at.position;
            const Vec seat_now = at.rotation.rotate_back(position(box) - at.position);
            most_slip = std::max(most_slip, norm(seat_now - seat));
            const Vec v = velocity(box) - at.velocity - cross(at.spin, position(box) - at.position);
            most_jump = std::max(most_jump, norm(v));
        });
    EXPECT_LT(most_slip, 0.002);
    EXPECT_LT(most_jump, 0.01);
    const taut_pose target = target_at(time);
    for (int i = 0; i < 2; ++i) {
        ok(taut_body_move_kinematic(platform, &target));
        ok(taut_world_advance(world.handle, 1.5 * frame, nullptr));
    }
    EXPECT_NEAR(norm(position(platform) - Vec(target.position)), 0, 1e-9);
    EXPECT_NEAR(norm(velocity(platform)), 0, 1e-9);
}

// A passenger of a lift that stops and goes is pushed by no more than the lift accelerates, at any rate of frames: a
// speed that jumped between none and twice would throw it off.
TEST_P(AtEveryRate, ALiftCarriesSmoothly) {
    World world;
    const taut_body lift = world.add(
        {.kind = TAUT_BODY_KINEMATIC, .shape = world.box({1, 0.1, 1}), .position = {0, -0.1, 0}, .friction = 0.5});
    const taut_body box = world.add({.shape = world.box({0.2, 0.3, 0.2}), .position = {0, 0.3, 0}, .mass = 5});
    world.step(30);
    // 1 m up and down with 2.5 m/s^2 at most.
    const auto height = [](double t) { return 0.5 - 0.5 * std::cos(std::sqrt(5.0) * t); };
    double most = 0;
    play(
        world, 6,
        [&](double now, double seconds) {
            const taut_pose target{{0, height(now + seconds) - 0.1, 0}, {0, 0, 0, 1}, {0, 0}};
            ok(taut_body_move_kinematic(lift, &target));
        },
        [&](double, const taut_advance&) {
            most = std::max(most, std::abs(position(box).y - position(lift).y - 0.4));
        });
    EXPECT_LT(most, 0.002) << "the box left the lift";
}

// The velocity stays until it is changed, and a target waits for a call that takes time.
TEST_P(AtEveryRate, AKinematicBodyGoesOnAtItsSpeed) {
    World world;
    const double frame = world.frame();
    const taut_body body = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.sphere(0.2), .position = {3, 1, 2}});
    const taut_pose target{{3.2, 1, 1.6}, {0, 0, 0, 1}, {0, 0}};
    ok(taut_body_move_kinematic(body, &target));
    ok(taut_world_advance(world.handle, 0, nullptr));
    EXPECT_EQ(position(body).x, 3);
    double start = 0;
    const double time = play(
        world, 1, [](double, double) {},
        [&](double now, const taut_advance&) {
            if (start == 0) start = now;
            const double taken = steps * frame;
            ASSERT_NEAR(position(body).x, 3 + 0.2 * taken / start, 1e-6);
            ASSERT_NEAR(position(body).z, 2 - 0.4 * taken / start, 1e-6);
        });
    EXPECT_GT(time, 0.99);
    ok(taut_body_set_velocity(body, {0, 1, 0}, {0, 0, 0}));
    const Vec at = position(body);
    ok(taut_world_advance(world.handle, 3 * frame, nullptr));
    EXPECT_NEAR(position(body).x, at.x, 1e-9);
    EXPECT_GT(position(body).y, at.y + 2 * frame);
}

// ---------------------------------------------------------------- events

struct Told {
    int begins = 0, ends = 0, hits = 0, enters = 0, leaves = 0, broken = 0, slept = 0, woke = 0;
    std::map<uint64_t, int> hits_of;
    bool operator==(const Told&) const = default;
};

// Twenty balls fall through a sensor onto the ground, one after another. A rope breaks, and what it held falls.
struct Rain {
    static constexpr int kBalls = 20;

    World world{[](auto& def) {
        def.contact_events = TAUT_CONTACT_EVENTS_BEGIN_END | TAUT_CONTACT_EVENTS_HIT;
        def.sleeping = 1;
        def.sleep_time = 0.3f;
    }};
    std::vector<taut_body> balls;

    Rain() {
        world.add_ground();
        const taut_body gate =
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({30, 0.05, 1}), .position = {0, 1, 0}});
        ok(taut_collider_set_sensor(collider_of(gate), 1));
        for (int i = 0; i < kBalls; ++i)
            balls.push_back(world.add({.shape = world.sphere(0.1),
                                       .position = {-10.0 + i, 1.5 + 0.31 * i, 0},
                                       .rolling = 0.01,
                                       .spinning = 0.01}));
        taut_distance_joint_def def;
        taut_distance_joint_def_init(&def);
        def.base.body_b = world.add({.shape = world.box({0.3, 0.3, 0.3}), .position = {0, 20, 0}, .mass = 10});
        def.base.frame_a.position = {0, 22, 0};
        def.length = 2;
        def.base.break_force = 90;  // less than it weighs
        taut_joint rope{};
        ok(taut_world_add_distance_joint(world.handle, &def, &rope));
    }
    void read(Told& told, bool steps_taken) {
        const taut_events e = events_of(world);
        EXPECT_TRUE(steps_taken || (e.steps == 0 && e.begin_count + e.hit_count + e.end_count + e.moved_count == 0));
        EXPECT_EQ(e.dropped_steps, 0u);
        told.begins += e.begin_count;
        told.ends += e.end_count;
        told.hits += e.hit_count;
        told.enters += e.sensor_enter_count;
        told.leaves += e.sensor_leave_count;
        told.broken += e.broken_count;
        told.slept += e.fell_asleep_count;
        told.woke += e.woke_count;
        for (uint32_t i = 0; i < e.hit_count; ++i)  // by slot and generation, not by world
            ++told.hits_of[std::max(e.hit[i].body_a.bits, e.hit[i].body_b.bits) >> 24];
    }
};

TEST_P(AtEveryRate, EachEventIsToldOnce) {
    Told stepped;
    Rain by_steps;
    for (int i = 0; i < 240; ++i) {
        by_steps.world.step();
        by_steps.read(stepped, true);
    }
    ASSERT_GE(stepped.hits, Rain::kBalls + 1);
    ASSERT_GE(stepped.begins, Rain::kBalls + 1);
    ASSERT_EQ(stepped.broken, 1);
    ASSERT_GE(stepped.enters, Rain::kBalls);
    ASSERT_GT(stepped.slept, 0);

    Told told;
    Rain rain;
    Frames frames(GetParam());
    for (uint32_t taken = 0; taken < 240;) {
        // The last frame brings no step too many.
        taut_advance done{};
        ok(taut_world_advance(rain.world.handle, std::min(frames.next(), (240 - taken) / 60.0), &done));
        taken += done.steps;
        rain.read(told, done.steps > 0);
    }
    EXPECT_EQ(told, stepped);
    for (size_t i = 0; i < rain.balls.size(); ++i)
        EXPECT_EQ(norm(position(rain.balls[i]) - position(by_steps.balls[i])), 0) << i;
}

// What rests pushes the ground by its weight, whoever counts and how often.
TEST_P(AtEveryRate, ImpulsesOfARestAreWeightTimesTime) {
    World world([](auto& def) { def.contact_events = TAUT_CONTACT_EVENTS_ALL; });
    world.add_ground();
    world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .mass = 30});
    world.step(60);
    events_of(world);
    double impulse = 0;
    play(
        world, 2, [](double, double) {},
        [&](double, const taut_advance&) {
            const taut_events e = events_of(world);
            for (uint32_t i = 0; i < e.point_count; ++i) impulse += static_cast<double>(e.points[i].normal_impulse);
        });
    EXPECT_NEAR(impulse / (30 * kG * steps * world.frame()), 1, 0.002);
}

// The loop that README.md shows: what it draws is what there is, and the same at every rate.
TEST_P(AtEveryRate, TheLoopDrawsWhatThereIs) {
    const auto build = [](const World& world, std::vector<taut_body>& bodies) {
        world.add_ground();
        const taut_shape cube = world.box({0.5, 0.5, 0.5});
        for (int i = 0; i < 5; ++i) bodies.push_back(world.add({.shape = cube, .position = {0, 0.5 + i, 0}}));
        taut_body end{};
        for (int i = 1; i <= 10; ++i) {
            const taut_body next =
                world.add({.shape = cube, .position = {9.0 + i, 12, 0}, .mass = i < 10 ? 1.0 : 1000.0});
            world.ball(end, i == 1 ? Vec(9.5, 12, 0) : Vec(0.5, 0, 0), next, {-0.5, 0, 0});
            bodies.push_back(end = next);
        }
    };
    constexpr uint32_t kSteps = 200;
    World plain, world;
    std::vector<taut_body> expected, bodies;
    build(plain, expected);
    build(world, bodies);
    plain.step(kSteps);
    std::map<uint64_t, taut_pose> drawn;
    Frames frames(GetParam());
    double time = 0;
    for (uint32_t taken = 0; taken < kSteps;) {
        const double seconds = std::min(frames.next(), (kSteps - taken) / 60.0);
        taut_advance done{};
        ok(taut_world_advance(world.handle, seconds, &done));
        time += seconds;
        taken += done.steps;
        const taut_events events = events_of(world);
        for (uint32_t i = 0; i < events.moved_count; ++i) drawn[events.moved[i].body.bits] = events.moved[i].pose;
    }
    for (size_t i = 0; i < bodies.size(); ++i) {
        EXPECT_EQ(norm(position(bodies[i]) - position(expected[i])), 0) << i;
        ASSERT_TRUE(drawn.count(bodies[i].bits)) << i;
        EXPECT_EQ(norm(Vec(drawn[bodies[i].bits].position) - position(bodies[i])), 0) << i;
    }
}

// Between steps the drawn pose of what moves evenly moves evenly too, one step behind the host.
TEST_P(AtEveryRate, DrawnPosesMoveEvenly) {
    World world([](auto& def) { def.gravity = {0, 0, 0}; });
    const taut_body ball = world.add({.shape = world.sphere(0.1), .velocity = {2, 0, 0}});
    const taut_body sledge =
        world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.sphere(0.1), .position = {0, 3, 0}});
    play(
        world, 1,
        [&](double now, double seconds) {
            const taut_pose target{{2 * (now + seconds), 3, 0}, {0, 0, 0, 1}, {0, 0}};
            ok(taut_body_move_kinematic(sledge, &target));
        },
        [&](double now, const taut_advance&) {
            if (now < 2 * world.frame()) return;
            for (const taut_body body : {ball, sledge}) {
                taut_pose pose{};
                ok(taut_body_get_render_pose(body, &pose));
                ASSERT_NEAR(pose.position.x, 2 * (now - world.frame()), 3e-6) << now;
            }
        });
}

// ---------------------------------------------------------------- alone

// What begins and ends between two readings is told in the order in which it came.
TEST(Events, ComeInTheOrderOfTheirSteps) {
    World world([](auto& def) {
        def.gravity = {0, 0, 0};
        def.contact_events = TAUT_CONTACT_EVENTS_ALL;
    });
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.1, 1, 1}), .position = {1, 0, 0}, .restitution = 1});
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.1, 1, 1}), .position = {-1, 0, 0}, .restitution = 1});
    const taut_body gate = world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.02, 1, 1})});
    ok(taut_collider_set_sensor(collider_of(gate), 1));
    const taut_body puck =
        world.add({.shape = world.sphere(0.3), .position = {-0.4, 0, 0}, .velocity = {7, 0, 0}, .restitution = 1});
    constexpr uint32_t kSteps = 55;
    world.step(kSteps);
    const taut_events e = events_of(world);
    EXPECT_EQ(e.steps, kSteps);
    EXPECT_EQ(e.dropped_steps, 0u);
    ASSERT_GE(e.begin_count, 3u);
    ASSERT_GE(e.sensor_enter_count, 3u);
    int touching = 0, inside = 0;
    uint32_t b = 0, d = 0, in = 0, out = 0;
    for (uint32_t step = 0; step < e.steps; ++step) {
        for (; d < e.end_count && e.end[d].step == step; ++d) --touching;
        for (; b < e.begin_count && e.begin[b].step == step; ++b) ++touching;
        for (; out < e.sensor_leave_count && e.sensor_leave[out].step == step; ++out) --inside;
        for (; in < e.sensor_enter_count && e.sensor_enter[in].step == step; ++in) ++inside;
        EXPECT_TRUE(touching == 0 || touching == 1) << step;
        EXPECT_TRUE(inside == 0 || inside == 1) << step;
    }
    EXPECT_EQ(b, e.begin_count);
    EXPECT_EQ(d, e.end_count);
    EXPECT_EQ(in, e.sensor_enter_count);
    EXPECT_EQ(out, e.sensor_leave_count);
    // Points belong to their own events: each pushes the puck by what its bounce took.
    for (uint32_t i = 0; i < e.begin_count; ++i) {
        ASSERT_LT(e.begin[i].first_point, e.point_count);
        EXPECT_NEAR(std::abs(e.points[e.begin[i].first_point].position.x), 0.9, 0.05);
        const bool right = e.begin[i].collider_a.bits == e.begin[0].collider_a.bits;
        EXPECT_EQ(e.points[e.begin[i].first_point].position.x > 0, right) << i;
    }
    EXPECT_EQ(e.moved_count, 1u);
    EXPECT_EQ(Vec(e.moved[0].pose.position).x, position(puck).x);
}

// One step by hand: the force over that step, the target at its end, beside the frames' time.
TEST(Steps, ByHandMeanWhatTheySay) {
    World world([](auto& def) { def.gravity = {0, 0, 0}; });
    const double frame = world.frame();
    const taut_body body = world.add({.shape = world.sphere(0.5), .mass = 2});
    const taut_body led = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.sphere(0.5), .position = {0, 5, 0}});
    ok(taut_body_apply_force(body, {6, 0, 0}, {0, 0, 0}));
    ok(taut_world_advance(world.handle, 0.5 * frame, nullptr));  // waits with its half
    EXPECT_EQ(velocity(body).x, 0);
    ok(taut_body_apply_force(body, {0, 6, 0}, {0, 0, 0}));
    const taut_pose target{{1, 5, 0}, {0, 0, 0, 1}, {0, 0}};
    ok(taut_body_move_kinematic(led, &target));
    world.step();
    EXPECT_NEAR(velocity(body).y, 3 * frame, 1e-7);
    EXPECT_EQ(velocity(body).x, 0);
    EXPECT_NEAR(position(led).x, 1, 1e-12);
    ok(taut_body_set_velocity(led, {0, 0, 0}, {0, 0, 0}));
    ok(taut_world_advance(world.handle, 0.5 * frame, nullptr));
    EXPECT_NEAR(velocity(body).x, 0.5 * 3 * frame, 1e-7);
    world.step();
    EXPECT_NEAR(velocity(body).x, 0.5 * 3 * frame, 1e-7);
    EXPECT_NEAR(velocity(body).y, 3 * frame, 1e-7);
    ok(taut_body_apply_impulse(body, {0, 0, 1}, {0, 0, 0}));
    EXPECT_NEAR(velocity(body).z, 0.5, 1e-7) << "at once";
    ok(taut_world_advance(world.handle, 3.2 * frame, nullptr));
    EXPECT_NEAR(velocity(body).z, 0.5, 1e-7) << "and once";
}

// Time that a slow frame gives up takes its force with it; the target is reached.
TEST(Steps, GivenUpTakeNoForceAndReachTheTarget) {
    World world([](auto& def) {
        def.gravity = {0, 0, 0};
        def.max_catch_up = 3;
    });
    const double frame = world.frame();
    const taut_body body = world.add({.shape = world.sphere(0.5), .mass = 1});
    const taut_body led = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.sphere(0.5), .position = {0, 5, 0}});
    ok(taut_body_apply_force(body, {1, 0, 0}, {0, 0, 0}));
    const taut_pose target{{1, 5, 0}, {0, 0, 0, 1}, {0, 0}};
    ok(taut_body_move_kinematic(led, &target));
    taut_advance done{};
    ok(taut_world_advance(world.handle, 10 * frame, &done));
    EXPECT_EQ(done.steps, 3u);
    EXPECT_NEAR(done.dropped, 7 * frame, 1e-12);
    EXPECT_NEAR(velocity(body).x, 3 * frame, 1e-7);
    EXPECT_NEAR(position(led).x, 1, 1e-9);
    EXPECT_NEAR(velocity(led).x, 1 / (10 * frame), 1e-6) << "it goes on as fast as the host moves it";
}

}  // namespace
