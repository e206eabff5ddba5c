// Bodies changed at run time: mass, kind, switched off and on, names; joints switched off and on; lists, frames and
// boxes; and that snapshots hold what is state of it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "support.h"

using namespace taut_test;

namespace {

constexpr taut_sym3 kNoInertia = {0, 0, 0, 0, 0, 0};

void step_on(taut_world world, int count = 1) {
    for (int i = 0; i < count; ++i) ASSERT_OK(taut_world_step(world));
}
taut_pos place_of(taut_body body) {
    taut_pose pose{};
    EXPECT_OK(taut_body_get_pose(body, &pose));
    return pose.position;
}
taut_vec3 speed_of(taut_body body) {
    taut_vec3 v{};
    EXPECT_OK(taut_body_get_velocity(body, &v, nullptr));
    return v;
}
taut_body_kind kind_now(taut_body body) {
    taut_body_kind kind{};
    EXPECT_OK(taut_body_get_kind(body, &kind));
    return kind;
}
template <class Get, class Of, class Item>
std::vector<Item> list_of(Get get, Of of, Item) {
    uint32_t count = 0;
    const taut_result none = get(of, nullptr, 0, &count);
    EXPECT_EQ(none, count == 0 ? TAUT_OK : TAUT_TOO_SMALL);
    std::vector<Item> out(count);
    EXPECT_OK(get(of, out.data(), count, &count));
    return out;
}
std::vector<taut_contact> touches_of(taut_body body) {
    return list_of([](auto... all) { return taut_body_get_contacts(all...); }, body, taut_contact{});
}

struct CrateOnGround {
    CrateOnGround() : world(make_world()), box(add_box(world)) {
        ground = add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
        crate = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 0.5, 0));
    }
    ~CrateOnGround() { taut_world_destroy(world); }

    taut_world world;
    taut_shape box;
    taut_body ground, crate;
};

// ---------------------------------------------------------------- mass

TEST(BodyMass, IsWhatWasSet) {
    CrateOnGround s;
    const taut_sym3 inertia = {2, 3, 4, 0.5f, 0, -0.5f};
    ASSERT_OK(taut_body_set_mass(s.crate, 12, {0.25f, 0, 0}, inertia));
    float mass = 0;
    taut_vec3 centre;
    taut_sym3 read;
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &read));
    EXPECT_EQ(mass, 12);
    EXPECT_EQ(centre.x, 0.25f);
    EXPECT_EQ(std::memcmp(&read, &inertia, sizeof read), 0);
    EXPECT_EQ(place_of(s.crate).x, 0);
    // Of a cube of side 1 m, m / 6.
    ASSERT_OK(taut_body_set_mass(s.crate, 12, {0, 0, 0}, kNoInertia));
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &read));
    EXPECT_NEAR(read.xx, 2, 1e-5);
    EXPECT_EQ(centre.x, 0);
    ASSERT_OK(taut_body_set_mass(s.crate, 0, {0, 0, 0}, kNoInertia));
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &read));
    EXPECT_EQ(mass, 1000);
}

// An impulse J at the centre gives J / m, whatever it weighed before.
TEST(BodyMass, IsWhatImpulsesMove) {
    CrateOnGround s;
    const taut_body free = add_body(s.world, body_def(TAUT_BODY_DYNAMIC, s.box, 20, 20, 0));
    ASSERT_OK(taut_body_set_mass(free, 5, {0, 0, 0}, {1, 1, 2, 0, 0, 0}));
    ASSERT_OK(taut_body_apply_impulse(free, {10, 0, 0}, {0, 0, 6}));
    taut_vec3 v, w;
    ASSERT_OK(taut_body_get_velocity(free, &v, &w));
    EXPECT_FLOAT_EQ(v.x, 2);
    EXPECT_FLOAT_EQ(w.z, 3);
}

