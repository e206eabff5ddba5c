#include "integrate/locked_axes.h"

#include <bit>
#include <cmath>

namespace taut {
namespace {

constexpr uint32_t kLockedGrain = 128;  // nodes that a thread takes at a time

// act(node, locks) for those nodes of a group that do not move along or about some axis.
template <class Act>
void for_locked(Team& team, const Group& group, const Nodes& nodes, Act&& act) {
    if (nodes.locked.empty()) return;
    team.for_ranges(static_cast<uint32_t>(group.nodes.size()), kLockedGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            if (const Locks locks = nodes.locks_of(group.nodes[i]); locks.any()) act(group.nodes[i], locks);
    });
}

// A spin about two axes keeps its momentum about them in the world, for what holds the third has no moment there: with
// P the projection on the two and I as it lies in the world
//   P I(t + h) P w(t + h) = P I(t) P w(t).
// About one axis I is constant, and so is w. Where the inertia is the same about all axes it is likewise.
bool turns_about_two(const Nodes& nodes, uint32_t node, const Locks& locks) {
    return std::has_single_bit(static_cast<unsigned>(locks.axes >> 3)) && !nodes.mass[node].isotropic;
}

// P I w, world axes.
Vec3 momentum_held(const Nodes& nodes, uint32_t node, const Mat3& R, const Locks& locks, const Vec3& w) {
    Vec3 l = R * (nodes.mass[node].inertia.matrix() * (R.transpose() * w)), none = Vec3::Zero();
    locks.hold(none, l);
    return l;
}

// The spin with that momentum after a turn at m over h from rotation q.
Vec3 spin_held(const Nodes& nodes, uint32_t node, const Quat& q, const Vec3& momentum, const Vec3& m, double h) {
    const Quat turned = (rotation_from_vector(h * m) * q).normalized();
    return nodes.free_inverse_inertia(node, turned.toRotationMatrix()) * momentum;
}

// From before the end of the substep: what the solver gave changes P I w by P I d, d = solved - w*, and its energy by
// no more than the work of that, as spin_after() of motion_kernels.inl has it; where it gave nothing the energy stays.
Vec3 spin_after_held(const System& system, const Nodes& nodes, uint32_t node, const Locks& locks, const NodeMotion& m) {
    const uint32_t at = system.at(node);
    const Mat3& R = system.pose[at].R;
    const Vec3 free = system.start[at].w, solved = system.exact[at].w, change = solved - free;
    const Vec3 before = momentum_held(nodes, node, R, locks, m.w), given = momentum_held(nodes, node, R, locks, change);
    const Vec3 momentum = before + given;
    const Vec3 w = nodes.free_inverse_inertia(node, m.q.toRotationMatrix()) * momentum;
    const double most = m.w.dot(before) + given.dot(free + solved), energy = w.dot(momentum);
    const bool keeps = given == Vec3::Zero() && energy > 0;
    return keeps || energy > most ? Vec3(std::sqrt(std::max(0.0, most) / energy) * w) : w;
}

}  // namespace

void hold_velocities(Team& team, System& system, const Group& group, const Nodes& nodes, const NodeMotion* motion) {
    constexpr int kRounds = 2;  // each brings the mean spin closer by h^2
    for_locked(team, group, nodes, [&](uint32_t node, const Locks& locks) {
        const uint32_t at = system.at(node);
        const NodeMotion& m = motion[system.lent ? at : node];
        Velocity& u = system.exact[at];
        if (turns_about_two(nodes, node, locks) && m.w != Vec3::Zero()) {
            const Vec3 l = momentum_held(nodes, node, system.pose[at].R, locks, m.w), added = u.w - m.w;
            Vec3 mean = m.w;
            for (int round = 0; round < kRounds; ++round)
                mean = 0.5 * (m.w + spin_held(nodes, node, m.q, l, mean, system.scheme.h));
            u.w = mean + added;
            system.start[at].w = mean;
        }
        locks.hold(u.v, u.w);
        set_sweep_velocity(system.sweep[at].velocity, u);
    });
}

void hold_solution(Team& team, const System& system, const Group& group, const Nodes& nodes,
                   Array<Velocity>& velocity) {
    for_locked(team, group, nodes, [&](uint32_t node, const Locks& locks) {
        Velocity& u = velocity[system.at(node)];
        locks.hold(u.v, u.w);
    });
}

HeldSpins::HeldSpins(const System& system, const Nodes& nodes, const Batch& batch, const NodeMotion* motion) {
    if (nodes.locked.empty()) return;
    for (uint32_t i = 0; i < batch.count; ++i) {
        const Locks locks = nodes.locks_of(batch.node[i]);
        if (!turns_about_two(nodes, batch.node[i], locks)) continue;
        some_ |= 1u << i;
        w_[i] = spin_after_held(system, nodes, batch.node[i], locks, motion[batch.motion[i]]);
    }
}

void HeldSpins::put(const Batch& batch, NodeMotion* motion) const {
    for (uint32_t i = 0; i < batch.count; ++i)
        if ((some_ >> i & 1) != 0) motion[batch.motion[i]].w = w_[i];
}

HeldTurns::HeldTurns(const Nodes& nodes, const Batch& batch, const NodeMotion* motion) {
    if (nodes.locked.empty()) return;
    for (uint32_t i = 0; i < batch.count; ++i) {
        if (!nodes.locks_of(batch.node[i]).all_angular()) continue;
        some_ |= 1u << i;
        q_[i] = motion[batch.motion[i]].q;
    }
}

void HeldTurns::put(const Batch& batch, NodeMotion* motion) const {
    for (uint32_t i = 0; i < batch.count; ++i)
        if ((some_ >> i & 1) != 0) motion[batch.motion[i]].q = q_[i];
}

}  // namespace taut
