// Meshes as games use them: stairs, a moving platform, hills.
#include <algorithm>

#include "physics/surface_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

// Boxes and balls dropped onto stairs, the boxes in another pose each time.
struct StairsDrop {
    float deepest = 0;  // from 2 s on [m]
    int moving = 0;     // boxes faster than 2 cm/s after 10 s, on the stairs
    int sunk = 0;       // boxes below the stairs; what tumbles off the lowest step is neither

    explicit StairsDrop(int drop) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = mesh(world, stairs(10, 0.8, 0.3, 8))});
        const taut_shape box = world.box({0.3, 0.2, 0.25}), ball = world.sphere(0.2);
        std::vector<taut_body> boxes;
        for (int i = 0; i < 12; ++i) {
            const bool is_ball = i % 3 == 2;  // balls roll
            const taut_body body = world.add({.shape = is_ball ? ball : box,
                                              .position = {0.5 + 0.6 * i + 0.01 * drop, 3.8 + 0.05 * i, 1.0 + 0.5 * i},
                                              .rotation = Quat::turn({1, 0.4, 0.2}, i + 0.3 * drop),
                                              .friction = 0.8});
            if (!is_ball) boxes.push_back(body);
        }
        for (int i = 0; i < 600; ++i) {
            world.step();
            if (i > 120) deepest = std::max(deepest, world.profile().penetration);
        }
        for (const taut_body body : boxes) {
            const Vec at = position(body);
            if (at.x < 0) continue;
            moving += norm(velocity(body)) >= 0.02;
            sunk += !(at.y > 0);
        }
    }
};

// Dropped onto stairs a box comes to rest on them, on one step or across the edges, without sinking in. One in forty
// goes on rocking across an edge.
TEST(Stairs, CarryWhatFallsOnThem) {
    constexpr int kDrops = 25, kBoxes = 8;
    std::vector<float> deepest;
    int moving = 0;
    for (int drop = 0; drop < kDrops; ++drop) {
        const StairsDrop fallen(drop);
        deepest.push_back(fallen.deepest);
        moving += fallen.moving;
        EXPECT_EQ(fallen.sunk, 0) << drop;
    }
    std::sort(deepest.begin(), deepest.end());
    EXPECT_LE(moving, kDrops * kBoxes / 20);
    EXPECT_LT(deepest[kDrops - 2], 0.02f);
    EXPECT_LT(deepest.back(), 0.05f);
}

// Thrown onto the edges of steps a box overlaps them for a moment; no face that it only brushes pushes it from afar.
TEST(Stairs, StopABoxThrownOntoTheirEdges) {
    std::vector<float> deepest;
    for (int i = 0; i < 100; ++i) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = mesh(world, stairs(10, 0.8, 0.3, 8))});
        world.add({.shape = world.box({0.3, 0.2, 0.25}),
                   .position = {3.9 + 0.008 * i, 2.9, 4},
                   .rotation = Quat::turn({1, 0.3 + 0.02 * i, 0.5}, 1.4 * i),
                   .velocity = {0, -8, 0}});
        float most = 0;
        for (int k = 0; k < 90; ++k) {
            world.step();
            most = std::max(most, world.profile().penetration);
        }
        deepest.push_back(most);
    }
    std::sort(deepest.begin(), deepest.end());
    EXPECT_LT(deepest[50], 0.015f);
    EXPECT_LT(deepest[90], 0.06f);
    EXPECT_LT(deepest[99], 0.2f);  // 0.1 on stairs of boxes
}

TEST(PlatformOfTriangles, CarriesABox) {
    World world;
    Triangles deck;
    deck.add_box({-3, -0.2, -3}, {3, 0, 3});
    const taut_body platform = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = mesh(world, deck)});
    const taut_body box = world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {0.5, 0.25, 0}, .mass = 20});
    world.step(30);
    const Vec start = position(box) - position(platform);
    double slip = 0;
    const auto frame = static_cast<double>(world.def.time_step);
    for (int i = 1; i <= std::lround(2 / frame); ++i) {
        const double t = i * frame, speed = t < 1 ? 3 * t : 3 * (2 - t);
        ok(taut_body_set_velocity(platform, Vec(speed, 1, 0).narrow(), Vec().narrow()));
        ok(taut_world_step(world.handle));
        slip = std::max(slip, norm(position(box) - position(platform) - start));
    }
    EXPECT_LT(slip, 0.01);
    EXPECT_GT(position(platform).x, 2.5);
}

