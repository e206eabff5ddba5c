// What holds a cable's parts together: types, anchors and softness of its joints.
#include <cstddef>
#include <cstring>

#include "constraints/ball.h"
#include "constraints/bend.h"
#include "constraints/distance.h"
#include "constraints/joint_frames.h"
#include "models/cable_parts.h"
#include "state/joint_data.h"
#include "state/joint_reading.h"

namespace taut {

static_assert(offsetof(BallData, anchor_b) == sizeof(Vec3) && offsetof(DistanceData, anchor_b) == sizeof(Vec3) &&
                  offsetof(JointFrames, anchor_b) == sizeof(Vec3) && offsetof(BendData, anchor_c) == 2 * sizeof(Vec3),
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

void set_segment(const Cable& cable, Joint& joint, double length) {
    std::memcpy(joint.data + offsetof(DistanceData, length), &length, sizeof length);
    set_softness(cable, joint, length);
}

Joint make_inner_joint(const Cable& cable, uint32_t i) {
    Joint joint;
    joint.node[0] = cable.node[i];
    joint.node[1] = cable.node[i + 1];
    joint.user_data = cable.user_data;
    if (!links(cable)) {
        joint.type = &kDistance;
        write_data(joint, DistanceData{Vec3::Zero(), Vec3::Zero(), cable.length[i]});
        set_softness(cable, joint, cable.length[i]);
        return joint;
    }
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

Joint make_bend(const Cable& cable, uint32_t point) {
    Joint joint;
    joint.type = &kBend;
    joint.inner = true;
    joint.collide_connected = true;  // segments are what keeps neighbours from colliding
    joint.user_data = cable.user_data;
    write_data(joint, BendData{});
    for (int n = 0; n < 3; ++n) {
        const uint32_t at = point + static_cast<uint32_t>(n) - 1;
        if (at < cable.node.size()) joint.node[n] = cable.node[at];
    }
    set_softness(cable, joint, share_of(cable, point));
    return joint;
}

Joint make_clamp(const World& world, const Cable& cable, int e, const CableTie& tie) {
    const uint32_t end = e == 0 ? 0 : cable.segments(), next = e == 0 ? 1 : end - 1;
    const Vec3 behind = world.nodes.motion[cable.node[end]].x - world.nodes.motion[cable.node[next]].x;
    Joint joint = make_bend(cable, end);
    const int outside = e == 0 ? 0 : 2;
    joint.node[outside] = tie.node;
    const Quat body = tie.node == kNone ? Quat::Identity() : world.nodes.motion[tie.node].q;
    set_anchor(joint, outside, tie.anchor + body.conjugate() * behind);
    return joint;
}

void tie_bend(World& world, const Cable& cable, uint32_t point) {
    Joint* joint = find(world.joints, bend_at(cable, point));
    if (!joint) return;
    const Joint now = make_bend(cable, point);
    for (int n = 0; n < 3; ++n)
        if (now.node[n] != kNone) joint->node[n] = now.node[n];
    set_softness(cable, *joint, share_of(cable, point));
}

}  // namespace taut
