#include "integrate/integrate.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <utility>

#include "integrate/gyroscopic.h"
#include "integrate/locked_axes.h"
#include "integrate/motion_kernels.h"
#include "state/levers.h"
#include "state/sane.h"
#include "system/reached.h"

namespace taut {
namespace {

void set_inverse_mass(System& system, uint32_t at, const Nodes& nodes, uint32_t node, const Mat3& R) {
    const NodeMass& mass = nodes.mass[node];
    const Locks locks = nodes.locks_of(node);
    SweepNode& to = system.sweep[at];
    SweepMass& out = to.mass;
    if (!system.joint_share.empty()) system.joint_share[at] = 1;
    const auto inv_mass = static_cast<float>(mass.inv_mass);
    const auto along = [&](int axis) { return locks.linear(axis) ? 0 : inv_mass; };
    to.set_inv_mass(inv_mass, along(0), along(1), along(2));
    const Mat3 inverse = locks.any_angular() ? nodes.free_inverse_inertia(node, R)
                         : mass.isotropic    ? mass.inv_inertia.matrix()
                                             : Mat3(R * mass.inv_inertia.matrix() * R.transpose());
    const Sym3 packed = Sym3::of(inverse);
    const double values[6] = {packed.xx, packed.yy, packed.zz, packed.xy, packed.xz, packed.yz};
    for (int i = 0; i < 6; ++i) out.inv_inertia[i] = static_cast<float>(values[i]);
}

void set_shift(SweepShift& shift, const Vec3& dx, const Quat& dq) {
    for (int i = 0; i < 3; ++i) shift.dx[i] = static_cast<float>(dx[i]);
    for (int i = 0; i < 4; ++i) shift.dq[i] = static_cast<float>(dq.coeffs()[i]);
}

void set_sweep_pose(System& system, uint32_t at, const Vec3& dx, const Quat& q) {
    if (system.sweep_pose.empty()) return;
    SweepPose& pose = system.sweep_pose[at];
    for (int i = 0; i < 3; ++i) pose.dx[i] = static_cast<float>(dx[i]);
    for (int i = 0; i < 4; ++i) pose.q[i] = static_cast<float>(q.coeffs()[i]);
}

// Below such a turn in a substep a spin is left in the world: to first order in it, and I w is off by its square [rad].
constexpr double kStill = 1e-3;
// Kinematic bodies do not yield: what they seem to move at beside their way is forced on what they carry.
constexpr double kKinematicTurn = 1e-3;

void note_turn(System& system, uint32_t at, const Quat& q, double least) {
    System::Found& found = system.found[at];
    const Quat turn = q * found.q.conjugate();
    system.turned[at] = turn.vec().squaredNorm() > 0.25 * least * least;
    if (system.turned[at]) found.q = q;
}

// Of a kinematic body at its own velocity.
Quat rotation_after(const NodeMotion& m, double time) { return (rotation_from_vector(time * m.w) * m.q).normalized(); }

constexpr uint32_t kGrain = 128;  // nodes that a thread takes at a time

static_assert(offsetof(NodeMotion, q) == offsetof(MotionRow, q) && offsetof(NodeMotion, v) == offsetof(MotionRow, v) &&
              offsetof(NodeMotion, slow_w) == offsetof(MotionRow, slow_w) && sizeof(NodeMotion) == sizeof(MotionRow));
static_assert(offsetof(NodeMass, inertia) == offsetof(MassRow, inertia) &&
              offsetof(NodeMass, gravity_scale) == offsetof(MassRow, gravity_scale));
static_assert(sizeof(Velocity) == sizeof(PairRow) && sizeof(NodeLoad) == sizeof(PairRow));
static_assert(sizeof(Pose) == sizeof(PoseRow));
static_assert(offsetof(System::Found, q) == offsetof(FoundRow, q) && sizeof(System::Found) == sizeof(FoundRow));
static_assert(sizeof(SweepShift) == sizeof(FloatRow) && sizeof(SweepPose) == sizeof(FloatRow));
static_assert(sizeof(SweepNode) == sizeof(SweepRow) && offsetof(SweepNode, velocity) == 0);

template <class Row, class T>
Row* rows_of(T* first) {
    return reinterpret_cast<Row*>(first);
}
NodeMotion* motions_of(System& system, Nodes& nodes) {
    return system.lent ? system.motion.data() : nodes.motion.data();
}
NodeRows rows_of(System& system, Nodes& nodes, Array<Velocity>& velocity) {
    return {rows_of<MotionRow>(motions_of(system, nodes)),
            nodes.load.empty() ? nullptr : rows_of<const PairRow>(nodes.load.data()),
            rows_of<PoseRow>(system.pose.data()),
            rows_of<PairRow>(velocity.data()),
            rows_of<PairRow>(system.start.data()),
            rows_of<const FoundRow>(system.found.data()),
            rows_of<FloatRow>(system.shift.data()),
            rows_of<SweepRow>(system.sweep.data()),
            system.sweep_pose.empty() ? nullptr : rows_of<FloatRow>(system.sweep_pose.data())};
}

template <class Act>
void for_batches(const System& system, std::span<const uint32_t> list, Act&& act) {
    const auto count = static_cast<uint32_t>(list.size());
    for (uint32_t i = 0; i < count; i += kBodies) {
        Batch batch;
        for (uint32_t k = 0; k < kBodies; ++k) {
            const uint32_t node = list[std::min(i + k, count - 1)], at = system.at(node);
            batch.node[k] = node;
            batch.seat[k] = at;
            batch.motion[k] = system.lent ? at : node;
        }
        batch.count = std::min<uint32_t>(kBodies, count - i);
        act(batch);
    }
}
template <class Act>
void for_batches(Team& team, const System& system, std::span<const uint32_t> list, Act&& act) {
    team.for_ranges(static_cast<uint32_t>(list.size()), kGrain,
                    [&](uint32_t begin, uint32_t end) { for_batches(system, list.subspan(begin, end - begin), act); });
}

// Those nodes or seats of a batch of which it holds.
template <class Holds>
Bodies which(const uint32_t (&batch)[kBodies], Holds&& holds) {
    Bodies bits = 0;
    for (uint32_t i = 0; i < kBodies; ++i) bits |= static_cast<Bodies>(holds(batch[i])) << i;
    return bits;
}

template <class Act>
void for_nodes(Team& team, std::span<const uint32_t> list, Act&& act) {
    team.for_ranges(static_cast<uint32_t>(list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) act(list[i]);
    });
}

void rotate(const double theta[3], double q[4]) {
    const Quat turn = rotation_from_vector(Vec3(theta[0], theta[1], theta[2]));
    for (int i = 0; i < 4; ++i) q[i] = turn.coeffs()[i];
}

// What the last frame left at a seat.
void forget(System& system, uint32_t at) {
    system.shift[at] = {};
    system.turned[at] = system.in_block[at] = system.filtered[at] = 0;
    system.place[at] = kNone;
}

void begin_node(System& system, const Nodes& nodes, uint32_t node, uint32_t at) {
    const NodeMotion& m = nodes.motion[node];
    system.pose[at] = {m.x, m.q.toRotationMatrix()};
    system.found[at] = {m.x, m.q};
    set_sweep_pose(system, at, Vec3::Zero(), m.q);
    system.exact[at] = {m.v, m.w};
    set_inverse_mass(system, at, nodes, node, system.pose[at].R);
    if (nodes.sleeps(node)) system.sweep[at].stop();  // what comes near stops at it until it wakes
    if (!system.sweep_pose.empty()) system.sweep_pose[at].inv_mass = system.sweep[at].mass.inv_mass;
    set_sweep_velocity(system.sweep[at].velocity, {m.v, m.w});
}

// Unless it has one.
void take_seat(System& system, uint32_t node) {
    uint32_t& seat = system.seat[node + 1];
    if (seat != 0) return;
    reserve_more(system.node_at, 1);
    seat = static_cast<uint32_t>(system.node_at.size());
    system.node_at.push_back(node);
}

// Nodes of groups first, in their order, then others that the step goes through, then what is reached.
void take_seats(System& system, const Partition& partition, const Nodes& nodes) {
    grow_to(system.seat, nodes.slots() + 1);
    for (const uint32_t node : system.node_at) system.seat[node + 1] = 0;
    system.node_at.clear();
    system.node_at.push_back(kNone);
    for (uint32_t g = 0; g < partition.group_count; ++g)
        for (const uint32_t node : partition.groups[g].nodes) take_seat(system, node);
    system.movers = static_cast<uint32_t>(system.node_at.size()) - 1;
    for (const uint32_t node : nodes.active)
        if (!stands_by(nodes, node)) take_seat(system, node);
    for (const uint32_t node : system.reached) take_seat(system, node);
}

// A dynamic node with a spin of its own: not one whose inertia is the same about all axes, or that does not turn about
// some; see turn_held().
bool turns_freely(const Nodes& nodes, uint32_t node) {
    return nodes.info[node].kind == NodeKind::dynamic && !nodes.mass[node].isotropic &&
           !nodes.locks_of(node).any_angular();
}

// Masses of a batch's bodies.
struct Masses {
    const MassRow* of[kBodies];

