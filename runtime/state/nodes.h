// Nodes: rigid bodies and particles in one index space. Arrays by slot; a dead slot is skipped by kind.
#pragma once

#include <taut/body.h>

#include <algorithm>
#include <array>
#include <bit>

#include "base/id_pool.h"
#include "base/math.h"
#include "state/shared_values.h"

namespace taut {

constexpr uint32_t kNone = UINT32_MAX;  // no node, no collider: the world, or nothing

enum class NodeKind : uint8_t { fixed, kinematic, dynamic, particle, dead };

inline bool moves_by_forces(NodeKind kind) { return kind == NodeKind::dynamic || kind == NodeKind::particle; }

// Whether a step goes through a node. One that settles fell asleep in the last step, and the next one brings its boxes
// and what solvers see of it up to date for the last time. A kinematic node sleeps while it stands still, in worlds
// with sleeping; a fixed one after the step that sees it first or anew; what is dead sleeps.
enum class Rest : uint8_t { awake, settling, asleep };

struct NodeMotion {
    Vec3 x = Vec3::Zero();       // centre of mass [m]
    Quat q = Quat::Identity();   // world from body
    Vec3 v = Vec3::Zero();       // of the centre of mass [m/s]
    Vec3 w = Vec3::Zero();       // world axes [rad/s]
    Vec3 slow_v = Vec3::Zero();  // low-passed v and w, which geometric stiffness spares
    Vec3 slow_w = Vec3::Zero();
};
template <class Visitor, Like<NodeMotion> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [x, q, v, w, slow_v, slow_w] = of;
    TAUT_FIELDS(visitor, x, q, v, w, slow_v, slow_w);
}

// The velocities of its centre of mass [m/s, rad/s], and the low-passed ones, which start from them.
inline void set_velocity(NodeMotion& motion, const Vec3& v, const Vec3& w) {
    motion.v = motion.slow_v = v;
    motion.w = motion.slow_w = w;
}

struct NodeMass {
    double mass = 0, inv_mass = 0;  // [kg]; 0 for fixed and kinematic nodes
    Sym3 inertia, inv_inertia;      // about the centre of mass, body axes [kg m^2]
    Vec3 centre = Vec3::Zero();     // of mass, in the body's frame [m]
    double gravity_scale = 1;
    bool isotropic = false;  // inertia is a multiple of the identity: no gyroscopic torque
    std::array<uint64_t, 19> words() const {
        const Sym3 &i = inertia, &j = inv_inertia;
        const double numbers[] = {mass, inv_mass, i.xx, i.yy, i.zz, i.xy,       i.xz,       i.yz,       j.xx,
                                  j.yy, j.zz,     j.xy, j.xz, j.yz, centre.x(), centre.y(), centre.z(), gravity_scale};
        std::array<uint64_t, 19> words;
        std::transform(std::begin(numbers), std::end(numbers), words.begin(),
                       [](double x) { return std::bit_cast<uint64_t>(x); });
        words.back() = isotropic;
        return words;
    }
};
template <class Visitor, Like<NodeMass> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [mass, inv_mass, inertia, inv_inertia, centre, gravity_scale, isotropic] = of;
    TAUT_FIELDS(visitor, mass, inv_mass, inertia, inv_inertia, centre, gravity_scale, isotropic);
}

// What slows a node by itself; 0: nothing does.
struct Restraint {
    uint32_t node = kNone;
    double damping = 0, angular_damping = 0;  // [1/s]
    double most_speed = 0, most_spin = 0;     // [m/s, rad/s]

    bool operator==(const Restraint&) const = default;
    bool any() const { return damping != 0 || angular_damping != 0 || most_speed != 0 || most_spin != 0; }
};
template <class Visitor, Like<Restraint> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, damping, angular_damping, most_speed, most_spin] = of;
    TAUT_FIELDS(visitor, node, damping, angular_damping, most_speed, most_spin);
}

// Motions along and about the world's axes that a dynamic node does not make: a bit for each, linear x, y, z, then
// angular, as TAUT_LOCK_.
struct Locks {
    uint8_t axes = 0;

    bool any() const { return axes != 0; }
    bool linear(int axis) const { return (axes >> axis & 1) != 0; }
    bool angular(int axis) const { return (axes >> (3 + axis) & 1) != 0; }
    bool any_angular() const { return axes >> 3 != 0; }
    bool all_angular() const { return axes >> 3 == 7; }
    // v and w without what is locked; +0 there.
    void hold(Vec3& v, Vec3& w) const {
        for (int i = 0; i < 3; ++i) {
            if (linear(i)) v[i] = 0;
            if (angular(i)) w[i] = 0;
        }
    }
};

