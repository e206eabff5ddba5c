// Contacts of deformables by minimisation: ways out of obstacles, penalties within meshes and each other, friction,
// what is told of them, and what is refused (Gast and Schroeder 2014, sections 3.2 and 5).
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

World filming(double rate = 24, const std::function<void(taut_world_def&)>& change = {}) {
    return World([&](taut_world_def& def) {
        def.solver = TAUT_SOLVER_MINIMISATION;
        def.time_step = static_cast<float>(1 / rate);
        def.substeps = 1;
        if (change) change(def);
    });
}

// A cube of rubber of 0.2 m a side, its least corner there.
taut_solid add_cube(const World& world, const Vec& corner, const std::function<void(taut_solid_def&)>& change = {},
                    int nodes = 4, bool hexahedra = false) {
    Beam cube({0.2, 0.2, 0.2}, nodes, nodes, nodes, hexahedra);
    for (taut_pos& p : cube.points) p = (Vec(p) + corner).pos();
    taut_solid_def def = cube.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3);
    def.density = 1000;
    if (change) change(def);
    return add(world, def);
}
constexpr double kCubeMass = 8;  // [kg]

double least_height(taut_solid solid) {
    double least = 1e9;
    for (const Vec& p : points_of(solid)) least = std::min(least, p.y);
    return least;
}
Vec middle_of(taut_solid solid) {
    const std::vector<Vec> points = points_of(solid);
    Vec sum;
    for (const Vec& p : points) sum += p;
    return 1.0 / static_cast<double>(points.size()) * sum;
}
double contact_impulse(const World& world) {
    double sum = 0;
    for (const taut_contact& contact : world.contacts()) sum += contact.normal_impulse;
    return sum;
}

// ---------------------------------------------------------------- obstacles

class AtRate : public testing::TestWithParam<double> {};

// At rest no vertex is below the ground, nor further above than the radius of its sphere, and the ground bears its
// weight.
TEST_P(AtRate, CubeRestsOnTheGround) {
    const World world = filming(GetParam());
    world.add_ground();
    const taut_solid cube = add_cube(world, {0, 0.3, 0});
    double deepest = 1;
    for (int i = 0; i < 3 * GetParam(); ++i) {
        world.step();
        deepest = std::min(deepest, least_height(cube));
    }
    EXPECT_GE(deepest, 0);
    EXPECT_LT(least_height(cube), 0.02);
    EXPECT_NEAR(contact_impulse(world) * GetParam(), kCubeMass * 9.81, 0.01 * kCubeMass * 9.81);
    for (const taut_contact& contact : world.contacts()) EXPECT_GT(contact.normal.y * contact.normal.y, 0.99);
    EXPECT_LT(norm(momentum_of(bodies_of(cube))), 1e-3 * kCubeMass);
}

// A cube on a slope of 0.4 rad stays below tan 0.4 = 0.42, and slides with g (sin - mu cos) above. Friction after the
// solve stops vertices of the surface alone, so that at long steps what is above them creeps.
TEST_P(AtRate, CubeOnASlope) {
    const double slope = 0.4, rate = GetParam();
    for (const double friction : {0.0, 0.2, 0.6}) {
        const World world = filming(rate, [&](taut_world_def& def) {
            def.gravity = {static_cast<float>(9.81 * std::sin(slope)), static_cast<float>(-9.81 * std::cos(slope)), 0};
        });
        world.add_ground(friction);
        const taut_solid cube = add_cube(world, {0, 0.003, 0}, [&](taut_solid_def& def) {
            def.young_modulus = 1e6f;
            def.surface.friction = static_cast<float>(friction);
        });
        world.step(static_cast<int>(rate));
        const double before = momentum_of(bodies_of(cube)).x / kCubeMass;
        world.step(static_cast<int>(rate / 2));
        const double grew = (momentum_of(bodies_of(cube)).x / kCubeMass - before) / 0.5;
        const double expected = friction > std::tan(slope) ? 0 : 9.81 * (std::sin(slope) - friction * std::cos(slope));
        EXPECT_NEAR(grew, expected, 0.08 * 9.81 * std::sin(slope)) << friction;
    }
}
INSTANTIATE_TEST_SUITE_P(Hertz, AtRate, testing::Values(24.0, 60.0, 240.0));

