// Fluids and explosions against Archimedes, the metacentre, terminal speeds and the impulse on a plate.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <taut/taut.h>

namespace {

constexpr double kG = static_cast<double>(9.81f), kForcePi = 3.14159265358979323846;
#define ASSERT_OK(call) ASSERT_EQ(call, TAUT_OK) << taut_last_error()
#define EXPECT_OK(call) EXPECT_EQ(call, TAUT_OK) << taut_last_error()

struct Pool {
    explicit Pool(double hz) : seconds(static_cast<float>(1 / hz)) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.time_step = seconds;
        def.sleeping = 1;
        EXPECT_OK(taut_world_create(&def, &world));
        taut_fluid_def_init(&fluid);
    }
    ~Pool() { EXPECT_OK(taut_world_destroy(world)); }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    taut_shape box(taut_vec3 half) {
        taut_box_def def;
        taut_box_def_init(&def);
        def.half_extents = half;
        taut_shape out;
        EXPECT_OK(taut_world_add_box(world, &def, &out));
        return out;
    }
    taut_shape sphere(float radius) {
        taut_sphere_def def;
        taut_sphere_def_init(&def);
        def.radius = radius;
        taut_shape out;
        EXPECT_OK(taut_world_add_sphere(world, &def, &out));
        return out;
    }
    taut_body add(taut_shape shape, float density, taut_pos at, taut_quat turn = {0, 0, 0, 1}) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.shape = shape;
        def.density = density;
        def.position = at;
        def.rotation = turn;
        taut_body out;
        EXPECT_OK(taut_world_add_body(world, &def, &out));
        return out;
    }
    void step(taut_body body) {
        ASSERT_OK(taut_body_apply_fluid(body, &fluid, seconds, &report));
        ASSERT_OK(taut_world_step(world));
    }
    double height(taut_body body) const {
        taut_pose pose;
        EXPECT_OK(taut_body_get_pose(body, &pose));
        return pose.position.y;
    }
    double speed(taut_body body) const {
        taut_vec3 v;
        EXPECT_OK(taut_body_get_velocity(body, &v, nullptr));
        return static_cast<double>(v.y);
    }

    float seconds;
    taut_world world{};
    taut_fluid_def fluid{};
    taut_fluid_report report{};
};

class FluidAtRates : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Hz, FluidAtRates, testing::Values(30.0, 60.0, 120.0, 240.0));