    Masses(const Nodes& nodes, const Batch& batch) {
        for (int i = 0; i < kBodies; ++i) of[i] = rows_of<const MassRow>(&nodes.mass[batch.node[i]]);
    }
};

// Quarantined in this frame.
void stop(System& system, uint32_t at) {
    system.exact[at] = {};
    system.sweep[at] = {};
    if (!system.sweep_pose.empty()) system.sweep_pose[at].inv_mass = 0;
    if (system.in_block[at]) system.inertia[at].setZero();
}

bool are_points(const Nodes& nodes, const Batch& batch) {
    return std::ranges::all_of(batch.node, [&](uint32_t n) { return nodes.info[n].kind == NodeKind::particle; });
}

// What a node's turn in the substep before changes. Inverse masses beside its velocities come as if nothing was locked.
void turn_axes(System& system, const Nodes& nodes, uint32_t node, const NodeMotion& motion, uint32_t at, bool turned) {
    const Mat3& R = system.pose[at].R;
    const NodeMass& mass = nodes.mass[node];
    const Locks locks = nodes.locks_of(node);
    const bool in_block = system.in_block[at];
    system.turned[at] = turned;
    if (turned) system.found[at].q = motion.q;
    if (locks.any() || (!mass.isotropic && (turned || in_block))) set_inverse_mass(system, at, nodes, node, R);
    if (!in_block) return;
    Mat3& inertia = system.inertia[at];
    inertia = R * mass.inertia.matrix() * R.transpose();
    for (int i = 0; i < 3; ++i) {
        if (!locks.angular(i)) continue;
        inertia.row(i).setZero();
        inertia.col(i).setZero();
        inertia(i, i) = kHeldMass;
    }
}

void add_torque(System& system, const Nodes& nodes, uint32_t node, uint32_t at) {
    const Vec3& torque = nodes.load_of(node).torque;
    if (torque == Vec3::Zero() || nodes.info[node].kind != NodeKind::dynamic) return;
    Velocity& u = system.exact[at];
    u.w += system.scheme.h * nodes.spin_by(node, system.pose[at].R, torque);
    set_sweep_velocity(system.sweep[at].velocity, u);
}

NodeMotion& motion_of(System& system, Nodes& nodes, uint32_t node) {
    return motions_of(system, nodes)[system.lent ? system.at(node) : node];
}

void shorten(Vec3& velocity, double most) {
    const double speed = velocity.norm();
    if (most > 0 && speed > most) velocity *= most / speed;
}

// act(restraint, node) for those nodes of a group that have one.
template <class Act>
void for_restrained(Team& team, const Group& group, const Nodes& nodes, Act&& act) {
    if (nodes.restraints.empty()) return;
    for_nodes(team, group.nodes, [&](uint32_t node) {
        if (nodes.info[node].restrained) act(*nodes.find_restraint(node), node);
    });
}

// Damping is dv/dt = a - c v with a constant over the substep, whose solution is
//   v(h) = e^(-c h) v + a h (1 - e^(-c h)) / (c h):
// the same decay and the same final speed a / c for any h. The first part is taken before the forces, so that all that
// a substep starts from has it.
void damp_velocities(Team& team, System& system, const Group& group, Nodes& nodes) {
    for_restrained(team, group, nodes, [&](const Restraint& by, uint32_t node) {
        NodeMotion& m = motion_of(system, nodes, node);
        m.v *= decay_over(system.scheme.h * by.damping).left;
        m.w *= decay_over(system.scheme.h * by.angular_damping).left;
    });
}

// The second part, of the forces that predict() took in full; and no more speed than a body may have.
void restrain_velocities(Team& team, System& system, const Group& group, const Nodes& nodes, const Vec3& gravity) {
    for_restrained(team, group, nodes, [&](const Restraint& by, uint32_t node) {
        if (!moves_by_forces(nodes.info[node].kind)) return;
        const NodeMass& mass = nodes.mass[node];
        const NodeLoad& load = nodes.load_of(node);
        const double h = system.scheme.h;
        const uint32_t at = system.at(node);
        Velocity& u = system.exact[at];
        u.v -= (1 - decay_over(h * by.damping).mean) * h * (mass.gravity_scale * gravity + mass.inv_mass * load.force);
        if (load.torque != Vec3::Zero())
            u.w -=
                (1 - decay_over(h * by.angular_damping).mean) * h * nodes.spin_by(node, system.pose[at].R, load.torque);
        nodes.locks_of(node).hold(u.v, u.w);
        shorten(u.v, by.most_speed);
        shorten(u.w, by.most_spin);
        set_sweep_velocity(system.sweep[at].velocity, u);
    });
}

// What contacts and joints gave beyond that is not kept.
void limit_velocities(Team& team, System& system, const Group& group, Nodes& nodes) {
    for_restrained(team, group, nodes, [&](const Restraint& by, uint32_t node) {
        NodeMotion& m = motion_of(system, nodes, node);
        shorten(m.v, by.most_speed);
        shorten(m.w, by.most_spin);
    });
}

// At the velocities of the rows over h.
void move(System& system, Nodes& nodes, const NodeRows& rows, const Batch& batch, double h) {
    NodeMotion* const motion = motions_of(system, nodes);
    const HeldTurns held(nodes, batch, motion);
    motion_kernels().commit(rows, batch, h, rotate);
    held.put(batch, motion);
}

void make_room_by_seat(System& system, bool tied) {
    grow_to(system.start, system.pose.size());
    if (!tied) return;
    grow_to(system.sweep_pose, system.pose.size());
    grow_to(system.joint_share, system.pose.size());
}

}  // namespace

