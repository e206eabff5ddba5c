// The families of random scenes.
#include <algorithm>
#include <cmath>

#include "physics/tunnel_lab.h"
#include "soak/medley.h"

namespace soak {

using namespace lab;

namespace {

double heavy_mass(Random& random) { return std::pow(10, between(random, 1, 4)); }  // [kg]

// Of any turn, high above the one before.
void rain(Medley& m, Random& random, int count, double spread, double height, int one_heavy_in) {
    for (int i = 0; i < count; ++i) {
        taut_shape shape{};
        const double core = m.light_shape(random, shape);
        const bool heavy = one_heavy_in > 0 && random() % static_cast<uint32_t>(one_heavy_in) == 0;
        m.add({.shape = shape,
               .position = {between(random, -spread, spread), height + 0.35 * i, between(random, -spread, spread)},
               .rotation = Quat::turn(random_direction(random), between(random, 0, 3)),
               .mass = heavy ? heavy_mass(random) : between(random, 0.3, 3)},
              core);
    }
}

// Four wheels, some driven, over rubble.
void truck(Medley& m, Random& random) {
    m.add_ground();
    m.scatter(random, 20, {3, 0, -1.3}, {12, 0, 1.3});
    constexpr double kWheel = 0.4;  // [m]
    const double mass = 90 + heavy_mass(random), speed = between(random, 2, 15);
    const bool round = random() % 2;
    const taut_shape wheel = round ? m.world.sphere(0.6 * kWheel) : m.world.cylinder(kWheel, 0.12);
    const taut_body chassis = m.add({.shape = m.world.box({1.8, 0.3, 0.7}),
                                     .position = {0, kWheel + 0.35, 0},
                                     .velocity = {speed, 0, 0},
                                     .mass = mass},
                                    0.3);
    for (const double x : {-1.3, 1.3})
        for (const double z : {-1.0, 1.0}) {
            const Vec at(x, kWheel - (round ? 0.16 : 0), z);
            const taut_body body = m.add({.shape = wheel,
                                          .position = at,
                                          .rotation = Quat::turn({1, 0, 0}, kPi / 2),
                                          .velocity = {speed, 0, 0},
                                          .mass = std::max(10.0, mass / 50)},
                                         0.12);
            const taut_axis_def axle = random() % 2 ? motor(-speed / kWheel, 3 * mass) : free_axis();
            m.joints.push_back(hinge(m.world, chassis, body, at, {0, 0, 1}, axle));
        }
}

// A ball or drum rolls over rubble.
void roller(Medley& m, Random& random) {
    m.add_ground();
    m.scatter(random, 12, {1.5, 0, -0.6}, {6, 0, 0.6});
    const double radius = between(random, 0.3, 1);
    m.add({.shape = random() % 2 ? m.world.sphere(radius) : m.world.cylinder(radius, 0.8),
           .position = {0, radius, 0},
           .rotation = Quat::turn({1, 0, 0}, kPi / 2),
           .velocity = {between(random, 2, 10), 0, 0},
           .mass = heavy_mass(random)},
          0.3);
}

// A box slides through rubble to a wall.
void shove(Medley& m, Random& random) {
    m.add_ground();
    m.add_fixed(m.world.box({0.5, 2, 5}), {6, 2, 0});
    m.scatter(random, 12, {2, 0, -0.5}, {5, 0, 0.5});
    m.add({.shape = m.world.box({0.5, 0.5, 0.7}),
           .position = {0, 0.5, 0},
           .velocity = {between(random, 3, 15), 0, 0},
           .mass = heavy_mass(random),
           .friction = 0.1},
          0.5);
}

// A load on a plate on four legs that nothing ties.
void table(Medley& m, Random& random) {
    m.add_ground();
    const double half = between(random, 0.1, 0.5);
    for (const double x : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5})
            m.add({.shape = m.world.box({0.05, half, 0.05}), .position = {x, half, z}, .mass = 1}, 0.05);
    m.add({.shape = m.world.box({0.6, 0.03, 0.6}), .position = {0, 2 * half + 0.03, 0}, .mass = 5}, 0.03);
    const double x = between(random, -0.1, 0.1), z = between(random, -0.1, 0.1);
    m.add({.shape = m.world.box({0.3, 0.3, 0.3}),
           .position = {x, 2 * half + 0.36 + between(random, 0, 0.5), z},
           .mass = heavy_mass(random)},
          0.3);
}

// A load on planks between two stands.
void planks(Medley& m, Random& random) {
    m.add_ground();
    for (const double x : {-1.0, 1.0})
        m.add({.shape = m.world.box({0.1, 0.2, 0.3}), .position = {x, 0.2, 0}, .mass = between(random, 1, 20)}, 0.1);
    const int count = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < count; ++i)
        m.add({.shape = m.world.box({1.2, 0.03, 0.25}), .position = {0, 0.43 + 0.06 * i, 0}, .mass = 3}, 0.03);
    m.add({.shape = random() % 2 ? m.world.sphere(0.3) : m.world.box({0.3, 0.3, 0.3}),
           .position = {between(random, -0.3, 0.3), 0.7 + 0.06 * count + between(random, 0, 1), 0},
           .mass = heavy_mass(random)},
          0.3);
}

