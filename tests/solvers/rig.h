// A hand-made world taken through the stages of step.cpp one by one, with any solver, and the dense system that each
// of its substeps poses.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstring>
#include <vector>

#include "constraints/ball.h"
#include "constraints/distance.h"
#include "integrate/integrate.h"
#include "solvers/solver.h"
#include "system/assemble.h"
#include "system/reached.h"
#include "world.h"

namespace taut::test {

inline taut_world_def default_def() {
    taut_world_def def;
    taut_world_def_init(&def);
    return def;
}

// Places in the list of those that take joints.
inline std::vector<size_t> solvers_of_joints() {
    std::vector<size_t> out;
    for (size_t i = 0; i < solvers().size(); ++i)
        if (!solvers()[i]->energies) out.push_back(i);
    return out;
}

class Rig {
public:
    explicit Rig(double substep = 1.0 / 240) : w(default_def()) {
        w.def.substeps = 1;
        w.def.time_step = static_cast<float>(substep);
        h = w.def.time_step;
    }

    uint32_t fixed(const Vec3& x = Vec3::Zero()) { return add(NodeKind::fixed, 0, Vec3::Zero(), x); }
    uint32_t particle(double mass, const Vec3& x, const Vec3& v = Vec3::Zero()) {
        const uint32_t node = add(NodeKind::particle, mass, Vec3::Zero(), x);
        w.nodes.motion[node].v = v;
        return node;
    }
    // inertia: principal, body axes.
    uint32_t body(double mass, const Vec3& inertia, const Vec3& x, const Quat& q = Quat::Identity(),
                  const Vec3& v = Vec3::Zero(), const Vec3& spin = Vec3::Zero()) {
        const uint32_t node = add(NodeKind::dynamic, mass, inertia, x);
        NodeMotion& m = w.nodes.motion[node];
        m.q = q;
        m.v = v;
        m.w = spin;
        return node;
    }
    template <class Data>
    uint32_t join(const ConstraintType& type, uint32_t a, uint32_t b, const Data& data, double compliance,
                  double damping) {
        Joint joint;
        joint.type = &type;
        joint.node[0] = a;
        joint.node[1] = b;
        std::memcpy(joint.data, &data, sizeof data);
        joint.compliance = compliance;
        joint.damping = damping;
        return w.joints.add(joint);
    }
    uint32_t ball(uint32_t a, uint32_t b, const Vec3& anchor_a, const Vec3& anchor_b, double compliance = 0,
                  double damping = 0) {
        return join(kBall, a, b, BallData{anchor_a, anchor_b}, compliance, damping);
    }
    uint32_t rod(uint32_t a, uint32_t b, const Vec3& anchor_a, const Vec3& anchor_b, double length,
                 double compliance = 0, double damping = 0) {
        return join(kDistance, a, b, DistanceData{anchor_a, anchor_b, length}, compliance, damping);
    }
    // Contact points in the world; a < b.
    void contact(uint32_t a, uint32_t b, const Vec3f& normal, const std::vector<std::pair<Vec3, double>>& points) {
        Pair& pair = w.pairs.list.emplace_back();
        pair.key = pair_key(a, b);
        pair.a = a;
        pair.b = b;
        pair.friction = 0.5f;
        pair.manifold.normal = normal;
        pair.manifold.count = static_cast<int>(points.size());
        for (size_t i = 0; i < points.size(); ++i)
            pair.manifold.points[i] = {(points[i].first - w.nodes.origin(a)).cast<float>(),
                                       static_cast<float>(points[i].second), static_cast<uint32_t>(i)};
        for (size_t i = w.pairs.list.size() - 1; i > 0 && w.pairs.list[i - 1].key > w.pairs.list[i].key; --i)
            std::swap(w.pairs.list[i - 1], w.pairs.list[i]);
        w.pairs.active.clear();
        for (uint32_t i = 0; i < w.pairs.list.size(); ++i) {
            const Pair& p = w.pairs.list[i];
            w.pairs.active.push_back({p.a, p.b, i, static_cast<uint8_t>(p.manifold.count)});
        }
    }

