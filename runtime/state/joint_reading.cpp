#include "state/joint_reading.h"

#include <cmath>
#include <cstring>

namespace taut {
namespace {

constexpr double kLeast = 1e-9;  // share of an inverse mass that counts as nothing

const double* row_of(const Joint& joint, const JointReading& reading, int end, int row) {
    return reading.jacobian + (end * joint.type->rows + row) * kDof;
}

Vec3 linear_part(const double* row) { return {row[0], row[1], row[2]}; }
Vec3 angular_part(const double* row) { return {row[3], row[4], row[5]}; }

// J_i W J_k^T of two rows; of the masses that bodies have, or would have with no axis locked.
double coupling(const Nodes& nodes, const Joint& joint, const JointReading& reading, int i, int k, bool locks = true) {
    double sum = 0;
    for (int end = 0; end < joint.type->nodes; ++end) {
        const uint32_t node = joint.node[end];
        if (node == kNone || !moves_by_forces(nodes.info[node].kind)) continue;
        const double *ji = row_of(joint, reading, end, i), *jk = row_of(joint, reading, end, k);
        const Mat3 to_body = reading.pose[end].R.transpose();
        const NodeMass& mass = nodes.mass[node];
        if (locks && nodes.locks_of(node).any()) {
            sum += nodes.move_by(node, linear_part(ji)).dot(linear_part(jk)) +
                   nodes.spin_by(node, reading.pose[end].R, angular_part(ji)).dot(angular_part(jk));
            continue;
        }
        sum += mass.inv_mass * linear_part(ji).dot(linear_part(jk)) +
               (to_body * angular_part(ji)).dot(mass.inv_inertia.matrix() * (to_body * angular_part(jk)));
    }
    return sum;
}

void poses_of(const Nodes& nodes, const Joint& joint, Pose* pose) {
    for (int end = 0; end < joint.type->nodes; ++end) pose[end] = pose_of(nodes, joint.node[end]);
}

// Three locked rows that are no angles hold the anchors of two nodes together: they are p_b - p_a along some axes.
bool holds_anchors(const Joint& joint) {
    const ConstraintType& type = *joint.type;
    const bool others_turn = (type.angular | 7) == (1 << type.rows) - 1;
    return type.nodes == 2 && type.rows >= 3 && (type.angular & 7) == 0 && others_turn && is_locked(joint, 0) &&
           is_locked(joint, 1) && is_locked(joint, 2);
}

JointError error_at(const Joint& joint, const double* value) {
    double squared[2] = {};
    for (int row = 0; row < joint.type->rows; ++row) {
        const double error = is_locked(joint, row) ? value[row] : overrun_of(joint, value, row);
        squared[is_angle(joint, row)] += error * error;
    }
    return {std::sqrt(squared[0]), std::sqrt(squared[1])};
}

}  // namespace

Vec3 anchor_of(const Joint& joint, int end) {
    Vec3 anchor;
    std::memcpy(static_cast<void*>(&anchor), joint.data + end * sizeof anchor, sizeof anchor);
    return anchor;
}

void set_anchor(Joint& joint, int end, const Vec3& anchor) {
    std::memcpy(joint.data + end * sizeof anchor, static_cast<const void*>(&anchor), sizeof anchor);
}

Pose pose_of(const Nodes& nodes, uint32_t node) {
    if (node == kNone) return {};
    const NodeMotion& motion = nodes.motion[node];
    if (nodes.info[node].kind == NodeKind::particle) return {motion.x, Mat3::Identity()};
    return {motion.x, motion.q.toRotationMatrix()};
}

Vec3 world_anchor(const Nodes& nodes, const Joint& joint, int end) {
    const Pose pose = pose_of(nodes, joint.node[end]);
    return pose.x + pose.R * anchor_of(joint, end);
}

JointReading read_joint(const Nodes& nodes, const Joint& joint) {
    JointReading reading;
    poses_of(nodes, joint, reading.pose);
    joint.type->evaluate(joint.data, reading.pose, reading.value, reading.jacobian);
    return reading;
}

void restart(const Nodes& nodes, Joint& joint) {
    if (!joint.type->restart) return;
    Pose pose[kMaxEnds];
    poses_of(nodes, joint, pose);
    joint.type->restart(joint.data, pose);
}

void place_anew(const Nodes& nodes, Joint& joint) {
    for (AxisMemory& memory : joint.memory) memory.angle = AxisMemory{}.angle;
    restart(nodes, joint);
}

double rate_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    double rate = 0;
    for (int end = 0; end < joint.type->nodes; ++end) {
        if (joint.node[end] == kNone) continue;
        const double* j = row_of(joint, reading, end, row);
        const NodeMotion& motion = nodes.motion[joint.node[end]];
        rate += linear_part(j).dot(motion.v) + angular_part(j).dot(motion.w);
    }
    return rate;
}

double inverse_mass_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    return coupling(nodes, joint, reading, row, row);
}

bool is_blocked(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    return inverse_mass_of(nodes, joint, reading, row) <= kLeast * coupling(nodes, joint, reading, row, row, false);
}

double held_inverse_mass_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row) {
    int rows[kMaxRows], count = 0;
    for (int r = 0; r < joint.type->rows; ++r)
        if (r != row && is_locked(joint, r)) rows[count++] = r;
    rows[count++] = row;  // last
    double a[kMaxRows][kMaxRows];
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < count; ++k) a[i][k] = coupling(nodes, joint, reading, rows[i], rows[k]);
    for (int pivot = 0; pivot + 1 < count; ++pivot) {
        // A row that earlier ones hold already has nothing left to hold.
        if (!(a[pivot][pivot] > kLeast * inverse_mass_of(nodes, joint, reading, rows[pivot]))) continue;
        for (int i = pivot + 1; i < count; ++i) {
            const double share = a[i][pivot] / a[pivot][pivot];
            for (int k = pivot + 1; k < count; ++k) a[i][k] -= share * a[pivot][k];
        }
    }
    return std::max(a[count - 1][count - 1], kLeast * inverse_mass_of(nodes, joint, reading, row));
}

double overrun_of(const Joint& joint, const double* values, int row) {
    const Axis& axis = joint.axis[row];
    if (axis.mode != AxisMode::limited) return 0;
    double value = values[row];
    if (is_angle(joint, row)) value = angle_between_stops(axis, joint.memory[row], value);
    return std::max({0.0, axis.lower - value, value - axis.upper});
}

JointError error_of(const Joint& joint, const JointReading& reading) { return error_at(joint, reading.value); }

double gap_of(const Nodes& nodes, const Joint& joint) {
    Pose pose[kMaxEnds];
    poses_of(nodes, joint, pose);
    if (holds_anchors(joint)) {
        const Vec3 lever_a = pose[0].R * anchor_of(joint, 0), lever_b = pose[1].R * anchor_of(joint, 1);
        return (pose[1].x - pose[0].x + (lever_b - lever_a)).norm();
    }
    double value[kMaxRows];
    joint.type->evaluate(joint.data, pose, value, nullptr);
    return error_at(joint, value).linear;
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
    wrench.torque -= (reading.pose[1].R * anchor_of(joint, 1)).cross(wrench.force);
    return wrench;
}

}  // namespace taut