TEST(BodyMass, RefusesWhatIsNone) {
    Populated p;
    const Watch watch(p.world);
    const auto refused = [&](taut_body body, float mass, taut_vec3 centre, taut_sym3 inertia, const char* word) {
        EXPECT_EQ(taut_body_set_mass(body, mass, centre, inertia), TAUT_INVALID_ARGUMENT) << word;
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
    };
    refused(p.crate, -1, {0, 0, 0}, kNoInertia, "mass is -1");
    refused(p.crate, NAN, {0, 0, 0}, kNoInertia, "mass");
    refused(p.crate, 1, {0, INFINITY, 0}, kNoInertia, "centre_of_mass.y");
    refused(p.crate, 1, {0, 0, 0}, {1, 1, -1, 0, 0, 0}, "positive definite");
    refused(p.bob, 0, {0, 0, 0}, kNoInertia, "mass is 0");
    refused(p.bob, 1, {1, 0, 0}, kNoInertia, "particle");
    refused(p.bob, 1, {0, 0, 0}, {1, 1, 1, 0, 0, 0}, "particle");
    EXPECT_TRUE(watch.unchanged());
    ASSERT_OK(taut_body_set_mass(p.bob, 3, {0, 0, 0}, kNoInertia));
    ASSERT_OK(taut_body_apply_impulse(p.bob, {0, 0, 6}, {0, 0, 0}));
    EXPECT_NEAR(speed_of(p.bob).z, 2, 1e-3);
}

// ---------------------------------------------------------------- damping and limits, as calls

TEST(BodyRestraint, RefusesWhatIsOutOfRange) {
    Populated p;
    const Watch watch(p.world);
    for (const float bad : {-1.0f, 1.1e6f, INFINITY, NAN}) {
        EXPECT_EQ(taut_body_set_damping(p.crate, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "linear is ")) << taut_last_error();
        EXPECT_EQ(taut_body_set_damping(p.crate, 0, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "angular is ")) << taut_last_error();
        EXPECT_EQ(taut_body_set_max_speed(p.crate, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_body_set_max_speed(p.crate, 0, bad), TAUT_INVALID_ARGUMENT);
    }
    EXPECT_EQ(taut_body_set_gravity_scale(p.crate, 1001), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_damping(p.bob, 1, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_max_speed(p.bob, 1, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
}

TEST(BodyRestraint, IsWhatTheDefSays) {
    CrateOnGround s;
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, s.box, 9, 9, 9);
    def.linear_damping = 1, def.angular_damping = 2, def.max_linear_speed = 3, def.max_angular_speed = 4;
    const taut_body body = add_body(s.world, def);
    float a = 0, b = 0;
    ASSERT_OK(taut_body_get_damping(body, &a, &b));
    EXPECT_TRUE(a == 1 && b == 2);
    ASSERT_OK(taut_body_get_max_speed(body, &a, &b));
    EXPECT_TRUE(a == 3 && b == 4);
    ASSERT_OK(taut_body_get_gravity_scale(body, &a));
    EXPECT_EQ(a, 1);
}

// ---------------------------------------------------------------- kind

// Held in the air as a static one, let fall, held again.
// What is locked takes no velocity, by whatever means, and a pose is set as ever.
TEST(LockedAxes, TakeNoVelocity) {
    CrateOnGround s;
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, s.box, 20, 20, 0);
    def.linear_velocity = {1, 2, 3};
    def.angular_velocity = {4, 5, 6};
    def.locked_axes = TAUT_LOCK_TO_PLANE_XY;
    const taut_body body = add_body(s.world, def);
    const auto expect_motion = [&](taut_vec3 linear, taut_vec3 angular) {
        taut_vec3 v, w;
        ASSERT_OK(taut_body_get_velocity(body, &v, &w));
        EXPECT_EQ(std::memcmp(&v, &linear, sizeof v), 0) << v.x << " " << v.y << " " << v.z;
        EXPECT_EQ(std::memcmp(&w, &angular, sizeof w), 0) << w.x << " " << w.y << " " << w.z;
    };
    uint32_t axes = 0;
    ASSERT_OK(taut_body_get_locked_axes(body, &axes));
    EXPECT_EQ(axes, TAUT_LOCK_TO_PLANE_XY);
    expect_motion({1, 2, 0}, {0, 0, 6});
    ASSERT_OK(taut_body_set_velocity(body, {-1, -2, -3}, {-4, -5, -6}));
    expect_motion({-1, -2, 0}, {0, 0, -6});
    ASSERT_OK(taut_body_set_locked_axes(body, TAUT_LOCK_X | TAUT_LOCK_ROTATION));
    expect_motion({0, -2, 0}, {0, 0, 0});
    ASSERT_OK(taut_body_apply_impulse(body, {1e6f, 3000, 0}, {7, 8, 9}));  // a tonne
    expect_motion({0, 1, 0}, {0, 0, 0});
    ASSERT_OK(set_pose(body, at(-3, 40, 5)));
    EXPECT_EQ(place_of(body).x, -3);
    step_on(s.world, 10);
    EXPECT_EQ(place_of(body).x, -3);
    EXPECT_NE(place_of(body).y, 40);
    ASSERT_OK(taut_body_set_locked_axes(body, 0));
    ASSERT_OK(taut_body_apply_impulse(body, {2000, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(speed_of(body).x, 2);
}

// Locks are of dynamic bodies, and wait while a body is none.
TEST(LockedAxes, WaitWhileABodyIsNotDynamic) {
    CrateOnGround s;
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_KINEMATIC));
    ASSERT_OK(taut_body_set_locked_axes(s.crate, TAUT_LOCK_X | TAUT_LOCK_Y));
    ASSERT_OK(taut_body_set_velocity(s.crate, {3, 0, 4}, {0, 0, 0}));
    step_on(s.world, 60);
    EXPECT_NEAR(place_of(s.crate).x, 3, 1e-6);
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_DYNAMIC));
    EXPECT_EQ(speed_of(s.crate).x, 0);
    EXPECT_EQ(speed_of(s.crate).z, 4);
    const taut_pos before = place_of(s.crate);
    step_on(s.world, 60);
    EXPECT_EQ(place_of(s.crate).x, before.x);
    EXPECT_EQ(place_of(s.crate).y, before.y);
    EXPECT_NE(place_of(s.crate).z, before.z);
}

TEST(LockedAxes, RefuseWhatCannotBeLocked) {
    Populated p;
    const Watch watch(p.world);
    EXPECT_EQ(taut_body_set_locked_axes(p.crate, 64), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "locked_axes is 64")) << taut_last_error();
    EXPECT_EQ(taut_body_set_locked_axes(p.bob, TAUT_LOCK_X), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "particle")) << taut_last_error();
    EXPECT_EQ(taut_body_get_locked_axes(p.crate, nullptr), TAUT_NULL_POINTER);
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 9, 9, 9);
    def.locked_axes = 1u << 31;
    taut_body out;
    EXPECT_EQ(taut_world_add_body(p.world, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "locked_axes")) << taut_last_error();
}