// (P I P)^+ of an inertia in world axes, P the projection on angular axes that are free.
Mat3 free_inverse(Mat3 inertia, Locks locks);

struct LockedNode {
    uint32_t node = kNone;
    uint8_t axes = 0;  // as Locks
};
template <class Visitor, Like<LockedNode> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, axes] = of;
    TAUT_FIELDS(visitor, node, axes);
}

// The mass that a node which forces do not move has once they do.
struct SpareMass {
    uint32_t node = kNone;
    double mass = 0;  // [kg]
    Sym3 inertia;     // about the centre of mass, body axes [kg m^2]
};
template <class Visitor, Like<SpareMass> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, mass, inertia] = of;
    TAUT_FIELDS(visitor, node, mass, inertia);
}

struct NodeLoad {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m]; times a time: [N s], [N m s]

    bool any() const { return force != Vec3::Zero() || torque != Vec3::Zero(); }
};
template <class Visitor, Like<NodeLoad> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [force, torque] = of;
    bool any = of.any();  // of most nodes none
    TAUT_FIELDS(visitor, any);
    if (any) TAUT_FIELDS(visitor, force, torque);
}

// What is on as it comes, and counts for the hash where it is off.
struct Switch {
    bool off = false;

    bool empty() const { return !off; }
};
template <class Visitor, Like<Switch> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [off] = of;
    TAUT_FIELDS(visitor, off);
}

struct NodeInfo {
    NodeKind kind = NodeKind::dead;
    uint32_t collider = kNone;  // the first of its colliders
    uint32_t cable = kNone;     // that it is part of
    uint32_t soft = kNone;      // likewise, a cloth or solid
    bool continuous = true;     // what moves past its own thickness is looked for along its way; detect/impact.h
    Switch disabled;            // asleep until it is enabled: no box, no pair and no joint of it is there meanwhile
    bool restrained = false;    // Nodes::restraints has it
    uint8_t locks = 0;          // as Nodes::locked has it; of Locks
    uint64_t user_data = 0;

    // What the host knows as a whole, and changes as one.
    bool is_part() const { return cable != kNone || soft != kNone; }
};
template <class Visitor, Like<NodeInfo> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [kind, collider, cable, soft, continuous, disabled, restrained, locks, user_data] = of;
    TAUT_FIELDS(visitor, kind, collider, cable, soft, continuous);
    TAUT_RARE(visitor, disabled);
    TAUT_ASIDE(visitor, restrained, locks, user_data);
}

struct NodeSleep {
    double quiet = 0;          // how long it has been slower than the world's sleep_speed [s]
    uint32_t next = kNone;     // of its sleeping island: a ring; kNone while awake
    bool can_sleep = true;     // its island may fall asleep
    bool told_asleep = false;  // what events have said
};
template <class Visitor, Like<NodeSleep> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [quiet, next, can_sleep, told_asleep] = of;
    TAUT_FIELDS(visitor, quiet, next, can_sleep);
    TAUT_ASIDE(visitor, told_asleep);
}

// Why a node is in quarantine: its motion, or what its load would make of it, is not finite or beyond kMaxSpeed.
enum class Divergence : uint8_t { none, non_finite, too_fast };  // as taut_quarantine_reason

// What a node in quarantine was.
struct FrozenNode {
    uint32_t node = kNone;
    NodeKind kind = NodeKind::dead;
    Divergence why = Divergence::none;
    NodeMass mass;
};
template <class Visitor, Like<FrozenNode> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, kind, why, mass] = of;
    TAUT_FIELDS(visitor, node, kind, why, mass);
}

struct NodePose {  // of the body's origin, for rendering
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();
};
template <class Visitor, Like<NodePose> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [position, rotation] = of;
    TAUT_FIELDS(visitor, position, rotation);
}

struct Speed {
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // of the centre of mass [m/s], world axes [rad/s]
};
template <class Visitor, Like<Speed> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [v, w] = of;
    TAUT_FIELDS(visitor, v, w);
}

// What schemes of more than one step remember of a node; system/scheme.h.
struct NodeHistory {
    Speed velocity;      // at the end of the last substep: what a host sets since then is no force
    Speed acceleration;  // by springs then [m/s^2, rad/s^2]
    Speed rate, before;  // BDF2: displacement of the last substep over its length; velocity at its begin
    double length = 0;   // of the last substep [s]; 0: there was none

