// A light body between a far heavier one and something else, as the heavy one arrives.
#include <algorithm>
#include <random>

#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"
#include "starts.h"

namespace lab {
namespace {

enum class Light { ball, cube };

struct Box {
    Vec centre, half;
    Quat rotation;

    // Of a ball, in it [m].
    double depth_of(const Vec& ball, double radius) const {
        const Vec at = rotation.rotate_back(ball - centre);
        const Vec over(std::abs(at.x) - half.x, std::abs(at.y) - half.y, std::abs(at.z) - half.z);
        const double inside = std::max({over.x, over.y, over.z});
        const Vec outside(std::max(0.0, over.x), std::max(0.0, over.y), std::max(0.0, over.z));
        return radius - (inside > 0 ? norm(outside) : inside);
    }
};

// A heavy box and light bodies of 1 kg, balls or cubes, before a static box.
struct Press {
    World w;
    Box heavy_box, stand;
    double mass, radius;
    taut_body heavy{};
    std::vector<taut_body> light;
    double depth = 0;   // of the ball in a light body, in either, at the most so far, in parts of its radius
    double energy = 0;  // of the heavy one's motion, at the most after it was stopped, in parts of what it came with

    Press(double gravity, const Box& moving, const Box& fixed, double of_heavy, double of_light)
        : w([&](taut_world_def& def) {
              def.gravity = {0, static_cast<float>(-gravity), 0};
          }),
          heavy_box(moving),
          stand(fixed),
          mass(of_heavy),
          radius(of_light) {
        w.add({.kind = TAUT_BODY_STATIC, .shape = w.box(fixed.half), .position = fixed.centre});
    }
    void add_light(Light kind, const Vec& position) {
        const taut_shape shape = kind == Light::ball ? w.sphere(radius) : w.box({radius, radius, radius});
        light.push_back(w.add({.shape = shape, .position = position, .mass = 1}));
    }
    void add_heavy(const Vec& velocity) {
        heavy =
            w.add({.shape = w.box(heavy_box.half), .position = heavy_box.centre, .velocity = velocity, .mass = mass});
    }
    // A ball joint in the middle of the one.
    void tie(taut_body one, taut_body other, taut_joint_solve solve) {
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_a = one;
        def.base.body_b = other;
        def.base.frame_b.position = (position(one) - position(other)).pos();
        def.base.solve = solve;
        taut_joint joint{};
        ok(taut_world_add_ball_joint(w.handle, &def, &joint));
    }
    double kinetic() const {
        const BodyState now = state(heavy);
        const Vec v = now.velocity, s = now.rotation.rotate_back(now.spin), h = heavy_box.half;
        const Vec inertia = mass / 3 * Vec(h.y * h.y + h.z * h.z, h.x * h.x + h.z * h.z, h.x * h.x + h.y * h.y);
        return 0.5 * (mass * dot(v, v) + inertia.x * s.x * s.x + inertia.y * s.y * s.y + inertia.z * s.z * s.z);
    }
    void run(int frames) {
        double came = kinetic();
        bool stopped = false;
        for (int i = 0; i < frames; ++i) {
            w.step();
            const double now = kinetic();
            stopped = stopped || now < 0.9 * came;
            if (stopped)
                energy = std::max(energy, now / came);
            else
                came = std::max(came, now);
            look();
        }
    }
    void look() {
        const Box now = {position(heavy), heavy_box.half, state(heavy).rotation};
        for (const taut_body body : light)
            for (const Box& box : {now, stand}) depth = std::max(depth, box.depth_of(position(body), radius) / radius);
    }
};

struct Outcome {
    double depth, energy;  // as in Press
};

// A slab of 2 m falls on pebbles that lie on the ground, some of them tied together in pairs.
Outcome slab_on(Light kind, double mass, std::mt19937& random, uint32_t ties, taut_joint_solve solve) {
    const double radius = between(random, 0.02, 0.06), height = between(random, 0.05, 4);
    const Box slab = {{0, 2 * radius + 0.1 + height, 0}, {1, 0.1, 1}, {}}, ground = {{0, -1, 0}, {5, 1, 5}, {}};
    Press press(kG, slab, ground, mass, radius);
    const int count = 4 + static_cast<int>(random() % 40);
    for (int i = 0; i < count; ++i)
        press.add_light(kind, {between(random, -0.9, 0.9), radius, between(random, -0.9, 0.9)});
    for (size_t i = 0; i < ties && 2 * i + 1 < press.light.size(); ++i)
        press.tie(press.light[2 * i], press.light[2 * i + 1], solve);
    press.add_heavy({});
    press.run(150);
    return {press.depth, press.energy};
}

Outcome slab_on_pebbles(Light kind, double mass, std::mt19937& random) {
    return slab_on(kind, mass, random, 0, TAUT_JOINT_SOLVE_DIRECT);
}
Outcome slab_on_tied_pebbles(Light kind, double mass, std::mt19937& random) {
    const uint32_t ties = 1 + random() % 6;
    return slab_on(kind, mass, random, ties, random() % 2 ? TAUT_JOINT_SOLVE_DIRECT : TAUT_JOINT_SOLVE_BY_LOAD);
}

// A box of 1 m flies against a wall, free of weight, with light ones before that.
Outcome box_at_wall(Light kind, double mass, std::mt19937& random) {
    const double radius = between(random, 0.02, 0.12), speed = between(random, 1, 12);
    const Box box = {{-1 - 2 * radius - between(random, 0, 0.2), 0, 0}, {0.5, 0.5, 0.5}, {}},
              wall = {{0.5, 0, 0}, {0.5, 3, 3}, {}};
    Press press(0, box, wall, mass, radius);
    const int count = 1 + static_cast<int>(random() % 6);
    for (int i = 0; i < count; ++i)
        press.add_light(kind, {-radius - 0.001, between(random, -0.4, 0.4), between(random, -0.4, 0.4)});
    press.add_heavy({speed, 0, 0});
    press.run(60);
    return {press.depth, press.energy};
}

// A box of 1 m slides over the ground and shoves a dozen light bodies before it to a wall.
struct Shove {
    double fastest = 0;  // of the light ones, in parts of the speed that the box came with
    double energy = 0;   // kinetic and of height, at the most, less what came, in parts of that
};

std::vector<taut_body> add_rubble_before_a_wall(World& w, Light kind, std::mt19937& random) {
    w.add({.kind = TAUT_BODY_STATIC, .shape = w.box({30, 1, 30}), .position = {0, -1, 0}});
    w.add({.kind = TAUT_BODY_STATIC, .shape = w.box({0.5, 2, 5}), .position = {6, 2, 0}});
    std::vector<taut_body> bodies;
    for (int i = 0; i < 12; ++i) {
        const double radius = between(random, 0.03, 0.12);
        const Vec at(2 + 0.24 * i, 1.5 * radius, between(random, -0.5, 0.5));
        const taut_shape shape = kind == Light::ball ? w.sphere(radius) : w.box({radius, radius, radius});
        const Quat turn = Quat::turn(random_direction(random), between(random, 0, 1));
        bodies.push_back(w.add({.shape = shape, .position = at, .rotation = turn, .mass = between(random, 0.3, 3)}));
    }
    return bodies;
}

Shove shove(Light kind, double mass, std::mt19937& random) {
    World w;
    std::vector<taut_body> bodies = add_rubble_before_a_wall(w, kind, random);
    const double speed = between(random, 3, 15);
    bodies.push_back(w.add({.shape = w.box({0.5, 0.5, 0.7}),
                            .position = {0, 0.5, 0},
                            .velocity = {speed, 0, 0},
                            .mass = mass,
                            .friction = 0.1}));
    const auto energy = [&] {
        const Totals all = totals(bodies);
        return all.kinetic + kG * all.height;
    };
    const double came = energy(), kinetic = totals(bodies).kinetic;
    Shove out;
    for (int frame = 0; frame < 150; ++frame) {
        w.step();
        out.energy = std::max(out.energy, (energy() - came) / kinetic);
        for (size_t i = 0; i + 1 < bodies.size(); ++i)
            out.fastest = std::max(out.fastest, norm(velocity(bodies[i])) / speed);
    }
    return out;
}

// What does not yield at all: a plough goes on at its speed until it stands before the wall, a cube of 10 kg to 10 t
// lies in the rubble. How fast any of it was, in parts of the plough's speed.
double plough(Light kind, std::mt19937& random) {
    World w;
    std::vector<taut_body> bodies = add_rubble_before_a_wall(w, kind, random);
    bodies.push_back(w.add(
        {.shape = w.box({0.3, 0.3, 0.3}), .position = {1.3, 0.3, 0}, .mass = std::pow(10, between(random, 1, 4))}));
    const taut_body blade =
        w.add({.kind = TAUT_BODY_KINEMATIC, .shape = w.box({0.3, 0.5, 0.8}), .position = {0, 0.52, 0}});
    const double speed = between(random, 1, 6);
    double fastest = 0;
    for (int frame = 0; frame < 360; ++frame) {
        const double moves = position(blade).x < 5.1 ? speed : 0;
        ok(taut_body_set_velocity(blade, Vec(moves, 0, 0).narrow(), {}));
        w.step();
        for (const taut_body body : bodies) fastest = std::max(fastest, norm(velocity(body)) / speed);
    }
    return fastest;
}

class HeavyOn : public testing::TestWithParam<Light> {
protected:
    // Of random starts none sinks in by more than a part of the radius, nor comes back faster than it came.
    void expect_none_sinks_in(Outcome (*scene)(Light kind, double mass, std::mt19937& random)) const {
        for (const double mass : {30.0, 1e3, 1e4, 1e5}) {
            std::mt19937 random(7);
            for (int start = 0; start < starts(16); ++start) {
                const Outcome came = scene(GetParam(), mass, random);
                EXPECT_LT(came.depth, 0.31) << mass << " kg, start " << start;
                EXPECT_LT(came.energy, 1) << mass << " kg, start " << start;
            }
        }
    }
};

// Swept, because the slab had its own contact with the ground ahead: it sank in in 155 of 480 starts.
TEST_P(HeavyOn, PebblesStopsOnThem) { expect_none_sinks_in(slab_on_pebbles); }

// With joints about, and pebbles flew apart where those were swept while they carried little.
TEST_P(HeavyOn, TiedPebblesStopsOnThem) { expect_none_sinks_in(slab_on_tied_pebbles); }

// Here in 134, and in 16 it came back with up to five times its energy.
TEST_P(HeavyOn, WhatIsBeforeAWallStopsThere) { expect_none_sinks_in(box_at_wall); }

// Cubes gained energy in 95 of 240 starts, 40 of these with 100 t, and left with up to 19000 times the box's speed.
TEST_P(HeavyOn, RubbleThrowsNoneOfIt) {
    for (const double mass : {100.0, 1e3, 1e4}) {
        std::mt19937 random(7);
        for (int start = 0; start < starts(16); ++start) {
            const Shove came = shove(GetParam(), mass, random);
            EXPECT_LT(came.fastest, 20) << mass << " kg, start " << start;
            EXPECT_LT(came.energy, 1e-3) << mass << " kg, start " << start;
        }
    }
}

// In 216 of 240 starts some of it left at more than 20 times the plough's speed, at up to 38000 times.
TEST_P(HeavyOn, RubbleIsHardlyThrownByWhatDoesNotYield) {
    std::mt19937 random(7);
    int fast = 0;
    for (int start = 0; start < starts(32); ++start) {
        const double came = plough(GetParam(), random);
        EXPECT_LT(came, 100) << "start " << start;
        fast += came > 20;
    }
    EXPECT_LE(fast, 4);
}

INSTANTIATE_TEST_SUITE_P(Light, HeavyOn, testing::Values(Light::ball, Light::cube),
                         [](const auto& of) { return of.param == Light::ball ? "balls" : "cubes"; });

}  // namespace
}  // namespace lab