void begin_frame(Team& team, System& system, const Partition& partition, const Nodes& nodes, bool tied) {
    take_seats(system, partition, nodes);
    const auto others = static_cast<uint32_t>(system.node_at.size()) - 1;  // than the world
    system.make_room(nodes.slots(), others);
    if (!tied) system.sweep_pose.clear(), system.joint_share.clear();
    make_room_by_seat(system, tied);
    system.kinematic.clear();
    for (const uint32_t node : nodes.active)
        if (nodes.info[node].kind == NodeKind::kinematic && nodes.rest[node] != Rest::asleep)
            system.kinematic.push_back(node);
    forget(system, 0);
    team.for_ranges(others, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t at = begin + 1; at <= end; ++at) {
            forget(system, at);
            begin_node(system, nodes, system.node_at[at], at);
        }
    });
}

void seat_reached(System& system, const Nodes& nodes) {
    const auto seated = static_cast<uint32_t>(system.node_at.size());
    for (const uint32_t node : system.reached) take_seat(system, node);
    const auto all = static_cast<uint32_t>(system.node_at.size());
    system.make_room(nodes.slots(), all);
    make_room_by_seat(system, !system.sweep_pose.empty());
    for (uint32_t at = seated; at < all; ++at) {
        forget(system, at);
        begin_node(system, nodes, system.node_at[at], at);
    }
}

