// By which rules an island has rows that are solved directly.
#include <gtest/gtest.h>

#include "partition/needs.h"
#include "unit/partition_graph.h"

namespace taut::test {
namespace {

struct Reasons : testing::Test, Graph {
    uint8_t of(uint32_t node) {
        Array<uint8_t> reasons(memory);
        partition.find_reasons(joints, elements, reasons);
        return reasons[partition.island_of(node)];
    }
};

TEST_F(Reasons, LightThingsAreSwept) {
    const auto boxes = tower(3);
    build();
    EXPECT_EQ(of(boxes[0]), 0);
}

TEST_F(Reasons, HeavyOnLightIsATowerThatIsPressed) {
    const auto boxes = tower(3), others = tower(3);
    set_mass(boxes[2], 100);
    build();
    EXPECT_EQ(of(boxes[0]), kByTower | kByPress);
    EXPECT_EQ(of(others[0]), 0) << "of another island";
}

TEST_F(Reasons, JointsAreDirectByTheirDefOrTheirLoad) {
    const uint32_t a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
    const uint32_t joint = join(a, b);
    joints.record[joint].loaded = 0;
    build();
    EXPECT_EQ(of(a), kByJoint);
    joints.record[joint].solve = JointSolve::by_load;
    joints.record[joint].need = 2 * kPatience;
    build();
    EXPECT_EQ(of(a), kByLoad);
}

TEST_F(Reasons, LoadedMechanismsTakeContactsIn) {
    const uint32_t ground = add(NodeKind::fixed), a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
    const uint32_t joint = join(a, b);
    touch(ground, a);
    joints.record[joint].loaded = kLoadedAfter;
    build();
    EXPECT_EQ(of(a), kByJoint | kByLoad);
}

TEST_F(Reasons, HitsTakeContactsIn) {
    const uint32_t ground = add(NodeKind::fixed), a = add(NodeKind::dynamic), b = add(NodeKind::dynamic);
    joints.record[join(a, b)].loaded = 0;
    touch(ground, a);
    touching[0].force[0].normal = 1000;  // [N]: more than sweeps hold of 1 kg
    build();
    EXPECT_EQ(of(a), kByJoint | kByHit);
}

}  // namespace
}  // namespace taut::test
