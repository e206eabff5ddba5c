// Damping, gravity scale and greatest speeds of bodies, against the solutions of their equations at any step.
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

// How a world steps, whatever the pace of the run.
struct Steps {
    int hz;
    uint32_t substeps;
};

void PrintTo(const Steps& s, std::ostream* out) { *out << s.hz << "_hz_" << s.substeps; }

class Damping : public testing::TestWithParam<Steps> {
protected:
    std::function<void(taut_world_def&)> paced(const Vec& gravity) const {
        return [gravity](taut_world_def& def) {
            def.time_step = 1.0f / static_cast<float>(GetParam().hz);
            def.substeps = GetParam().substeps;
            def.fixed_substeps = 1;
            def.sleeping = 0;
            def.gravity = gravity.narrow();
        };
    }
    // After each tenth of a second, of which there are ten.
    template <class Look>
    void watch(const World& world, Look&& look) const {
        const auto h = static_cast<double>(world.def.time_step);
        for (int frame = 1; frame <= GetParam().hz; ++frame) {
            ok(taut_world_step(world.handle));
            if (frame % (GetParam().hz / 10) == 0) look(frame * h);
        }
    }
};

constexpr double kRound = 3e-7;  // of a velocity read in single precision

// v(t) = v0 e^(-c t).
TEST_P(Damping, DecaysExponentiallyAtAnyStep) {
    World world(paced({0, 0, 0}));
    const Vec v0(3, -8, 1.5);
    struct Mover {
        taut_body body;
        double rate;
    };
    std::vector<Mover> movers;
    for (const double rate : {0.05, 1.0, 7.0, 60.0}) {
        const taut_body box = world.add({.shape = world.box({0.5, 0.3, 0.1}), .velocity = v0, .group = -1});
        const taut_body point = world.particle(2, {0, 50, 0}, v0);
        for (const taut_body body : {box, point}) {
            ok(taut_body_set_damping(body, static_cast<float>(rate), 0));
            movers.push_back({body, rate});
        }
    }
    watch(world, [&](double time) {
        for (const Mover& mover : movers) {
            const Vec exact = std::exp(-static_cast<double>(static_cast<float>(mover.rate)) * time) * v0;
            EXPECT_LT(norm(velocity(mover.body) - exact), kRound * norm(exact)) << mover.rate << "/s at " << time;
        }
    });
}

// v(t) = g / c (1 - e^(-c t)), and of a force F in place of the weight F / (m c) (1 - e^(-c t)).
TEST_P(Damping, ComesToTheSameFinalSpeedAtAnyStep) {
    const Vec g(0, -9.81, 0), force(6, 0, -2);
    World world(paced(g));
    constexpr double kMass = 3;
    for (const float rate : {0.5f, 10.0f, 900.0f}) {
        const double c = static_cast<double>(rate);
        const taut_body box = world.add({.shape = world.box({0.5, 0.3, 0.1}), .mass = kMass, .group = -1});
        const taut_body point = world.particle(kMass, {0, 50, 0});
        const Vec weight = Vec(world.def.gravity);
        for (const taut_body body : {box, point}) ok(taut_body_set_damping(body, rate, 0));
        for (int frame = 1; frame <= GetParam().hz; ++frame) {
            for (const taut_body body : {box, point}) ok(taut_body_apply_force(body, force.narrow(), {0, 0, 0}));
            ok(taut_world_step(world.handle));
            const double time = frame * static_cast<double>(world.def.time_step);
            const Vec exact = -std::expm1(-c * time) / c * (weight + 1 / kMass * force);
            for (const taut_body body : {box, point})
                ASSERT_LT(norm(velocity(body) - exact), 2 * kRound * norm(exact)) << rate << "/s, frame " << frame;
        }
        ok(taut_body_remove(box));
        ok(taut_body_remove(point));
    }
}

// The angular momentum of any body decays by e^(-c t) and keeps its direction; a torque M about a principal axis turns
// it at M / (I c) (1 - e^(-c t)) in the end.
TEST_P(Damping, TakesAngularMomentumAtItsRate) {
    World world(paced({0, 0, 0}));
    const double rate = 1.5;
    const taut_body body =
        world.add({.shape = world.box({0.5, 0.3, 0.1}), .spin = {1.5, 1, 2}, .mass = 7, .group = -1});
    const taut_body driven = world.add({.spin = {0, 0, 0}, .mass = 1, .inertia = {0.5, 0.7, 0.9}});
    ok(taut_body_set_damping(body, 0, 1.5f));
    ok(taut_body_set_damping(driven, 0, 40));
    const taut_sym3 inertia = mass_of(body).inertia;
    const Vec start = spin_momentum(state(body), inertia);
    const auto h = static_cast<double>(world.def.time_step);
    for (int frame = 1; frame <= GetParam().hz; ++frame) {
        ok(taut_body_apply_force(driven, {0, 0, 0}, {0, 0, 9}));
        ok(taut_world_step(world.handle));
        const Vec now = spin_momentum(state(body), inertia), exact = std::exp(-rate * frame * h) * start;
        ASSERT_LT(norm(now - exact), 0.01 * norm(exact)) << "frame " << frame;
        const Vec turns(0, 0, -9 / (0.9 * 40) * std::expm1(-40 * frame * h));
        ASSERT_LT(norm(state(driven).spin - turns), 1e-6 * norm(turns)) << "frame " << frame;
    }
}