void MotionLoan::begin() {
    if (system_.lent) return;
    grow_to(system_.motion, system_.node_at.size());
    system_.lent = true;
    for_nodes(team_, group_.nodes, [&](uint32_t node) { system_.motion[system_.at(node)] = nodes_.motion[node]; });
}

void MotionLoan::end() {
    if (!system_.lent) return;
    for_nodes(team_, group_.nodes, [&](uint32_t node) { nodes_.motion[node] = system_.motion[system_.at(node)]; });
    system_.lent = false;
}

void predict(Team& team, System& system, const Group& group, Nodes& nodes, const Vec3& gravity) {
    damp_velocities(team, system, group, nodes);
    const MotionKernels& kernels = motion_kernels();
    const NodeRows rows = rows_of(system, nodes, system.exact);
    const NodeMotion* const motion = motions_of(system, nodes);
    const Prediction terms{system.scheme.h, {gravity.x(), gravity.y(), gravity.z()}, kLeverTurn, gyroscopic_euler};
    for_batches(team, system, group.nodes, [&](const Batch& batch) {
        if (are_points(nodes, batch)) return kernels.predict_points(rows, batch, Masses(nodes, batch).of, terms);
        const Bodies turning = which(batch.node, [&](uint32_t node) { return turns_freely(nodes, node); });
        const Bodies in_block = which(batch.seat, [&](uint32_t at) { return system.in_block[at] != 0; });
        const Bodies turned = kernels.predict(rows, batch, Masses(nodes, batch).of, terms, turning, in_block);
        for (uint32_t i = 0; i < batch.count; ++i) {
            const uint32_t node = batch.node[i], at = batch.seat[i];
            const NodeMotion& m = motion[batch.motion[i]];
            const NodeKind kind = nodes.info[node].kind;
            if (kind == NodeKind::dynamic) turn_axes(system, nodes, node, m, at, (turned >> i & 1) != 0);
            if (kind == NodeKind::fixed) stop(system, at);
            if (rows.load) add_torque(system, nodes, node, at);
        }
    });
    hold_velocities(team, system, group, nodes, motion);
    restrain_velocities(team, system, group, nodes, gravity);
}

