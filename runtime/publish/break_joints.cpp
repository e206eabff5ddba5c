#include "publish/publish.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"
#include "threads/gather.h"

namespace taut {
namespace {

bool overloaded(const Nodes& nodes, const Joint& joint) {
    if (!joint.type || (std::isinf(joint.break_force) && std::isinf(joint.break_torque))) return false;
    if (asleep(nodes, joint)) return false;
    const Wrench load = wrench_of(joint, read_joint(nodes, joint));
    return load.force.norm() > joint.break_force || load.torque.norm() > joint.break_torque;
}

}  // namespace

// In ascending slot order, which also orders the events. What a break wakes may break in the next step.
void break_joints(World& world) {
    gather(world.team, static_cast<uint32_t>(world.joints.record.size()), world.pairs.picked,
           [&](uint32_t index) { return overloaded(world.nodes, world.joints.record[index]); });
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