// No faster than it may be, and along the same line; what the limit takes is gone.
TEST_P(Damping, KeepsSpeedsWithinTheirLimits) {
    World world(paced({0, -9.81, 0}));
    const taut_body falls = world.add({.shape = world.box({0.5, 0.3, 0.1}), .velocity = {0.3, 0, 0}, .group = -1});
    const taut_body point = world.particle(2, {0, 50, 0}, {0.3, 0, 0});
    const taut_body turns = world.add({.spin = {0, 30, 40}, .mass = 1, .inertia = {1, 1, 1}, .gravity_scale = 0});
    ok(taut_body_set_max_speed(falls, 2.5f, 0));
    ok(taut_body_set_max_speed(point, 2.5f, 0));
    ok(taut_body_set_max_speed(turns, 0, 10));
    watch(world, [&](double time) {
        const double free = std::hypot(0.3, 9.81 * time);
        for (const taut_body body : {falls, point}) {
            EXPECT_LE(norm(velocity(body)), 2.5 * (1 + kRound));
            if (free < 2.4) {
                EXPECT_NEAR(norm(velocity(body)), free, 1e-5);
            }
            if (free > 2.6) {
                EXPECT_NEAR(norm(velocity(body)), 2.5, 1e-6);
            }
        }
        EXPECT_LT(norm(state(turns).spin - Vec(0, 6, 8)), 1e-5);
    });
    // A collision that drives it faster is over when the step ends.
    const double away = norm(position(falls) - Vec(0, 0, 0));
    EXPECT_LT(away, 2.5 * 1.001);
}

INSTANTIATE_TEST_SUITE_P(At, Damping,
                         testing::Values(Steps{30, 1}, Steps{30, 4}, Steps{60, 1}, Steps{60, 4}, Steps{60, 7},
                                         Steps{120, 4}, Steps{240, 1}, Steps{240, 2}),
                         [](const auto& tested) {
                             return std::to_string(tested.param.hz) + "_hz_" + std::to_string(tested.param.substeps);
                         });

// By all schemes and solvers of rows: whoever predicts, the decay is the same.
TEST(DampingOfSchemes, IsTheSame) {
    for (const taut_scheme scheme : {TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2}) {
        World world([&](taut_world_def& def) {
            def.gravity = {0, 0, 0};
            def.scheme = scheme;
        });
        const taut_body body = world.add({.shape = world.box({0.5, 0.3, 0.1}), .velocity = {3, 4, 0}});
        ok(taut_body_set_damping(body, 2, 0));
        world.step(60);
        const double exact = 5 * std::exp(-2 * world.stepped(60));
        EXPECT_NEAR(norm(velocity(body)), exact, 1e-5 * exact) << "scheme " << scheme;
    }
}

// A damped body rests where an undamped one does, and a joint holds it: impulses come whole.
TEST(DampedBody, RestsAndHangsAsAnyOther) {
    World world;
    world.add_ground();
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .mass = 4});
    const taut_body bob = world.add({.shape = world.sphere(0.1), .position = {5, 3, 0}, .mass = 2});
    const taut_joint rod = world.rod({0}, {5, 4, 0}, bob, {}, 1);
    for (const taut_body body : {box, bob}) ok(taut_body_set_damping(body, 5, 5));
    world.step(120);
    EXPECT_LT(norm(velocity(box)), 1e-3);
    EXPECT_NEAR(position(box).y, 0.5, 2e-3);
    taut_vec3 force{};
    ok(taut_joint_get_force(rod, &force));
    const double g = norm(Vec(world.def.gravity));
    EXPECT_NEAR(static_cast<double>(force.y), 2 * g, 0.02 * 2 * g);
}

// From the moment on: x = v t + g s t^2 / 2 to first order in h.
TEST(GravityScale, ChangesWhatABodyFallsBy) {
    World world;
    const taut_body body = world.add({.shape = world.sphere(0.2), .position = {0, 100, 0}});
    for (const double scale : {0.0, -0.5, 2.0}) {
        const Vec before = velocity(body);
        ok(taut_body_set_gravity_scale(body, static_cast<float>(scale)));
        world.step(60);
        const Vec gained = world.stepped(60) * scale * Vec(world.def.gravity);
        EXPECT_LT(norm(velocity(body) - before - gained), 1e-4 * (1 + norm(gained))) << scale;
    }
}

// What others do does not depend on it: their bits are the same.
TEST(DampedBody, LeavesOthersAsTheyAre) {
    const auto run = [](bool beside) {
        World world;
        world.add_ground();
        std::vector<taut_body> boxes;
        for (int i = 0; i < 5; ++i)
            boxes.push_back(world.add({.shape = world.box({0.3, 0.3, 0.3}), .position = {0.1 * i, 0.4 + 0.7 * i, 0}}));
        const taut_body other = world.add({.shape = world.sphere(0.2), .position = {50, 20, 0}});
        if (beside) ok(taut_body_set_damping(other, 3, 3));
        world.step(90);
        std::vector<double> out;
        for (const taut_body body : boxes)
            for (const double number : {position(body).x, position(body).y, position(body).z, velocity(body).y})
                out.push_back(number);
        return out;
    };
    EXPECT_EQ(run(false), run(true));
}

}  // namespace