    // As at the start of a frame of one group: partition, rows, lanes.
    void begin(const Solver& with) {
        solver = with;
        w.partition.build(w.team, w.nodes, w.joints, w.elements, w.pairs,
                          {1, true, solver.direct, 1.0 / 60, Vec3::Zero(), false});
        list_reached(w.nodes, w.joints, w.pairs, w.partition.held(), w.system.reached);
        begin_frame(w.team, w.system, w.partition, w.nodes, true);
        ASSERT_EQ(w.partition.group_count, 1u);
        w.system.scheme.set_length(h);
        build_rows(w.system, group(), w.partition.blocks, w.joints, w.elements, w.pairs, w.nodes, !solver.lanes,
                   solver.energies);
        if (!solver.lanes) return;
        build_lanes(w.team, w.system, group(), w.pairs, w.nodes, *settings.kernels);
        build_surface_lanes(w.team, w.system, group(), w.pairs.surfaces, *settings.surface_kernels);
        build_joint_lanes(w.team, w.system, group(), h);
    }
    // Unconstrained velocities and rows of a substep.
    void predict() {
        shift_kinematic(w.system, w.nodes, 0);
        taut::predict(w.team, w.system, group(), w.nodes, gravity);
        build_block_contacts(w.system, group(), w.partition.blocks, w.pairs, w.nodes);
        evaluate_rows(w.team, w.system, 0, h);
        if (!solver.lanes) return;
        evaluate_joint_lanes(w.team, w.system);
        if (settings.geometric_stiffness)
            stiffen_joints(w.team, w.system, w.nodes, *settings.joint_kernels, settings.velocity_filter > 0);
        prepare_joint_lanes(w.team, w.system, *settings.joint_kernels);
    }
    void solve() {
        Substep s = substep();
        solver.solve(s);
        if (solver.lanes) store_joint_lanes(w.team, w.system);
    }
    void move() { commit(w.team, w.system, group(), w.nodes); }
    void relax() {
        Substep s = substep();
        solver.relax(s);
        store_velocity(w.team, w.system, group(), w.nodes, settings.velocity_filter);
    }
    void store_contacts() {
        store_contact_rows(w.system);
        if (!solver.lanes) return;
        store_lanes(w.team, w.system, w.pairs);
        store_surface_lanes(w.team, w.system, w.pairs.surfaces);
    }
    Group& group() { return w.partition.groups[0]; }
    Substep substep() {
        return {w.team, w.system, group(), w.partition.blocks, w.nodes, settings, report, w.scratch, false};
    }