    bool any() const { return length != 0; }
};
template <class Visitor, Like<NodeHistory> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [velocity, acceleration, rate, before, length] = of;
    TAUT_FIELDS(visitor, velocity, acceleration, rate, before, length);
}

// Where the host leads a kinematic node, in the host's time: that of all its calls, of which the steps have yet to take
// what is left in the accumulator.
struct KinematicPath {
    uint32_t node = kNone;
    bool follows = false;  // else the node has a velocity, and this means nothing
    bool asked = false;    // the target waits for the next call, whose end is its time
    NodePose start;        // at the end of the last call
    Speed speed;           // since then
    NodePose target;
    Speed held;  // the node's own, while a step tries another
};
template <class Visitor, Like<KinematicPath> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, follows, asked, start, speed, target, held] = of;
    TAUT_FIELDS(visitor, node, follows);
    if (follows) TAUT_FIELDS(visitor, asked, start, speed, target);
}

// What the host calls a node.
struct NodeName {
    uint32_t node = kNone;
    std::array<char, TAUT_BODY_NAME_SIZE> text{};
};
template <class Visitor, Like<NodeName> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, text] = of;
    TAUT_FIELDS(visitor, node, text);
}

struct Nodes {
    explicit Nodes(Memory& memory)
        : ids(memory),
          info(memory),
          motion(memory),
          mass(memory),
          applied(memory),
          owed(memory),
          load(memory),
          paths(memory),
          frozen(memory),
          names(memory),
          restraints(memory),
          locked(memory),
          spares(memory),
          before(memory),
          history(memory),
          rest(memory),
          sleep(memory),
          active(memory) {}

    // Adds a dead-to-live slot with default contents; throws std::bad_alloc before anything changes.
    uint32_t add();
    void remove(uint32_t node);

    uint32_t slots() const { return ids.slots(); }
    const NodeLoad& load_of(uint32_t node) const { return load.empty() ? kNoLoad : load[node]; }
    // Until the host's next call and over the time that it brings. Throws std::bad_alloc before anything changes.
    void add_load(uint32_t node, const Vec3& force, const Vec3& torque);
    void clear_load(uint32_t node) {
        for (Array<NodeLoad>* list : loads())
            if (!list->empty()) (*list)[node] = {};
    }
    // Of a kinematic node; null: it never had a target.
    KinematicPath* find_path(uint32_t node);
    // Makes one where there is none; throws std::bad_alloc with nothing changed.
    KinematicPath& path_of(uint32_t node);
    // A node that forces move stays where it was before the last step, as a fixed one, until it is let go: as what it
    // was, at rest. Throws std::bad_alloc with nothing changed.
    void freeze(uint32_t node, Divergence why);
    void let_go(uint32_t node);
    void stay(uint32_t node);  // where it was before the last step, at rest
    // Of a node; null: it has none.
    const Restraint* find_restraint(uint32_t node) const { return find_in(restraints, node); }
    const SpareMass* find_spare(uint32_t node) const { return find_in(spares, node); }
    // Their nodes say whose they are; one of nothing is dropped. Throw std::bad_alloc with nothing changed.
    void set_restraint(const Restraint& restraint);
    void set_locks(uint32_t node, Locks locks);
    void set_spare(const SpareMass& spare);
    void drop_spare(uint32_t node);
    // How strongly gravity pulls; of one in quarantine, once it is let go. Throws std::bad_alloc with nothing changed.
    void set_gravity_scale(uint32_t node, double scale);
    // Of a node that forces move, else none.
    Locks locks_of(uint32_t node) const {
        return {info[node].kind == NodeKind::dynamic ? info[node].locks : uint8_t{0}};
    }
    // Drops the velocity along what is locked.
    void hold(uint32_t node) {
        const Locks locks = locks_of(node);
        if (!locks.any()) return;
        locks.hold(motion[node].v, motion[node].w);
        locks.hold(motion[node].slow_v, motion[node].slow_w);
    }
    // Moves its centre of mass by a way, or to a place, but not along what is locked.
    void shift(uint32_t node, const Vec3& way) { place(node, motion[node].x + way); }
    void place(uint32_t node, const Vec3& at) {
        const Locks locks = locks_of(node);
        for (int i = 0; i < 3; ++i)
            if (!locks.linear(i)) motion[node].x[i] = at[i];
    }
    // W p: what an impulse at the centre of mass [N s], and an angular one [N m s], change of a node's velocities where
    // its rotation is R.
    Vec3 move_by(uint32_t node, const Vec3& impulse) const {
        Vec3 v = mass[node].inv_mass * impulse, none = Vec3::Zero();
        locks_of(node).hold(v, none);
        return v;
    }
    Vec3 spin_by(uint32_t node, const Mat3& R, const Vec3& angular_impulse) const {
        if (locks_of(node).any_angular()) return free_inverse_inertia(node, R) * angular_impulse;
        return R * (mass[node].inv_inertia.matrix() * (R.transpose() * angular_impulse));
    }
    // Of a node with locked angular axes, world axes: (P I P)^+, P the projection on those that are free.
    Mat3 free_inverse_inertia(uint32_t node, const Mat3& R) const;
    const char* name_of(uint32_t node) const;  // null: it has none
    // Empty: none from now on. Throws std::bad_alloc with nothing changed.
    void set_name(uint32_t node, const std::array<char, TAUT_BODY_NAME_SIZE>& text);
    const FrozenNode* find_frozen(uint32_t node) const;  // null: it is in no quarantine
    Vec3 centre_at(uint32_t node, const NodePose& pose) const {
        return pose.position + pose.rotation * mass[node].centre;
    }
    // Moved by forces, and not asleep.
    bool solved(uint32_t node) const { return moves_by_forces(info[node].kind) && rest[node] == Rest::awake; }
    bool sleeps(uint32_t node) const { return moves_by_forces(info[node].kind) && rest[node] != Rest::awake; }
    bool enabled(uint32_t node) const { return !info[node].disabled.off; }
    void set_rest(uint32_t node, Rest to) {
        listed_ = listed_ && (rest[node] == Rest::asleep) == (to == Rest::asleep);
        rest[node] = to;
    }
    // Brings `active` up to date.
    void list_active();
    // All of them for the next step, as where what it found of those that sleep is not there.
    void forget_active() { all_ = true; }
    Vec3 origin(uint32_t node) const { return motion[node].x - motion[node].q * mass[node].centre; }

