// What a change of an axis does to the forces that its row carries, which the C interface does not show.
#include <gtest/gtest.h>

#include <cmath>

#include "api/joint_parts.h"
#include "constraints/random.h"

namespace taut {
namespace {

constexpr int kAngle = 5;

// A hinge that is driven within stops, with friction, and was solved.
Joint solved_hinge() {
    Joint joint;
    joint.type = &kHinge;
    Axis axis;
    axis.mode = AxisMode::limited;
    axis.lower = -1;
    axis.upper = 1;
    axis.stiffness = 10;
    axis.max_force = 5;
    axis.friction = 2;
    change_axis(joint, {kAngle}, axis);
    joint.memory[kAngle] = {1, 2, 3, 4};
    for (double& force : joint.lambda) force = 7;
    joint.fresh = false;
    return joint;
}

bool keeps(const AxisMemory& m) { return m.lower == 1 && m.upper == 2; }
bool forgot(const AxisMemory& m) { return m.lower == 0 && m.upper == 0 && m.drive == 0; }

TEST(ChangeOfAxis, OfTargetAndGainsKeepsTheForces) {
    Joint joint = solved_hinge();
    Axis axis = joint.axis[kAngle];
    axis.target = 0.5f;
    axis.speed = 1;
    axis.stiffness = 20;
    axis.damping = 1;
    axis.limit_compliance = 1e-3f;
    change_axis(joint, {kAngle}, axis);
    const AxisMemory& m = joint.memory[kAngle];
    EXPECT_TRUE(keeps(m));
    EXPECT_EQ(m.drive, 3);
    EXPECT_EQ(m.friction, 4);
    EXPECT_EQ(joint.lambda[kAngle], 7);
}

TEST(ChangeOfAxis, OfModeOrStopsForgetsTheForces) {
    for (auto change : {+[](Axis& a) { a.lower = -2; }, +[](Axis& a) { a.upper = 2; },
                        +[](Axis& a) { a.mode = AxisMode::free; }, +[](Axis& a) { a = {}; }}) {
        Joint joint = solved_hinge();
        Axis axis = joint.axis[kAngle];
        change(axis);
        change_axis(joint, {kAngle}, axis);
        EXPECT_TRUE(forgot(joint.memory[kAngle]));
        EXPECT_EQ(joint.lambda[kAngle], 0);
        EXPECT_EQ(joint.lambda[0], 7);  // the other rows go on
    }
}

TEST(ChangeOfAxis, WithoutDriveOrFrictionForgetsThat) {
    Joint joint = solved_hinge();
    Axis axis = joint.axis[kAngle];
    axis.max_force = 0;
    change_axis(joint, {kAngle}, axis);
    EXPECT_TRUE(keeps(joint.memory[kAngle]));
    EXPECT_EQ(joint.memory[kAngle].drive, 0);
    EXPECT_EQ(joint.memory[kAngle].friction, 4);
    axis.friction = 0;
    change_axis(joint, {kAngle}, axis);
    EXPECT_EQ(joint.memory[kAngle].friction, 0);
}

TEST(ChangeOfAxis, TellsWhetherAllIsLocked) {
    Joint joint = solved_hinge();
    EXPECT_FALSE(joint.plain);
    change_axis(joint, {kAngle}, {});
    EXPECT_TRUE(joint.plain);
    Axis axis;
    axis.mode = AxisMode::free;
    change_axis(joint, {kAngle}, axis);
    EXPECT_FALSE(joint.plain);
}

// A new length or place comes bit by bit, an angle by the short way; of a joint that was never solved at once.
TEST(ReplaceJoint, LeavesTheChangeOfItsCoordinatesAsDrift) {
    Memory memory({});
    Nodes nodes(memory);
    Joint joint;
    joint.type = &kHinge;
    joint.node[0] = joint.node[1] = kNone;
    const auto turned = [](double angle) { return rotation_from_vector(Vec3(angle, 0, 0)); };
    write_data(joint, JointFrames{Vec3::Zero(), Vec3::Zero(), Quat::Identity(), turned(3)});
    Joint moved = joint;
    write_data(moved, JointFrames{Vec3::Zero(), Vec3(0, 0.5, 0), Quat::Identity(), turned(-3)});

    Joint fresh = joint;
    replace_joint(nodes, fresh, moved);
    for (double drift : fresh.drift) EXPECT_EQ(drift, 0);
    joint.fresh = moved.fresh = false;
    replace_joint(nodes, joint, moved);
    EXPECT_NEAR(joint.drift[1], 0.5, 1e-12);
    EXPECT_NEAR(joint.drift[kAngle], 2 * 3.14159265358979323846 - 6, 1e-9);
    const Joint same = joint;
    replace_joint(nodes, joint, same);  // what is still to come stays
    EXPECT_NEAR(joint.drift[1], 0.5, 1e-12);
}

// J W J^T against the change of a coordinate's rate by an impulse along it.
TEST(InverseMass, IsWhatAnImpulseAlongTheRowDoes) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        Memory memory({});
        Nodes nodes(memory);
        Joint joint;
        joint.type = &kSixDof;
        for (uint32_t& end : joint.node) {
            end = nodes.add();
            NodeMass mass;
            nodes.info[end].kind = NodeKind::dynamic;
            nodes.motion[end].x = random.vector();
            nodes.motion[end].q = random.rotation();
            mass.inv_mass = random.between(0.1, 2);
            mass.inv_inertia = {random.between(1, 2), random.between(1, 2), random.between(1, 2), 0.1, 0.2, -0.1};
            nodes.mass.reserve_values(1);
            nodes.mass.set(end, mass);
        }
        write_data(joint, JointFrames{random.vector(), random.vector(), random.rotation(), random.rotation()});
        const JointReading reading = read_joint(nodes, joint);
        for (int row = 0; row < 6; ++row) {
            for (int end = 0; end < 2; ++end) {
                const double* j = reading.jacobian + (end * 6 + row) * kDof;
                NodeMotion& motion = nodes.motion[joint.node[end]];
                const NodeMass& mass = nodes.mass[joint.node[end]];
                motion.v = mass.inv_mass * Vec3(j[0], j[1], j[2]);
                motion.w = motion.q * (mass.inv_inertia.matrix() * (motion.q.conjugate() * Vec3(j[3], j[4], j[5])));
            }
            const double expected = rate_of(nodes, joint, reading, row);
            EXPECT_NEAR(inverse_mass_of(nodes, joint, reading, row), expected, 1e-9 * expected) << seed << ", " << row;
        }
    }
}

}  // namespace
}  // namespace taut