Pose pose_between(const System& system, const Nodes& nodes, uint32_t at) {
    const uint32_t node = system.node_at[at];
    if (node == kNone || !moves_by_forces(nodes.info[node].kind)) return system.pose[at];
    const NodeMotion& m = system.lent ? system.motion[at] : nodes.motion[node];
    return {m.x, m.q.toRotationMatrix()};
}

void commit_strikes(System& system, const Impacts& impacts, Nodes& nodes) {
    for (const Impacts::Struck& struck : impacts.struck) {
        const uint32_t at = system.at(struck.node);
        NodeMotion& m = motions_of(system, nodes)[system.lent ? at : struck.node];
        for (int i = 0; i < 3; ++i) m.x[i] += static_cast<double>(impacts.flight[at].moved[i]);
    }
}

void drop_strikes(System& system, const Impacts& impacts) {
    for (const Impacts::Struck& struck : impacts.struck) {
        float(&dx)[3] = system.shift[system.at(struck.node)].dx;
        std::copy(std::begin(struck.dx), std::end(struck.dx), dx);
    }
}

void commit(Team& team, System& system, const Group& group, Nodes& nodes) {
    hold_solution(team, system, group, nodes, system.exact);
    const MotionKernels& kernels = motion_kernels();
    const NodeRows rows = rows_of(system, nodes, system.exact);
    for_batches(team, system, group.nodes, [&](const Batch& batch) {
        if (are_points(nodes, batch)) return kernels.commit_points(rows, batch, system.scheme.h);
        move(system, nodes, rows, batch, system.scheme.h);
    });
}

void correct(System& system, const Group& group, const Array<Block>& blocks, Nodes& nodes) {
    const NodeRows rows = rows_of(system, nodes, system.correction);
    for (uint32_t b : group.blocks) {
        if (!blocks[b].corrected) continue;
        for (const uint32_t node : blocks[b].nodes) {
            Velocity& way = system.correction[system.at(node)];
            nodes.locks_of(node).hold(way.v, way.w);
        }
        for_batches(system, blocks[b].nodes, [&](const Batch& batch) { move(system, nodes, rows, batch, 1); });
    }
}