TEST(BodyKind, ChangesAtRunTime) {
    CrateOnGround s;
    const taut_body body = add_body(s.world, body_def(TAUT_BODY_STATIC, s.box, 0, 5, 0));
    step_on(s.world, 30);
    EXPECT_EQ(place_of(body).y, 5);
    ASSERT_OK(taut_body_set_kind(body, TAUT_BODY_DYNAMIC));
    EXPECT_EQ(kind_now(body), TAUT_BODY_DYNAMIC);
    float mass = 0;
    taut_vec3 centre;
    taut_sym3 inertia;
    ASSERT_OK(taut_body_get_mass(body, &mass, &centre, &inertia));
    EXPECT_EQ(mass, 1000);
    step_on(s.world, 30);
    EXPECT_NEAR(speed_of(body).y, -9.81 * 0.5, 0.02);
    const double height = place_of(body).y;
    ASSERT_OK(taut_body_set_kind(body, TAUT_BODY_STATIC));
    EXPECT_EQ(speed_of(body).y, 0);
    step_on(s.world, 30);
    EXPECT_EQ(place_of(body).y, height);
    ASSERT_OK(taut_body_set_kind(body, TAUT_BODY_KINEMATIC));
    ASSERT_OK(taut_body_set_velocity(body, {0, 2, 0}, {0, 0, 0}));
    step_on(s.world, 30);
    EXPECT_NEAR(place_of(body).y, height + 1, 1e-4);
    ASSERT_OK(taut_body_set_kind(body, TAUT_BODY_DYNAMIC));
    EXPECT_FLOAT_EQ(speed_of(body).y, 2);
    step_on(s.world, 300);
    EXPECT_NEAR(place_of(body).y, 1.5, 0.02) << "on the crate";
}

