// Frames, axes and what is read back of them. How axes act is tested with the physics.
#include <numbers>

#include "joint_support.h"

using namespace taut_test;

namespace {

constexpr double kPi = std::numbers::pi;

taut_quat turn(taut_vec3 axis, double angle) {
    const float s = static_cast<float>(std::sin(angle / 2)), c = static_cast<float>(std::cos(angle / 2));
    return {s * axis.x, s * axis.y, s * axis.z, c};
}

double coordinate(taut_joint joint, uint32_t axis) {
    float value = NAN;
    EXPECT_OK(taut_joint_get_coordinates(joint, axis, &value, nullptr));
    return value;
}

bool same(const taut_drive& a, const taut_drive& b) {
    return a.target == b.target && a.speed == b.speed && a.stiffness == b.stiffness && a.damping == b.damping &&
           a.frequency == b.frequency && a.damping_ratio == b.damping_ratio && a.max_force == b.max_force;
}
bool same(const taut_axis_def& a, const taut_axis_def& b) {
    return a.struct_size == b.struct_size && a.mode == b.mode && a.lower == b.lower && a.upper == b.upper &&
           a.stop_compliance == b.stop_compliance && a.stop_damping == b.stop_damping && same(a.drive, b.drive) &&
           a.friction == b.friction;
}

class EveryFramedKind : public testing::TestWithParam<size_t> {
protected:
    const FramedKind& kind() const { return framed_kinds()[GetParam()]; }
    uint32_t axes() const { return static_cast<uint32_t>(kind().angular.size()); }
    TwoBoxes boxes;
};

INSTANTIATE_TEST_SUITE_P(List, EveryFramedKind, testing::Range<size_t>(0, framed_kinds().size()),
                         [](const auto& param) { return std::string(framed_kinds()[param.param].name); });

// A joint made at a world point begins closed, with every coordinate at 0, wherever its bodies are.
TEST_P(EveryFramedKind, FromAWorldPointBeginsAtZero) {
    const taut_vec3 directions[] = {{1, 0, 0}, {0, 2, 0}, {0, 0, -1}, {1, 2, -3}, {1e-20f, 0, 0}};
    for (const taut_vec3& axis : directions) {
        ASSERT_OK(set_pose(boxes.b, at(1, 5.2, 0.1, turn({0, 1, 0}, 0.7))));
        const taut_joint joint = boxes.add(kind(), axis);
        taut_joint_kind read;
        ASSERT_OK(taut_joint_get_kind(joint, &read));
        EXPECT_EQ(read, kind().kind);
        float linear, angular;
        ASSERT_OK(taut_joint_get_error(joint, &linear));
        ASSERT_OK(taut_joint_get_angular_error(joint, &angular));
        EXPECT_LT(linear, 1e-6);
        EXPECT_LT(angular, 1e-6);
        uint32_t count;
        ASSERT_OK(taut_joint_get_axis_count(joint, &count));
        ASSERT_EQ(count, axes());
        for (uint32_t i = 0; i < count; ++i) EXPECT_NEAR(coordinate(joint, i), 0, 1e-6) << i;
        taut_pos a, b;
        ASSERT_OK(taut_joint_get_anchors(joint, &a, &b));
        EXPECT_NEAR(a.x, 0, 1e-9);
        EXPECT_NEAR(a.y, 5, 1e-9);
        EXPECT_NEAR(b.y, 5, 1e-9);
    }
}

// What is set is what is read, and the read may be set.
TEST_P(EveryFramedKind, AxesReadAsTheyWereSet) {
    const taut_joint joint = boxes.add(kind());
    for (uint32_t i = 0; i < axes(); ++i) {
        taut_axis_def def = axis_def(TAUT_AXIS_LIMITED), read;
        const bool swing = kind().kind == TAUT_JOINT_CONE_TWIST && i == 0;
        if (!swing) def.lower = -0.5f;
        def.drive = {0.25f, 2, 30, 4, 0, 1, 60};
        def.upper = 0.75f;
        def.stop_compliance = 1e-3f;
        def.stop_damping = 7;
        def.friction = 3;
        ASSERT_OK(taut_joint_set_axis(joint, i, &def));
        ASSERT_OK(taut_joint_get_axis(joint, i, &read));
        EXPECT_TRUE(same(def, read)) << i;
        const float target = swing ? 0.125f : -0.125f;
        EXPECT_EQ(taut_joint_set_target(joint, i, -target, 1), swing ? TAUT_INVALID_ARGUMENT : TAUT_OK);
        ASSERT_OK(taut_joint_set_target(joint, i, target, 1));
        ASSERT_OK(taut_joint_get_axis(joint, i, &read));
        EXPECT_EQ(read.drive.target, target);
        EXPECT_EQ(read.drive.speed, 1);
        EXPECT_EQ(read.drive.stiffness, 30);
        def = axis_def(TAUT_AXIS_FREE);
        ASSERT_OK(taut_joint_set_axis(joint, i, &def));
        EXPECT_EQ(taut_joint_set_target(joint, i, 0, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "no drive")) << taut_last_error();
    }
}

TEST_P(EveryFramedKind, RefusesAxesThatItHasNot) {
    const taut_joint joint = boxes.add(kind());
    const Watch watch(boxes.world);
    const taut_axis_def def = axis_def(TAUT_AXIS_FREE);
    taut_axis_def read;
    taut_axis_forces forces;
    for (uint32_t axis : {axes(), axes() + 1, UINT32_MAX}) {
        for (taut_result result :
             {taut_joint_set_axis(joint, axis, &def), taut_joint_get_axis(joint, axis, &read),
              taut_joint_set_target(joint, axis, 0, 0), taut_joint_get_coordinates(joint, axis, nullptr, nullptr),
              taut_joint_get_axis_forces(joint, axis, &forces)}) {
            EXPECT_EQ(result, TAUT_INVALID_ARGUMENT);
            EXPECT_TRUE(contains(taut_last_error(), kind().name)) << taut_last_error();
        }
    }
    EXPECT_TRUE(watch.unchanged());
}

// A coordinate is read where the pose put it, and its rate is that of its change.
TEST_P(EveryFramedKind, RatesAreThoseOfTheCoordinates) {
    const taut_joint joint = boxes.add(kind());
    constexpr double kStep = 1e-3;
    const taut_vec3 v = {0.3f, -0.2f, 0.1f}, w = {0.4f, 0.25f, -0.3f};
    const auto pose_at = [&](double t) {
        const double speed = std::sqrt(double(w.x) * w.x + double(w.y) * w.y + double(w.z) * w.z);
        const taut_vec3 axis = {static_cast<float>(w.x / speed), static_cast<float>(w.y / speed),
                                static_cast<float>(w.z / speed)};
        return at(1 + v.x * t, 5 + v.y * t, v.z * t, turn(axis, speed * t));
    };
    ASSERT_OK(taut_body_set_velocity(boxes.b, v, w));
    for (uint32_t i = 0; i < axes(); ++i) {
        double value[2];
        for (int side = 0; side < 2; ++side) {
            ASSERT_OK(set_pose(boxes.b, pose_at(0.8 + (side == 0 ? -kStep : kStep))));
            value[side] = coordinate(joint, i);
        }
        ASSERT_OK(set_pose(boxes.b, pose_at(0.8)));
        float rate;
        ASSERT_OK(taut_joint_get_coordinates(joint, i, nullptr, &rate));
        EXPECT_NEAR(rate, (value[1] - value[0]) / (2 * kStep), 1e-3) << i;
        EXPECT_EQ(coordinate(joint, i) > 1e-9 || coordinate(joint, i) < -1e-9, true) << i;
    }
}

TEST_P(EveryFramedKind, FramesReadAsTheyWereSet) {
    const taut_joint joint = boxes.add(kind());
    const taut_frame a = frame(0.5, 0.25, 0, turn({0, 0, 1}, 0.5)), b = frame(-0.5, 0, 0.125, turn({1, 0, 0}, 0.25));
    ASSERT_OK(taut_joint_set_frames(joint, &a, &b));
    taut_frame read_a, read_b;
    ASSERT_OK(taut_joint_get_frames(joint, &read_a, &read_b));
    EXPECT_EQ(read_a.position.x, 0.5);
    EXPECT_EQ(read_b.position.z, 0.125);
    EXPECT_NEAR(read_a.rotation.z, a.rotation.z, 1e-6);
    EXPECT_NEAR(read_b.rotation.x, b.rotation.x, 1e-6);
    const Watch watch(boxes.world);
    taut_frame bad = a;
    bad.position.x = NAN;
    EXPECT_EQ(taut_joint_set_frames(joint, &bad, &b), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "frame_a.position.x")) << taut_last_error();
    bad = a;
    bad.rotation.w = 3;
    EXPECT_EQ(taut_joint_set_frames(joint, &a, &bad), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "frame_b.rotation")) << taut_last_error();
    bad = frame(1.1e4, 0, 0);
    EXPECT_EQ(taut_joint_set_frames(joint, &bad, &b), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_frames(joint, nullptr, &b), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_set_frames(joint, &a, nullptr), TAUT_NULL_POINTER);
    EXPECT_TRUE(watch.unchanged());
}