// A sheet laid over each shape ends outside of it, and rests.
class OverShape : public testing::TestWithParam<const char*> {};
TEST_P(OverShape, SheetStaysOutside) {
    const World world = filming();
    const std::string kind = GetParam();
    BodyPlan plan;
    plan.kind = TAUT_BODY_STATIC;
    plan.position = {0, 0.5, 0};
    plan.rotation = Quat::turn({1, 0, 0.3}, 0.4);
    plan.shape = kind == "box"        ? world.box({0.2, 0.2, 0.2})
                 : kind == "sphere"   ? world.sphere(0.25)
                 : kind == "capsule"  ? world.capsule(0.15, 0.2)
                 : kind == "cylinder" ? world.cylinder(0.2, 0.2)
                 : kind == "cone"     ? world.cone(0.25, 0.25)
                                      : world.tapered_capsule(0.2, 0.1, 0.2);
    const taut_body body = world.add(plan);
    taut_collider collider{};
    uint32_t count = 0;
    ok(taut_body_get_colliders(body, &collider, 1, &count));
    Sheet sheet(15, 15, 1, 1, 0.9);
    for (taut_pos& p : sheet.points) p.x -= 0.5, p.z -= 0.5;
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    def.stretch_stiffness[0] = def.stretch_stiffness[1] = 500;
    def.shear_stiffness = 200;
    def.mass_damping = 1;
    const taut_cloth cloth = add(world, def);
    double deepest = 1;
    size_t contacts = 0;
    for (int i = 0; i < 48; ++i) {
        world.step();
        contacts += world.contacts().size();
        for (const Vec& p : points_of(cloth)) {
            taut_distance distance{};
            ok(taut_collider_closest_point(collider, p.pos(), &distance));
            deepest = std::min(deepest, static_cast<double>(distance.distance));
            ASSERT_TRUE(finite(p));
        }
    }
    EXPECT_GT(deepest, 0.4 * 0.02 - 1e-4);  // the radius of its vertices
    EXPECT_GT(contacts, 0u);
}
INSTANTIATE_TEST_SUITE_P(Kinds, OverShape,
                         testing::Values("box", "sphere", "capsule", "cylinder", "cone", "tapered_capsule"));

