// Stops that leave an angle more than half a turn to either side: a reading in (-pi, pi] does not tell which of them
// was passed.
#include "physics/joint_lab.h"

namespace {

using namespace lab;

const Vec kAxis(0, 0, 1);

// A top about its centre, and how far it turned about the axis since it was made, whole turns counted.
class Top {
public:
    Top(double rate, uint32_t substeps, taut_solver solver = TAUT_SOLVER_BLOCK_LDLT)
        : world([&](taut_world_def& def) {
              def.gravity = {0, 0, 0};
              def.time_step = static_cast<float>(1 / rate);
              def.substeps = substeps;
              def.solver = solver;
          }),
          body(world.add({.mass = 2, .inertia = {0.1, 0.1, 0.1}})) {}

    template <class Def>
    void hold(void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*), uint32_t axis,
              const taut_axis_def& stops, taut_joint_solve solve = TAUT_JOINT_SOLVE_DIRECT) {
        Def def = at(world, init, {}, body, {}, kAxis);
        def.base.solve = solve;
        ok(add(world.handle, &def, &joint));
        ok(taut_joint_set_axis(joint, axis, &stops));
    }
    void turn(double torque, double time) {
        for (int frame = 0; frame < static_cast<int>(time / world.frame()); ++frame) {
            ok(taut_body_apply_force(body, {0, 0, 0}, {0, 0, static_cast<float>(torque)}));
            step();
        }
    }
    void step() {
        world.step();
        const Vec now = state(body).rotation.rotate({1, 0, 0});
        angle += std::atan2(dot(kAxis, cross(last_, now)), dot(last_, now));
        last_ = now;
        least = std::min(least, angle);
        most = std::max(most, angle);
    }

    const World world;
    taut_body body;
    taut_joint joint{};
    double angle = 0, least = 0, most = 0;  // [rad]

private:
    Vec last_{1, 0, 0};
};

struct Stops {
    double lower, upper;  // [degrees]
};
const std::vector<Stops> kStops = {{-180, 180}, {-180, 175}, {-182, 178}, {-20, 340}, {0, 360}, {-360, 0}, {-90, 190}};

std::string text_of(const Stops& s) { return std::to_string(s.lower) + " to " + std::to_string(s.upper); }

template <class Hold>
void expect_held(const Stops& stops, double rate, uint32_t substeps, Hold&& hold,
                 taut_solver solver = TAUT_SOLVER_BLOCK_LDLT) {
    for (const double torque : {3.0, -3.0}) {
        Top top(rate, substeps, solver);
        hold(top, limited(stops.lower * kDegree, stops.upper * kDegree));
        top.turn(torque, 1.5);
        const std::string text = text_of(stops) + ", " + std::to_string(rate) + " Hz, " + std::to_string(substeps) +
                                 " substeps, " + std::to_string(torque) + " N m: turned by " +
                                 std::to_string(top.angle / kDegree);
        EXPECT_NEAR(top.angle / kDegree, torque > 0 ? stops.upper : stops.lower, 1) << text;
        EXPECT_LE(top.most / kDegree, stops.upper + 1) << text;
        EXPECT_GE(top.least / kDegree, stops.lower - 1) << text;
    }
}

const auto kHinge = [](Top& top, const taut_axis_def& angle) {
    top.hold(taut_hinge_joint_def_init, taut_world_add_hinge_joint, 0, angle);
};

TEST(StopsAWholeTurnApart, HoldAHinge) {
    for (const Stops& stops : kStops)
        for (const double rate : {30.0, 60.0, 120.0, 240.0})
            for (const uint32_t substeps : {1u, 4u, 16u}) expect_held(stops, rate, substeps, kHinge);
}

TEST(StopsAWholeTurnApart, HoldEveryAngleThatMayTurnSoFar) {
    for (const Stops& stops : kStops) {
        expect_held(stops, 60, 4, [](Top& top, const taut_axis_def& angle) {
            top.hold(taut_cylindrical_joint_def_init, taut_world_add_cylindrical_joint, 1, angle);
        });
        expect_held(stops, 60, 4, [](Top& top, const taut_axis_def& angle) {
            top.hold(taut_cone_twist_joint_def_init, taut_world_add_cone_twist_joint, 1, angle);
        });
        expect_held(stops, 60, 4, [](Top& top, const taut_axis_def& angle) {
            top.hold(taut_universal_joint_def_init, taut_world_add_universal_joint, 0, angle);
        });
        expect_held(stops, 60, 4, [](Top& top, const taut_axis_def& angle) {
            top.hold(taut_six_dof_joint_def_init, taut_world_add_six_dof_joint, 3, angle);
        });
    }
}

