// Joints of cables: between links, and what holds an end.
#include <cstddef>

#include "constraints/ball.h"
#include "constraints/bend.h"
#include "constraints/joint_frames.h"
#include "models/cable_parts.h"
#include "state/joint_data.h"
#include "state/joint_reading.h"

namespace taut {

static_assert(offsetof(BallData, anchor_b) == sizeof(Vec3) && offsetof(JointFrames, anchor_b) == sizeof(Vec3) &&
                  offsetof(BendData, anchor_c) == 2 * sizeof(Vec3),
              "set_anchor relies on it");

double span_before(const Cable& cable, uint32_t i) {
    return 0.5 * (cable.length[i] + (i == 0 ? 0 : cable.length[i - 1]));
}

double span_after(const Cable& cable, uint32_t i) {
    return 0.5 * (cable.length[i] + (i + 1 == cable.segments() ? 0 : cable.length[i + 1]));
}

void set_softness(const Cable& cable, Joint& joint, double span) {
    joint.compliance = cable.stretch_compliance * span;
    joint.damping = cable.stretch_damping / span;
    if (joint.type->angular == 0) return;
    joint.angular_compliance = span / cable.bending_stiffness;
    joint.angular_damping = cable.bending_damping / span;
}

Joint make_inner_joint(const Cable& cable, uint32_t i) {
    Joint joint;
    joint.node[0] = cable.node[i];
    joint.node[1] = cable.node[i + 1];
    joint.user_data = cable.user_data;
    const Vec3 a = along(0.5 * cable.length[i]), b = along(-0.5 * cable.length[i + 1]);
    if (cable.bending_stiffness > 0) {
        joint.type = &kFixed;
        write_data(joint, JointFrames{a, b, Quat::Identity(), Quat::Identity()});
    } else {
        joint.type = &kBall;
        write_data(joint, BallData{a, b});
    }
    set_softness(cable, joint, span_after(cable, i));
    return joint;
}

Joint make_end_joint(const World& world, const Cable& cable, int e, const CableTie& tie) {
    const uint32_t i = e == 0 ? 0 : static_cast<uint32_t>(cable.node.size()) - 1;
    const uint32_t node = cable.node[i];
    Vec3 anchor[2];
    Quat frame[2] = {Quat::Identity(), Quat::Identity()};
    const int outside = e == 0 ? 0 : 1, inside = 1 - outside;
    Joint joint;
    joint.node[outside] = tie.node;
    joint.node[inside] = node;
    joint.user_data = cable.user_data;
    anchor[outside] = tie.anchor;
    anchor[inside] = links(cable) ? along((e == 0 ? -0.5 : 0.5) * cable.length[i]) : Vec3::Zero();
    if (tie.clamped && links(cable)) {
        const Quat body = tie.node == kNone ? Quat::Identity() : world.nodes.motion[tie.node].q;
        frame[outside] = body.conjugate() * world.nodes.motion[node].q;
        joint.type = &kFixed;
        write_data(joint, JointFrames{anchor[0], anchor[1], frame[0], frame[1]});
    } else {
        joint.type = &kBall;
        write_data(joint, BallData{anchor[0], anchor[1]});
    }
    if (links(cable)) set_softness(cable, joint, 0.5 * cable.length[i]);
    return joint;
}

Joint make_clamp(const World& world, const Cable& cable, int e, const CableTie& tie) {
    const uint32_t end = e == 0 ? 0 : cable.segments(), next = e == 0 ? 1 : end - 1;
    const Vec3 behind = world.nodes.motion[cable.node[end]].x - world.nodes.motion[cable.node[next]].x;
    const int outside = e == 0 ? 0 : 2;
    Joint joint;
    joint.type = &kBend;
    joint.inner = true;
    joint.collide_connected = true;  // segments are what keeps neighbours from colliding
    joint.user_data = cable.user_data;
    joint.node[outside] = tie.node;
    joint.node[1] = cable.node[end];
    joint.node[2 - outside] = cable.node[next];
    set_softness(cable, joint, share_of(cable, end));
    const Quat body = tie.node == kNone ? Quat::Identity() : world.nodes.motion[tie.node].q;
    write_data(joint, BendData{});
    set_anchor(joint, outside, tie.anchor + body.conjugate() * behind);
    return joint;
}

}  // namespace taut