// What rests on a body falls as that stops holding it, and what it rests on holds it once it falls.
TEST(BodyKind, MeetsWhatItDidNotMeet) {
    CrateOnGround s;
    const taut_body shelf = add_body(s.world, body_def(TAUT_BODY_STATIC, s.box, 0, 4, 0));
    const taut_body other = add_body(s.world, body_def(TAUT_BODY_STATIC, s.box, 0, 2, 0));
    const taut_body top = add_body(s.world, body_def(TAUT_BODY_DYNAMIC, s.box, 0, 5, 0));
    step_on(s.world, 120);
    EXPECT_NEAR(place_of(top).y, 5, 0.01);
    ASSERT_OK(taut_body_set_kind(shelf, TAUT_BODY_DYNAMIC));
    step_on(s.world, 240);
    EXPECT_NEAR(place_of(shelf).y, 3, 0.02);
    EXPECT_NEAR(place_of(top).y, 4, 0.03);
    EXPECT_EQ(place_of(other).y, 2);
}

TEST(BodyKind, KeepsTheMassOfBefore) {
    CrateOnGround s;
    ASSERT_OK(taut_body_set_mass(s.crate, 7, {0, 0, 0}, {1, 2, 2.5f, 0, 0, 0}));
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_KINEMATIC));
    float mass = 1;
    taut_vec3 centre;
    taut_sym3 inertia;
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &inertia));
    EXPECT_EQ(mass, 0);
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_DYNAMIC));
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &inertia));
    EXPECT_EQ(mass, 7);
    EXPECT_EQ(inertia.zz, 2.5f);
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_STATIC));
    ASSERT_OK(taut_body_set_mass(s.crate, 9, {0, 0, 0}, kNoInertia));
    ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_DYNAMIC));
    ASSERT_OK(taut_body_get_mass(s.crate, &mass, &centre, &inertia));
    EXPECT_EQ(mass, 9);
}

TEST(BodyKind, RefusesWhatCannotBe) {
    Populated p;
    const Watch watch(p.world);
    EXPECT_EQ(taut_body_set_kind(p.crate, TAUT_BODY_PARTICLE), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_kind(p.bob, TAUT_BODY_STATIC), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "particle")) << taut_last_error();
    EXPECT_EQ(taut_body_set_kind(p.ground, TAUT_BODY_DYNAMIC), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "plane")) << taut_last_error();
    EXPECT_OK(taut_body_set_kind(p.crate, TAUT_BODY_DYNAMIC));
    EXPECT_TRUE(watch.unchanged());
}

// ---------------------------------------------------------------- switched off and on

