// Joints whose ends begin, or were torn, far from where they lock: every solver brings them back.
#include "physics/joint_lab.h"

namespace {

using namespace lab;

struct Way {
    const char* name;
    taut_solver solver;
    taut_joint_solve solve;
};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

class TornUnder : public testing::TestWithParam<Way> {
protected:
    // A body that a joint of the world locks, turned by an angle about an axis. Its angular error in the end [rad].
    template <class Def>
    double left_of(void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*), const Vec& axis,
                   double angle) const {
        const World world([](taut_world_def& def) {
            def.solver = GetParam().solver;
            def.gravity = {0, 0, 0};
        });
        Def def;
        init(&def);
        def.base.body_b = world.add({.rotation = Quat::turn(axis, angle), .mass = 2, .inertia = {0.1, 0.2, 0.25}});
        def.base.solve = GetParam().solve;
        taut_joint joint{};
        ok(add(world.handle, &def, &joint));
        EXPECT_GT(angular_error(joint), 1) << "degrees " << angle / kDegree;
        world.step(240);
        EXPECT_LT(error(joint), 1e-4);
        return angular_error(joint);
    }
    template <class Def>
    void expect_return(void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*),
                       std::initializer_list<Vec> axes,
                       std::initializer_list<double> angles = {100, 170, 179.9, 180}) const {
        for (double degrees : angles)
            for (const Vec& axis : axes)
                EXPECT_LT(left_of(init, add, axis, degrees * kDegree), 1e-3)
                    << degrees << " degrees about " << axis.x << " " << axis.y << " " << axis.z;
    }
};

// The axes of turns that none of the joint's freedoms are.
TEST_P(TornUnder, FixedReturns) {
    expect_return(taut_fixed_joint_def_init, taut_world_add_fixed_joint,
                  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -2, 0.5}});
}
TEST_P(TornUnder, SliderReturns) {
    expect_return(taut_slider_joint_def_init, taut_world_add_slider_joint,
                  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -2, 0.5}});
}
TEST_P(TornUnder, HingeReturns) {
    expect_return(taut_hinge_joint_def_init, taut_world_add_hinge_joint, {{0, 1, 0}, {0, 0, 1}, {0, -2, 0.5}});
}
TEST_P(TornUnder, CylindricalReturns) {
    expect_return(taut_cylindrical_joint_def_init, taut_world_add_cylindrical_joint,
                  {{0, 1, 0}, {0, 0, 1}, {0, -2, 0.5}});
}

// Its cross turns over freely: it is furthest off where the arms are in line.
TEST_P(TornUnder, UniversalReturns) {
    expect_return(taut_universal_joint_def_init, taut_world_add_universal_joint, {{0, 0, 1}, {0, 0, -1}},
                  {60, 80, 89.9, 90, 100});
}

INSTANTIATE_TEST_SUITE_P(Solver, TornUnder,
                         testing::Values(Way{"direct", TAUT_SOLVER_BLOCK_LDLT, TAUT_JOINT_SOLVE_DIRECT},
                                         Way{"swept", TAUT_SOLVER_BLOCK_LDLT, TAUT_JOINT_SOLVE_SOFT},
                                         Way{"gauss_seidel", TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                             TAUT_JOINT_SOLVE_DIRECT},
                                         Way{"jacobi", TAUT_SOLVER_ACCELERATED_JACOBI, TAUT_JOINT_SOLVE_DIRECT}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
