#include "api/joint_kinds.h"

#include <algorithm>

namespace taut {
namespace {

constexpr JointAxis kFirst[] = {{0}}, kAngle[] = {{5}}, kSlideAngle[] = {{0}, {5}}, kTwoAngles[] = {{4}, {5}},
                    kSwingTwist[] = {{3, true, 5}, {4}}, kSix[] = {{0}, {1}, {2}, {3}, {4}, {5}},
                    kWheelAxes[] = {{0}, {4}, {5}};

// In the order of taut_joint_kind.
const JointKind kKinds[] = {
    {TAUT_JOINT_BALL, &kBall, false, false, {}},
    {TAUT_JOINT_DISTANCE, &kDistance, false, false, kFirst},
    {TAUT_JOINT_FIXED, &kFixed, true, false, {}},
    {TAUT_JOINT_HINGE, &kHinge, true, false, kAngle},
    {TAUT_JOINT_SLIDER, &kSlider, true, false, kFirst},
    {TAUT_JOINT_UNIVERSAL, &kUniversal, true, false, kTwoAngles},
    {TAUT_JOINT_CYLINDRICAL, &kCylindrical, true, false, kSlideAngle},
    {TAUT_JOINT_CONE_TWIST, &kConeTwist, true, false, kSwingTwist},
    {TAUT_JOINT_SIX_DOF, &kSixDof, true, false, kSix},
    {TAUT_JOINT_WHEEL, &kWheel, true, false, kWheelAxes},
    {TAUT_JOINT_GEAR, &kGear, true, true, {}},
    {TAUT_JOINT_RACK_PINION, &kRackPinion, true, true, {}},
    {TAUT_JOINT_PULLEY, &kPulley, false, true, kFirst},
};

}  // namespace

const JointKind& joint_kind(taut_joint_kind kind) { return kKinds[kind]; }

const JointKind& kind_of(const Joint& joint) {
    return *std::find_if(std::begin(kKinds), std::end(kKinds),
                         [&](const JointKind& kind) { return kind.type == joint.type; });
}

}  // namespace taut
