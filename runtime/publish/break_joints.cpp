// Of the joints of a mechanism that carry more than they bear, the one that does so most breaks: those that carry the
// same force are relieved by it, and what the others carry is known after the next step. Mechanisms, bodies that joints
// tie together, break each on its own.
#include <algorithm>
#include <cmath>

#include "publish/publish.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"
#include "threads/gather.h"

namespace taut {
namespace {

// What a joint carries in parts of what it bears.
double load_ratio(const Nodes& nodes, const Joint& joint) {
    const Wrench load = wrench_of(joint, read_joint(nodes, joint));
    return std::max(load.force.norm() / joint.break_force, load.torque.norm() / joint.break_torque);
}

bool overloaded(const Nodes& nodes, const Joint& joint) {
    if (!joint.type || (std::isinf(joint.break_force) && std::isinf(joint.break_torque))) return false;
    return !asleep(nodes, joint) && load_ratio(nodes, joint) > 1;
}

// Bodies tied by joints, by slot of a node: what static and kinematic bodies hold on either side moves apart.
class Assemblies {
public:
    Assemblies(Memory& memory, const Nodes& nodes, const Joints& joints, const Elements& elements)
        : nodes_(nodes), parent_(nodes.slots(), 0, memory) {
        for (uint32_t node = 0; node < nodes.slots(); ++node) parent_[node] = node;
        for_each_tie(joints, elements, [&](std::span<const uint32_t> ends) {
            const uint32_t first = mover(ends);
            for (const uint32_t node : ends)
                if (moves(node)) unite(first, node);
        });
    }
    // Slot of one of its nodes, kNone if nothing of the joint moves.
    uint32_t of(const Joint& joint) {
        const uint32_t node = mover(joint.nodes());
        return node == kNone ? kNone : find(node);
    }

private:
    bool moves(uint32_t node) const { return node != kNone && moves_by_forces(nodes_.info[node].kind); }
    uint32_t mover(std::span<const uint32_t> ends) const {
        const auto at = std::find_if(ends.begin(), ends.end(), [&](uint32_t node) { return moves(node); });
        return at == ends.end() ? kNone : *at;
    }
    uint32_t find(uint32_t node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    }
    void unite(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const Nodes& nodes_;
    Array<uint32_t> parent_;
};

struct Overload {
    uint32_t mechanism, joint;
    double ratio;
};

// Leaves of overloaded joints, in ascending slot order, the worst of each mechanism; of like ones the oldest.
void keep_worst(World& world, Array<uint32_t>& overloaded) {
    constexpr double kAlike = 1e-6;  // rounding of a solve
    if (overloaded.size() < 2) return;
    const Joints& joints = world.joints;
    Assemblies assemblies(world.memory, world.nodes, joints, world.elements);
    Array<Overload> all(world.memory);
    for (const uint32_t index : overloaded)
        all.push_back({assemblies.of(joints.record[index]), index, load_ratio(world.nodes, joints.record[index])});
    std::sort(all.begin(), all.end(), [&](const Overload& a, const Overload& b) {
        const uint64_t age_a = joints.record[a.joint].serial, age_b = joints.record[b.joint].serial;
        return a.mechanism != b.mechanism ? a.mechanism < b.mechanism : age_a < age_b;
    });
    overloaded.clear();
    for (size_t begin = 0, end; begin < all.size(); begin = end) {
        size_t worst = begin;
        for (end = begin + 1; end < all.size() && all[end].mechanism == all[begin].mechanism; ++end)
            if (all[end].ratio > (1 + kAlike) * all[worst].ratio) worst = end;
        overloaded.push_back(all[worst].joint);
    }
    std::sort(overloaded.begin(), overloaded.end());
}

}  // namespace

// In ascending slot order, which also orders the events. What a break wakes may break in the next step.
void break_joints(World& world) {
    gather(world.team, static_cast<uint32_t>(world.joints.record.size()), world.pairs.picked,
           [&](uint32_t index) { return overloaded(world.nodes, world.joints.record[index]); });
    keep_worst(world, world.pairs.picked);
    for (const uint32_t index : world.pairs.picked) {
        const Joint& joint = world.joints.record[index];
        const Wrench load = wrench_of(joint, read_joint(world.nodes, joint));
        const Vec3f force = load.force.cast<float>(), torque = load.torque.cast<float>();
        // What may fail comes first.
        world.broken.push_back({world.joint_handle(index),
                                joint.user_data,
                                {force.x(), force.y(), force.z()},
                                {torque.x(), torque.y(), torque.z()},
                                world.window.steps,
                                0});
        // The two bodies may collide from the next step on: a pair that was filtered is found anew, and touched nobody.
        if (!joint.collide_connected && joint.node[0] != kNone && joint.node[1] != kNone)
            forget_pairs(world.pairs, world.nodes, world.colliders, between_nodes(joint.node[0], joint.node[1]));
        for (uint32_t node : joint.nodes()) wake(world, node);
        world.joints.remove(index);
    }
}

}  // namespace taut
