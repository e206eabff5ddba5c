// Colliders through the interface: several shapes a body, their mass, their changes at run time, their events.
#include <cmath>

#include "def_check.h"
#include "support.h"

namespace {

using namespace taut_test;

taut_collider_def collider_def(taut_shape shape, taut_vec3 position = {0, 0, 0}) {
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = shape;
    def.position = position;
    return def;
}

taut_collider add_collider(taut_body body, const taut_collider_def& def) {
    taut_collider out = {0};
    EXPECT_EQ(taut_body_add_collider(body, &def, &out), TAUT_OK) << taut_last_error();
    return out;
}

std::vector<taut_collider> colliders_of(taut_body body) {
    uint32_t count = 0;
    taut_body_get_colliders(body, nullptr, 0, &count);
    std::vector<taut_collider> out(count);
    EXPECT_EQ(taut_body_get_colliders(body, out.data(), count, &count), TAUT_OK) << taut_last_error();
    return out;
}

struct ColliderCalls : testing::Test {
    Populated p;
};

TEST_F(ColliderCalls, RefuseWhatIsOutOfRange) {
    const taut_collider_def good = collider_def(p.box, {1, 2, 3});
    const Watch watch(p.world);
    const auto refuse = [&](const char* word, taut_result code, auto change) {
        taut_collider_def bad = good;
        change(bad);
        taut_collider out = {0x77};
        EXPECT_EQ(taut_body_add_collider(p.crate, &bad, &out), code) << word;
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(out.bits, 0x77u);
        // The same inside a body's def.
        taut_body_def body = body_def(TAUT_BODY_DYNAMIC, p.box);
        body.colliders = &bad;
        body.collider_count = 1;
        taut_body made = {0x77};
        EXPECT_EQ(taut_world_add_body(p.world, &body, &made), code) << word;
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(made.bits, 0x77u);
    };
    using Def = taut_collider_def;
    refuse("struct_size", TAUT_STRUCT_SIZE, [](Def& d) { --d.struct_size; });
    refuse("density", TAUT_INVALID_ARGUMENT, [](Def& d) { d.density = -1; });
    refuse("density", TAUT_INVALID_ARGUMENT, [](Def& d) { d.density = NAN; });
    refuse("position.y", TAUT_INVALID_ARGUMENT, [](Def& d) { d.position.y = INFINITY; });
    refuse("rotation", TAUT_INVALID_ARGUMENT, [](Def& d) { d.rotation = {0, 0, 0, 2}; });
    refuse("material.friction", TAUT_INVALID_ARGUMENT, [](Def& d) { d.material.friction = -0.1f; });
    refuse("material.restitution", TAUT_INVALID_ARGUMENT, [](Def& d) { d.material.restitution = 1.1f; });
    refuse("material.friction_rule is 6", TAUT_INVALID_ARGUMENT,
           [](Def& d) { d.material.friction_rule = static_cast<taut_combine>(6); });
    refuse("material.restitution_rule is 6", TAUT_INVALID_ARGUMENT,
           [](Def& d) { d.material.restitution_rule = static_cast<taut_combine>(6); });
    refuse("material.rolling_friction", TAUT_INVALID_ARGUMENT, [](Def& d) { d.material.rolling_friction = -1; });
    refuse("material.spinning_friction", TAUT_INVALID_ARGUMENT, [](Def& d) { d.material.spinning_friction = NAN; });
    refuse("filter.reserved", TAUT_INVALID_ARGUMENT, [](Def& d) { d.filter.reserved = 1; });
    refuse("shape", TAUT_STALE_HANDLE, [](Def& d) { d.shape = {0}; });
    refuse("plane", TAUT_INVALID_ARGUMENT, [&](Def& d) { d.shape = p.plane; });
    taut_body_def body = body_def(TAUT_BODY_DYNAMIC, p.box);
    body.collider_count = 2;
    taut_body made = {0};
    EXPECT_EQ(taut_world_add_body(p.world, &body, &made), TAUT_NULL_POINTER);
    EXPECT_TRUE(contains(taut_last_error(), "colliders")) << taut_last_error();
    taut_collider out = {0};
    EXPECT_EQ(taut_body_add_collider(p.bob, &good, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_collider_set_density(p.collider, NAN), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_collider_set_surface_velocity(p.collider, {0, 1.1e4f, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "taut_collider_set_surface_velocity: velocity")) << taut_last_error();
    EXPECT_EQ(taut_collider_set_surface_velocity(p.collider, {0, 1, 0}, {0, 0, NAN}), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "spin.z")) << taut_last_error();
    EXPECT_EQ(taut_collider_set_shape(p.collider, p.plane, {0, 0, 0}, {0, 0, 0, 1}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_collider_set_shape(p.collider, p.box, {0, 2e4f, 0}, {0, 0, 0, 1}), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(ColliderCalls, ReadBackWhatWasWritten) {
    taut_collider_def def = collider_def(p.box, {1, 2, 3});
    def.rotation = {0, 0.6f, 0, 0.8f};
    def.density = 7;
    def.material = {0.25f, 0.5f, TAUT_COMBINE_MINIMUM, TAUT_COMBINE_AVERAGE, 0.03f, 0.04f};
    def.filter = {2, 5, -3, 0};
    def.user_data = 42;
    const taut_collider collider = add_collider(p.crate, def);
    taut_collider_def read;
    ASSERT_OK(taut_collider_get_def(collider, &read));
    EXPECT_EQ(read.struct_size, sizeof read);
    EXPECT_EQ(read.shape.bits, p.box.bits);
    EXPECT_EQ(read.position.z, 3);
    EXPECT_FLOAT_EQ(read.rotation.y, 0.6f);
    EXPECT_EQ(read.density, 7);
    EXPECT_EQ(read.material.friction, 0.25f);
    EXPECT_EQ(read.material.restitution, 0.5f);
    EXPECT_EQ(read.material.friction_rule, TAUT_COMBINE_MINIMUM);
    EXPECT_EQ(read.material.restitution_rule, TAUT_COMBINE_AVERAGE);
    EXPECT_EQ(read.material.rolling_friction, 0.03f);
    EXPECT_EQ(read.material.spinning_friction, 0.04f);
    EXPECT_EQ(read.filter.group, -3);
    EXPECT_EQ(read.user_data, 42u);
    taut_vec3 velocity = {7, 7, 7}, spin = {7, 7, 7};
    ASSERT_OK(taut_collider_get_surface_velocity(collider, &velocity, &spin));
    EXPECT_TRUE(velocity.x == 0 && velocity.y == 0 && velocity.z == 0);
    ASSERT_OK(taut_collider_set_surface_velocity(collider, {1, 2, 3}, {0, 0, -4}));
    ASSERT_OK(taut_collider_get_surface_velocity(collider, &velocity, &spin));
    EXPECT_TRUE(velocity.x == 1 && velocity.y == 2 && velocity.z == 3);
    EXPECT_TRUE(spin.x == 0 && spin.y == 0 && spin.z == -4);
    taut_body body = {0};
    ASSERT_OK(taut_collider_get_body(collider, &body));
    EXPECT_EQ(body.bits, p.crate.bits);
    EXPECT_EQ(colliders_of(p.crate).size(), 2u);
    EXPECT_EQ(colliders_of(p.crate)[0].bits, p.collider.bits);
    EXPECT_EQ(taut_shape_remove(p.box), TAUT_IN_USE);
    ASSERT_OK(taut_collider_remove(p.collider));
    EXPECT_EQ(colliders_of(p.crate)[0].bits, collider.bits);
    ASSERT_OK(taut_collider_remove(collider));
    EXPECT_FALSE(taut_collider_is_valid(collider));
    EXPECT_TRUE(colliders_of(p.crate).empty());
    taut_material material;
    EXPECT_EQ(taut_body_get_material(p.crate, &material), TAUT_INVALID_ARGUMENT);
    ASSERT_OK(taut_world_step(p.world));
}

// Two cubes of side 1 and 2 m, 3 m apart along x, the second turned: Steiner's theorem by hand.
TEST_F(ColliderCalls, MassOfSeveralIsTheirSum) {
    const taut_shape big = add_box(p.world, 1);
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0, 50, 0);
    def.density = 10;
    taut_collider_def second = collider_def(big, {3, 0, 0});
    second.density = 5;
    second.rotation = {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
    def.colliders = &second;
    def.collider_count = 1;
    const taut_body body = add_body(p.world, def);
    const Mass m = mass_of(body);
    EXPECT_FLOAT_EQ(m.mass, 10 + 40);
    EXPECT_FLOAT_EQ(m.centre.x, 3 * 40 / 50.0f);
    const float about_x = 10 / 6.0f + 40 * 4 / 6.0f;
    EXPECT_FLOAT_EQ(m.inertia.xx, about_x);
    EXPECT_FLOAT_EQ(m.inertia.yy, about_x + 10 * 40 / 50.0f * 9);
    EXPECT_NEAR(m.inertia.xy, 0, 1e-4);
}

// A new collider shifts the centre of mass of a moving body: its points move on as they did, joints keep their anchors.
TEST_F(ColliderCalls, MassFromCollidersKeepsTheMotion) {
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0, 50, 0);
    def.angular_velocity = {0, 2, 0};
    def.linear_velocity = {1, 0, 0};
    const taut_body body = add_body(p.world, def);
    const taut_joint ball = add_ball(p.world, body, {0}, {0.5, 0, 0}, {0.5, 50, 0});
    add_collider(body, collider_def(p.box, {2, 0, 0}));
    const float before = mass_of(body).mass;
    EXPECT_FLOAT_EQ(before, 1000);
    ASSERT_OK(taut_body_set_mass_from_colliders(body));
    EXPECT_FLOAT_EQ(mass_of(body).mass, 2000);
    EXPECT_FLOAT_EQ(mass_of(body).centre.x, 1);
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(body, &pose));
    EXPECT_NEAR(pose.position.x, 0, 1e-12);
    taut_vec3 v, w;
    ASSERT_OK(taut_body_get_velocity(body, &v, &w));
    EXPECT_FLOAT_EQ(v.z, -2);  // w x (1, 0, 0)
    EXPECT_FLOAT_EQ(v.x, 1);
    taut_pos a, b;
    ASSERT_OK(taut_joint_get_anchors(ball, &a, &b));
    EXPECT_NEAR(a.x, 0.5, 1e-6);
    EXPECT_EQ(taut_body_set_mass_from_colliders(p.ground), TAUT_INVALID_ARGUMENT);
}

// A table of five boxes rests on its four legs; one taken away, it falls over.
TEST_F(ColliderCalls, ATableStandsOnItsLegs) {
    taut_box_def box;
    taut_box_def_init(&box);
    taut_shape top, leg;
    box.half_extents = {1, 0.05f, 0.6f};
    ASSERT_OK(taut_world_add_box(p.world, &box, &top));
    box.half_extents = {0.05f, 0.4f, 0.05f};
    ASSERT_OK(taut_world_add_box(p.world, &box, &leg));
    std::vector<taut_collider_def> legs;
    for (float x : {-0.9f, 0.9f})
        for (float z : {-0.5f, 0.5f}) legs.push_back(collider_def(leg, {x, -0.45f, z}));
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, top, 20, 0.855, 0);
    def.colliders = legs.data();
    def.collider_count = 4;
    const taut_body table = add_body(p.world, def);
    uint32_t begun = 0;
    for (int i = 0; i < 120; ++i) {
        ASSERT_OK(taut_world_step(p.world));
        taut_events events;
        ASSERT_OK(taut_world_get_events(p.world, &events));
        for (uint32_t k = 0; k < events.begin_count; ++k)
            begun += events.begin[k].body_a.bits == table.bits || events.begin[k].body_b.bits == table.bits;
    }
    EXPECT_GE(begun, 4u);
    EXPECT_LE(begun, 6u) << "legs that lift again and again";
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(table, &pose));
    EXPECT_NEAR(pose.position.y, 0.85, 2e-3);
    taut_vec3 v, w;
    ASSERT_OK(taut_body_get_velocity(table, &v, &w));
    EXPECT_LT(std::hypot(v.x, v.y, v.z), 1e-3f);
    uint32_t count = 0;
    std::vector<taut_contact> contacts(256);
    ASSERT_OK(taut_world_get_contacts(p.world, contacts.data(), 256, &count));
    double weight = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (contacts[i].body_a.bits != table.bits && contacts[i].body_b.bits != table.bits) continue;
        weight += contacts[i].normal_impulse * 240.0;
        EXPECT_NEAR(contacts[i].position.y, 0, 2e-3);
        EXPECT_GT(std::abs(contacts[i].position.x - 20), 0.8);
    }
    EXPECT_NEAR(weight, mass_of(table).mass * 9.81, 0.02 * mass_of(table).mass * 9.81);