TEST(StopsAWholeTurnApart, HoldSweptJointsAndByEverySolver) {
    for (const Stops& stops : kStops) {
        expect_held(stops, 60, 4, [](Top& top, const taut_axis_def& angle) {
            top.hold(taut_hinge_joint_def_init, taut_world_add_hinge_joint, 0, angle, TAUT_JOINT_SOLVE_SOFT);
        });
        for (const taut_solver solver : {TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, TAUT_SOLVER_ACCELERATED_JACOBI})
            expect_held(stops, 60, 4, kHinge, solver);
    }
}

// By 40 rad/s, which a drive would have to stop, and against a motor of as much.
TEST(StopsAWholeTurnApart, HoldWhatComesFast) {
    for (const Stops& stops : kStops)
        for (const double speed : {40.0, -40.0}) {
            Top top(60, 4);
            kHinge(top, limited(stops.lower * kDegree, stops.upper * kDegree));
            ok(taut_body_set_velocity(top.body, {0, 0, 0}, {0, 0, static_cast<float>(speed)}));
            top.turn(0, 1);
            EXPECT_LE(top.most / kDegree, stops.upper + 1) << text_of(stops);
            EXPECT_GE(top.least / kDegree, stops.lower - 1) << text_of(stops);
        }
}

// The shorter way leads through the stops.
TEST(StopsAWholeTurnApart, LeadADriveBetweenThem) {
    for (const bool swept : {false, true}) {
        Top top(60, 4);
        taut_axis_def angle = limited(-180 * kDegree, 180 * kDegree);
        angle.drive.stiffness = 8;
        angle.drive.damping = 2;
        angle.drive.target = static_cast<float>(-170 * kDegree);
        top.hold(taut_hinge_joint_def_init, taut_world_add_hinge_joint, 0, angle,
                 swept ? TAUT_JOINT_SOLVE_SOFT : TAUT_JOINT_SOLVE_DIRECT);
        top.turn(0, 4);
        EXPECT_NEAR(top.angle / kDegree, -170, 1) << swept;
        ok(taut_joint_set_target(top.joint, 0, static_cast<float>(170 * kDegree), 0));
        top.turn(0, 4);
        EXPECT_NEAR(top.angle / kDegree, 170, 1) << swept;
        EXPECT_GE(top.least / kDegree, -181) << swept;
    }
}

// Where the host puts it there is no way that it came.
TEST(StopsAWholeTurnApart, LetTheHostPlaceABodyAnywhereBetweenThem) {
    Top top(60, 4);
    kHinge(top, limited(-180 * kDegree, 180 * kDegree));
    top.turn(3, 1.5);  // at the upper stop
    taut_pose pose{};
    ok(taut_body_get_pose(top.body, &pose));
    pose.rotation = Quat::turn(kAxis, -150 * kDegree).narrow();
    ok(taut_body_set_pose(top.body, &pose));
    ok(taut_body_set_velocity(top.body, {0, 0, 0}, {0, 0, 0}));
    top.world.step(30);
    EXPECT_NEAR(motion(top.joint).value / kDegree, -150, 0.1);
}

// What one stop holds may turn away from it more than once, and must turn back as often.
TEST(OneStop, CountsTheTurnsThatLeadAway) {
    for (const bool swept : {false, true}) {
        Top top(60, 4);
        top.hold(taut_hinge_joint_def_init, taut_world_add_hinge_joint, 0, limited(-INFINITY, 100 * kDegree),
                 swept ? TAUT_JOINT_SOLVE_SOFT : TAUT_JOINT_SOLVE_DIRECT);
        top.turn(-2, 1);  // away, 10 rad
        EXPECT_LE(top.angle, -9) << swept;
        top.turn(2, 3);
        EXPECT_NEAR(top.angle / kDegree, 100, 1) << swept;
        EXPECT_LE(top.most / kDegree, 101) << swept;
    }
}

}  // namespace