TEST(DisabledBody, IsNotThereAndStaysAsItIs) {
    CrateOnGround s;
    const taut_body top = add_body(s.world, body_def(TAUT_BODY_DYNAMIC, s.box, 0, 1.5, 0));
    step_on(s.world, 60);
    EXPECT_FALSE(touches_of(s.crate).empty());
    ASSERT_OK(taut_body_set_velocity(s.crate, {0, 0.25f, 0}, {0, 1, 0}));
    const taut_pos before = place_of(s.crate);
    ASSERT_OK(taut_body_set_enabled(s.crate, 0));
    uint32_t enabled = 1;
    ASSERT_OK(taut_body_get_enabled(s.crate, &enabled));
    EXPECT_EQ(enabled, 0u);
    EXPECT_TRUE(touches_of(s.crate).empty());
    step_on(s.world, 90);
    EXPECT_EQ(place_of(s.crate).y, before.y);
    EXPECT_EQ(speed_of(s.crate).y, 0.25f);
    EXPECT_NEAR(place_of(top).y, 0.5, 0.02) << "fell through it";
    EXPECT_EQ(taut_body_apply_force(s.crate, {1, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "disabled")) << taut_last_error();

    // No query of the world finds it; one of its collider does.
    taut_ray ray{};
    ray.origin = {0.1, 10, 0.1};
    ray.translation = {0, -20, 0};
    taut_query_hit hit;
    ASSERT_OK(taut_world_cast_ray(s.world, &ray, nullptr, &hit));
    EXPECT_EQ(hit.body.bits, top.bits);
    taut_collider collider;
    uint32_t count = 0;
    ASSERT_OK(taut_body_get_colliders(s.crate, &collider, 1, &count));
    ASSERT_OK(taut_collider_cast_ray(collider, &ray, &hit));
    EXPECT_EQ(hit.body.bits, s.crate.bits);

    // Moved away and put back, it goes on.
    ASSERT_OK(set_pose(s.crate, at(20, 3, 0)));
    ASSERT_OK(taut_body_set_enabled(s.crate, 1));
    step_on(s.world, 30);
    EXPECT_NEAR(speed_of(s.crate).y, 0.25 - 9.81 * 0.5, 0.02);
    step_on(s.world, 120);
    EXPECT_NEAR(place_of(s.crate).y, 0.5, 0.02);
}

// Of static and kinematic bodies too, with whom what rests there wakes.
TEST(DisabledBody, LetsFallWhatItHeld) {
    for (const taut_body_kind kind : {TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC}) {
        CrateOnGround s;
        ASSERT_OK(taut_body_set_kind(s.crate, kind));
        const taut_body top = add_body(s.world, body_def(TAUT_BODY_DYNAMIC, s.box, 0, 1.5, 0));
        step_on(s.world, 240);
        ASSERT_OK(taut_body_set_enabled(s.crate, 0));
        step_on(s.world, 120);
        EXPECT_NEAR(place_of(top).y, 0.5, 0.02) << kind;
        ASSERT_OK(set_pose(s.crate, at(0, -50, 0)));
        ASSERT_OK(taut_body_set_kind(s.crate, TAUT_BODY_STATIC));
        ASSERT_OK(taut_body_set_enabled(s.crate, 1));
        step_on(s.world, 10);
        EXPECT_EQ(place_of(s.crate).y, -50);
        ASSERT_OK(taut_body_remove(s.crate));
        step_on(s.world);
    }
}

TEST(DisabledBody, HasItsJointsOff) {
    const taut_world world = make_world();
    const taut_shape box = add_box(world);
    const taut_body anchor = add_body(world, body_def(TAUT_BODY_KINEMATIC, box, 0, 10, 0));
    const taut_body bob = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 8, 0));
    const taut_joint joint = add_ball(world, anchor, bob, {0, -1, 0}, {0, 1, 0});
    step_on(world, 60);
    EXPECT_NEAR(place_of(bob).y, 8, 1e-3);
    ASSERT_OK(taut_body_set_enabled(anchor, 0));
    step_on(world, 30);
    EXPECT_NEAR(speed_of(bob).y, -9.81 * 0.5, 0.02);
    taut_vec3 force;
    ASSERT_OK(taut_joint_get_force(joint, &force));
    EXPECT_TRUE(force.x == 0 && force.y == 0 && force.z == 0);
    uint32_t enabled = 0;
    ASSERT_OK(taut_joint_get_enabled(joint, &enabled));
    EXPECT_EQ(enabled, 1u) << "by itself";
    ASSERT_OK(set_pose(bob, at(0, 8, 0)));
    ASSERT_OK(taut_body_set_velocity(bob, {0, 0, 0}, {0, 0, 0}));
    ASSERT_OK(taut_body_set_enabled(anchor, 1));
    step_on(world, 60);
    EXPECT_NEAR(place_of(bob).y, 8, 5e-3);
    taut_world_destroy(world);
}

TEST(DisabledBody, MayBeChangedMeanwhile) {
    CrateOnGround s;
    const taut_shape small = add_box(s.world, 0.25f);
    ASSERT_OK(taut_body_set_enabled(s.crate, 0));
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = small;
    def.position = {0, 2, 0};
    taut_collider added = {0}, first = {0};
    ASSERT_OK(taut_body_add_collider(s.crate, &def, &added));
    uint32_t count = 0;
    std::vector<taut_collider> both(2);
    ASSERT_OK(taut_body_get_colliders(s.crate, both.data(), 2, &count));
    first = both[0];
    ASSERT_OK(taut_collider_set_shape(first, small, {0, 0, 0}, {0, 0, 0, 1}));
    step_on(s.world, 5);
    ASSERT_OK(taut_collider_remove(added));
    ASSERT_OK(taut_body_set_material(s.crate, &def.material));
    ASSERT_OK(set_pose(s.crate, at(3, 0.25, 0)));
    step_on(s.world, 5);
    ASSERT_OK(taut_body_set_enabled(s.crate, 1));
    step_on(s.world, 60);
    EXPECT_NEAR(place_of(s.crate).y, 0.25, 0.01);
    ASSERT_OK(taut_body_set_enabled(s.crate, 0));
    ASSERT_OK(taut_body_remove(s.crate));
    step_on(s.world, 5);
}

