#include "advance.h"

#include <algorithm>
#include <cmath>

#include "models/bodies.h"
#include "publish/publish.h"
#include "sleep/wake.h"

namespace taut {
namespace {

// Share of a step by which advance may be early: a host that adds 1.0 / 60 to a step of 1 / 60 in single precision
// gets a step each frame.
constexpr double kEarly = 1e-3;
constexpr double kMaxLedSpeed = 1e4;  // of a body that goes on past its target [m/s, rad/s]

// How the steps of a call share out its time and what the accumulator held before [s].
class Shares {
public:
    Shares(double owed, double seconds, double step) : step_(step), owed_(owed), seconds_(seconds), left_(seconds) {}

    // To the next step: what is owed comes first. Where the step before came early that is below zero.
    void next() {
        of_owed_ = std::min(owed_, step_);
        share_ = owed_ > step_ ? step_ / owed_ : 1;
        owed_ -= of_owed_;
        left_ -= step_ - of_owed_;
    }
    double step() const { return step_; }
    double seconds() const { return seconds_; }          // of the call
    double left() const { return left_; }                // of the call, for later ones
    double reached() const { return seconds_ - left_; }  // of the call, at the step's end
    double of_call() const { return step_ - of_owed_; }  // of the call, in the step
    double owed_share() const { return share_; }         // in the step

private:
    double step_, owed_, seconds_, left_, of_owed_ = 0, share_ = 1;
};

// ---------------------------------------------------------------- forces

void add(NodeLoad& to, const NodeLoad& load, double times) {
    to.force += times * load.force;
    to.torque += times * load.torque;
}

// For all that a call does with forces; throws std::bad_alloc with nothing changed.
void make_room(Nodes& nodes) {
    if (nodes.applied.empty() && nodes.owed.empty()) return;
    nodes.load.reserve(nodes.slots());
    if (nodes.owed.empty()) nodes.owed.resize(nodes.slots());
}

// The mean force of a step over the time that it stands for: (share J + F t) / h.
void load_step(Nodes& nodes, const Shares& shares) {
    nodes.load.assign(nodes.owed.size(), {});
    for (size_t node = 0; node < nodes.owed.size(); ++node)
        add(nodes.load[node], nodes.owed[node], shares.owed_share() / shares.step());
    for (size_t node = 0; node < nodes.applied.size(); ++node)
        add(nodes.load[node], nodes.applied[node], shares.of_call() / shares.step());
}

void pay_owed(Nodes& nodes, const Shares& shares) {
    for (NodeLoad& owed : nodes.owed) add(owed, owed, -shares.owed_share());
}

void owe_rest(Nodes& nodes, double left) {
    for (size_t node = 0; node < nodes.applied.size(); ++node) add(nodes.owed[node], nodes.applied[node], left);
    nodes.applied.clear();
    const auto any = [](const NodeLoad& load) { return load.any(); };
    if (std::none_of(nodes.owed.begin(), nodes.owed.end(), any)) nodes.owed.clear();
}

// ---------------------------------------------------------------- kinematic nodes

// Rotation vector of q, at most pi long [rad]. By Newton's iteration on rotation_from_vector, whose bits no C
// library decides: the remainder turns about the same axis by an angle e, and 2 sin(e/2) of it is taken off.
Vec3 rotation_vector(const Quat& q) {
    Vec3 theta = Vec3::Zero();
    for (int i = 0; i < 6; ++i) {
        const Quat left = q * rotation_from_vector(theta).conjugate();
        theta += (left.w() < 0 ? -2.0 : 2.0) * left.vec();
    }
    return theta;
}

NodePose pose_about(const Nodes& nodes, uint32_t node, const Vec3& centre, const Quat& rotation) {
    return {centre - rotation * nodes.mass[node].centre, rotation};
}

// After a time at a velocity.
NodePose pose_after(const Nodes& nodes, uint32_t node, const NodePose& from, const Speed& speed, double time) {
    return pose_about(nodes, node, nodes.centre_at(node, from) + time * speed.v,
                      (rotation_from_vector(time * speed.w) * from.rotation).normalized());
}

// Targets that were in reach may no longer be, of shorter steps.
Speed limited(const Speed& speed) {
    const auto limit = [](const Vec3& x) -> Vec3 { return x * (kMaxLedSpeed / std::max(x.norm(), kMaxLedSpeed)); };
    return {limit(speed.v), limit(speed.w)};
}
void set_speed(NodeMotion& motion, const Speed& speed) { set_velocity(motion, speed.v, speed.w); }

template <class Act>
void for_paths(Nodes& nodes, Act&& act) {
    for (KinematicPath& path : nodes.paths)
        if (path.follows) act(path, nodes.motion[path.node]);
}

// Where a path leads in a call that lasts some seconds: evenly to its target, or on as before.
NodePose pose_in_call(const Nodes& nodes, const KinematicPath& path, double time, double seconds) {
    const bool to_target = path.asked && seconds > 0;
    const Speed speed = to_target ? speed_between(nodes, path.node, path.start, path.target, seconds) : path.speed;
    return pose_after(nodes, path.node, path.start, speed, time);
}

// The velocity that brings a node to where its path is at the step's end, be that before the call begins.
void lead_step(World& world, KinematicPath& path, NodeMotion& motion, const Shares& shares) {
    const Nodes& nodes = world.nodes;
    path.held = {motion.v, motion.w};
    const bool before = shares.owed_share() < 1;
    const NodePose to = before ? path.start : pose_in_call(nodes, path, shares.reached(), shares.seconds());
    const double time = shares.step() / shares.owed_share();
    const Speed speed = limited(speed_between(nodes, path.node, origin_pose(world, path.node), to, time));
    if (nodes.rest[path.node] != Rest::awake) {
        if (stands_still(speed.v, speed.w)) return;
        wake(world, path.node);
    }
    set_speed(motion, speed);
}

// Goes on from a target at the host's own speed: over all seconds of the call, `taken` of which were not given up.
void end_path(Nodes& nodes, KinematicPath& path, NodeMotion& motion, double taken, double seconds) {
    if (path.asked) {
        path.speed = limited(speed_between(nodes, path.node, path.start, path.target, seconds));
        path.start = path.target;
        path.asked = false;
    } else {
        path.start = pose_after(nodes, path.node, path.start, path.speed, taken);
    }
    if (nodes.rest[path.node] == Rest::awake) set_speed(motion, path.speed);
}

// ---------------------------------------------------------------- steps

// A step with what leads to it: all of it, or throws and leaves the world as it was, as far as Undo does.
template <class Act>
void or_nothing(World& world, Act&& act) {
    world.undo.note(world);
    try {
        act();
    } catch (...) {
        world.nodes.load.clear();
        world.undo.restore(world);
        throw;
    }
}

// A step of a call. Throws as step(), with what it was given taken back.
void take(World& world, const Shares& shares) {
    Nodes& nodes = world.nodes;
    or_nothing(world, [&] {
        load_step(nodes, shares);
        for_paths(nodes, [&](KinematicPath& path, NodeMotion& motion) { lead_step(world, path, motion, shares); });
        try {
            step(world);
        } catch (...) {
            for_paths(nodes, [](KinematicPath& path, NodeMotion& motion) { set_speed(motion, path.held); });
            throw;
        }
    });
    pay_owed(nodes, shares);
}

}  // namespace

void take_step(World& world) {
    Nodes& nodes = world.nodes;
    or_nothing(world, [&] {
        nodes.load = nodes.applied;
        step(world);
    });
    nodes.applied.clear();
    for_paths(nodes, [](KinematicPath& path, NodeMotion&) { path.follows = path.asked = false; });
}

void take_rest(World& world, Relaxation& relaxation) {
    Nodes& nodes = world.nodes;
    const auto for_led = [&](Array<Speed>& led, auto&& act) {
        for (uint32_t node = 0; node < nodes.slots(); ++node)
            if (nodes.info[node].kind == NodeKind::kinematic) act(nodes.motion[node], led[node]);
    };
    or_nothing(world, [&] {
        Array<Speed> led(nodes.slots(), Speed{}, world.memory);
        wake_all(world);
        nodes.load = nodes.applied;
        for_led(led, [](NodeMotion& motion, Speed& speed) {
            speed = {motion.v, motion.w};
            set_speed(motion, {});
        });
        const auto end = [&] {
            world.relaxation = nullptr;
            for_led(led, [](NodeMotion& motion, const Speed& speed) { set_speed(motion, speed); });
        };
        world.relaxation = &relaxation;
        try {
            step(world);
        } catch (...) {
            end();
            throw;
        }
        nodes.load.clear();
        end();
    });
    for (uint32_t node = 0; node < nodes.slots(); ++node)
        if (moves_by_forces(nodes.info[node].kind)) set_speed(nodes.motion[node], {});
    std::ranges::fill(nodes.history, NodeHistory{});
}

Advance advance(World& world, double seconds) {
    begin_call(world);
    make_room(world.nodes);
    const double h = world.def.time_step, before = world.accumulator;
    const double due = std::floor((before + seconds) / h + kEarly);
    const double dropped = std::clamp((due - world.def.max_catch_up) * h, 0.0, seconds), taken = seconds - dropped;
    const double steps = std::min<double>(due, world.def.max_catch_up);
    Advance done{0, dropped};
    Shares shares(before, taken, h);
    for (; done.steps < steps; ++done.steps) {
        Shares next = shares;
        next.next();
        try {
            take(world, next);
        } catch (...) {
            if (done.steps > 0) break;
            throw;
        }
        shares = next;
    }
    world.accumulator = before + taken - done.steps * h;
    owe_rest(world.nodes, shares.left());
    if (taken > 0)
        for_paths(world.nodes, [&](KinematicPath& path, NodeMotion& motion) {
            end_path(world.nodes, path, motion, taken, seconds);
        });
    return done;
}

Speed speed_between(const Nodes& nodes, uint32_t node, const NodePose& from, const NodePose& to, double time) {
    return {(nodes.centre_at(node, to) - nodes.centre_at(node, from)) / time,
            rotation_vector(to.rotation * from.rotation.conjugate()) / time};
}

double render_weight(const World& world) { return std::clamp(world.accumulator / world.last_step, 0.0, 1.0); }

void lead_to(World& world, uint32_t node, const NodePose& target) {
    KinematicPath& path = world.nodes.path_of(node);
    if (!path.follows) {
        const NodeMotion& motion = world.nodes.motion[node];
        path.speed = {motion.v, motion.w};
        path.start = pose_after(world.nodes, node, origin_pose(world, node), path.speed, world.accumulator);
        path.follows = true;
    }
    path.target = target;
    path.asked = true;
}

void forget_path(Nodes& nodes, uint32_t node) {
    if (KinematicPath* path = nodes.find_path(node)) path->follows = path->asked = false;
}

void restart_path(World& world, uint32_t node) {
    if (KinematicPath* path = world.nodes.find_path(node)) path->start = origin_pose(world, node);
}

void change_time_step(World& world, float time_step) {
    const double by = static_cast<double>(time_step) / static_cast<double>(world.def.time_step);
    for_paths(world.nodes, [&](KinematicPath& path, NodeMotion& motion) {
        if (path.asked) set_speed(motion, limited({motion.v / by, motion.w / by}));
    });
    world.def.time_step = time_step;
}

}  // namespace taut
