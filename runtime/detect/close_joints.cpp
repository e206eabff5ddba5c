// A part of the way of what hangs on the world is no way that its joints allow: a line of length r that turns by a is
// r a^2/8 shorter half way. They are closed by sweeps over their rigid rows, each in turn
//   dx = -W J^T C (J W J^T)^-1
#include <algorithm>
#include <cmath>

#include "detect/mechanism.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

constexpr double kClosed = 1e-3;  // narrower gaps stay [m]
constexpr double kWide = 0.05;    // and what was open before the step by more than this [m], [rad]
constexpr int kMostSweeps = 40;

// As it was before the step.
Pose pose_before(const Nodes& nodes, uint32_t node) {
    if (node == kNone || nodes.rest[node] != Rest::awake) return pose_of(nodes, node);
    const NodePose& before = nodes.before[node];
    return {before.position + before.rotation * nodes.mass[node].centre, before.rotation.toRotationMatrix()};
}

// What leads a joint goes on.
bool is_led(const Nodes& nodes, const Joint& joint) {
    return std::ranges::any_of(
        joint.nodes(), [&](uint32_t node) { return node != kNone && nodes.info[node].kind == NodeKind::kinematic; });
}

// A joint at the present poses, and those of its rows that are to be closed.
class Closing {
public:
    Closing(Nodes& nodes, const Joint& joint) : nodes_(nodes), joint_(joint) {
        Pose before[kMaxNodes];
        double value[kMaxRows];
        for (int end = 0; end < joint.type->nodes; ++end) before[end] = pose_before(nodes, joint.node[end]);
        joint.type->evaluate(joint.data, before, value, nullptr);
        for (int row = 0; row < joint.type->rows; ++row)
            closes_[row] = is_rigid(joint, row) && std::abs(value[row]) < kWide;
    }

    // Of these rows that are no angles, the most [m].
    double gap() const {
        const JointReading reading = read_joint(nodes_, joint_);
        double most = 0;
        for (int row = 0; row < joint_.type->rows; ++row)
            if (closes_[row] && !is_angle(joint_, row)) most = std::max(most, std::abs(reading.value[row]));
        return most;
    }
    void close() {
        for (int row = 0; row < joint_.type->rows; ++row)
            if (closes_[row]) close(row);
    }

private:
    void close(int row) {
        const JointReading reading = read_joint(nodes_, joint_);
        const double inverse = inverse_mass_of(nodes_, joint_, reading, row);
        if (!(inverse > 0)) return;
        const double impulse = -reading.value[row] / inverse;
        for (int end = 0; end < joint_.type->nodes; ++end) {
            const uint32_t node = joint_.node[end];
            if (node == kNone || !nodes_.solved(node)) continue;
            const double* j = reading.jacobian + (end * joint_.type->rows + row) * kDof;
            const NodeMass& mass = nodes_.mass[node];
            const Mat3& R = reading.pose[end].R;
            const Vec3 turn = R * (mass.inv_inertia.matrix() * (R.transpose() * Vec3::Map(j + 3)));
            NodeMotion& m = nodes_.motion[node];
            m.x += impulse * mass.inv_mass * Vec3::Map(j);
            if (turn != Vec3::Zero()) m.q = (rotation_from_vector(impulse * turn) * m.q).normalized();
        }
    }

    Nodes& nodes_;
    const Joint& joint_;
    bool closes_[kMaxRows] = {};
};

}  // namespace

void Mechanism::close_joints() {
    all_.open.clear();
    for (uint32_t j = all_.first_joint[root_]; j != kNone; j = all_.next_joint[j])
        if (!is_led(nodes_, joints_.record[j])) all_.open.push_back(j);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        bool any = false;
        for (const uint32_t j : all_.open) {
            Closing joint(nodes_, joints_.record[j]);
            if (joint.gap() < kClosed) continue;
            joint.close();
            any = true;
        }
        if (!any) return;
        std::ranges::reverse(all_.open);
    }
}

}  // namespace taut