    IdPool ids;
    Array<NodeInfo> info;
    Array<NodeMotion> motion;
    SharedValues<NodeMass> mass;
    // Of all, or of none while nothing was put on any.
    Array<NodeLoad> applied;      // by the host, over the time of its next call [N]
    Array<NodeLoad> owed;         // by its calls over what the accumulator holds of their time [N s]
    Array<NodeLoad> load;         // in the step that is being taken [N]
    Array<KinematicPath> paths;   // sorted by node
    Array<FrozenNode> frozen;     // likewise
    Array<NodeName> names;        // likewise
    Array<Restraint> restraints;  // likewise
    Array<LockedNode> locked;     // likewise
    Array<SpareMass> spares;      // likewise
    Array<NodePose> before;       // origin pose before the last step
    Array<NodeHistory> history;   // of all, or of none in worlds whose scheme has one step
    Array<Rest> rest;             // set_rest()
    Array<NodeSleep> sleep;
    Array<uint32_t> active;  // slots of those that do not sleep, ascending; list_active()
    uint64_t lists = 0;      // counts changes of it
    uint32_t movable = 0;    // how many live that were not fixed when they came

private:
    std::array<Array<NodeLoad>*, 3> loads() { return {&applied, &owed, &load}; }

    // In a list that is sorted by node.
    template <class T>
    static const T* find_in(const Array<T>& list, uint32_t node) {
        const auto at = std::ranges::lower_bound(list, node, {}, &T::node);
        return at != list.end() && at->node == node ? &*at : nullptr;
    }

    static const NodeLoad kNoLoad;

    bool listed_ = false;  // active is up to date
    bool all_ = false;     // forget_active()

    template <class Visitor, Like<Nodes> Of>
    friend void describe(Visitor& visitor, Of& of);
};
template <class Visitor, Like<Nodes> Of>
void describe(Visitor& visitor, Of& of) {
    // load: within a step; the list of active ones follows.
    auto& [ids, info, motion, mass, applied, owed, load, paths, frozen, names, restraints, locked, spares, before,
           history, rest, sleep, active, lists, movable, listed, all] = of;
    OrNone loads_applied{applied}, loads_owed{owed};
    OrNone histories{history};
    TAUT_ASIDE(visitor, ids, names);
    TAUT_ROWS(visitor, ids, info, motion, mass, loads_applied, loads_owed, before, histories, rest, sleep);
    TAUT_FIELDS(visitor, paths);
    TAUT_RARE(visitor, frozen);
    TAUT_RARE(visitor, restraints);
    TAUT_RARE(visitor, locked);
    TAUT_RARE(visitor, spares);
}

}  // namespace taut