    World w;
    double h;
    Vec3 gravity{0, -9.81, 0};
    Solver solver = kBlockLdlt;
    SolverSettings settings{0,
                            true,
                            0.25,
                            9.81 * 9.81,
                            &kContactKernelsBase,
                            &kJointKernelsBase,
                            &kElementKernelsBase,
                            &kGrainKernelsBase,
                            &kSurfaceKernelsBase};
    SolverReport report;

private:
    uint32_t add(NodeKind kind, double mass, const Vec3& inertia, const Vec3& x) {
        const uint32_t node = w.nodes.add();
        w.nodes.info[node].kind = kind;
        w.nodes.motion[node].x = x;
        NodeMass m;
        m.mass = mass;
        m.inv_mass = mass > 0 ? 1 / mass : 0;
        m.inertia = {inertia.x(), inertia.y(), inertia.z(), 0, 0, 0};
        if (inertia != Vec3::Zero()) m.inv_inertia = {1 / inertia.x(), 1 / inertia.y(), 1 / inertia.z(), 0, 0, 0};
        m.isotropic = inertia.x() == inertia.y() && inertia.y() == inertia.z();
        w.nodes.mass.reserve_values(1);
        w.nodes.mass.set(node, m);
        w.nodes.list_active();
        return node;
    }
};

// The substep's equations without their sparsity, from the constraint types alone (runtime/system/system.h):
//   [ M + h^2 K   -J^T ] [v+]   [ M v* + h^2 K s ]
//   [ -J          -c   ] [mu] = [ rate C         ]
using Forces = std::vector<Eigen::VectorXd>;  // lambda of each joint [N]

struct DenseSubstep {
    Eigen::VectorXd velocity;  // 6 a moving node, in order
    Forces force;              // mu / h
};

// K is the sum over the sets of forces. After rig.predict().
inline DenseSubstep solve_dense(Rig& rig, const std::vector<Forces>& sets, bool spare_slow = true) {
    const World& w = rig.w;
    const double h = rig.h;
    std::vector<long> at(w.nodes.slots(), -1);
    long unknowns = 0;
    for (uint32_t node = 0; node < w.nodes.slots(); ++node) {
        if (!moves_by_forces(w.nodes.info[node].kind)) continue;
        at[node] = unknowns;
        unknowns += 6;
    }
    const long moving = unknowns;
    for (const Joint& joint : w.joints.record) unknowns += joint.type->rows;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
    for (uint32_t node = 0; node < w.nodes.slots(); ++node) {
        if (at[node] < 0) continue;
        const NodeMass& mass = w.nodes.mass[node];
        const Mat3 R = w.nodes.motion[node].q.toRotationMatrix();
        Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Identity();  // a particle's turning: kept apart
        m.topLeftCorner<3, 3>() *= mass.mass;
        if (w.nodes.info[node].kind == NodeKind::dynamic)
            m.bottomRightCorner<3, 3>() = R * mass.inertia.matrix() * R.transpose();
        Eigen::Matrix<double, 6, 1> u;
        const Velocity& velocity = w.system.exact[w.system.at(node)];
        u << velocity.v, velocity.w;
        if (w.nodes.info[node].kind == NodeKind::particle) u.tail<3>().setZero();
        a.block<6, 6>(at[node], at[node]) = m;
        b.segment<6>(at[node]) = m * u;
    }
    long row = moving;
    for (size_t j = 0; j < w.joints.record.size(); ++j) {
        const Joint& joint = w.joints.record[j];
        const ConstraintType& type = *joint.type;
        Pose pose[kMaxNodes];
        long column[kMaxNodes];
        Eigen::VectorXd slow = Eigen::VectorXd::Zero(6 * type.nodes), error(type.rows);
        for (int n = 0; n < 2; ++n) {
            column[n] = joint.node[n] == kNone ? -1 : at[joint.node[n]];
            if (joint.node[n] == kNone) continue;
            const NodeMotion& m = w.nodes.motion[joint.node[n]];
            pose[n] = {m.x, m.q.toRotationMatrix()};
            if (spare_slow && column[n] >= 0) slow.segment<6>(6 * n) << m.slow_v, m.slow_w;
        }
        if (spare_slow && type.line) {  // b's end against a's turns with the line; a known end moves as it does
            const Line line = type.line(joint.data, pose);
            const Vec3 wa = slow.segment<3>(3), wb = slow.segment<3>(9);
            slow.segment<3>(0).setZero();
            slow.segment<3>(6) = joint.slow_turn.cross(line.span) + wa.cross(line.lever_a) - wb.cross(line.lever_b);
            for (int n = 0; n < 2; ++n) {
                if (column[n] >= 0) continue;
                const Vec3 known = joint.node[n] == kNone ? Vec3(Vec3::Zero()) : w.nodes.motion[joint.node[n]].v;
                const Vec3 shift = known - Vec3(slow.segment<3>(6 * n));
                for (int k = 0; k < 2; ++k) slow.segment<3>(6 * k) += shift;
                slow.segment<6>(6 * n).setZero();  // K takes no part of a known end
            }
        }
        std::vector<double> jacobian(static_cast<size_t>(type.nodes * type.rows * kDof));
        type.evaluate(joint.data, pose, error.data(), jacobian.data());
        const double* elastic = type.compliance ? type.compliance(joint.data) : nullptr;
        const double d = elastic ? joint.damping : joint.compliance * joint.damping, rate = 1 / (h + d);
        Eigen::MatrixXd c = joint.compliance * Eigen::MatrixXd::Identity(type.rows, type.rows);
        if (elastic)
            c = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
                elastic, type.rows, type.rows);
        b.segment(row, type.rows) = rate * error;
        a.block(row, row, type.rows, type.rows) = -c / (h * (h + d));
        for (int n = 0; n < type.nodes; ++n) {
            if (column[n] < 0) continue;
            const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> block(
                jacobian.data() + n * type.rows * kDof, type.rows, 6);
            a.block(row, column[n], type.rows, 6) = -block;
            a.block(column[n], row, 6, type.rows) = -block.transpose();
        }
        for (const Forces& forces : sets) {
            const long width = 6 * type.nodes;
            Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> k(width, width);
            type.stiffness(joint.data, pose, forces[j].data(), Curvature::positive, k.data());
            const Eigen::VectorXd known = h * h * k * slow;
            for (int n = 0; n < type.nodes; ++n) {
                if (column[n] < 0) continue;
                b.segment<6>(column[n]) += known.segment<6>(6 * n);
                for (int m = 0; m < type.nodes; ++m)
                    if (column[m] >= 0) a.block<6, 6>(column[n], column[m]) += h * h * k.block<6, 6>(6 * n, 6 * m);
            }
        }
        row += type.rows;
    }
    const Eigen::VectorXd x = a.fullPivLu().solve(b);
    DenseSubstep out{x.head(moving), {}};
    row = moving;
    for (const Joint& joint : w.joints.record) {
        out.force.push_back(x.segment(row, joint.type->rows) / h);
        row += joint.type->rows;
    }
    return out;
}

inline Eigen::VectorXd velocities(const Rig& rig) {
    std::vector<double> all;
    for (uint32_t node = 0; node < rig.w.nodes.slots(); ++node) {
        if (!moves_by_forces(rig.w.nodes.info[node].kind)) continue;
        const Velocity& u = rig.w.system.exact[rig.w.system.at(node)];
        const bool turns = rig.w.nodes.info[node].kind == NodeKind::dynamic;
        for (int k = 0; k < 3; ++k) all.push_back(u.v[k]);
        for (int k = 0; k < 3; ++k) all.push_back(turns ? u.w[k] : 0.0);
    }
    return Eigen::VectorXd::Map(all.data(), static_cast<long>(all.size()));
}

}  // namespace taut::test