// A tower of heavy and light boxes.
void sandwich(Medley& m, Random& random) {
    m.add_ground();
    const double mass = heavy_mass(random);
    const int count = 3 + static_cast<int>(random() % 6);
    double top = 0;
    for (int i = 0; i < count; ++i) {
        const double half = between(random, 0.1, 0.4);
        m.add({.shape = m.world.box({0.4, half, 0.4}),
               .position = {between(random, -0.02, 0.02), top + half, between(random, -0.02, 0.02)},
               .mass = random() % 2 ? mass : 1},
              half);
        top += 2 * half;
    }
    m.frames = 300;
}

// Balls, one of them heavy, fall into an open box of 5 kg and rattle about.
void cup(Medley& m, Random& random) {
    m.add_ground();
    constexpr double kHalf = 0.5, kWall = 0.05;
    std::vector<taut_collider_def> walls;
    const auto add_wall = [&](const Vec& position, const Vec& half) {
        taut_collider_def& wall = walls.emplace_back();
        taut_collider_def_init(&wall);
        wall.shape = m.world.box(half);
        wall.position = position.narrow();
    };
    add_wall({0, -0.4, 0}, {kHalf, kWall, kHalf});
    for (const double side : {-kHalf, kHalf}) {
        add_wall({side, 0, 0}, {kWall, 0.45, kHalf});
        add_wall({0, 0, side}, {kHalf, 0.45, kWall});
    }
    taut_body_def def;
    taut_body_def_init(&def);
    def.colliders = walls.data();
    def.collider_count = static_cast<uint32_t>(walls.size());
    def.mass = 5;
    def.position = {0, 0.46, 0};
    m.add_compound(def, kWall);
    const int count = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < count; ++i) {
        const double radius = between(random, 0.1, 0.2), x = between(random, -0.2, 0.2), z = between(random, -0.2, 0.2);
        m.add({.shape = m.world.sphere(radius),
               .position = {x, 0.3 + 0.4 * i + radius, z},
               .velocity = {between(random, -5, 5), 0, between(random, -5, 5)},
               .mass = i == 0 ? heavy_mass(random) : 1},
              radius);
    }
}

// A plate on a motor of half to four times its weight comes down on rubble.
void press(Medley& m, Random& random) {
    m.add_ground();
    m.scatter(random, 10, {-0.5, 0, -0.5}, {0.5, 0, 0.5});
    const double mass = heavy_mass(random);
    const taut_body plate = m.add({.shape = m.world.box({0.8, 0.2, 0.8}), .position = {0, 1.5, 0}, .mass = mass}, 0.2);
    const taut_axis_def drive = motor(-between(random, 0.2, 2), mass * between(random, 5, 40));
    m.joints.push_back(slider(m.world, {}, plate, {0, 1.5, 0}, {0, 1, 0}, drive));
}