TEST(Fluid, VolumesAreThoseOfGeometry) {
    Pool pool(60);
    ASSERT_OK(taut_world_set_gravity(pool.world, {0, 0, 0}));
    // A box on its edge, half in: the half.
    const taut_quat turned = {0, 0, static_cast<float>(std::sin(kForcePi / 8)),
                              static_cast<float>(std::cos(kForcePi / 8))};
    const taut_body box = pool.add(pool.box({1, 1, 0.5f}), 500, {3, 0, 2}, turned);
    ASSERT_OK(taut_body_apply_fluid(box, &pool.fluid, pool.seconds, &pool.report));
    EXPECT_NEAR(static_cast<double>(pool.report.volume), 2, 1e-5);
    EXPECT_NEAR(pool.report.centre.y, -std::sqrt(2.0) / 3, 1e-5);
    EXPECT_NEAR(pool.report.centre.x, 3, 1e-5);
    // Balls at depths: a cap of height d has pi d^2 (3 r - d) / 3.
    for (const double y : {0.6, 0.3, 0.0, -0.2, -0.7, -2.0}) {
        constexpr double kR = 0.7;
        const taut_body ball = pool.add(pool.sphere(static_cast<float>(kR)), 500, {20, y, 0});
        ASSERT_OK(taut_body_apply_fluid(ball, &pool.fluid, pool.seconds, &pool.report));
        const double d = std::min(std::max(kR - y, 0.0), 2 * kR), whole = 4 * kForcePi / 3 * kR * kR * kR;
        EXPECT_NEAR(static_cast<double>(pool.report.volume), kForcePi * d * d * (3 * kR - d) / 3, 2e-3 * whole) << y;
    }
    // Other round shapes are whole by the calls' own masses.
    taut_capsule_def capsule;
    taut_capsule_def_init(&capsule);
    taut_cylinder_def cylinder;
    taut_cylinder_def_init(&cylinder);
    taut_cone_def cone;
    taut_cone_def_init(&cone);
    taut_tapered_capsule_def tapered;
    taut_tapered_capsule_def_init(&tapered);
    taut_shape shapes[4];
    ASSERT_OK(taut_world_add_capsule(pool.world, &capsule, &shapes[0]));
    ASSERT_OK(taut_world_add_cylinder(pool.world, &cylinder, &shapes[1]));
    ASSERT_OK(taut_world_add_cone(pool.world, &cone, &shapes[2]));
    ASSERT_OK(taut_world_add_tapered_capsule(pool.world, &tapered, &shapes[3]));
    for (const taut_shape shape : shapes) {
        taut_mass_properties mass;
        ASSERT_OK(taut_shape_get_mass_properties(shape, 1, &mass));
        const taut_body body = pool.add(shape, 1000, {50, -5, 0});
        ASSERT_OK(taut_body_apply_fluid(body, &pool.fluid, pool.seconds, &pool.report));
        EXPECT_NEAR(pool.report.volume, mass.mass, 1e-4f * mass.mass);
        EXPECT_NEAR(pool.report.centre.y, -5 + static_cast<double>(mass.centre_of_mass.y), 2e-3);
        ASSERT_OK(taut_body_remove(body));
    }
}

TEST_P(FluidAtRates, FloatsAtItsDraught) {
    for (const float density : {100.0f, 500.0f, 900.0f}) {
        Pool pool(GetParam());
        pool.fluid.skin_drag = 200;
        const taut_body box = pool.add(pool.box({1, 0.2f, 1}), density, {0, 0.5, 0});
        for (int i = 0; i < 20 * GetParam(); ++i) pool.step(box);
        // Draught is the ratio of densities times the height of 0.4 m.
        EXPECT_NEAR(0.2 - pool.height(box), static_cast<double>(density) / 1000 * 0.4, 0.004) << density;
        EXPECT_NEAR(pool.speed(box), 0, 0.01);
    }
}

// Without drag a float bobs for ever, and no higher than it was let go.
TEST_P(FluidAtRates, BobsWithoutGain) {
    Pool pool(GetParam());
    pool.fluid.drag = 0;
    const taut_body box = pool.add(pool.box({1, 0.5f, 1}), 500, {0, 0.2, 0});
    double most = 0, late = 0;
    const int steps = static_cast<int>(30 * GetParam());
    for (int i = 0; i < steps; ++i) {
        pool.step(box);
        most = std::max(most, pool.height(box));
        if (i > steps / 2) late = std::max(late, pool.height(box));
    }
    EXPECT_LE(most, 0.202);
    EXPECT_GT(late, 0.1);
    // A light plate whose frequency is far above the rate does not swing up either.
    Pool steep(GetParam());
    steep.fluid.drag = 0;
    const taut_body plate = steep.add(steep.box({1, 0.05f, 1}), 5, {0, 0.05, 0});
    for (int i = 0; i < 10 * GetParam(); ++i) {
        steep.step(plate);
        ASSERT_LT(std::abs(steep.height(plate)), 0.2);
    }
}

