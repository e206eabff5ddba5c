#include "integrate/integrate.h"

#include <algorithm>
#include <atomic>
#include <span>

#include "check/quarantine.h"
#include "integrate/gyroscopic.h"

namespace taut {
namespace {

void set_inverse_mass(SweepMass& out, const NodeMass& mass, const Mat3& R) {
    out.inv_mass = static_cast<float>(mass.inv_mass);
    const Mat3 inverse =
        mass.isotropic ? mass.inv_inertia.matrix() : Mat3(R * mass.inv_inertia.matrix() * R.transpose());
    const Sym3 packed = Sym3::of(inverse);
    const double values[6] = {packed.xx, packed.yy, packed.zz, packed.xy, packed.xz, packed.yz};
    for (int i = 0; i < 6; ++i) out.inv_inertia[i] = static_cast<float>(values[i]);
}

void set_shift(SweepShift& shift, const Vec3& dx, const Quat& dq) {
    for (int i = 0; i < 3; ++i) shift.dx[i] = static_cast<float>(dx[i]);
    for (int i = 0; i < 4; ++i) shift.dq[i] = static_cast<float>(dq.coeffs()[i]);
}

void set_sweep_pose(System& system, uint32_t node, const Vec3& dx, const Quat& q) {
    if (system.sweep_pose.empty()) return;
    SweepPose& pose = system.sweep_pose[node + 1];
    for (int i = 0; i < 3; ++i) pose.dx[i] = static_cast<float>(dx[i]);
    for (int i = 0; i < 4; ++i) pose.q[i] = static_cast<float>(q.coeffs()[i]);
}

// Of a product of unit quaternions, where |q|^2 - 1 = e is some rounding: one Newton step leaves 3/8 e^2.
Quat unit_again(const Quat& q) { return Quat(q.coeffs() * (1.5 - 0.5 * q.squaredNorm())); }

void displace(System& system, Nodes& nodes, uint32_t node, const Vec3& dx, const Vec3& dtheta) {
    NodeMotion& m = nodes.motion[node];
    m.x += dx;
    if (nodes.info[node].kind == NodeKind::dynamic) m.q = unit_again(rotation_from_vector(dtheta) * m.q);
    const System::Found& found = system.found[node + 1];
    set_shift(system.shift[node + 1], m.x - found.x, m.q * found.q.conjugate());
}

// Contacts, found once a frame, turn their levers and masses with bodies that turned by more than this since they last
// did [rad]. With levers of the frame's beginning and masses of now thin bodies gain energy without bound.
constexpr double kTurn = 0.05;
// Kinematic bodies do not yield: what they seem to move at beside their way is forced on what they carry.
constexpr double kKinematicTurn = 1e-3;

void note_turn(System& system, uint32_t node, const Quat& q, double least) {
    System::Found& found = system.found[node + 1];
    const Quat turn = q * found.q.conjugate();
    system.turned[node + 1] = turn.vec().squaredNorm() > 0.25 * least * least;
    if (system.turned[node + 1]) found.q = q;
}

// Of a kinematic body at its own velocity.
Quat rotation_after(const NodeMotion& m, double time) { return (rotation_from_vector(time * m.w) * m.q).normalized(); }

// The spin of a body that turned in this substep, found for the pose that it turned from: it is that spin as seen from
// the body. Kept in the world, what contacts changed of it since the body was moved would turn about axes of another
// inertia (measured: thin rods and cylinders that bounce gained up to 5000 times their energy).
Vec3 spin_after(const Pose& from, const Velocity& u, const NodeMotion& now) {
    return now.q * (from.R.transpose() * u.w);
}

constexpr uint32_t kGrain = 128;  // nodes that a thread takes at a time

template <class Act>
void for_nodes(Team& team, const Array<uint32_t>& list, Act&& act) {
    team.for_ranges(static_cast<uint32_t>(list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) act(list[i]);
    });
}

// What the last frame left, by index.
void forget(System& system, uint32_t at) {
    system.shift[at] = {};
    system.turned[at] = system.in_block[at] = 0;
    system.place[at] = kNone;
}

void begin_node(System& system, const Nodes& nodes, uint32_t node) {
    const NodeMotion& m = nodes.motion[node];
    system.pose[node + 1] = {m.x, m.q.toRotationMatrix()};
    system.found[node + 1] = {m.x, m.q};
    set_sweep_pose(system, node, Vec3::Zero(), m.q);
    system.exact[node + 1] = {m.v, m.w};
    set_inverse_mass(system.sweep[node + 1].mass, nodes.mass[node], system.pose[node + 1].R);
    if (nodes.sleeps(node)) system.sweep[node + 1].mass = {};  // what comes near stops at it until it wakes
    set_sweep_velocity(system.sweep[node + 1].velocity, {m.v, m.w});
}

// Velocities at which nodes would go on through a substep without contacts and joints.
struct Prediction {
    System& system;
    Nodes& nodes;
    const Vec3& gravity;