// Locked parts alone count as errors, each in its own unit.
TEST(JointError, TellsMetresFromRadians) {
    TwoBoxes boxes;
    const taut_joint fixed = boxes.add(framed_kinds()[0]);
    const taut_joint hinge = boxes.add(framed_kinds()[1]);
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0.3, turn({1, 0, 0}, 0.2))));  // about the hinge's own axis
    float linear, angular;
    ASSERT_OK(taut_joint_get_error(fixed, &linear));
    ASSERT_OK(taut_joint_get_angular_error(fixed, &angular));
    EXPECT_NEAR(linear, 0.3, 1e-6);
    EXPECT_NEAR(angular, 4 * std::tan(0.2 / 4), 1e-6);
    ASSERT_OK(taut_joint_get_angular_error(hinge, &angular));
    EXPECT_NEAR(angular, 0, 1e-6);
    EXPECT_NEAR(coordinate(hinge, 0), 0.2, 1e-6);
    // Beyond a stop it does, in the turn that is nearest to the stops.
    taut_axis_def def = axis_def(TAUT_AXIS_LIMITED);
    def.upper = 0.15f;
    ASSERT_OK(taut_joint_set_axis(hinge, 0, &def));
    ASSERT_OK(taut_joint_get_angular_error(hinge, &angular));
    EXPECT_NEAR(angular, 0.05, 1e-6);
    def.lower = static_cast<float>(kPi) - 0.1f;
    def.upper = static_cast<float>(kPi) + 0.3f;
    ASSERT_OK(taut_joint_set_axis(hinge, 0, &def));
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0, turn({1, 0, 0}, kPi + 0.2))));
    ASSERT_OK(taut_joint_get_angular_error(hinge, &angular));
    EXPECT_NEAR(angular, 0, 1e-6);
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0, turn({1, 0, 0}, kPi + 0.5))));
    ASSERT_OK(taut_joint_get_angular_error(hinge, &angular));
    EXPECT_NEAR(angular, 0.2, 1e-6);
}

