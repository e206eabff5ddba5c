// A part of the way of what hangs on the world is no way that its joints allow: a line of length r that turns by a is
// r a^2/8 shorter half way. They are closed by sweeps over their rigid rows, each in turn
//   dx = -W J^T C (J W J^T)^-1
#include <algorithm>
#include <cmath>

#include "constraints/contact_lanes.h"
#include "detect/mechanism.h"
#include "state/constraint_view.h"

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
bool is_led(const Nodes& nodes, const ConstraintView& joint) {
    return std::ranges::any_of(
        joint.nodes, [&](uint32_t node) { return node != kNone && nodes.info[node].kind == NodeKind::kinematic; });
}

// A joint or element at the present poses, and those of its rows that are to be closed.
class Closing {
public:
    Closing(Nodes& nodes, const ConstraintView& joint) : nodes_(nodes), joint_(joint) {
        Pose before[kMaxNodes];
        double value[kMaxRows];
        for (size_t end = 0; end < joint.nodes.size(); ++end) before[end] = pose_before(nodes, joint.nodes[end]);
        joint.type->evaluate(joint.data, before, value, nullptr);
        for (int row = 0; row < joint.type->rows; ++row)
            closes_[row] = joint.is_rigid(row) && std::abs(value[row]) < kWide;
    }

    // Of these rows that are no angles, the most [m].
    double gap() const {
        double value[kMaxRows], most = 0;
        joint_.read(nodes_, value);
        for (int row = 0; row < joint_.type->rows; ++row)
            if (closes_[row] && !joint_.is_angle(row)) most = std::max(most, std::abs(value[row]));
        return most;
    }
    void close() {
        for (int row = 0; row < joint_.type->rows; ++row)
            if (closes_[row]) close(row);
    }

private:
    void close(int row) {
        Pose pose[kMaxNodes];
        double value[kMaxRows], jacobian[kMaxNodes * kMaxRows * kDof];
        joint_.poses(nodes_, pose);
        joint_.type->evaluate(joint_.data, pose, value, jacobian);
        const auto along = [&](size_t end) {
            return jacobian + (end * static_cast<size_t>(joint_.type->rows) + static_cast<size_t>(row)) * kDof;
        };
        const auto moves = [&](uint32_t node) { return node != kNone && nodes_.solved(node); };
        double inverse = 0, least = 0;  // J W J^T, and what of it is rounding where axes are locked
        for (size_t end = 0; end < joint_.nodes.size(); ++end) {
            if (!moves(joint_.nodes[end])) continue;
            const uint32_t node = joint_.nodes[end];
            const NodeMass& mass = nodes_.mass[node];
            const Vec3 j = Vec3::Map(along(end)), own = Vec3::Map(along(end) + 3), turn = pose[end].R.transpose() * own;
            const bool held = nodes_.locks_of(node).any();
            const double whole = mass.inv_mass * j.dot(j) + turn.dot(mass.inv_inertia.matrix() * turn);
            inverse += held ? nodes_.move_by(node, j).dot(j) + nodes_.spin_by(node, pose[end].R, own).dot(own) : whole;
            least += held ? static_cast<double>(kLeastFree) * whole : 0;
        }
        if (!(inverse > least)) return;
        const double impulse = -value[row] / inverse;
        for (size_t end = 0; end < joint_.nodes.size(); ++end) {
            const uint32_t node = joint_.nodes[end];
            if (!moves(node)) continue;
            const double* j = along(end);
            const Vec3 turn = nodes_.spin_by(node, pose[end].R, Vec3::Map(j + 3));
            NodeMotion& m = nodes_.motion[node];
            nodes_.shift(node, impulse * nodes_.mass[node].inv_mass * Vec3::Map(j));
            if (turn != Vec3::Zero()) m.q = (rotation_from_vector(impulse * turn) * m.q).normalized();
        }
    }

    Nodes& nodes_;
    const ConstraintView& joint_;
    bool closes_[kMaxRows] = {};
};

}  // namespace

void Mechanism::close_joints() {
    all_.open.clear();
    for (uint32_t i = all_.ties_of[root_].begin; i < all_.ties_of[root_].end; ++i)
        if (!is_led(nodes_, view_of(joints_, elements_, all_.tie[i]))) all_.open.push_back(all_.tie[i]);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        bool any = false;
        for (const ConstraintRef& tie : all_.open) {
            const ConstraintView view = view_of(joints_, elements_, tie);
            Closing joint(nodes_, view);
            if (joint.gap() < kClosed) continue;
            joint.close();
            any = true;
        }
        if (!any) return;
        std::ranges::reverse(all_.open);
    }
}

}  // namespace taut
