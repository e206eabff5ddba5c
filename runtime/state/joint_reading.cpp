#include "state/joint_reading.h"

#include <cmath>
#include <cstring>

namespace taut {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;

JointAnchors anchors_of(const Joint& joint) {
    JointAnchors anchors;
    std::memcpy(static_cast<void*>(&anchors), joint.data, sizeof anchors);
    return anchors;
}

const double* row_of(const Joint& joint, const JointReading& reading, int end, int row) {
    return reading.jacobian + (end * joint.type->rows + row) * kDof;
}

Vec3 linear_part(const double* row) { return {row[0], row[1], row[2]}; }
Vec3 angular_part(const double* row) { return {row[3], row[4], row[5]}; }

}  // namespace

Pose pose_of(const Nodes& nodes, uint32_t node) {
    if (node == kNone) return {};
    const NodeMotion& motion = nodes.motion[node];
    if (nodes.info[node].kind == NodeKind::particle) return {motion.x, Mat3::Identity()};
    return {motion.x, motion.q.toRotationMatrix()};
}

Vec3 world_anchor(const Nodes& nodes, const Joint& joint, int end) {
    const JointAnchors anchors = anchors_of(joint);
    const Pose pose = pose_of(nodes, joint.node[end]);
    return pose.x + pose.R * (end == 0 ? anchors.a : anchors.b);
}

JointReading read_joint(const Nodes& nodes, const Joint& joint) {
    JointReading reading;
    for (int end = 0; end < 2; ++end) reading.pose[end] = pose_of(nodes, joint.node[end]);
    joint.type->evaluate(joint.data, reading.pose, reading.value, reading.jacobian);
    return reading;
}

double rate_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    double rate = 0;
    for (int end = 0; end < 2; ++end) {
        if (joint.node[end] == kNone) continue;
        const double* j = row_of(joint, reading, end, row);
        const NodeMotion& motion = nodes.motion[joint.node[end]];
        rate += linear_part(j).dot(motion.v) + angular_part(j).dot(motion.w);
    }
    return rate;
}

double inverse_mass_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    double inverse = 0;
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = joint.node[end];
        if (node == kNone || !moves_by_forces(nodes.info[node].kind)) continue;
        const double* j = row_of(joint, reading, end, row);
        const Vec3 turn = reading.pose[end].R.transpose() * angular_part(j);
        const NodeMass& mass = nodes.mass[node];
        inverse += mass.inv_mass * linear_part(j).squaredNorm() + turn.dot(mass.inv_inertia.matrix() * turn);
    }
    return inverse;
}

double overrun_of(const Joint& joint, const JointReading& reading, int row) {
    const Axis& axis = joint.axis[row];
    if (axis.mode != AxisMode::limited) return 0;
    double value = reading.value[row];
    const double centre = 0.5 * (static_cast<double>(axis.lower) + axis.upper);
    if (is_angle(joint, row) && std::isfinite(centre)) value -= kTurn * std::round((value - centre) / kTurn);
    return std::max({0.0, axis.lower - value, value - axis.upper});
}

JointError error_of(const Joint& joint, const JointReading& reading) {
    double squared[2] = {};
    for (int row = 0; row < joint.type->rows; ++row) {
        const double error = is_locked(joint, row) ? reading.value[row] : overrun_of(joint, reading, row);
        squared[is_angle(joint, row)] += error * error;
    }
    return {std::sqrt(squared[0]), std::sqrt(squared[1])};
}

Wrench wrench_of(const Joint& joint, const JointReading& reading) {
    Wrench wrench;
    if (joint.fresh) return wrench;
    for (int row = 0; row < joint.type->rows; ++row) {
        const double* j = row_of(joint, reading, 1, row);
        wrench.force += joint.lambda[row] * linear_part(j);
        wrench.torque += joint.lambda[row] * angular_part(j);
    }
    // J^T lambda is about the centre of mass: move it to the anchor.
    wrench.torque -= (reading.pose[1].R * anchors_of(joint).b).cross(wrench.force);
    return wrench;
}

}  // namespace taut
