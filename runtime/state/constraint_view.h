// A joint or an element of a set, for what asks the same of both.
#pragma once

#include "state/elements.h"
#include "state/joint_reading.h"
#include "state/motion.h"

namespace taut {

struct ConstraintView {
    const ConstraintType* type = nullptr;  // null: there is none
    const void* data = nullptr;
    std::span<const uint32_t> nodes;
    const double* lambda = nullptr;  // [rows]
    const double* drift = nullptr;   // [rows]
    double compliance[2] = {};       // of rows, and of rows that are angles
    uint8_t locked = 0;              // bit r: row r is

    explicit operator bool() const { return type != nullptr; }
    double compliance_of(int row) const { return compliance[type->angular >> row & 1]; }
    bool is_rigid(int row) const { return (locked >> row & 1) != 0 && compliance_of(row) == 0; }
    bool is_angle(int row) const { return (type->angular >> row & 1) != 0; }
    void poses(const Nodes& all, Pose* pose) const {
        for (size_t n = 0; n < nodes.size(); ++n) pose[n] = pose_of(all, nodes[n]);
    }
    // C at the present poses: [rows].
    void read(const Nodes& all, double* value) const {
        Pose pose[kMaxNodes];
        poses(all, pose);
        type->evaluate(data, pose, value, nullptr);
    }
};

inline ConstraintView view_of(const Joint& joint) {
    ConstraintView view{joint.type,   joint.data,  joint.ends(),
                        joint.lambda, joint.drift, {joint.compliance, joint.angular_compliance}};
    for (int r = 0; joint.type && r < joint.type->rows; ++r)
        view.locked |= static_cast<uint8_t>((joint.plain || joint.axis[r].mode == AxisMode::locked) << r);
    return view;
}

inline ConstraintView view_of(const ElementSet& set, uint32_t element) {
    if (!set.lives(element)) return {};
    const double compliance = set.softness[element] * set.compliance[0];
    return {&set.type->row,
            set.data_of(element),
            set.nodes_of(element),
            set.lambda_of(element),
            set.drift_of(element),
            {compliance, compliance},
            static_cast<uint8_t>(set.pulls ? 0 : (1 << set.type->row.rows) - 1)};
}

inline ConstraintView view_of(const Joints& joints, const Elements& elements, const ConstraintRef& ref) {
    return ref.set == kNone ? view_of(joints.record[ref.index]) : view_of(elements.set[ref.set], ref.index);
}

}  // namespace taut
