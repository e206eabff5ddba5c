// What the calls on bodies and shapes do, where no step is needed or one suffices.
#include <cmath>
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

taut_pose pose_of(taut_body body) {
    taut_pose out;
    EXPECT_OK(taut_body_get_pose(body, &out));
    return out;
}

struct Velocity {
    taut_vec3 linear, angular;
};

Velocity velocity_of(taut_body body) {
    Velocity out;
    EXPECT_OK(taut_body_get_velocity(body, &out.linear, &out.angular));
    return out;
}

struct Bodies : testing::Test {
    Populated p;
};

TEST_F(Bodies, MassFromShapeAndDensity) {
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0, 20, 0);
    def.density = 600;
    Mass mass = mass_of(add_body(p.world, def));
    EXPECT_FLOAT_EQ(mass.mass, 600);
    EXPECT_FLOAT_EQ(mass.inertia.xx, 100);
    EXPECT_FLOAT_EQ(mass.inertia.xy, 0);
    def.mass = 6;  // the density no longer counts
    mass = mass_of(add_body(p.world, def));
    EXPECT_FLOAT_EQ(mass.mass, 6);
    EXPECT_FLOAT_EQ(mass.inertia.zz, 1);
    def.inertia = {2, 3, 4, 0.1f, 0.2f, 0.3f};
    def.centre_of_mass = {0.1f, 0, 0};
    mass = mass_of(add_body(p.world, def));
    EXPECT_FLOAT_EQ(mass.mass, 6);
    EXPECT_FLOAT_EQ(mass.inertia.yz, 0.3f);
    EXPECT_FLOAT_EQ(mass.centre.x, 0.1f);
    def.mass = 0;
    EXPECT_FLOAT_EQ(mass_of(add_body(p.world, def)).mass, 600);
    def.mass = 6;
    def.shape = {0};
    const taut_body bare = add_body(p.world, def);
    EXPECT_FLOAT_EQ(mass_of(bare).inertia.xx, 2);
    EXPECT_FLOAT_EQ(mass_of(p.bob).mass, 1);
    EXPECT_EQ(mass_of(p.bob).inertia.xx, 0);
    EXPECT_EQ(mass_of(p.ground).mass, 0);
    EXPECT_EQ(mass_of(p.lift).inertia.yy, 0);
}

TEST_F(Bodies, HullsTurnAboutTheirCentreOfMass) {
    const Mass mass = mass_of(p.wedge);
    EXPECT_NEAR(mass.centre.x, 0.25, 1e-6);
    EXPECT_NEAR(mass.centre.z, 0.25, 1e-6);
    EXPECT_NEAR(mass.mass, 1000.0 / 6, 1e-3);
    // An impulse at the centre of mass does not turn it; elsewhere it does.
    ASSERT_OK(set_pose(p.wedge, at(-5, 9, 0)));
    ASSERT_OK(taut_body_set_velocity(p.wedge, {0, 0, 0}, {0, 0, 0}));
    ASSERT_OK(taut_body_apply_impulse_at(p.wedge, {0, 100, 0}, {-4.75, 9.25, 0.25}));
    EXPECT_NEAR(velocity_of(p.wedge).angular.z, 0, 1e-6);
    EXPECT_NEAR(velocity_of(p.wedge).linear.y, 0.6, 1e-5);
    ASSERT_OK(taut_body_apply_impulse_at(p.wedge, {0, 100, 0}, {-4, 9.25, 0.25}));
    EXPECT_GT(velocity_of(p.wedge).angular.z, 0.1);
}