// A frequency is that of the two ends alone: a spring of k = m (2 pi f)^2 between bodies whose masses are m1
// m2/(m1+m2).
TEST(Frequency, GivesTheStiffnessOfTheTwoEnds) {
    const taut_world world = make_world();
    const auto ball = [&](double x, float mass) {
        taut_particle_def def;
        taut_particle_def_init(&def);
        def.position = {x, 0, 0};
        def.mass = mass;
        taut_body out;
        EXPECT_OK(taut_world_add_particle(world, &def, &out));
        return out;
    };
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    def.base.body_a = ball(0, 2);
    def.base.body_b = ball(3, 6);
    def.max_length = INFINITY;
    def.drive.frequency = 2;
    def.drive.damping_ratio = 0.5f;
    taut_joint joint;
    ASSERT_OK(taut_world_add_distance_joint(world, &def, &joint));
    const double mass = 1.5, omega = 4 * kPi;
    taut_axis_def axis;
    ASSERT_OK(taut_joint_get_axis(joint, 0, &axis));
    EXPECT_NEAR(axis.drive.stiffness, mass * omega * omega, 1e-3);
    EXPECT_NEAR(axis.drive.damping, 2 * 0.5 * mass * omega, 1e-3);
    EXPECT_EQ(axis.drive.frequency, 0);
    EXPECT_EQ(axis.mode, TAUT_AXIS_LIMITED);

    // Of a hinge on the world: the box's own inertia about it, m (s^2 + s^2)/12 + m r^2.
    const taut_body box = add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world), 0, 9, 0));
    taut_hinge_joint_def hinge;
    taut_hinge_joint_def_init(&hinge);
    hinge.base.body_b = box;
    ASSERT_OK(taut_joint_frames_from_world(world, {0}, box, {0, 9.5, 0}, {0, 0, 1}, &hinge.base.frame_a,
                                           &hinge.base.frame_b));
    hinge.angle.drive.frequency = 1;
    ASSERT_OK(taut_world_add_hinge_joint(world, &hinge, &joint));
    ASSERT_OK(taut_joint_get_axis(joint, 0, &axis));
    const double inertia = 1000.0 / 6 + 1000 * 0.25;
    EXPECT_NEAR(axis.drive.stiffness, inertia * 4 * kPi * kPi, 1);
    taut_axis_def again = axis_def(TAUT_AXIS_FREE);
    again.drive.frequency = 1;
    ASSERT_OK(taut_joint_set_axis(joint, 0, &again));
    ASSERT_OK(taut_joint_get_axis(joint, 0, &axis));
    EXPECT_NEAR(axis.drive.stiffness, inertia * 4 * kPi * kPi, 1);
    EXPECT_OK(taut_world_destroy(world));
}

