// Blocks against the dense solution of the same equations, which is assembled from the constraint types alone.
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/random.h"
#include "rig.h"

namespace taut::test {
namespace {

Vec3 inertia_of(Random& random) {
    const double a = 0.5 + random.unit(), b = 0.5 + random.unit();
    return Vec3(a, b, a + b * random.unit()) * 0.1;
}

Vec3 anchor(const Rig& rig, uint32_t node, Random& random) {
    const Vec3 at = random.vector();
    return node != kNone && rig.w.nodes.info[node].kind == NodeKind::particle ? Vec3(Vec3::Zero()) : at;
}

Vec3 in_world(const Rig& rig, uint32_t node, const Vec3& point) {
    if (node == kNone) return point;
    return rig.w.nodes.motion[node].x + rig.w.nodes.motion[node].q * point;
}

// A tree of bodies and particles held by the world, in motion, its joints open by a millimetre.
void build_tree(Rig& rig, uint64_t seed, bool rigid) {
    Random random(seed);
    auto softness = [&] { return rigid ? 0.0 : std::pow(10.0, -2 - 4 * random.unit()); };
    const uint32_t count = 3 + static_cast<uint32_t>(random.unit() * 8);
    std::vector<uint32_t> nodes;
    for (uint32_t i = 0; i < count; ++i) {
        const bool point = i % 3 == 2, ball = random.unit() < 0.5;
        const uint32_t parent = i == 0 ? kNone : nodes[static_cast<size_t>(random.unit() * i)];
        const double mass = std::pow(10.0, 2 * random.unit()), length = 0.5 + random.unit(), soft = softness();
        const Quat q = random.rotation();
        const Vec3 there = anchor(rig, parent, random), here = point ? Vec3(Vec3::Zero()) : random.vector();
        const Vec3 gap =
            1e-3 * random.vector() + (ball ? Vec3(Vec3::Zero()) : Vec3(length * random.vector().normalized()));
        const Vec3 x = in_world(rig, parent, there) + gap - (point ? here : q * here);
        const Vec3 v = 0.3 * random.vector(), spin = 0.3 * random.vector();
        nodes.push_back(point ? rig.particle(mass, x, v) : rig.body(mass, mass * inertia_of(random), x, q, v, spin));
        NodeMotion& m = rig.w.nodes.motion[nodes.back()];
        m.slow_v = 0.3 * random.vector();
        if (!point) m.slow_w = 0.3 * random.vector();
        if (ball)
            rig.ball(parent, nodes.back(), there, here, soft, 3);
        else
            rig.rod(parent, nodes.back(), there, here, length, soft, 5);
    }
}

Forces forces(const Rig& rig) {
    Forces out;
    for (const Joint& joint : rig.w.joints.record) out.push_back(Eigen::VectorXd::Map(joint.lambda, joint.type->rows));
    return out;
}

void expect_velocity_near(const Rig& rig, const DenseSubstep& exact, double tolerance) {
    EXPECT_LE((velocities(rig) - exact.velocity).norm(), tolerance * exact.velocity.norm());
}

void expect_near(const Rig& rig, const DenseSubstep& exact, double tolerance) {
    expect_velocity_near(rig, exact, tolerance);
    double size = 0;
    for (const auto& f : exact.force) size = std::max(size, f.norm());
    for (size_t j = 0; j < exact.force.size(); ++j)
        EXPECT_LE((forces(rig)[j] - exact.force[j]).norm(), tolerance * size) << "joint " << j;
}

// A frame's first substep without geometric stiffness; the exact one.
DenseSubstep solve_without_stiffness(Rig& rig) {
    rig.settings.geometric_stiffness = false;
    rig.begin(kBlockLdlt);
    rig.predict();
    DenseSubstep exact = solve_dense(rig, {});
    rig.solve();
    EXPECT_EQ(rig.report.failures, 0u);
    return exact;
}

class BlockLdlt : public testing::TestWithParam<uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, BlockLdlt, testing::Range<uint64_t>(1, 31));

TEST_P(BlockLdlt, SolvesTheSubstepExactlyWithoutStiffness) {
    for (bool rigid : {true, false}) {
        Rig rig;
        build_tree(rig, GetParam(), rigid);
        expect_near(rig, solve_without_stiffness(rig), 1e-9);
    }
}

// First substep: solved without K, then with K of the forces just found (study/damping.md, section 7.2).
TEST_P(BlockLdlt, MakesStiffnessOfTheForcesJustFoundAtFirst) {
    Rig rig;
    build_tree(rig, GetParam(), true);
    rig.begin(kBlockLdlt);
    rig.predict();
    const DenseSubstep plain = solve_dense(rig, {}), exact = solve_dense(rig, {plain.force});
    rig.solve();
    EXPECT_EQ(rig.report.solves, 1u);
    EXPECT_EQ(rig.report.resolves, 1u);
    expect_near(rig, exact, 1e-8);
}

// (h^2 K(now) - 1.3 h^2 K(old)) / M of a joint, the largest of its nodes' freedoms.
double growth(const Rig& rig, const Joint& joint, const double* now, const double* old) {
    Eigen::Matrix<double, 12, 12, Eigen::RowMajor> k, before;
    Pose poses[2];
    for (int n = 0; n < 2; ++n)
        if (joint.node[n] != kNone) poses[n] = rig.w.system.pose[rig.w.system.at(joint.node[n])];
    joint.type->stiffness(joint.data, poses, now, Curvature::positive, k.data());
    joint.type->stiffness(joint.data, poses, old, Curvature::positive, before.data());
    double most = 0;
    for (int n = 0; n < 2; ++n) {
        if (joint.node[n] == kNone || !moves_by_forces(rig.w.nodes.info[joint.node[n]].kind)) continue;
        const bool turns = rig.w.nodes.info[joint.node[n]].kind == NodeKind::dynamic;
        const Mat3 inertia = poses[n].R * rig.w.nodes.mass[joint.node[n]].inertia.matrix() * poses[n].R.transpose();
        for (int i = 0; i < (turns ? 6 : 3); ++i)
            most = std::max(most, rig.h * rig.h * (k - 1.3 * before)(6 * n + i, 6 * n + i) /
                                      (i < 3 ? rig.w.nodes.mass[joint.node[n]].mass : inertia(i - 3, i - 3)));
    }
    return most;
}

// Later: with K of the last forces, and once more with the sum of old and new where K of a joint outgrew the old one by
// more than the motion bears.
TEST_P(BlockLdlt, MakesStiffnessOfTheLastForcesAndOfBothWhereOneGrew) {
    Rig rig;
    build_tree(rig, GetParam(), true);
    rig.begin(kBlockLdlt);
    static int grown = 0;  // over all seeds
    for (int substep = 0; substep < 6; ++substep) {
        SCOPED_TRACE(testing::Message() << "substep " << substep);
        if (substep % 2 == 0)  // a blow
            for (NodeMotion& m : rig.w.nodes.motion) m.v += Vec3(0, -std::pow(4.0, substep), 0);
        rig.predict();
        const Forces old = forces(rig);
        const uint32_t resolves = rig.report.resolves;
        const bool tripped = rig.w.partition.blocks[0].memory.guard_left > 0;
        const DenseSubstep exact = solve_dense(rig, {old}, !tripped),
                           again = solve_dense(rig, {old, exact.force}, !tripped);
        bool grew = false;
        double size = 0;
        for (const auto& f : exact.force) size = std::max(size, f.norm());
        for (size_t j = 0; j < old.size(); ++j)
            grew = grew ||
                   ((exact.force[j] - old[j]).norm() > 0.3 * old[j].norm() && exact.force[j].norm() > 1e-3 * size &&
                    growth(rig, rig.w.joints.record[j], exact.force[j].data(), old[j].data()) > 4);
        RecordProperty("grown", grown += grew);
        rig.solve();
        if (substep > 0 && !tripped) {
            EXPECT_EQ(rig.report.resolves - resolves, grew ? 1u : 0u);
            expect_near(rig, grew ? again : exact, 1e-8);
        }
        rig.move();
        rig.relax();
    }
}

// A body between two ball joints has five freedoms for their six rows, so its joints must not both be eliminated before
// what hangs further down; a rod's coupling makes its end look as well connected as that body.
TEST(BlockLdltOrder, BallBallRodOnTheWorld) {
    Rig rig;
    uint32_t last = kNone;
    for (int i = 0; i < 3; ++i) {
        const uint32_t link =
            rig.body(1, Vec3(0.1, 0.2, 0.15), Vec3(i + 0.5, 0, 0), Quat::Identity(), Vec3(0, 0, 0.1 * i));
        if (i < 2)
            rig.ball(last, link, Vec3(i == 0 ? 0 : 0.5, 0, 0), Vec3(-0.5, 0, 0));
        else
            rig.rod(last, link, Vec3(0.4, 0, 0), Vec3(-0.4, 0, 0), 0.2);
        last = link;
    }
    expect_near(rig, solve_without_stiffness(rig), 1e-9);
}

// Between two steps a joint went and another took its slot, between other nodes of the same block.
TEST(BlockLdltChanges, AJointInAReusedSlotIsSolvedAsItself) {
    for (bool elsewhere : {true, false}) {
        SCOPED_TRACE(elsewhere ? "joined elsewhere" : "of another type");
        Rig rig;
        std::vector<uint32_t> link;
        for (int i = 0; i < 4; ++i) link.push_back(rig.body(1 + i, Vec3(0.1, 0.2, 0.15), Vec3(i, 0, 0)));
        const Vec3 end(0.5, 0, 0);
        rig.ball(kNone, link[0], Vec3(-0.5, 0, 0), -end);
        for (size_t i = 1; i < 4; ++i) rig.ball(link[i - 1], link[i], end, -end);
        rig.settings.geometric_stiffness = false;
        rig.begin(kBlockLdlt);
        rig.predict();
        rig.solve();
        rig.move();
        rig.relax();
        rig.w.joints.remove(3);
        const uint32_t slot = elsewhere ? rig.ball(link[0], link[3], Vec3(0, 0, 1), Vec3(-3, 0, 1))
                                        : rig.rod(link[2], link[3], Vec3::Zero(), Vec3::Zero(), 1);
        ASSERT_EQ(slot, 3u);
        expect_near(rig, solve_without_stiffness(rig), 1e-9);
    }
}

// Loops get a compliance, a tiny part of the rows' own effective inverse mass, which is not seen in the motion.
TEST(BlockLdltLoops, AreSolvedToTheirCompliance) {
    Rig rig;
    std::vector<uint32_t> node;
    for (int i = 0; i < 4; ++i)
        node.push_back(
            rig.body(1 + i, Vec3(0.1, 0.2, 0.15), Vec3(i % 2, i / 2, 0), Quat::Identity(), Vec3(0, 0, 0.3 * i)));
    const int ring[4] = {0, 1, 3, 2};
    for (int i = 0; i < 4; ++i) {
        const uint32_t a = node[static_cast<size_t>(ring[i])], b = node[static_cast<size_t>(ring[(i + 1) % 4])];
        const Vec3 half = 0.5 * (rig.w.nodes.motion[b].x - rig.w.nodes.motion[a].x);
        rig.ball(a, b, half, -half);
    }
    expect_velocity_near(rig, solve_without_stiffness(rig), 1e-5);
}

// Square nets of bodies on ball joints or of particles on rods, flat (many rows redundant) or bent, held at a corner.
TEST(BlockLdltLoops, NetsAreSolvedToTheirCompliance) {
    for (bool bodies : {true, false})
        for (bool bent : {true, false})
            for (int side : {2, 3, 5, 7}) {
                SCOPED_TRACE(testing::Message()
                             << (bodies ? "bodies" : "particles") << (bent ? ", bent, " : ", flat, ") << side);
                Rig rig;
                auto at = [&](int i, int k) { return Vec3(k, -i, bent ? 0.1 * std::sin(1.7 * i + 0.9 * k * k) : 0.0); };
                std::vector<uint32_t> node;
                for (int i = 0; i < side; ++i)
                    for (int k = 0; k < side; ++k) {
                        const double mass = 1 + (i + k) % 3;
                        node.push_back(bodies ? rig.body(mass, Vec3(0.1, 0.2, 0.15), at(i, k), Quat::Identity(),
                                                         Vec3(0, 0, 0.1 * i))
                                              : rig.particle(mass, at(i, k), Vec3(0.1 * k, 0, 0.1 * i)));
                    }
                auto tie = [&](int i, int k, int to_i, int to_k) {
                    const Vec3 d = at(to_i, to_k) - at(i, k);
                    const uint32_t a = node[static_cast<size_t>(i * side + k)],
                                   b = node[static_cast<size_t>(to_i * side + to_k)];
                    if (bodies)
                        rig.ball(a, b, 0.5 * d, -0.5 * d);
                    else
                        rig.rod(a, b, Vec3::Zero(), Vec3::Zero(), d.norm());
                };
                rig.ball(kNone, node[0], at(0, 0), Vec3::Zero());
                for (int i = 0; i < side; ++i)
                    for (int k = 0; k < side; ++k) {
                        if (k + 1 < side) tie(i, k, i, k + 1);
                        if (i + 1 < side) tie(i, k, i + 1, k);
                    }
                expect_velocity_near(rig, solve_without_stiffness(rig), 1e-4);
            }
}

// Two rods for one freedom: without its compliance the matrix would be singular.
TEST(BlockLdltLoops, RedundantRodsShareTheLoad) {
    Rig rig;
    const uint32_t weight = rig.particle(2, Vec3(0, -1, 0));
    for (int i = 0; i < 2; ++i) rig.rod(kNone, weight, Vec3::Zero(), Vec3::Zero(), 1);
    rig.begin(kBlockLdlt);
    rig.predict();
    rig.solve();
    EXPECT_EQ(rig.report.failures, 0u);
    EXPECT_LE(velocities(rig).norm(), 1e-6);
    for (const auto& f : forces(rig)) EXPECT_NEAR(f[0], -9.81, 1e-5);  // tension, half the weight each
}

// A kinematic end drives the block at its own velocity.
TEST(BlockLdltEnds, KinematicNodesDriveTheirJoints) {
    Rig rig;
    const uint32_t lift = rig.fixed();
    rig.w.nodes.info[lift].kind = NodeKind::kinematic;
    rig.w.nodes.motion[lift].v = Vec3(0, 3, 0);
    rig.w.nodes.motion[lift].w = Vec3(0, 0, 2);
    const uint32_t load = rig.body(5, Vec3(1, 1, 1), Vec3(1, 0, 0));
    rig.ball(lift, load, Vec3(1, 0, 0), Vec3::Zero());
    rig.begin(kBlockLdlt);
    rig.predict();
    rig.solve();
    EXPECT_LE((rig.w.system.exact[rig.w.system.at(load)].v - Vec3(0, 5, 0)).norm(), 1e-9);
}

// A body without mass, as quarantine leaves one behind in mid-frame, fails its block and nothing else.
TEST(BlockLdltFailure, LeavesTheUnconstrainedVelocity) {
    Rig rig;
    const uint32_t good = rig.particle(1, Vec3(0, 0, 0)), bad = rig.particle(1, Vec3(1, 0, 0));
    rig.rod(good, bad, Vec3::Zero(), Vec3::Zero(), 1);
    rig.begin(kBlockLdlt);
    NodeMass none = rig.w.nodes.mass[bad];
    none.mass = 0;
    rig.w.nodes.mass.reserve_values(1);
    rig.w.nodes.mass.set(bad, none);
    rig.predict();
    rig.solve();
    EXPECT_EQ(rig.report.failures, 1u);
    EXPECT_TRUE(velocities(rig).allFinite());
    EXPECT_NEAR(rig.w.system.exact[rig.w.system.at(good)].v.y(), -9.81 * rig.h, 1e-12);
}

}  // namespace
}  // namespace taut::test
