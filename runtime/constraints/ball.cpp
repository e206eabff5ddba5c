// Ball joint.  C = (x_b + R_b s_b) - (x_a + R_a s_a) [m];  J_b = (I, -hat r_b), J_a = (-I, hat r_a), r = R s;
// K: lambda at lever r_b, -lambda at lever r_a, block-diagonal           (Tournier et al. 2015, eq. 22)
#include "constraints/ball.h"

#include <algorithm>

#include "constraints/constraint.h"
#include "constraints/frame_lanes.h"
#include "constraints/lever.h"
#include "constraints/random.h"

namespace taut {
namespace {

void evaluate_ball(const void* data, const Pose* x, double* error, double* jacobian) {
    const auto& joint = *static_cast<const BallData*>(data);
    const Vec3 ra = x[0].R * joint.anchor_a, rb = x[1].R * joint.anchor_b;
    Vec3::Map(error) = (x[1].x - x[0].x) + (rb - ra);
    if (!jacobian) return;
    set_block(jacobian, 3, 0, 0, -Mat3::Identity());
    set_block(jacobian, 3, 0, 3, hat(ra));
    set_block(jacobian, 3, 1, 0, Mat3::Identity());
    set_block(jacobian, 3, 1, 3, -hat(rb));
}

void evaluate_ball_lanes(const LaneFrames& anchors, const float* const (&pose)[2][kLanes], LaneScalar* error,
                         LaneScalar* jacobian) {
    const FramePairLanes<BaseLanes> f(anchors, pose);
    LaneRowWriter<BaseLanes>(f, 3, error, jacobian).anchors();
}

void stiffness_of_ball(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const auto& joint = *static_cast<const BallData*>(data);
    const Vec3 f = Vec3::Map(lambda);
    std::fill(k, k + 12 * 12, 0.0);
    add_block(k, 3, 3, lever_stiffness(-f, x[0].R * joint.anchor_a, part));
    add_block(k, 9, 9, lever_stiffness(f, x[1].R * joint.anchor_b, part));
}

void sample_ball(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& joint = *static_cast<BallData*>(data);
    joint = {random.vector(), random.vector()};
    random.poses(x, 2);
}

}  // namespace

const ConstraintType kBall{
    "ball",  3,           2,       sizeof(BallData),   Bound::free, false, 0, evaluate_ball, stiffness_of_ball,
    nullptr, sample_ball, nullptr, evaluate_ball_lanes};

}  // namespace taut
