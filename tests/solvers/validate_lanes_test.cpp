// The validators of lanes and impulses, by planted flaws.
#include <gtest/gtest.h>

#include <limits>

#include "check/validate.h"
#include "rig.h"

namespace taut::test {
namespace {

// Two balls on the ground with a swept joint between them, after a substep.
class ValidateLanes : public testing::Test, protected Rig {
protected:
    ValidateLanes() {
        const uint32_t ground = fixed();
        for (const double x : {0.0, 1.0}) {
            ball_node[x > 0] = body(1, Vec3::Constant(0.1), Vec3(x, 0.5, 0));
            contact(ground, ball_node[x > 0], Vec3f::UnitY(), {{Vec3(x, 0, 0), 0.0}});
        }
        ball(ball_node[0], ball_node[1], Vec3(0.5, 0, 0), Vec3(-0.5, 0, 0));
        begin(kProjectedGaussSeidel);
        predict();
        solve();
        move();
        relax();
    }
    LanePoint& point() { return *w.system.contacts.group[0].point; }

    uint32_t ball_node[2];
};

TEST_F(ValidateLanes, SoundOnesHaveNoFlaw) {
    EXPECT_FALSE(validate_lanes(w.system, group()));
    EXPECT_FALSE(validate_impulses(w.system));
    EXPECT_GT(point().impulse[0][0], 0);
}

TEST_F(ValidateLanes, NodesAreOnceInALaneGroup) {
    LaneGroup& g = w.system.contacts.group[0];
    g.b[1] = g.b[0];
    const MaybeFlaw found = validate_lanes(w.system, group());
    ASSERT_TRUE(found);
    EXPECT_STREQ(found->invariant, "a lane group of contacts has a moving node once");
}

TEST_F(ValidateLanes, JointNodesAreOnceInALaneGroup) {
    JointGroup& g = w.system.joints.group[0];
    g.node[1][0] = g.node[0][0];
    const MaybeFlaw found = validate_lanes(w.system, group());
    ASSERT_TRUE(found);
    EXPECT_STREQ(found->invariant, "a lane group of joints has a moving node once");
}

TEST_F(ValidateLanes, PairsAndJointsAreOnceInLanes) {
    w.system.joints.group[0].block[1] = w.system.joints.group[0].block[0];
    const MaybeFlaw twice = validate_lanes(w.system, group());
    ASSERT_TRUE(twice);
    EXPECT_STREQ(twice->invariant, "lanes hold swept joints once");
    w.system.contacts.group[0].pair[1] = kNone;
    const MaybeFlaw lost = validate_lanes(w.system, group());
    ASSERT_TRUE(lost);
    EXPECT_STREQ(lost->invariant, "lanes hold each swept pair once");
    EXPECT_EQ(lost->index, 1u);
}

TEST_F(ValidateLanes, ImpulsesPushAndStayInTheirCones) {
    const float normal = point().impulse[0][0], friction = w.system.contacts.group[0].friction[0];
    point().impulse[1][0] = friction * normal;
    EXPECT_FALSE(validate_impulses(w.system)) << "on the rim";
    point().impulse[1][0] = 1.001f * friction * normal;
    const MaybeFlaw slips = validate_impulses(w.system);
    ASSERT_TRUE(slips);
    EXPECT_STREQ(slips->invariant, "friction is within its cone");
    point().impulse[0][0] = -normal;
    const MaybeFlaw pulls = validate_impulses(w.system);
    ASSERT_TRUE(pulls);
    EXPECT_STREQ(pulls->invariant, "normal impulses are not negative");
    EXPECT_EQ(pulls->index, w.system.contacts.group[0].pair[0]);
}

TEST_F(ValidateLanes, StepsOfCheckedBuildsAbortWithStageInvariantAndIndex) {
    validate(w, {Stage::publish});
    w.nodes.motion[ball_node[1]].v.x() = std::numeric_limits<double>::infinity();
    EXPECT_DEATH(validate(w, {Stage::publish}), "after publish .* motions are finite: 2");
}

}  // namespace
}  // namespace taut::test