TEST(DisabledBody, LeavesASensor) {
    CrateOnGround s;
    taut_body_def def = body_def(TAUT_BODY_STATIC, s.box, 0, 0.5, 0);
    def.collider_flags = TAUT_COLLIDER_SENSOR;
    add_body(s.world, def);
    step_on(s.world, 2);
    EXPECT_EQ(events_of(s.world).sensor_enter_count, 1u);
    ASSERT_OK(taut_body_set_enabled(s.crate, 0));
    step_on(s.world);
    EXPECT_EQ(events_of(s.world).sensor_leave_count, 1u);
    ASSERT_OK(taut_body_set_enabled(s.crate, 1));
    step_on(s.world);
    EXPECT_EQ(events_of(s.world).sensor_enter_count, 1u);
}

// ---------------------------------------------------------------- joints

TEST(JointSwitch, LetsGoAndHoldsAgain) {
    for (const taut_joint_solve solve : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT}) {
        const taut_world world = make_world();
        const taut_body bob = add_particle(world, 0, 5, 0);
        const taut_joint rod = add_rod(world, bob, {0}, {0, 0, 0}, {0, 6, 0});
        ASSERT_OK(taut_joint_set_solve(rod, solve));
        step_on(world, 30);
        EXPECT_NEAR(place_of(bob).y, 5, 5e-3);
        ASSERT_OK(taut_joint_set_enabled(rod, 0));
        step_on(world, 30);
        EXPECT_NEAR(speed_of(bob).y, -9.81 * 0.5, 0.03);
        taut_vec3 force;
        ASSERT_OK(taut_joint_get_force(rod, &force));
        EXPECT_EQ(force.y, 0);
        ASSERT_OK(set_pose(bob, at(0, 5, 0)));
        ASSERT_OK(taut_body_set_velocity(bob, {0, 0, 0}, {0, 0, 0}));
        ASSERT_OK(taut_joint_set_enabled(rod, 1));
        step_on(world, 30);
        EXPECT_NEAR(place_of(bob).y, 5, 5e-3);
        EXPECT_EQ(taut_joint_set_enabled(rod, 2), TAUT_INVALID_ARGUMENT);
        taut_world_destroy(world);
    }
}

// ---------------------------------------------------------------- names

TEST(BodyName, IsKeptAndTold) {
    Populated p;
    char name[TAUT_BODY_NAME_SIZE];
    uint32_t count = 0;
    ASSERT_OK(taut_body_get_name(p.crate, name, sizeof name, &count));
    EXPECT_STREQ(name, "");
    EXPECT_EQ(count, 1u);
    ASSERT_OK(taut_body_set_name(p.crate, "crate"));
    ASSERT_OK(taut_body_get_name(p.crate, name, sizeof name, &count));
    EXPECT_STREQ(name, "crate");
    EXPECT_EQ(taut_body_get_name(p.crate, name, 5, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 6u);
    EXPECT_EQ(taut_body_move_kinematic(p.crate, nullptr), TAUT_NULL_POINTER);
    const taut_pose there = at(0, 1, 0);
    EXPECT_EQ(taut_body_move_kinematic(p.crate, &there), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "body is not kinematic (body 'crate')")) << taut_last_error();
    EXPECT_EQ(taut_body_move_kinematic(p.wedge, &there), TAUT_INVALID_ARGUMENT);
    EXPECT_FALSE(contains(taut_last_error(), "'")) << taut_last_error();

    const std::vector<unsigned char> saved = save(p.world);
    const uint64_t hash = hash_of(p.world);
    ASSERT_OK(taut_body_set_name(p.crate, std::string(31, 'x').c_str()));
    EXPECT_EQ(hash_of(p.world), hash) << "names are no state";
    EXPECT_EQ(taut_body_set_name(p.crate, std::string(32, 'x').c_str()), TAUT_INVALID_ARGUMENT);
    ASSERT_OK(restore(p.world, saved));
    ASSERT_OK(taut_body_get_name(p.crate, name, sizeof name, &count));
    EXPECT_STREQ(name, "crate");
    ASSERT_OK(taut_body_set_name(p.crate, nullptr));
    ASSERT_OK(taut_body_get_name(p.crate, name, sizeof name, &count));
    EXPECT_STREQ(name, "");
    ASSERT_OK(taut_body_set_name(p.wedge, "wedge"));
    ASSERT_OK(taut_body_remove(p.wedge));
    const taut_body next = add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 30, 30, 0));
    ASSERT_OK(taut_body_get_name(next, name, sizeof name, &count));
    EXPECT_STREQ(name, "") << "of another body in that place";
}