// Metacentre: a tilted raft is turned back by rho g V GM sin(a), GM = I / V - BG.
TEST(Fluid, RaftIsRightedByItsMetacentre) {
    Pool pool(60);
    pool.fluid.drag = 0;
    constexpr double kHalf = 1, kThick = 0.25, kAngle = 0.02, kRatio = 0.5;
    const taut_quat turn = {0, 0, static_cast<float>(std::sin(kAngle / 2)), static_cast<float>(std::cos(kAngle / 2))};
    const taut_body raft = pool.add(pool.box({1, 0.25f, 1}), 500, {0, 0, 0}, turn);
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(raft, &pose));
    // A short time takes the stiffness at the end of the frame out of the force.
    ASSERT_OK(taut_body_apply_fluid(raft, &pool.fluid, 1e-4f, &pool.report));
    const double volume = 4 * kHalf * kHalf * 2 * kThick * kRatio, draught = 2 * kThick * kRatio;
    const double second = std::pow(2 * kHalf, 4) / 12, below = kThick - draught / 2;
    const double moment = 1000 * kG * volume * (second / volume - below) * std::sin(kAngle);
    EXPECT_NEAR(static_cast<double>(pool.report.volume), volume, 1e-3);
    EXPECT_NEAR(static_cast<double>(pool.report.torque.z), -moment, 0.01 * moment);
}

TEST_P(FluidAtRates, SinksAtTerminalSpeed) {
    Pool pool(GetParam());
    pool.fluid.normal = {0, 0, 0};  // it is everywhere
    constexpr double kR = 0.1, kDensity = 3000, kDrag = 0.5;
    pool.fluid.drag = static_cast<float>(kDrag);
    const taut_body ball = pool.add(pool.sphere(static_cast<float>(kR)), static_cast<float>(kDensity), {0, 0, 0});
    double before = 0;
    for (int i = 0; i < 4 * GetParam(); ++i) {
        pool.step(ball);
        EXPECT_LE(pool.speed(ball), before + 1e-5);  // it comes from above, at any rate
        before = pool.speed(ball);
    }
    const double speed = std::sqrt(2 * (kDensity - 1000) * kG * 4 / 3 * kR / (1000 * kDrag));
    EXPECT_NEAR(-pool.speed(ball), speed, 0.01 * speed);
}

TEST_P(FluidAtRates, WindTakesAlongWhatItMeets) {
    Pool pool(GetParam());
    ASSERT_OK(taut_world_set_gravity(pool.world, {0, 0, 0}));
    pool.fluid.normal = pool.fluid.gravity = {0, 0, 0};
    pool.fluid.density = 1.2f;
    pool.fluid.velocity = {10, 0, 0};
    const taut_body sail = pool.add(pool.box({0.01f, 1, 1}), 100, {0, 0, 0});
    ASSERT_OK(taut_body_apply_fluid(sail, &pool.fluid, 1e-4f, &pool.report));
    EXPECT_NEAR(static_cast<double>(pool.report.force.x), 0.5 * 1.2 * 4 * 100, 0.5);  // rho/2 A v^2
    EXPECT_NEAR(static_cast<double>(pool.report.force.y), 0, 1e-3);
    taut_vec3 v = {0, 0, 0};
    for (int i = 0; i < 4 * GetParam(); ++i) {
        pool.step(sail);
        ASSERT_OK(taut_body_get_velocity(sail, &v, nullptr));
        ASSERT_LT(v.x, 10.0f);
    }
    // dv/dt = k (10 - v)^2: v = 10 - 10 / (1 + 10 k t), k = rho A / (2 m), within the order of the frame.
    const double k = 1.2 * 4 / (2 * 0.02 * 4 * 100), t = 4;
    EXPECT_NEAR(static_cast<double>(v.x), 10 - 10 / (1 + 10 * k * t), 2 / GetParam() + 0.02);
}

// Light, coarse and fast: drag stops it and never throws it back.
TEST_P(FluidAtRates, DragStopsNoMoreThanThereIs) {
    Pool pool(GetParam());
    ASSERT_OK(taut_world_set_gravity(pool.world, {0, 0, 0}));
    pool.fluid.normal = pool.fluid.gravity = {0, 0, 0};
    const taut_body foam = pool.add(pool.box({0.5f, 0.5f, 0.5f}), 1, {0, 0, 0});
    ASSERT_OK(taut_body_set_velocity(foam, {0, -50, 0}, {0, 30, 0}));
    double before = 50;
    for (int i = 0; i < GetParam(); ++i) {
        pool.step(foam);
        const double now = -pool.speed(foam);
        EXPECT_LE(now, before + 1e-6);
        EXPECT_GE(now, -1e-4);
        before = now;
    }
    EXPECT_LT(before, 1);
}