TEST_F(Bodies, KindMaterialAndUserData) {
    const taut_body bodies[] = {p.ground, p.lift, p.crate, p.bob};
    for (int i = 0; i < 4; ++i) {
        taut_body_kind kind;
        ASSERT_OK(taut_body_get_kind(bodies[i], &kind));
        EXPECT_EQ(kind, static_cast<taut_body_kind>(i));
    }
    uint64_t data = 0;
    ASSERT_OK(taut_body_set_user_data(p.bob, 0xdeadbeef12345678));
    ASSERT_OK(taut_body_get_user_data(p.bob, &data));
    EXPECT_EQ(data, 0xdeadbeef12345678);
    taut_material material = {};
    material.friction = 0.25f;
    material.restitution = 1;
    ASSERT_OK(taut_body_set_material(p.crate, &material));
    for (float bad : {NAN, INFINITY, -INFINITY, -0.1f, 101.0f}) {
        material = {};
        material.friction = bad;
        EXPECT_EQ(taut_body_set_material(p.crate, &material), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_material: friction")) << taut_last_error();
        material = {};
        material.restitution = bad;
        EXPECT_EQ(taut_body_set_material(p.crate, &material), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_material: restitution")) << taut_last_error();
    }
    ASSERT_OK(taut_body_get_material(p.crate, &material));
    EXPECT_EQ(material.friction, 0.25f);
    EXPECT_EQ(material.restitution, 1);
}

TEST_F(Bodies, RefuseNullPointers) {
    const Watch watch(p.world);
    float mass;
    taut_vec3 centre;
    taut_sym3 inertia;
    EXPECT_EQ(taut_body_get_kind(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_user_data(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_mass(p.crate, nullptr, &centre, &inertia), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_mass(p.crate, &mass, nullptr, &inertia), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_mass(p.crate, &mass, &centre, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_material(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_set_material(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_pose(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_set_pose(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_get_render_pose(p.crate, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_body_move_kinematic(p.lift, nullptr), TAUT_NULL_POINTER);
    EXPECT_TRUE(contains(taut_last_error(), "taut_body_move_kinematic: target is null")) << taut_last_error();
    EXPECT_OK(taut_body_get_velocity(p.crate, nullptr, nullptr));
    EXPECT_EQ(taut_shape_get_mass_properties(p.box, 1, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_shape_get_triangles(p.hull, nullptr, 0, nullptr), TAUT_NULL_POINTER);
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(Bodies, PosesRoundTrip) {
    const float s = std::sqrt(0.5f);
    ASSERT_OK(set_pose(p.wedge, at(1, 2, 3, {s * 1.0005f, 0, 0, s * 1.0005f})));
    const taut_pose pose = pose_of(p.wedge);
    EXPECT_NEAR(pose.position.x, 1, 1e-12);
    EXPECT_NEAR(pose.position.y, 2, 1e-12);
    EXPECT_NEAR(pose.rotation.x, s, 1e-6);  // normalised
    EXPECT_NEAR(pose.rotation.w, s, 1e-6);
    EXPECT_EQ(pose.reserved[0], 0u);
    ASSERT_OK(set_pose(p.bob, at(1, 2, 3, {1, 0, 0, 0})));
    EXPECT_EQ(pose_of(p.bob).rotation.w, 1);  // a particle ignores the rotation

    const Watch watch(p.world);
    taut_pose good = at(0, 1, 0);
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.1e7, -1.1e7}) {
        for (double* field : {&good.position.x, &good.position.y, &good.position.z}) {
            const double kept = *field;
            *field = bad;
            EXPECT_EQ(taut_body_set_pose(p.crate, &good), TAUT_INVALID_ARGUMENT);
            EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_pose: position.")) << taut_last_error();
            EXPECT_EQ(taut_body_move_kinematic(p.lift, &good), TAUT_INVALID_ARGUMENT);
            EXPECT_TRUE(contains(taut_last_error(), "taut_body_move_kinematic: target.position.")) << taut_last_error();
            *field = kept;
        }
    }
    for (float bad : {NAN, INFINITY, -INFINITY, 2.0f}) {
        for (float* field : {&good.rotation.x, &good.rotation.y, &good.rotation.z, &good.rotation.w}) {
            const float kept = *field;
            *field = bad;
            EXPECT_EQ(taut_body_set_pose(p.crate, &good), TAUT_INVALID_ARGUMENT);
            EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_pose: rotation.")) << taut_last_error();
            EXPECT_EQ(taut_body_move_kinematic(p.lift, &good), TAUT_INVALID_ARGUMENT);
            *field = kept;
        }
    }
    good.reserved[1] = 1;
    EXPECT_EQ(taut_body_set_pose(p.crate, &good), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(Bodies, VelocitiesAreChecked) {
    ASSERT_OK(taut_body_set_velocity(p.crate, {1, 2, 3}, {4, 5, 6}));
    EXPECT_EQ(velocity_of(p.crate).angular.z, 6);
    const Watch watch(p.world);
    for (float bad : {NAN, INFINITY, -INFINITY, 1.1e4f}) {
        EXPECT_EQ(taut_body_set_velocity(p.crate, {0, bad, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_velocity: linear.y")) << taut_last_error();
        EXPECT_EQ(taut_body_set_velocity(p.crate, {0, 0, 0}, {bad, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_set_velocity: angular.x")) << taut_last_error();
    }
    EXPECT_EQ(taut_body_set_velocity(p.ground, {0, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_velocity(p.bob, {0, 0, 0}, {1, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(taut_body_set_velocity(p.bob, {1, 0, 0}, {0, 0, 0}));
    EXPECT_OK(taut_body_set_velocity(p.lift, {1, 0, 0}, {1, 0, 0}));
}

TEST_F(Bodies, ForcesAreChecked) {
    const Watch watch(p.world);
    for (float bad : {NAN, INFINITY, -INFINITY, 1e25f}) {
        for (int axis = 0; axis < 3; ++axis) {
            taut_vec3 v = {0, 0, 0};
            (axis == 0 ? v.x : axis == 1 ? v.y : v.z) = bad;
            EXPECT_EQ(taut_body_apply_force(p.crate, v, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
            EXPECT_TRUE(contains(taut_last_error(), "taut_body_apply_force: force.")) << taut_last_error();
            EXPECT_EQ(taut_body_apply_force(p.crate, {0, 0, 0}, v), TAUT_INVALID_ARGUMENT);
            EXPECT_EQ(taut_body_apply_impulse(p.crate, v, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
            EXPECT_EQ(taut_body_apply_impulse(p.crate, {0, 0, 0}, v), TAUT_INVALID_ARGUMENT);
            EXPECT_EQ(taut_body_apply_force_at(p.crate, v, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
            EXPECT_EQ(taut_body_apply_impulse_at(p.crate, v, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
        }
        const taut_pos far = {0, static_cast<double>(bad), 0};
        EXPECT_EQ(taut_body_apply_force_at(p.crate, {1, 0, 0}, far), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_apply_force_at: point.y")) << taut_last_error();
        EXPECT_EQ(taut_body_apply_impulse_at(p.crate, {1, 0, 0}, far), TAUT_INVALID_ARGUMENT);
    }
    for (taut_body body : {p.ground, p.lift}) {
        EXPECT_EQ(taut_body_apply_force(body, {1, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_body_apply_force_at(body, {1, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_body_apply_impulse(body, {1, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_body_apply_impulse_at(body, {1, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    }
    EXPECT_EQ(taut_body_apply_force(p.bob, {1, 0, 0}, {0, 1, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_apply_impulse(p.bob, {1, 0, 0}, {0, 1, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_apply_impulse(p.bob, {1e6f, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);  // 1e6 m/s
    EXPECT_TRUE(contains(taut_last_error(), "speed")) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(taut_body_apply_impulse(p.bob, {3, 0, 0}, {0, 0, 0}));
    EXPECT_OK(taut_body_apply_force_at(p.bob, {1, 0, 0}, {99, 0, 0}));
}

// A force for one step is worth its impulse; at a point it turns the body about its centre of mass.
TEST_F(Bodies, ForcesLastOneStep) {
    ASSERT_OK(taut_world_set_gravity(p.world, {0, 0, 0}));
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 50, 50, 0);
    def.mass = 6;
    const taut_body pushed = add_body(p.world, def);
    def.position.x = 60;
    const taut_body kicked = add_body(p.world, def);
    ASSERT_OK(taut_body_apply_force(pushed, {20, 0, 0}, {0, 0, 0}));
    ASSERT_OK(taut_body_apply_force_at(pushed, {40, 0, 0}, {50, 50.5, 0}));
    ASSERT_OK(taut_body_apply_impulse_at(kicked, {1, 0, 0}, {60, 50.5, 0}));
    EXPECT_NEAR(velocity_of(kicked).linear.x, 1.0 / 6, 1e-6);
    EXPECT_NEAR(velocity_of(kicked).angular.z, -0.5, 1e-6);
    ASSERT_OK(taut_world_step(p.world));
    EXPECT_NEAR(velocity_of(pushed).linear.x, 60.0 / 60 / 6, 1e-5);
    EXPECT_NEAR(velocity_of(pushed).angular.z, -40 * 0.5 / 60, 1e-4);
    ASSERT_OK(taut_world_step(p.world));
    EXPECT_NEAR(velocity_of(pushed).linear.x, 60.0 / 60 / 6, 1e-5);
}

// Accepted, however absurd: the body ends at a finite place, in quarantine if need be, and the rest goes on.
TEST_F(Bodies, SurviveTheLargestForces) {
    for (float size : {1e8f, 1e16f, 1e24f}) {
        Populated q;
        taut_body_def def = body_def(TAUT_BODY_DYNAMIC, q.box, 30, 30, 0);
        def.mass = 1e-6f;
        def.inertia = {1e-20f, 2e-20f, 2.5e-20f, 0, 0, 0};
        const taut_body light = add_body(q.world, def);
        for (int i = 0; i < 10; ++i) {
            for (taut_body body : {q.crate, q.wedge, light}) {
                taut_body_kind kind;
                ASSERT_OK(taut_body_get_kind(body, &kind));
                if (kind != TAUT_BODY_DYNAMIC) continue;
                ASSERT_OK(taut_body_apply_force(body, {size, -size, size}, {size, size, -size}));
            }
            ASSERT_OK(taut_world_step(q.world));
            for (taut_body body : {q.crate, q.wedge, q.bob, light}) {
                const taut_pose pose = pose_of(body);
                ASSERT_TRUE(std::isfinite(pose.position.x + pose.position.y + pose.position.z)) << size;
                ASSERT_TRUE(std::isfinite(pose.rotation.w)) << size;
            }
        }
    }
}

TEST_F(Bodies, KinematicReachesItsTargetInOneStep) {
    const float half = 0.75f;  // [rad], half the turn
    const taut_pose target = at(5.2, 3.1, -0.3, {0, std::sin(half), 0, std::cos(half)});
    ASSERT_OK(taut_body_move_kinematic(p.lift, &target));
    const Velocity velocity = velocity_of(p.lift);
    EXPECT_NEAR(velocity.linear.x, 12, 1e-4);
    EXPECT_NEAR(velocity.angular.y, 90, 1e-3);
    ASSERT_OK(taut_world_step(p.world));
    const taut_pose reached = pose_of(p.lift);
    EXPECT_NEAR(reached.position.x, 5.2, 1e-6);
    EXPECT_NEAR(reached.position.z, -0.3, 1e-6);
    EXPECT_NEAR(reached.rotation.y, target.rotation.y, 1e-5);
    EXPECT_EQ(velocity_of(p.lift).linear.x, velocity.linear.x);  // kept until changed
    // The opposite quaternion is the same turn.
    ASSERT_OK(set_pose(p.lift, at(5, 3, 0)));
    const taut_pose opposite = at(5, 3, 0, {0, -std::sin(half), 0, -std::cos(half)});
    ASSERT_OK(taut_body_move_kinematic(p.lift, &opposite));
    EXPECT_NEAR(velocity_of(p.lift).angular.y, 90, 1e-3);
    ASSERT_OK(move_to(p.lift, at(5, 3, 0, {0, 0, 1, 0})));
    EXPECT_NEAR(std::abs(velocity_of(p.lift).angular.z), 60 * 3.14159265, 1e-2);

    const Watch watch(p.world);
    EXPECT_EQ(taut_body_move_kinematic(p.crate, &target), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(move_to(p.lift, at(5e5, 0, 0)), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "target.position")) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(Bodies, ShapesInUseStay) {
    EXPECT_EQ(taut_shape_remove(p.box), TAUT_IN_USE);
    EXPECT_TRUE(contains(taut_last_error(), "2 bodies")) << taut_last_error();
    EXPECT_TRUE(taut_shape_is_valid(p.box));
    ASSERT_OK(taut_body_remove(p.crate));
    EXPECT_EQ(taut_shape_remove(p.box), TAUT_IN_USE);
    ASSERT_OK(taut_body_remove(p.lift));
    EXPECT_OK(taut_shape_remove(p.box));
    EXPECT_FALSE(taut_shape_is_valid(p.box));
}

TEST_F(Bodies, ShapesTellMassAndTriangles) {
    taut_mass_properties mass;
    ASSERT_OK(taut_shape_get_mass_properties(p.box, 10, &mass));
    EXPECT_FLOAT_EQ(mass.mass, 10);
    EXPECT_EQ(taut_shape_get_mass_properties(p.plane, 10, &mass), TAUT_INVALID_ARGUMENT);
    for (float bad : {NAN, INFINITY, -INFINITY, 0.0f, -1.0f, 1.1e8f}) {
        EXPECT_EQ(taut_shape_get_mass_properties(p.box, bad, &mass), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_shape_get_mass_properties: density")) << taut_last_error();
    }
    uint32_t count = 0;
    EXPECT_EQ(taut_shape_get_triangles(p.hull, nullptr, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 12u);
    std::vector<taut_vec3> points(count);
    count = 0;
    EXPECT_EQ(taut_shape_get_triangles(p.hull, points.data(), 11, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 12u);
    ASSERT_OK(taut_shape_get_triangles(p.hull, points.data(), 12, &count));
    for (const taut_vec3& q : points) EXPECT_TRUE((q.x == 0 || q.x == 1) && q.x + q.y + q.z <= 1);
    EXPECT_EQ(taut_shape_get_triangles(p.box, points.data(), 12, &count), TAUT_INVALID_ARGUMENT);
}

}  // namespace