TEST(Distance, HasRodRopeRangeAndSpring) {
    const taut_world world = make_world();
    taut_distance_joint_def good;
    taut_distance_joint_def_init(&good);
    good.base.body_b = add_particle(world, 0, -2, 0);
    const auto add = [&](auto change) {
        taut_distance_joint_def def = good;
        change(def);
        taut_joint joint = {0};
        EXPECT_OK(taut_world_add_distance_joint(world, &def, &joint));
        return joint;
    };
    const auto error = [](taut_joint joint) {
        float out = NAN;
        EXPECT_OK(taut_joint_get_error(joint, &out));
        return out;
    };
    using Def = taut_distance_joint_def;
    taut_axis_def axis;
    const taut_joint rod = add([](Def&) {});
    ASSERT_OK(taut_joint_get_axis(rod, 0, &axis));
    EXPECT_EQ(axis.mode, TAUT_AXIS_LOCKED);
    const taut_joint rope = add([](Def& d) { d.max_length = 1.5f; });  // 0.5 m too short
    EXPECT_NEAR(coordinate(rope, 0), 0.5, 1e-6);
    EXPECT_NEAR(error(rope), 0.5, 1e-6);
    ASSERT_OK(taut_joint_set_length(rope, 3));
    EXPECT_EQ(error(rope), 0);
    ASSERT_OK(taut_joint_get_axis(rope, 0, &axis));
    EXPECT_EQ(axis.lower, -INFINITY);
    EXPECT_EQ(axis.upper, 0);
    const taut_joint range =
        add([](Def& d) { d.min_length = 1, d.max_length = 4, d.length = 2, d.base.compliance = 1e-3f; });
    ASSERT_OK(taut_joint_get_axis(range, 0, &axis));
    EXPECT_EQ(axis.lower, -1);
    EXPECT_EQ(axis.upper, 2);
    EXPECT_EQ(axis.stop_compliance, 1e-3f);
    ASSERT_OK(taut_joint_set_compliance(range, 2e-3f, 5));
    ASSERT_OK(taut_joint_get_axis(range, 0, &axis));
    EXPECT_EQ(axis.stop_compliance, 2e-3f);
    EXPECT_EQ(axis.stop_damping, 5);
    const taut_joint strut = add([](Def& d) { d.min_length = 2.5f; });
    EXPECT_NEAR(error(strut), 0.5, 1e-6);
    const taut_joint spring = add([](Def& d) { d.frequency = 1, d.damping_ratio = 0.1f; });
    EXPECT_EQ(error(spring), 0);
    for (int i = 0; i < 3; ++i) ASSERT_OK(taut_world_step(world));
    EXPECT_OK(taut_world_destroy(world));
}