    // Of at most kSpins nodes.
    void of(std::span<const uint32_t> together) const {
        FreeSpin spins[kSpins];
        uint32_t spinning[kSpins];
        size_t count = 0;
        for (const uint32_t node : together) {
            start(node);
            if (nodes.info[node].kind != NodeKind::dynamic) continue;
            turn_axes(node);
            const NodeMass& mass = nodes.mass[node];
            if (mass.isotropic) continue;
            spinning[count] = node;
            spins[count++] = {system.pose[node + 1].R.transpose() * nodes.motion[node].w, &mass,
                              system.in_block[node + 1] != 0};
        }
        if (count > 0) gyroscopic({spins, count}, system.h);
        for (size_t i = 0; i < count; ++i)
            system.exact[spinning[i] + 1].w = system.pose[spinning[i] + 1].R * spins[i].w;
        for (const uint32_t node : together) finish(node);
    }

private:
    void start(uint32_t node) const {
        const NodeMotion& m = nodes.motion[node];
        const NodeMass& mass = nodes.mass[node];
        system.pose[node + 1].x = m.x;
        set_sweep_pose(system, node, m.x - system.found[node + 1].x, m.q);
        const Vec3& force = nodes.load_of(node).force;
        system.exact[node + 1] = {m.v + system.h * (mass.gravity_scale * gravity + mass.inv_mass * force), m.w};
        if (nodes.info[node].kind != NodeKind::fixed) return;  // else quarantined in this frame
        system.exact[node + 1] = {};
        system.sweep[node + 1].mass = {};
        if (system.in_block[node + 1]) system.inertia[node + 1].setZero();  // cannot be factored, and moves freely
    }
    void turn_axes(uint32_t node) const {
        const Quat& q = nodes.motion[node].q;
        const NodeMass& mass = nodes.mass[node];
        Mat3& R = system.pose[node + 1].R;
        R = q.toRotationMatrix();
        note_turn(system, node, q, kTurn);
        if (!mass.isotropic && (system.turned[node + 1] || system.in_block[node + 1]))
            set_inverse_mass(system.sweep[node + 1].mass, mass, R);
        if (system.in_block[node + 1]) system.inertia[node + 1] = R * mass.inertia.matrix() * R.transpose();
    }
    void finish(uint32_t node) const {
        Velocity& u = system.exact[node + 1];
        const Vec3& torque = nodes.load_of(node).torque;
        if (torque != Vec3::Zero() && nodes.info[node].kind == NodeKind::dynamic) {
            const Mat3& R = system.pose[node + 1].R;
            u.w += system.h * (R * (nodes.mass[node].inv_inertia.matrix() * (R.transpose() * torque)));
        }
        const NodeMotion& m = nodes.motion[node];
        if (system.in_block[node + 1]) system.start[node + 1] = {m.v, m.w};
        set_sweep_velocity(system.sweep[node + 1].velocity, u);
    }
};

}  // namespace

void begin_frame(Team& team, System& system, const Nodes& nodes, const Joints& joints) {
    const uint32_t slots = nodes.slots();
    system.make_room(slots);
    system.sweep_pose.resize(joints.ids.count() > 0 ? slots + 1 : 0);
    system.kinematic.clear();
    for (uint32_t node = 0; node < slots; ++node)
        if (nodes.info[node].kind == NodeKind::kinematic && nodes.rest[node] != Rest::asleep)
            system.kinematic.push_back(node);
    forget(system, 0);
    team.for_ranges(slots, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t node = begin; node < end; ++node) {
            forget(system, node + 1);
            if (nodes.info[node].kind != NodeKind::dead && nodes.rest[node] != Rest::asleep)
                begin_node(system, nodes, node);
        }
    });
}

void predict(Team& team, System& system, const Group& group, Nodes& nodes, const Vec3& gravity) {
    const Prediction prediction{system, nodes, gravity};
    team.for_ranges(static_cast<uint32_t>(group.nodes.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; i += kSpins)
            prediction.of({&group.nodes[i], std::min<size_t>(kSpins, end - i)});
    });
}

void commit(Team& team, System& system, const Group& group, Nodes& nodes) {
    for_nodes(team, group.nodes, [&](uint32_t node) {
        const Velocity& u = system.exact[node + 1];
        displace(system, nodes, node, system.h * u.v, system.h * u.w);
    });
}

void correct(System& system, const Group& group, const Array<Block>& blocks, Nodes& nodes) {
    for (uint32_t b : group.blocks) {
        if (!blocks[b].corrected) continue;
        for (uint32_t node : blocks[b].nodes)
            displace(system, nodes, node, system.correction[node + 1].v, system.correction[node + 1].w);
    }
}

bool store_velocity(Team& team, const System& system, const Group& group, Nodes& nodes, double velocity_filter) {
    std::atomic<bool> all_sane{true};
    for_nodes(team, group.nodes, [&](uint32_t node) {
        NodeMotion& m = nodes.motion[node];
        const Velocity& u = system.exact[node + 1];
        const bool turns = nodes.info[node].kind == NodeKind::dynamic && !nodes.mass[node].isotropic &&
                           !system.in_block[node + 1] && system.h * u.w.norm() > kTurn;
        m.v = u.v;
        m.w = turns ? spin_after(system.pose[node + 1], u, m) : u.w;
        const double kappa = system.in_block[node + 1] ? velocity_filter : 1.0;
        m.slow_v += kappa * (u.v - m.slow_v);
        m.slow_w += kappa * (u.w - m.slow_w);
        if (!sane(m)) all_sane.store(false, std::memory_order_relaxed);
    });
    return all_sane.load(std::memory_order_relaxed);
}

void turn_kinematic(System& system, const Nodes& nodes, double time) {
    for (uint32_t node : system.kinematic) {
        const NodeMotion& m = nodes.motion[node];
        if (time == 0) system.found[node + 1].q = m.q;  // the group before this one left it at its last substep
        note_turn(system, node, rotation_after(m, time), kKinematicTurn);
    }
}

void shift_kinematic(System& system, const Nodes& nodes, double time) {
    for (uint32_t node : system.kinematic) {
        const NodeMotion& m = nodes.motion[node];
        const Quat turned = rotation_after(m, time);
        system.pose[node + 1] = {m.x + time * m.v, turned.toRotationMatrix()};
        set_shift(system.shift[node + 1], time * m.v, turned * system.found[node + 1].q.conjugate());
        set_sweep_pose(system, node, time * m.v, turned);
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