    ASSERT_OK(taut_collider_remove(colliders_of(table)[1]));
    ASSERT_OK(taut_collider_remove(colliders_of(table)[1]));
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(p.world));
    ASSERT_OK(taut_body_get_pose(table, &pose));
    EXPECT_LT(pose.position.y, 0.7);
}

TEST_F(ColliderCalls, FilterAndShapeChangeAtOnce) {
    ASSERT_OK(taut_collider_set_shape(p.collider, p.box, {0, -0.5f, 0}, {0, 0, 0, 1}));
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(p.world));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(p.crate, &pose));
    EXPECT_NEAR(pose.position.y, 1, 5e-3);
    const taut_filter nothing = {1, 0, 0, 0};
    ASSERT_OK(taut_collider_set_filter(p.collider, &nothing));
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(p.world));
    ASSERT_OK(taut_body_get_pose(p.crate, &pose));
    EXPECT_NEAR(pose.position.y, 1 - 0.5 * 9.81, 0.1);
}

// A particle with a sphere rolls not, but slides and rests: a block on an incline, g (sin a - mu cos a).
TEST_F(ColliderCalls, AParticleSlidesDownASlope) {
    taut_sphere_def ball;
    taut_sphere_def_init(&ball);
    ball.radius = 0.1f;
    taut_shape sphere;
    ASSERT_OK(taut_world_add_sphere(p.world, &ball, &sphere));
    const double angle = 0.5, mu = 0.3;
    taut_body_def slope = body_def(TAUT_BODY_STATIC, p.plane, 0, 100, 0);
    slope.rotation = {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
    slope.material.friction = static_cast<float>(mu);
    add_body(p.world, slope);
    taut_particle_def def;
    taut_particle_def_init(&def);
    def.shape = sphere;
    def.material.friction = static_cast<float>(mu);
    const double out = 0.1;
    def.position = {-out * std::sin(angle), 100 + out * std::cos(angle), 0};
    taut_body grain = {0};
    ASSERT_OK(taut_world_add_particle(p.world, &def, &grain));
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(p.world));
    taut_vec3 v, w;
    ASSERT_OK(taut_body_get_velocity(grain, &v, &w));
    const double expected = 9.81 * (std::sin(angle) - mu * std::cos(angle));
    EXPECT_NEAR(std::hypot(v.x, v.y), expected, 0.01 * expected);
    def.shape = p.box;
    EXPECT_EQ(taut_world_add_particle(p.world, &def, &grain), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "sphere")) << taut_last_error();
}

}  // namespace
