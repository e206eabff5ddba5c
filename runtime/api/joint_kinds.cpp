#include "api/joint_kinds.h"

#include <algorithm>

namespace taut {
namespace {

constexpr JointAxis kFirst[] = {{0}}, kAngle[] = {{5}}, kSlideAngle[] = {{0}, {5}}, kTwoAngles[] = {{4}, {5}},
                    kSwingTwist[] = {{3, true, 5}, {4}}, kSix[] = {{0}, {1}, {2}, {3}, {4}, {5}};

// In the order of taut_joint_kind.
const JointKind kKinds[] = {
    {TAUT_JOINT_BALL, &kBall, false, {}},
    {TAUT_JOINT_DISTANCE, &kDistance, false, kFirst},
    {TAUT_JOINT_FIXED, &kFixed, true, {}},
    {TAUT_JOINT_HINGE, &kHinge, true, kAngle},
    {TAUT_JOINT_SLIDER, &kSlider, true, kFirst},
    {TAUT_JOINT_UNIVERSAL, &kUniversal, true, kTwoAngles},
    {TAUT_JOINT_CYLINDRICAL, &kCylindrical, true, kSlideAngle},
    {TAUT_JOINT_CONE_TWIST, &kConeTwist, true, kSwingTwist},
    {TAUT_JOINT_SIX_DOF, &kSixDof, true, kSix},
};

}  // namespace

const JointKind& joint_kind(taut_joint_kind kind) { return kKinds[kind]; }

const JointKind& kind_of(const Joint& joint) {
    return *std::find_if(std::begin(kKinds), std::end(kKinds),
                         [&](const JointKind& kind) { return kind.type == joint.type; });
}

}  // namespace taut