// A kinematic box that comes pushes a cube along at its own speed, and friction takes it along on a belt.
TEST(Minimised, MoversTakeACubeAlong) {
    const World world = filming(60, [](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    BodyPlan plan;
    plan.kind = TAUT_BODY_KINEMATIC;
    plan.shape = world.box({0.1, 0.3, 0.3});
    plan.position = {-0.3, 0.1, 0.1};
    plan.velocity = {1, 0, 0};
    world.add(plan);
    const taut_solid cube = add_cube(world, {0, 0, 0}, [](taut_solid_def& def) { def.damping = 0.05f; });
    world.step(120);
    EXPECT_NEAR(momentum_of(bodies_of(cube)).x, kCubeMass, 0.05 * kCubeMass);
    double least = 1e9;
    for (const Vec& p : points_of(cube)) least = std::min(least, p.x);
    EXPECT_GE(least, -0.2 + 2 - 1e-6);
}

// ---------------------------------------------------------------- with each other

// Two cubes that meet keep their momentum, part again, and gain no energy.
TEST(Minimised, CubesMeetAndPart) {
    for (const bool hexahedra : {false, true}) {
        const World world = filming(60, [](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const auto plain = [](taut_solid_def&) {};
        const taut_solid one = add_cube(world, {0, 0, 0}, plain, 4, hexahedra);
        const taut_solid other = add_cube(world, {0.3, 0.05, 0.03}, plain, 4, hexahedra);
        set_velocities(bodies_of(one), {1.5, 0, 0});
        std::vector<taut_body> bodies = bodies_of(one);
        for (const taut_body body : bodies_of(other)) bodies.push_back(body);
        const auto energy = [&] {
            double sum = 0;
            for (const taut_body body : bodies) sum += 0.5 * mass_of(body).mass * dot(velocity(body), velocity(body));
            return sum;
        };
        const double before = energy();
        double most_contacts = 0;
        for (int i = 0; i < 60; ++i) {
            world.step();
            most_contacts = std::max(most_contacts, static_cast<double>(world.contacts().size()));
            EXPECT_LT(energy(), before * (1 + 1e-6));
        }
        EXPECT_GT(most_contacts, 3);
        EXPECT_LT(norm(momentum_of(bodies) - Vec{1.5 * kCubeMass, 0, 0}), 1e-3 * kCubeMass);
        EXPECT_GT(momentum_of(bodies_of(other)).x, 0.6 * kCubeMass);
        EXPECT_GT(momentum_of(bodies_of(other)).x, momentum_of(bodies_of(one)).x);
        EXPECT_TRUE(world.contacts().empty());
    }
}

// A tower of cubes, each smaller than the one below, stands.
TEST(Minimised, CubesStandOnEachOther) {
    const World world = filming(24);
    world.add_ground();
    std::vector<taut_solid> cubes;
    const double side[3] = {0.2, 0.16, 0.12};
    double height = 0.01;
    for (const double each : side) {
        Beam cube({each, each, each}, 5, 5, 5, false);
        for (taut_pos& p : cube.points) p = (Vec(p) + Vec{-each / 2, height, -each / 2}).pos();
        cubes.push_back(add(world, cube.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3)));
        height += each + 0.01;
    }
    world.step(72);
    height = 0;
    for (size_t i = 0; i < cubes.size(); ++i) {
        EXPECT_NEAR(middle_of(cubes[i]).y, height + side[i] / 2, 0.02) << i;
        height += side[i];
    }
}

// A bar whose ends are led through each other's place closes on itself, if it is asked to.
TEST(Minimised, BarTouchesItself) {
    for (const bool self : {false, true}) {
        const World world = filming(60, [](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const Beam bar({1, 0.1, 0.1}, 21, 3, 3, false);
        taut_solid_def def = bar.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3);
        // A ring that is not quite closed, from the start.
        std::vector<taut_pos> points = bar.points;
        for (taut_pos& p : points) {
            const double turn = 5.6 * p.x, r = 1 / 5.6 - (p.y - 0.05);
            p = {r * std::sin(turn), 1 / 5.6 - r * std::cos(turn), p.z};
        }
        def.points = points.data();
        def.rest = points.data();
        def.self_collision = self ? 1 : 0;
        const taut_solid solid = add(world, def);
        const std::vector<taut_body> vertices = bodies_of(solid);
        for (int end : {0, 20})
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) {
                    const double way = end == 0 ? 1 : -1;
                    ok(taut_solid_pin(solid, bar.at(end, j, k), 1));
                    ok(taut_body_set_velocity(vertices[bar.at(end, j, k)], {static_cast<float>(-0.1 * way), 0, 0}, {}));
                }
        world.step(120);
        for (const Vec& p : points_of(solid)) EXPECT_TRUE(finite(p));
        EXPECT_EQ(world.profile().points > 0, self);
    }
}

// ---------------------------------------------------------------- meshes

taut_shape box_mesh(const World& world, const Vec& half, bool closed) {
    std::vector<taut_vec3> vertices;
    for (int i = 0; i < 8; ++i)
        vertices.push_back(Vec{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z}.narrow());
    const uint32_t indices[] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return world.shape(taut_mesh_def_init, taut_world_add_mesh, [&](taut_mesh_def& def) {
        def.vertices = vertices.data();
        def.vertex_count = 8;
        def.indices = indices;
        def.triangle_count = closed ? 12 : 11;
    });
}

TEST(Minimised, CubeRestsOnAMeshByPenalty) {
    for (const taut_scheme scheme : {TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2}) {
        const World world = filming(60, [&](taut_world_def& def) { def.scheme = scheme; });
        BodyPlan plan;
        plan.kind = TAUT_BODY_STATIC;
        plan.shape = box_mesh(world, {0.5, 0.1, 0.5}, true);
        plan.position = {0, -0.1, 0};
        ok(taut_shape_sample_distance(plan.shape, 0.02f));
        world.add(plan);
        const taut_solid cube = add_cube(world, {-0.1, 0.1, -0.1}, [&](taut_solid_def& def) {
            def.damping = scheme == TAUT_SCHEME_IMPLICIT_EULER ? 0 : 0.02f;
        });
        world.step(180);
        EXPECT_GT(least_height(cube), -0.01) << scheme;
        EXPECT_LT(least_height(cube), 0.02) << scheme;
        EXPECT_NEAR(contact_impulse(world) * 60, kCubeMass * 9.81, 0.02 * kCubeMass * 9.81) << scheme;
    }
}

TEST(Minimised, RefusesMeshesThatAreNotSampled) {
    const World world = filming();
    BodyPlan plan;
    plan.kind = TAUT_BODY_STATIC;
    plan.shape = box_mesh(world, {0.5, 0.1, 0.5}, false);
    EXPECT_EQ(taut_shape_sample_distance(plan.shape, 0), TAUT_UNSUPPORTED);
    EXPECT_NE(std::string(taut_last_error()).find("open"), std::string::npos) << taut_last_error();
    EXPECT_EQ(taut_shape_sample_distance(plan.shape, -1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_sample_distance(plan.shape, NAN), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_sample_distance(world.sphere(1), 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_sample_distance({0}, 0), TAUT_STALE_HANDLE);
    world.add(plan);
    EXPECT_EQ(taut_world_step(world.handle), TAUT_UNSUPPORTED);
    EXPECT_NE(std::string(taut_last_error()).find("taut_shape_sample_distance"), std::string::npos)
        << taut_last_error();
}

// ---------------------------------------------------------------- what is told, and refused

TEST(Minimised, TellsOfContacts) {
    const World world = filming(60, [](taut_world_def& def) { def.contact_events = TAUT_CONTACT_EVENTS_ALL; });
    const taut_body ground = world.add_ground();
    const taut_solid cube = add_cube(world, {0, 0.2, 0});
    int begins = 0, ends = 0, hits = 0;
    for (int i = 0; i < 90; ++i) {
        world.step();
        taut_events events{};
        ok(taut_world_get_events(world.handle, &events));
        begins += static_cast<int>(events.begin_count);
        ends += static_cast<int>(events.end_count);
        hits += static_cast<int>(events.hit_count);
    }
    static_cast<void>(ground), static_cast<void>(cube);
    EXPECT_GE(begins, 1);
    EXPECT_EQ(begins - ends, 1);
    EXPECT_GE(hits, 1);
}

TEST(Minimised, HasTheSameBitsOnAnyTeam) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        const World world = filming(24, [&](taut_world_def& def) { def.threads = threads; });
        world.add_ground();
        for (int i = 0; i < 2; ++i) add_cube(world, {0.05 * i, 0.1 + 0.25 * i, 0}, {}, 6);
        world.step(12);
        uint64_t hash = 0;
        ok(taut_world_get_state_hash(world.handle, &hash));
        hashes.push_back(hash);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

// What sleeps wakes for a box that its host leads, and for what falls on it.
TEST(Minimised, SleepersWakeForWhatComes) {
    for (const bool led : {true, false}) {
        const World world = filming(60, [](taut_world_def& def) { def.sleeping = 1; });
        world.add_ground();
        const taut_solid cube = add_cube(world, {0, 0.006, 0}, [](taut_solid_def& def) { def.damping = 0.1f; });
        world.step(300);
        const std::vector<taut_body> vertices = bodies_of(cube);
        const auto sleeps = [&] {
            uint32_t awake = 1;
            ok(taut_body_get_awake(vertices[0], &awake));
            return awake == 0;
        };
        ASSERT_TRUE(sleeps());
        const Vec before = middle_of(cube);
        if (led)
            world.add({.kind = TAUT_BODY_KINEMATIC,
                       .shape = world.box({0.1, 0.1, 0.3}),
                       .position = {-0.5, 0.15, 0.1},
                       .velocity = {1, 0, 0}});
        else
            add_cube(world, {0.05, 0.5, 0.05});
        bool woke = false;
        for (int i = 0; i < 60; ++i) {
            world.step();
            woke = woke || !sleeps();
        }
        EXPECT_TRUE(woke) << led;
        EXPECT_TRUE(!led || middle_of(cube).x > before.x + 0.3);
    }
}

TEST(Minimised, TakesNoMemoryOnceWarm) {
    const World world = filming();
    world.add_ground();
    for (int i = 0; i < 2; ++i) add_cube(world, {0.05 * i, 0.01 + 0.21 * i, 0});
    world.step(48);
    uint64_t calls = 0;
    for (int i = 0; i < 10; ++i) {
        world.step();
        calls += world.profile().allocations;
    }
    EXPECT_EQ(calls, 0u);
}

TEST(Minimised, RefusesWhatItCannotKeepApart) {
    const auto expect_refused = [](const World& world, const char* why) {
        EXPECT_EQ(taut_world_step(world.handle), TAUT_UNSUPPORTED);
        EXPECT_NE(std::string(taut_last_error()).find(why), std::string::npos) << taut_last_error();
    };
    const Sheet sheet(4, 4, 1, 1, 0);
    {
        const World world = filming();
        add(world, sheet.def(TAUT_CLOTH_TRIANGLES));
        ok(taut_world_step(world.handle));
        add(world, sheet.def(TAUT_CLOTH_TRIANGLES));
        expect_refused(world, "without cells");
    }
    {
        const World world = filming();
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.self_collision = 1;
        add(world, def);
        expect_refused(world, "without cells");
    }
    {
        const World world = filming();
        taut_particle_def def;
        taut_particle_def_init(&def);
        def.shape = world.sphere(0.1);
        taut_body particle{};
        ok(taut_world_add_particle(world.handle, &def, &particle));
        expect_refused(world, "particle or cable");
    }
}

}  // namespace