TEST(Explosion, PushesAPlateByItsArea) {
    Pool pool(60);
    ASSERT_OK(taut_world_set_gravity(pool.world, {0, 0, 0}));
    // A small plate at 5 m of 10: half the impulse on 0.2 x 0.2 m.
    const taut_body plate = pool.add(pool.box({0.01f, 0.1f, 0.1f}), 1000, {5.01, 0, 0});
    const taut_body far = pool.add(pool.box({0.1f, 0.1f, 0.1f}), 1000, {0, 20, 0});
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(pool.world));
    uint32_t awake = 1;
    ASSERT_OK(taut_body_get_awake(plate, &awake));
    EXPECT_EQ(awake, 0u);
    taut_explosion_def def;
    taut_explosion_def_init(&def);
    uint32_t pushed = 9;
    ASSERT_OK(taut_world_apply_explosion(pool.world, &def, &pushed));
    EXPECT_EQ(pushed, 1u);
    taut_vec3 v, w;
    ASSERT_OK(taut_body_get_velocity(plate, &v, &w));
    EXPECT_NEAR(static_cast<double>(v.x), 500 * 0.04 / 0.8, 0.02);
    EXPECT_NEAR(static_cast<double>(v.y), 0, 1e-4);
    ASSERT_OK(taut_body_get_awake(plate, &awake));
    EXPECT_EQ(awake, 1u);
    ASSERT_OK(taut_body_get_velocity(far, &v, &w));
    EXPECT_EQ(v.y, 0);
    // Off its middle it turns: from below its one end, about z.
    const taut_body beam = pool.add(pool.box({2, 0.1f, 0.1f}), 1000, {0, 0, 30});
    def.position = {1.5, -2, 30};
    ASSERT_OK(taut_world_apply_explosion(pool.world, &def, &pushed));
    ASSERT_OK(taut_body_get_velocity(beam, &v, &w));
    EXPECT_GT(v.y, 0.01f);
    EXPECT_GT(w.z, 0.01f);
    EXPECT_NEAR(w.x, 0, 1e-5);
    // A pull, by falloff 2.
    def.impulse = -1000;
    def.falloff = 2;
    def.position = {-5, 50, 0};
    const taut_body pulled = pool.add(pool.box({0.01f, 0.1f, 0.1f}), 1000, {0.01, 50, 0});
    ASSERT_OK(taut_world_apply_explosion(pool.world, &def, nullptr));
    ASSERT_OK(taut_body_get_velocity(pulled, &v, &w));
    EXPECT_NEAR(static_cast<double>(v.x), -250 * 0.04 / 0.8, 0.02);
}

TEST(Explosion, WallsHide) {
    Pool pool(60);
    ASSERT_OK(taut_world_set_gravity(pool.world, {0, 0, 0}));
    taut_body_def wall_def;
    taut_body_def_init(&wall_def);
    wall_def.kind = TAUT_BODY_STATIC;
    wall_def.shape = pool.box({0.1f, 2, 2});
    wall_def.position = {2, 0, 0};
    taut_body wall;
    ASSERT_OK(taut_world_add_body(pool.world, &wall_def, &wall));
    const taut_body behind = pool.add(pool.box({0.2f, 0.2f, 0.2f}), 1000, {4, 0, 0});
    const taut_body open = pool.add(pool.box({0.2f, 0.2f, 0.2f}), 1000, {-4, 0, 0});
    taut_explosion_def def;
    taut_explosion_def_init(&def);
    def.occlusion = 1;
    uint32_t pushed = 0;
    ASSERT_OK(taut_world_apply_explosion(pool.world, &def, &pushed));
    EXPECT_EQ(pushed, 1u);
    taut_vec3 v;
    ASSERT_OK(taut_body_get_velocity(behind, &v, nullptr));
    EXPECT_EQ(v.x, 0);
    ASSERT_OK(taut_body_get_velocity(open, &v, nullptr));
    EXPECT_LT(v.x, -0.1f);
    def.occlusion = 0;
    ASSERT_OK(taut_world_apply_explosion(pool.world, &def, &pushed));
    EXPECT_EQ(pushed, 2u);
}