// A spring given by its frequency swings at it.
TEST(Distance, SpringSwingsAtItsFrequency) {
    const taut_world world = make_world();
    ASSERT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    def.base.body_b = add_particle(world, 0, -2.1, 0);
    def.length = 2;
    def.frequency = 1;
    def.damping_ratio = 0;
    taut_joint joint;
    ASSERT_OK(taut_world_add_distance_joint(world, &def, &joint));
    int crossings = 0;
    double before = coordinate(joint, 0);
    for (int i = 0; i < 600; ++i) {
        ASSERT_OK(taut_world_step(world));
        const double now = coordinate(joint, 0);
        crossings += before * now < 0;
        before = now;
    }
    EXPECT_NEAR(crossings, 20, 1);  // twice a period, 10 s
    EXPECT_OK(taut_world_destroy(world));
}

TEST(JointChanges, AreCheckedAndTakeEffect) {
    Populated p;
    const taut_joint hinge = [&] {
        taut_joint out = {0};
        EXPECT_OK(framed_kinds()[1].add(p.world, {0}, p.crate, frame(0, 0.5, 0), frame(0, 0, 0), &out));
        return out;
    }();
    const auto changes = [&](taut_result result) {
        EXPECT_OK(result);
        const uint64_t hash = hash_of(p.world);
        static uint64_t last;
        const bool changed = hash != last;
        last = hash;
        return changed;
    };
    EXPECT_TRUE(changes(taut_joint_set_angular_compliance(hinge, 1e-3f, 2)));
    EXPECT_TRUE(changes(taut_joint_set_break(hinge, 1e6f, 0)));
    EXPECT_TRUE(changes(taut_joint_set_break(hinge, 0, 1e6f)));
    EXPECT_TRUE(changes(taut_joint_set_solve(hinge, TAUT_JOINT_SOLVE_SOFT)));
    EXPECT_FALSE(changes(taut_joint_set_solve(hinge, TAUT_JOINT_SOLVE_SOFT)));
    EXPECT_TRUE(changes(taut_joint_set_collide_connected(hinge, 1)));
    EXPECT_FALSE(changes(taut_joint_set_collide_connected(hinge, 1)));
    EXPECT_FALSE(changes(taut_joint_set_user_data(hinge, 42)));
    uint64_t data = 0;
    ASSERT_OK(taut_joint_get_user_data(hinge, &data));
    EXPECT_EQ(data, 42u);
    taut_axis_def def = axis_def(TAUT_AXIS_FREE);
    EXPECT_FALSE(changes(taut_joint_set_axis(hinge, 0, &def)));
    def.friction = 1;
    EXPECT_TRUE(changes(taut_joint_set_axis(hinge, 0, &def)));
    def.drive.damping = INFINITY;
    EXPECT_TRUE(changes(taut_joint_set_axis(hinge, 0, &def)));
    EXPECT_TRUE(changes(taut_joint_set_target(hinge, 0, 0, 1)));

    const Watch watch(p.world);
    for (float bad : {NAN, INFINITY, -INFINITY, -1.0f}) {
        EXPECT_EQ(taut_joint_set_angular_compliance(hinge, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_joint_set_angular_compliance(hinge, 0, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_joint_set_break(hinge, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_joint_set_break: force")) << taut_last_error();
        EXPECT_EQ(taut_joint_set_break(hinge, 0, bad), TAUT_INVALID_ARGUMENT);
    }
    for (float bad : {NAN, INFINITY, 7.0f, -7.0f}) {
        EXPECT_EQ(taut_joint_set_target(hinge, 0, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_joint_set_target: target")) << taut_last_error();
    }
    EXPECT_EQ(taut_joint_set_target(hinge, 0, 0, NAN), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_solve(hinge, TAUT_JOINT_SOLVE_MAX), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_collide_connected(hinge, 2), TAUT_INVALID_ARGUMENT);
    for (taut_joint plain : {p.ball, p.rod}) {
        EXPECT_EQ(taut_joint_set_angular_compliance(plain, 0, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "holds no angles")) << taut_last_error();
        EXPECT_EQ(taut_joint_set_break(plain, 10, 10), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "torque of a joint that holds no angles")) << taut_last_error();
    }
    EXPECT_EQ(taut_joint_set_axis(p.ball, 0, &def), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_axis(hinge, 0, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_axis(hinge, 0, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_axis_forces(hinge, 0, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_axis_count(hinge, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_torque(hinge, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_angular_error(hinge, nullptr), TAUT_NULL_POINTER);
    taut_frame out = frame(0, 0, 0);
    EXPECT_EQ(taut_joint_get_frames(hinge, &out, nullptr), TAUT_NULL_POINTER);
    // A particle takes no frame off itself; a distance joint none on its other point.
    const taut_frame off = frame(0.1, 0, 0), on = frame(0, 0, 0), there = frame(10, 5, 0);
    EXPECT_EQ(taut_joint_set_frames(p.rod, &off, &there), TAUT_INVALID_ARGUMENT);
    taut_pose bob;
    ASSERT_OK(taut_body_get_pose(p.bob, &bob));
    const taut_frame same = {bob.position, {0, 0, 0, 1}};
    EXPECT_EQ(taut_joint_set_frames(p.rod, &on, &same), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "distance")) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(taut_world_step(p.world));
}

TEST(Frames, FromWorldRefuse) {
    Populated p, other;
    taut_frame a = frame(7, 7, 7), b = a;
    const auto call = [&](taut_body body, taut_pos pivot, taut_vec3 axis, taut_result code, const char* word) {
        EXPECT_EQ(taut_joint_frames_from_world(p.world, p.crate, body, pivot, axis, &a, &b), code) << word;
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
    };
    call({0}, {0, 0, NAN}, {1, 0, 0}, TAUT_INVALID_ARGUMENT, "pivot.z");
    call({0}, {2e7, 0, 0}, {1, 0, 0}, TAUT_INVALID_ARGUMENT, "pivot");
    call({0}, {0, 0, 0}, {0, 0, 0}, TAUT_INVALID_ARGUMENT, "axis is 0");
    call({0}, {0, 0, 0}, {0, INFINITY, 0}, TAUT_INVALID_ARGUMENT, "axis.y");
    call(other.crate, {0, 0, 0}, {1, 0, 0}, TAUT_FOREIGN_HANDLE, "body_b");
    EXPECT_EQ(taut_joint_frames_from_world(p.world, {0}, {0}, {0, 0, 0}, {1, 0, 0}, nullptr, &b), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_frames_from_world(p.world, {0}, {0}, {0, 0, 0}, {1, 0, 0}, &a, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(a.position.x, 7);
    EXPECT_EQ(b.position.x, 7);
    // In the world's own axes: x as given, y the most square of the world's.
    ASSERT_OK(taut_joint_frames_from_world(p.world, {0}, {0}, {1, 2, 3}, {0, 0, 5}, &a, &b));
    EXPECT_EQ(a.position.z, 3);
    const taut_quat q = a.rotation;  // x to z, y to x, z to y
    EXPECT_NEAR(std::abs(q.w), 0.5, 1e-6);
    EXPECT_NEAR(std::abs(q.x + q.y + q.z), 1.5, 1e-6);
}

// A weight on a beam that is fixed to the wall: force and torque on it, at the wall, as of statics.
TEST(JointTorque, IsThatOfTheWeightOnItsBeam) {
    const taut_world world = make_world();
    const taut_joint joint = add_beam(world);
    taut_vec3 force, torque;
    ASSERT_OK(taut_joint_get_torque(joint, &torque));
    EXPECT_EQ(torque.z, 0);  // not solved yet
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_joint_get_force(joint, &force));
    ASSERT_OK(taut_joint_get_torque(joint, &torque));
    EXPECT_NEAR(force.y, 9810, 1);
    EXPECT_NEAR(torque.z, 2 * 9810, 5);  // of the wall on the box: against the weight's at an arm of 2 m
    EXPECT_NEAR(torque.x, 0, 1);
    EXPECT_NEAR(torque.y, 0, 1);
    EXPECT_OK(taut_world_destroy(world));
}

}  // namespace