// A plate on a motor shoves rubble to a wall.
void shovel(Medley& m, Random& random) {
    m.add_ground();
    m.add_fixed(m.world.box({0.5, 2, 5}), {6, 2, 0});
    m.scatter(random, 12, {1.2, 0, -0.6}, {3.5, 0, 0.6});
    const double mass = heavy_mass(random);
    const taut_body plate = m.add({.shape = m.world.box({0.1, 0.5, 1}), .position = {0, 0.502, 0}, .mass = mass}, 0.1);
    const taut_axis_def drive = motor(between(random, 0.5, 4), 50 * mass);
    m.joints.push_back(slider(m.world, {}, plate, {0, 0.5, 0}, {1, 0, 0}, drive));
}

// A platform heaves light things with a slab on them.
void lift(Medley& m, Random& random) {
    const taut_body platform = m.add_kinematic(m.world.box({2, 0.2, 2}), {0, -0.2, 0});
    m.scatter(random, 8, {-0.6, 0, -0.6}, {0.6, 0, 0.6});
    m.add({.shape = m.world.box({0.8, 0.2, 0.8}), .position = {0, 1, 0}, .mass = heavy_mass(random)}, 0.2);
    m.before_step = [platform, speed = between(random, -2, 4)](int frame) {
        const double up = frame < 60 ? 0 : speed * std::sin(0.03 * (frame - 60));
        ok(taut_body_set_velocity(platform, Vec(0, up, 0).narrow(), {}));
    };
}

// A trunk with limbs lies on the ground; something falls on it.
void doll(Medley& m, Random& random) {
    m.add_ground();
    const taut_body trunk = m.add({.shape = m.world.capsule(0.15, 0.25),
                                   .position = {0, 0.2, 0},
                                   .rotation = Quat::turn({0, 0, 1}, kPi / 2),
                                   .mass = 30},
                                  0.15);
    const auto add_limb = [&](taut_body to, const Vec& joint, const Vec& along, double length, double radius,
                              double mass) {
        const taut_body limb =
            m.add({.shape = m.world.capsule(radius, length / 2 - radius),
                   .position = joint + length / 2 * along,
                   .rotation = Quat::turn(cross({0, 1, 0}, along), std::acos(std::clamp(along.y, -1.0, 1.0))),
                   .mass = mass},
                  radius);
        auto def = at(m.world, taut_cone_twist_joint_def_init, to, limb, joint, along);
        def.swing = limited(0, 1);
        def.twist = limited(-0.5, 0.5);
        def.base.solve = static_cast<taut_joint_solve>(random() % 3);
        ok(taut_world_add_cone_twist_joint(m.world.handle, &def, &m.joints.emplace_back()));
        return limb;
    };
    for (const double z : {-0.15, 0.15}) {
        const taut_body thigh = add_limb(trunk, {0.42, 0.2, z}, {1, 0, 0}, 0.4, 0.08, 8);
        add_limb(thigh, {0.84, 0.2, z}, {1, 0, 0}, 0.4, 0.06, 4);
        add_limb(trunk, {-0.3, 0.2, 1.6 * z}, unit({-0.2, 0, z > 0 ? 1.0 : -1.0}), 0.3, 0.06, 3);
    }
    add_limb(trunk, {-0.42, 0.2, 0}, {-1, 0, 0}, 0.25, 0.1, 5);
    m.add({.shape = random() % 2 ? m.world.box({0.5, 0.5, 0.5}) : m.world.sphere(0.5),
           .position = {between(random, -0.5, 0.5), 0.9 + between(random, 0, 3), between(random, -0.2, 0.2)},
           .velocity = {between(random, -3, 3), 0, 0},
           .mass = heavy_mass(random)},
          0.5);
}

