#include "integrate/scheme.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "integrate/integrate.h"
#include "system/operators.h"

namespace taut {
namespace {

Speed speed_of(const NodeMotion& m) { return {m.v, m.w}; }
Speed speed_of(const Velocity& u) { return {u.v, u.w}; }
Velocity velocity_of(const Speed& u) { return {u.v, u.w}; }

void put(System& system, uint32_t at, const Speed& u) {
    system.exact[at] = velocity_of(u);
    set_sweep_velocity(system.sweep[at].velocity, system.exact[at]);
}

// What changed a velocity between substeps moved it in the past too: it is no force. Where there is no past of this
// length, it is that of the acceleration now.
void renew(NodeHistory& of, const Speed& velocity, double length, const Speed& external) {
    if (of.length == length) {
        const Speed jump = sum(velocity, -1, of.velocity);
        of.rate = sum(of.rate, 1, jump);
        of.before = sum(of.before, 1, jump);
        return;
    }
    const Speed acceleration = sum(of.acceleration, 1, external);
    of.rate = sum(velocity, -0.5 * length, acceleration);
    of.before = sum(velocity, -length, acceleration);
}

// Forces of a joint's springs alone, for only those have a past: what a rigid row does within a substep is an impulse,
// as a contact's (with it Newmark's is an unstable solution of the constraint's equations). Of a joint that was not
// solved yet from its error: C lambda = -error.
RowVector spring_force(const RowBlock& block, const double* error, bool is_new) {
    const int rows = block.type->rows;
    RowVector force = RowVector::Zero(rows);
    if (block.compliance_block && is_new)
        return -Eigen::Map<const RowMatrix>(block.compliance_block, rows, rows)
                    .llt()
                    .solve(Eigen::Map<const RowVector>(error, rows)) /
               block.compliance[0];
    for (int r = 0; r < rows; ++r)
        if (block.locked(r) && block.elastic(r))
            force[r] = is_new ? -error[r] / block.compliance[block.angular(r)] : block.force[r];
    return force;
}

// Accelerations by springs, W J^T lambda, with J at the present poses.
void find_spring_accelerations(System& system, const Group& group, const Nodes& nodes, bool are_new) {
    for (const uint32_t node : group.nodes) system.by_springs[system.at(node)] = {};
    for (uint32_t b = 0; b < system.rows.joints; ++b) {
        const RowBlock& block = system.rows.block[b];
        const ConstraintType& type = *block.type;
        double error[kMaxRows], jacobian[kMaxNodes * kMaxRows * kDof] = {};
        Pose poses[kMaxNodes];
        for (int n = 0; n < type.nodes; ++n) poses[n] = pose_between(system, nodes, block.node[n]);
        type.evaluate(block.data, poses, error, jacobian);
        const RowVector force = spring_force(block, error, are_new);
        for (int n = 0; n < type.nodes; ++n) {
            const Eigen::Map<const RowJacobian> j(jacobian + n * type.rows * kDof, type.rows, kDof);
            const NodeVector a = response(system.sweep[block.node[n]], j.transpose() * force);
            Velocity& to = system.by_springs[block.node[n]];
            to.v += a.head<3>();
            to.w += a.tail<3>();
        }
    }
}

// The same of elements that have no rows, -W J^T D C at x_n.
void add_elastic_accelerations(System& system, const Nodes& nodes) {
    for (const ElasticRun& run : system.rows.elastic) {
        const ElementType& type = *run.set->type;
        const int rows = type.row.rows;
        const Eigen::Map<const RowMatrix> stiffness(run.set->stiffness, rows, rows);
        for (uint32_t i = 0; i < run.count; ++i) {
            const uint32_t* const seat =
                &system.rows.element_node[run.node + i * static_cast<uint32_t>(type.row.nodes)];
            const uint32_t element = system.rows.element[run.element + i];
            RowVector error(rows);
            double jacobian[kMaxNodes * kMaxRows * 3];
            type.evaluate({1, seat, &element, run.set->data.data(), system.pose.data()}, error.data(), jacobian, 3);
            if (run.set->pulls && !(error[0] > 0)) continue;
            const RowVector force = -stiffness * error / run.set->softness[element];
            for (int n = 0; n < type.row.nodes; ++n) {
                const uint32_t node = system.node_at[seat[n]];
                if (node == kNone || !moves_by_forces(nodes.info[node].kind)) continue;
                const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMaxRows, 3>> j(
                    jacobian + n * rows * 3, rows, 3);
                system.by_springs[seat[n]].v += nodes.mass[node].inv_mass * (j.transpose() * force);
            }
        }
    }
}

// Nodes of which nothing is known yet: the accelerations that their springs give them.
void begin_histories(System& system, const Group& group, Nodes& nodes) {
    const auto is_new = [&](uint32_t node) { return !nodes.history[node].any(); };
    find_spring_accelerations(system, group, nodes, true);
    add_elastic_accelerations(system, nodes);
    for (const uint32_t node : group.nodes)
        if (is_new(node)) nodes.history[node].acceleration = speed_of(system.by_springs[system.at(node)]);
}

}  // namespace

void make_room_for_scheme(System& system, Nodes& nodes) {
    if (system.scheme.is_one_step()) return;
    grow_to(nodes.history, nodes.slots());
    for (Array<Velocity>* each : {&system.ahead, &system.coast, &system.began, &system.by_springs})
        grow_to(*each, system.pose.size());
}

void begin_scheme(System& system, const Group& group, Nodes& nodes, const SchemeType& of,
                  const SchemeSettings& settings, bool minimised) {
    Scheme& scheme = system.scheme;
    const Speed none;
    const bool any_new = !std::ranges::all_of(group.nodes, [&](uint32_t node) { return nodes.history[node].any(); });
    const SchemeType& type = any_new && minimised && of.first ? *of.first : of;
    const double h = scheme.h;
    scheme = type.times(settings);
    scheme.set_length(h);
    if (any_new) begin_histories(system, group, nodes);
    for (const uint32_t node : group.nodes) {
        const uint32_t at = system.at(node);
        NodeHistory& history = nodes.history[node];
        const Speed v = speed_of(nodes.motion[node]), gained = sum(speed_of(system.exact[at]), -1, v);
        renew(history, v, scheme.h, sum(none, 1 / scheme.h, gained));
        Speed ahead, coast;
        type.start({v, gained, history, scheme.h, settings}, ahead, coast);
        system.began[at] = velocity_of(v);
        system.ahead[at] = velocity_of(ahead);
        system.coast[at] = velocity_of(coast);
        put(system, at, ahead);
    }
}

void end_scheme(System& system, const Group& group, const Nodes& nodes, bool springs_known) {
    const Scheme& scheme = system.scheme;
    if (!springs_known) find_spring_accelerations(system, group, nodes, false);
    for (const uint32_t node : group.nodes) {
        const uint32_t at = system.at(node);
        const Speed turn = sum(sum(speed_of(system.coast[at]), -1, speed_of(system.ahead[at])),
                               scheme.velocity_act - scheme.act, speed_of(system.by_springs[at]));
        if (system.in_block[at]) system.kept[at] = velocity_of(sum(speed_of(system.kept[at]), 1, turn));
        put(system, at, sum(speed_of(system.exact[at]), 1, turn));
    }
}

void remember_scheme(const System& system, const Group& group, Nodes& nodes) {
    const Scheme& scheme = system.scheme;
    for (const uint32_t node : group.nodes) {
        const uint32_t at = system.at(node);
        NodeHistory& history = nodes.history[node];
        const Speed v = speed_of(nodes.motion[node]), by_springs = speed_of(system.by_springs[at]);
        // What neither springs nor external forces did: contacts and rigid joints.
        const Speed jump = sum(sum(v, -1, speed_of(system.coast[at])), -scheme.velocity_act, by_springs);
        history.before = sum(speed_of(system.began[at]), 1, jump);
        history.rate = sum(sum(speed_of(system.ahead[at]), scheme.act, by_springs), 1, jump);
        history.acceleration = by_springs;
        history.velocity = v;
        history.length = scheme.h;
    }
}

}  // namespace taut