void follow_joints(const System& system, const Nodes& nodes) {
    for (const FollowedJoint& joint : system.rows.followed) {
        const RowBlock& block = system.rows.block[joint.block];
        Pose poses[kMaxEnds];
        Vec3 turned[kMaxEnds];
        bool sane = true;  // else it is put back to where it was
        for (int n = 0; n < block.type->nodes; ++n) {
            const uint32_t at = block.node[n];
            const Vec3& w = system.exact[at].w;
            poses[n] = pose_between(system, nodes, at);
            turned[n] = system.scheme.h * w;
            sane = sane && poses[n].x.allFinite() && poses[n].R.allFinite() && w.squaredNorm() <= kMaxSpeed * kMaxSpeed;
        }
        if (sane) block.type->follow(joint.data, poses, turned);
    }
}

// Kept in the world, what contacts changed of a spin since the body was moved would turn about axes of another inertia
// (measured: thin rods and cylinders that bounce gained up to 5000 times their energy).
bool store_velocity(Team& team, System& system, const Group& group, Nodes& nodes, double velocity_filter) {
    const MotionKernels& kernels = motion_kernels();
    const NodeRows rows = rows_of(system, nodes, system.exact);
    const Keeping keeping{system.scheme.h, kStill, velocity_filter, kMaxSpeed, rotate};
    constexpr Bodies kAll = (1u << kBodies) - 1;
    std::atomic<bool> all_sane{true};
    hold_solution(team, system, group, nodes, system.exact);
    for_batches(team, system, group.nodes, [&](const Batch& batch) {
        const Bodies in_block = which(batch.seat, [&](uint32_t at) { return system.in_block[at] != 0; });
        const Bodies slow = which(batch.seat, [&](uint32_t at) { return system.filtered[at] != 0; }) | in_block;
        if (are_points(nodes, batch)) {
            if (kernels.store_points(rows, batch, keeping, slow) != (1u << batch.count) - 1)
                all_sane.store(false, std::memory_order_relaxed);
            return;
        }
        const Bodies turning = which(batch.node, [&](uint32_t node) { return turns_freely(nodes, node); });
        const HeldSpins held(system, nodes, batch, motions_of(system, nodes));
        if (kernels.store(rows, batch, Masses(nodes, batch).of, keeping, turning, in_block, slow) != kAll)
            all_sane.store(false, std::memory_order_relaxed);
        held.put(batch, motions_of(system, nodes));
    });
    limit_velocities(team, system, group, nodes);
    return all_sane.load(std::memory_order_relaxed);
}

void turn_kinematic(System& system, const Nodes& nodes, double time) {
    for (uint32_t node : system.kinematic) {
        const NodeMotion& m = nodes.motion[node];
        const uint32_t at = system.at(node);
        if (time == 0) system.found[at].q = m.q;  // the group before this one left it at its last substep
        note_turn(system, at, rotation_after(m, time), kKinematicTurn);
    }
}

void shift_kinematic(System& system, const Nodes& nodes, double time) {
    for (uint32_t node : system.kinematic) {
        const NodeMotion& m = nodes.motion[node];
        const Quat turned = rotation_after(m, time);
        const uint32_t at = system.at(node);
        system.pose[at] = {m.x + time * m.v, turned.toRotationMatrix()};
        set_shift(system.shift[at], time * m.v, turned * system.found[at].q.conjugate());
        set_sweep_pose(system, at, time * m.v, turned);
    }
}

void commit_kinematic(const System& system, Nodes& nodes, double time_step) {
    for (uint32_t node : system.kinematic) {
        if (nodes.rest[node] != Rest::awake) continue;
        NodeMotion& m = nodes.motion[node];
        m.x += time_step * m.v;
        m.q = rotation_after(m, time_step);
    }
}

}  // namespace taut