// Something falls or comes sliding on three chains on the ground.
void chains(Medley& m, Random& random) {
    m.add_ground();
    for (const double z : {-0.3, 0.0, 0.3}) {
        taut_body last{};
        for (int i = 0; i < 8; ++i) {
            const taut_body link = m.add({.shape = m.world.capsule(0.04, 0.1),
                                          .position = {-1 + 0.28 * i, 0.05, z},
                                          .rotation = Quat::turn({0, 0, 1}, kPi / 2),
                                          .mass = 0.5},
                                         0.04);
            if (i > 0) m.joints.push_back(m.world.ball(last, {0, -0.14, 0}, link, {0, 0.14, 0}));
            last = link;
        }
    }
    m.add({.shape = random() % 2 ? m.world.box({0.4, 0.4, 0.4}) : m.world.sphere(0.4),
           .position = {between(random, -0.5, 0.5), 0.6 + between(random, 0, 3), between(random, -0.2, 0.2)},
           .velocity = {between(random, -6, 6), 0, 0},
           .mass = heavy_mass(random)},
          0.4);
}

// Something is thrown down on a heap.
void heap(Medley& m, Random& random) {
    m.add_ground();
    rain(m, random, 15, 0.4, 0.3, 0);
    m.world.step(120);
    m.add({.shape = random() % 2 ? m.world.box({0.5, 0.3, 0.5}) : m.world.sphere(0.5),
           .position = {0, 2.5 + between(random, 0, 3), 0},
           .velocity = {0, -between(random, 0, 8), 0},
           .mass = heavy_mass(random)},
          0.3);
}

// Heavy and light things fall into a pit of four triangles.
void pit(Medley& m, Random& random) {
    Triangles triangles;
    constexpr double kHalf = 1.2, kHeight = 1.5;
    const Vec rim[4] = {
        {-kHalf, kHeight, -kHalf}, {kHalf, kHeight, -kHalf}, {kHalf, kHeight, kHalf}, {-kHalf, kHeight, kHalf}};
    for (int i = 0; i < 4; ++i) triangles.add({}, rim[(i + 1) % 4], rim[i]);
    m.add_fixed(mesh(m.world, triangles), {});
    m.add_fixed(m.world.box({30, 1, 30}), {0, -3, 0});  // for what is thrown out
    rain(m, random, 15, 0.4, 1, 4);
    m.frames = 400;
}

// A ball flies at a door of 20 kg with rubble behind it.
void door(Medley& m, Random& random) {
    m.add_ground();
    const taut_body leaf = m.add({.shape = m.world.box({0.5, 1, 0.05}), .position = {0.5, 1.1, 0}, .mass = 20}, 0.05);
    m.joints.push_back(hinge(m.world, {}, leaf, {0, 1.1, 0}, {0, 1, 0}, limited(-1.6, 1.6)));
    m.add_fixed(m.world.box({0.1, 1, 1}), {-0.12, 1, 0});
    const double x = between(random, 0.3, 0.9), y = between(random, 0.4, 1.6);
    m.add({.shape = m.world.sphere(0.3),
           .position = {x, y, -2},
           .velocity = {between(random, -1, 1), 0, between(random, 2, 20)},
           .mass = heavy_mass(random)},
          0.3);
    m.scatter(random, 5, {0.1, 0, 0.3}, {0.9, 0, 2});
    m.frames = 180;
}

// A weight falls on one end of a beam, something light lies on the other.
void seesaw(Medley& m, Random& random) {
    m.add_ground();
    m.add_fixed(m.world.box({0.1, 0.2, 0.5}), {0, 0.2, 0});
    const taut_body beam = m.add({.shape = m.world.box({1.5, 0.04, 0.3}), .position = {0, 0.45, 0}, .mass = 10}, 0.04);
    m.joints.push_back(hinge(m.world, {}, beam, {0, 0.45, 0}, {0, 0, 1}));
    m.add({.shape = m.world.box({0.15, 0.15, 0.15}), .position = {-1.2, 0.65, 0}, .mass = 1}, 0.15);
    m.add({.shape = m.world.box({0.2, 0.2, 0.2}),
           .position = {1.2, 1 + between(random, 0, 2), 0},
           .mass = heavy_mass(random)},
          0.2);
    m.frames = 180;
}