TEST(Forces, RefuseBadInput) {
    Pool pool(60);
    const taut_body body = pool.add(pool.box({0.5f, 0.5f, 0.5f}), 1000, {0, 0, 0});
    const auto fluid_refused = [&](const char* text, auto&& change) {
        taut_fluid_def def;
        taut_fluid_def_init(&def);
        change(def);
        uint64_t before = 0, after = 0;
        ASSERT_OK(taut_world_get_state_hash(pool.world, &before));
        EXPECT_NE(taut_body_apply_fluid(body, &def, 0.01f, nullptr), TAUT_OK) << text;
        EXPECT_NE(std::string(taut_last_error()).find(text), std::string::npos) << taut_last_error();
        ASSERT_OK(taut_world_get_state_hash(pool.world, &after));
        EXPECT_EQ(before, after);
    };
    using Fluid = taut_fluid_def;
    fluid_refused("struct_size", [](Fluid& def) { def.struct_size = 0; });
    fluid_refused("density", [](Fluid& def) { def.density = -1; });
    fluid_refused("normal", [](Fluid& def) { def.normal.y = NAN; });
    fluid_refused("gravity", [](Fluid& def) { def.gravity.x = INFINITY; });
    fluid_refused("velocity", [](Fluid& def) { def.velocity.x = 1e5f; });
    fluid_refused("drag", [](Fluid& def) { def.drag = NAN; });
    fluid_refused("skin_drag", [](Fluid& def) { def.skin_drag = -1; });
    taut_fluid_def fluid;
    taut_fluid_def_init(&fluid);
    EXPECT_EQ(taut_body_apply_fluid(body, &fluid, 0, nullptr), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_apply_fluid({0}, &fluid, 0.01f, nullptr), TAUT_STALE_HANDLE);
    const auto blast_refused = [&](taut_result expected, const char* text, auto&& change) {
        taut_explosion_def def;
        taut_explosion_def_init(&def);
        def.position = {2, 0, 0};
        change(def);
        uint64_t before = 0, after = 0;
        ASSERT_OK(taut_world_get_state_hash(pool.world, &before));
        EXPECT_EQ(taut_world_apply_explosion(pool.world, &def, nullptr), expected) << text;
        EXPECT_NE(std::string(taut_last_error()).find(text), std::string::npos) << taut_last_error();
        ASSERT_OK(taut_world_get_state_hash(pool.world, &after));
        EXPECT_EQ(before, after);
    };
    using Blast = taut_explosion_def;
    blast_refused(TAUT_STRUCT_SIZE, "struct_size", [](Blast& def) { def.struct_size = 2; });
    blast_refused(TAUT_INVALID_ARGUMENT, "radius", [](Blast& def) { def.radius = 0; });
    blast_refused(TAUT_INVALID_ARGUMENT, "position", [](Blast& def) { def.position.x = NAN; });
    blast_refused(TAUT_INVALID_ARGUMENT, "impulse is", [](Blast& def) { def.impulse = INFINITY; });
    blast_refused(TAUT_INVALID_ARGUMENT, "falloff", [](Blast& def) { def.falloff = 17; });
    blast_refused(TAUT_INVALID_ARGUMENT, "occlusion", [](Blast& def) { def.occlusion = 2; });
    blast_refused(TAUT_INVALID_ARGUMENT, "past 1e4", [](Blast& def) { def.impulse = 1e12f; });
    EXPECT_EQ(taut_world_apply_explosion({0}, nullptr, nullptr), TAUT_NULL_POINTER);
}

}  // namespace