// ---------------------------------------------------------------- frames and boxes

TEST(BodyFrame, TakesPointsThereAndBack) {
    const taut_world world = make_world();
    const float s = std::sqrt(0.5f);
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, add_box(world), 10, 20, 30);
    def.rotation = {0, 0, s, s};  // a quarter turn about z: x to y
    def.linear_velocity = {1, 0, 0};
    def.angular_velocity = {0, 0, 2};
    const taut_body body = add_body(world, def);
    taut_pos point;
    taut_vec3 local, along, back, speed;
    ASSERT_OK(taut_body_get_world_point(body, {1, 2, 3}, &point));
    EXPECT_NEAR(point.x, 8, 1e-6);
    EXPECT_NEAR(point.y, 21, 1e-6);
    EXPECT_NEAR(point.z, 33, 1e-6);
    ASSERT_OK(taut_body_get_local_point(body, point, &local));
    EXPECT_NEAR(local.x, 1, 1e-6);
    EXPECT_NEAR(local.y, 2, 1e-6);
    ASSERT_OK(taut_body_get_world_vector(body, {1, 0, 0}, &along));
    EXPECT_NEAR(along.y, 1, 1e-6);
    ASSERT_OK(taut_body_get_local_vector(body, along, &back));
    EXPECT_NEAR(back.x, 1, 1e-6);
    // v + w x r = (1, 0, 0) + 2 z x (-2, 1, 3) = (1 - 2, -4, 0).
    ASSERT_OK(taut_body_get_point_velocity(body, point, &speed));
    EXPECT_NEAR(speed.x, -1, 1e-5);
    EXPECT_NEAR(speed.y, -4, 1e-5);
    EXPECT_NEAR(speed.z, 0, 1e-5);
    taut_pos low, high;
    ASSERT_OK(taut_body_get_bounds(body, &low, &high));
    EXPECT_NEAR(low.x, 9.5, 1e-5);
    EXPECT_NEAR(high.z, 30.5, 1e-5);
    EXPECT_EQ(taut_body_get_world_point(body, {NAN, 0, 0}, &point), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_get_bounds(add_particle(world, 0, 0, 0), &low, &high), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "no collider")) << taut_last_error();
    taut_world_destroy(world);
}

TEST(ColliderAlone, IsAskedByItself) {
    CrateOnGround s;
    taut_collider collider;
    uint32_t count = 0;
    ASSERT_OK(taut_body_get_colliders(s.crate, &collider, 1, &count));
    add_body(s.world, body_def(TAUT_BODY_STATIC, s.box, 0, 3, 0));  // before it, on the ray
    taut_ray ray{};
    ray.origin = {0, 10, 0};
    ray.translation = {0, -10, 0};
    taut_query_hit hit;
    ASSERT_OK(taut_collider_cast_ray(collider, &ray, &hit));
    EXPECT_EQ(hit.collider.bits, collider.bits);
    EXPECT_NEAR(hit.fraction, 0.9, 1e-6);
    EXPECT_NEAR(hit.normal.y, 1, 1e-6);
    ray.origin.x = 5;
    ASSERT_OK(taut_collider_cast_ray(collider, &ray, &hit));
    EXPECT_EQ(hit.body.bits, 0u);
    EXPECT_EQ(hit.fraction, 1);
    int32_t inside = -1;
    ASSERT_OK(taut_collider_overlap_point(collider, {0.4, 0.9, -0.4}, &inside));
    EXPECT_EQ(inside, 1);
    ASSERT_OK(taut_collider_overlap_point(collider, {0.6, 0.9, -0.4}, &inside));
    EXPECT_EQ(inside, 0);
    taut_pose there = at(0.9, 0.5, 0);
    ASSERT_OK(taut_collider_overlap_shape(collider, s.box, &there, &inside));
    EXPECT_EQ(inside, 1);
    there.position.x = 1.1;
    ASSERT_OK(taut_collider_overlap_shape(collider, s.box, &there, &inside));
    EXPECT_EQ(inside, 0);
}