// What does not yield shoves rubble, half of the time with something heavy in it, to a wall and stops before it.
void plough(Medley& m, Random& random) {
    m.add_ground();
    m.add_fixed(m.world.box({0.5, 2, 5}), {6, 2, 0});
    m.scatter(random, 10, {2, 0, -0.5}, {5, 0, 0.5});
    if (random() % 2)
        m.add({.shape = m.world.box({0.3, 0.3, 0.3}), .position = {1.2, 0.3, 0}, .mass = heavy_mass(random)}, 0.3);
    const taut_body blade = m.add_kinematic(m.world.box({0.3, 0.5, 0.8}), {0, 0.52, 0});
    m.before_step = [blade, speed = between(random, 0.5, 6)](int) {
        ok(taut_body_set_velocity(blade, Vec(position(blade).x < 3.5 ? speed : 0, 0, 0).narrow(), {}));
    };
    m.frames = 400;
}

// The same from above, down to 5 cm over the ground, and up again.
void crusher(Medley& m, Random& random) {
    m.add_ground();
    m.scatter(random, 6, {-0.5, 0, -0.5}, {0.5, 0, 0.5});
    if (random() % 2)
        m.add({.shape = m.world.box({0.3, 0.2, 0.3}), .position = {0, 0.8, 0}, .mass = heavy_mass(random)}, 0.2);
    const taut_body plate = m.add_kinematic(m.world.box({1, 0.2, 1}), {0, 2, 0});
    m.before_step = [plate, speed = between(random, 0.2, 4)](int frame) {
        const double up = frame >= 300 ? speed : position(plate).y > 0.25 ? -speed : 0;
        ok(taut_body_set_velocity(plate, Vec(0, up, 0).narrow(), {}));
    };
    m.frames = 500;
}

// A blade turns between four walls that it passes at 5 cm.
void mixer(Medley& m, Random& random) {
    m.add_ground();
    for (int i = 0; i < 4; ++i) {
        const double angle = i * kPi / 2;
        m.add_fixed(m.world.box({0.1, 0.6, 1.3}), 1.2 * Vec(std::cos(angle), 0.5, std::sin(angle)),
                    Quat::turn({0, 1, 0}, -angle));
    }
    rain(m, random, 15, 0.7, 0.5, 5);
    const taut_body blade = m.add_kinematic(m.world.box({1.05, 0.3, 0.05}), {0, 0.31, 0});
    m.before_step = [blade, speed = between(random, 0.5, 8)](int frame) {
        ok(taut_body_set_velocity(blade, {}, Vec(0, frame > 120 ? speed : 0, 0).narrow()));
    };
    m.frames = 600;
}

// About twice what 700 random starts gave at the most, or more.
constexpr Family kFamilies[] = {
    {"truck", truck, {.driven = true, .fastest = 50, .gap = 0.005}},
    {"roller", roller, {.fastest = 30}},
    {"shove", shove, {.fastest = 200}},
    {"table", table, {.fastest = 25}},
    {"planks", planks, {.fastest = 15}},
    {"sandwich", sandwich, {.fastest = 2}},
    {"cup", cup, {.fastest = 30}},
    {"press", press, {.driven = true, .fastest = 15, .gap = 0.001}},
    {"shovel", shovel, {.driven = true, .fastest = 150, .gap = 0.001}},
    {"lift", lift, {.driven = true, .fastest = 40}},
    {"doll", doll, {.fastest = 100, .gap = 0.2}},
    {"chains", chains, {.fastest = 30, .gap = 0.01}},
    {"heap", heap, {.fastest = 100}},
    {"pit", pit, {.fastest = 200}},
    {"door", door, {.fastest = 120, .gap = 0.02}},
    {"seesaw", seesaw, {.fastest = 25, .gap = 0.001}},
    {"plough", plough, {.driven = true, .fastest = 50}},
    {"crusher", crusher, {.driven = true, .leaves_room = false, .fastest = 200}},
    {"mixer", mixer, {.driven = true, .leaves_room = false, .fastest = 1000}},
};

}  // namespace

std::span<const Family> families() { return kFamilies; }

}  // namespace soak
