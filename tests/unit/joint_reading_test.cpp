// What is read from a joint at the present poses.
#include <gtest/gtest.h>

#include <string>

#include "state/joint_reading.h"

namespace taut {
namespace {

// A joint of a type, with random data and poses about it. Some of its rows are free or limited.
struct Posed {
    Memory memory{taut_hooks{}};
    Nodes nodes{memory};
    Joint joint;

    Posed(const ConstraintType& type, uint64_t seed) {
        joint.type = &type;
        Pose pose[kMaxNodes];
        type.sample(seed, joint.data, pose);
        for (int end = 0; end < type.nodes; ++end) {
            const uint32_t node = joint.node[end] = nodes.add();
            nodes.info[node].kind = NodeKind::dynamic;
            nodes.motion[node].x = pose[end].x;
            nodes.motion[node].q = Quat(pose[end].R);
        }
        for (int row = 0; row < type.rows; ++row) {
            const uint64_t mode = seed >> row & 3;
            if (mode == 0) joint.axis[row].mode = AxisMode::free;
            if (mode != 1) continue;
            joint.axis[row].mode = AxisMode::limited;
            joint.axis[row].lower = -0.1f;
            joint.axis[row].upper = 0.1f;
        }
    }
};

class EveryJoint : public testing::TestWithParam<const ConstraintType*> {};

INSTANTIATE_TEST_SUITE_P(List, EveryJoint, testing::ValuesIn(constraint_types().begin(), constraint_types().end()),
                         [](const auto& param) { return std::string(param.param->name); });

TEST_P(EveryJoint, GapIsTheLinearErrorOfItsRows) {
    if (GetParam()->bound != Bound::free) GTEST_SKIP() << "no joint";
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        const Posed posed(*GetParam(), seed);
        const double error = error_of(posed.joint, read_joint(posed.nodes, posed.joint)).linear;
        EXPECT_NEAR(gap_of(posed.nodes, posed.joint), error, 1e-12 * (1 + error)) << "seed " << seed;
    }
}

}  // namespace
}  // namespace taut