// ---------------------------------------------------------------- lists

TEST(Lists, NameWhatIsThere) {
    Populated p;
    const auto has = [](const auto& all, auto one) {
        return std::any_of(all.begin(), all.end(), [&](auto each) { return each.bits == one.bits; });
    };
    const auto bodies = list_of(taut_world_get_bodies, p.world, taut_body{});
    EXPECT_EQ(bodies.size(), counts_of(p.world).bodies);
    for (const taut_body body : {p.ground, p.crate, p.lift, p.wedge, p.bob}) EXPECT_TRUE(has(bodies, body));
    const auto shapes = list_of(taut_world_get_shapes, p.world, taut_shape{});
    EXPECT_EQ(shapes.size(), 3u);
    const auto joints = list_of(taut_world_get_joints, p.world, taut_joint{});
    EXPECT_EQ(joints.size(), 2u);
    const auto own = list_of(taut_body_get_joints, p.wedge, taut_joint{});
    ASSERT_EQ(own.size(), 1u);
    EXPECT_EQ(own[0].bits, p.ball.bits);
    const std::vector<taut_contact> contacts = touches_of(p.crate);
    EXPECT_EQ(contacts.size(), 4u);
    for (const taut_contact& contact : contacts)
        EXPECT_TRUE(contact.body_a.bits == p.crate.bits || contact.body_b.bits == p.crate.bits);
    ASSERT_OK(taut_body_remove(p.wedge));
    EXPECT_EQ(list_of(taut_world_get_joints, p.world, taut_joint{}).size(), 1u);
}

// ---------------------------------------------------------------- snapshots

// All of it is state, and a restored world goes on bit by bit.
TEST(Snapshot, HoldsWhatBodiesWereChangedTo) {
    CrateOnGround s;
    const taut_body top = add_body(s.world, body_def(TAUT_BODY_DYNAMIC, s.box, 0.1, 3, 0));
    const taut_body bob = add_particle(s.world, 5, 5, 0);
    const taut_joint rod = add_rod(s.world, bob, {0}, {0, 0, 0}, {5, 6, 0});
    const uint64_t plain = hash_of(s.world);
    const auto changes = [&](taut_result result) {
        EXPECT_OK(result);
        const uint64_t now = hash_of(s.world);
        EXPECT_NE(now, plain);
        return now;
    };
    changes(taut_body_set_damping(top, 0.5f, 0.25f));
    changes(taut_body_set_max_speed(top, 4, 5));
    changes(taut_body_set_locked_axes(top, TAUT_LOCK_X | TAUT_LOCK_ANGULAR_Y));
    changes(taut_joint_set_enabled(rod, 0));
    changes(taut_body_set_enabled(s.crate, 0));
    const uint64_t hash = changes(taut_body_set_kind(top, TAUT_BODY_KINEMATIC));
    const std::vector<unsigned char> saved = save(s.world);
    const auto go_on = [&] {
        step_on(s.world, 20);
        EXPECT_OK(taut_body_set_kind(top, TAUT_BODY_DYNAMIC));
        step_on(s.world, 60);
        EXPECT_OK(set_pose(s.crate, at(4, 1, 0)));
        EXPECT_OK(taut_body_set_enabled(s.crate, 1));
        EXPECT_OK(taut_joint_set_enabled(rod, 1));
        step_on(s.world, 60);
        return hash_of(s.world);
    };
    const uint64_t after = go_on();
    ASSERT_OK(restore(s.world, saved));
    EXPECT_EQ(hash_of(s.world), hash);
    EXPECT_EQ(go_on(), after);
}

}  // namespace