// Pushed in by up to 0.45 of its height a box comes out above, and does not jump.
TEST(FloorOfTriangles, PushesOutTheFrontWay) {
    for (const double depth : {0.1, 0.3, 0.6}) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = mesh(world, grid(8, 8, 0.5)), .position = {-4, 0, -4}});
        const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0.1, 0.5 - depth, 0.2}});
        double top = 0;
        for (int i = 0; i < 120; ++i) {
            world.step();
            top = std::max(top, position(box).y);
        }
        EXPECT_NEAR(position(box).y, 0.5, 2e-3) << depth;
        EXPECT_LT(top, 0.51) << depth;
    }
}

// Cones whose middle is above it were let through if they stood on their tips' side: the mean of their corners lies
// next to the base.
TEST(FloorOfTriangles, PushesOutWhatIsMadeAcrossIt) {
    std::mt19937 random(1);
    for (int start = 0; start < 60; ++start) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = mesh(world, grid(8, 8, 0.5)), .position = {-4, 0, -4}});
        const taut_shape kinds[] = {world.cone(0.3, 0.3), world.tapered_capsule(0.25, 0.1, 0.2),
                                    world.cylinder(0.3, 0.25)};
        std::vector<taut_body> bodies;
        for (int i = 0; i < 3; ++i)
            bodies.push_back(world.add({.shape = kinds[i],
                                        .position = {1.5 * i - 1.5, between(random, 0, 0.25), between(random, -1, 1)},
                                        .rotation = Quat::turn(random_direction(random), between(random, 0, 6))}));
        double fastest = 0;
        for (int i = 0; i < 120; ++i) {
            world.step();
            for (const taut_body body : bodies) fastest = std::max(fastest, norm(velocity(body)));
        }
        for (int i = 0; i < 3; ++i)
            EXPECT_GT(position(bodies[static_cast<size_t>(i)]).y, 0) << "kind " << i << ", " << start;
        EXPECT_LT(fastest, 4) << start;
    }
}

// With grip a ball rolls over the seams as over a plane.
TEST(Ball, RollsOverSeams) {
    const double radius = 0.3, speed = 8;
    const auto roll = [&](bool plane) {
        World world;
        const taut_shape floor = plane ? world.plane() : mesh(world, grid(26, 4, 0.37));
        world.add({.kind = TAUT_BODY_STATIC, .shape = floor, .position = {-13, 0, -2}});
        const taut_body ball = world.add({.shape = world.sphere(radius), .position = {-6, radius, 0}});
        world.step(20);
        ok(taut_body_set_velocity(ball, Vec(speed, 0, 0).narrow(), Vec(0, 0, -speed / radius).narrow()));
        for (int i = 0; position(ball).x < 4 && i < 200; ++i) world.step();
        return state(ball);
    };
    const BodyState on_plane = roll(true), on_mesh = roll(false);
    EXPECT_LT(norm(on_mesh.velocity - on_plane.velocity), 1e-4 * speed);
    EXPECT_LT(norm(on_mesh.spin - on_plane.spin), 1e-4 * speed / radius);
    EXPECT_LT(std::abs(on_mesh.position.z), 1e-4);
}

// Frictionless down a valley and up again, sampled finely: the height it reaches is the height it came from, within
// what a step adds by going straight where the ground is hollow.
TEST(Ball, KeepsItsEnergyInAHeightField) {
    World world;
    const taut_shape field =
        height_field(world, 11, 401, 0.05, [](double x, double) { return 0.02 * (x - 10) * (x - 10); });
    world.add({.kind = TAUT_BODY_STATIC, .shape = field, .friction = 0});
    const double radius = 0.4;
    const taut_body ball =
        world.add({.shape = world.sphere(radius), .position = {4, 0.02 * 36 + radius * 1.03, 0.26}, .friction = 0});
    const double start = position(ball).y;
    double top = 0;
    for (int i = 0; i < 400; ++i) {
        world.step();
        if (position(ball).x > 10) top = std::max(top, position(ball).y);
    }
    EXPECT_GT(top - radius, 0.98 * (start - radius));
    EXPECT_LT(top - radius, 1.02 * (start - radius));
}

}  // namespace
