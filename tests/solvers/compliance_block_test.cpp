// A constraint type that the library does not have: six rows between two bodies with a full compliance block, as a
// finite element or a beam brings it. Type and solver meet only through the contract.
#include <gtest/gtest.h>

#include <algorithm>

#include "constraints/random.h"

#include "solvers/rig.h"

namespace taut::test {
namespace {

struct BeamData {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();  // unused; where the interface looks for anchors
    Vec3 offset = Vec3::Zero();
    const double* compliance = nullptr;  // [6][6]
};

// C = (x_b - x_a - offset, 0): the turn of one substep is all the second half sees.
void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    Vec3::Map(error) = x[1].x - x[0].x - static_cast<const BeamData*>(data)->offset;
    Vec3::Map(error + 3).setZero();
    if (!jacobian) return;
    std::fill(jacobian, jacobian + 72, 0.0);
    for (int r = 0; r < 6; ++r) {
        jacobian[r * kDof + r] = -1;
        jacobian[36 + r * kDof + r] = 1;
    }
}

void no_stiffness(const void*, const Pose*, const double*, Curvature, double* k) { std::fill(k, k + 144, 0.0); }

const double* compliance(const void* data) { return static_cast<const BeamData*>(data)->compliance; }

const ConstraintType kBeam{"beam",       6,          2,      sizeof(BeamData), Bound::free, false, 0x38, evaluate,
                           no_stiffness, compliance, nullptr};

// A chain of bodies on beams of random stiffness, held at one end.
void build(Rig& rig, Eigen::Matrix<double, 6, 6, Eigen::RowMajor>* blocks, int count, uint64_t seed) {
    Random random(seed);
    uint32_t parent = kNone;
    for (int i = 0; i < count; ++i) {
        Eigen::Matrix<double, 6, 6> root;
        for (int e = 0; e < 36; ++e) root.data()[e] = 2 * random.unit() - 1;
        blocks[i] = 1e-3 * (root * root.transpose() + 0.1 * Eigen::Matrix<double, 6, 6>::Identity());
        const Vec3 x(i + 1.0, 0.1 * random.unit(), 0);
        const uint32_t body = rig.body(1 + 10 * random.unit(), Vec3(1, 2, 3), x, random.rotation(),
                                       0.3 * random.vector(), 0.3 * random.vector());
        rig.join(kBeam, parent, body, BeamData{Vec3::Zero(), Vec3::Zero(), Vec3(1, 0, 0), blocks[i].data()}, 0, 0.002);
        parent = body;
    }
}

TEST(ComplianceBlock, IsSolvedByTheDirectSolver) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Rig rig;
        Eigen::Matrix<double, 6, 6, Eigen::RowMajor> blocks[5];
        build(rig, blocks, 5, seed);
        rig.begin(kBlockLdlt);
        rig.predict();
        const DenseSubstep exact = solve_dense(rig, {});
        rig.solve();
        EXPECT_LE((velocities(rig) - exact.velocity).norm(), 1e-9 * exact.velocity.norm());
        for (size_t j = 0; j < exact.force.size(); ++j)
            EXPECT_LE((Eigen::VectorXd::Map(rig.w.joints.record[j].lambda, 6) - exact.force[j]).norm(),
                      1e-8 * exact.force[j].norm());
    }
}

TEST(ComplianceBlock, IsReachedByEverySweepingSolver) {
    for (const Solver* solver : {&kProjectedGaussSeidel, &kAcceleratedJacobi}) {
        SCOPED_TRACE(solver->name);
        Rig rig;
        Eigen::Matrix<double, 6, 6, Eigen::RowMajor> blocks[3];
        build(rig, blocks, 3, 7);
        rig.settings.sweeps = 1000;
        rig.settings.stepping = Stepping::velocity;
        rig.begin(*solver);
        rig.predict();
        const DenseSubstep exact = solve_dense(rig, {});
        rig.solve();
        EXPECT_LE((velocities(rig) - exact.velocity).norm(), 1e-4 * exact.velocity.norm());
    }
}

}  // namespace
}  // namespace taut::test
