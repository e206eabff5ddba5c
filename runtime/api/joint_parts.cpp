#include "api/joint_parts.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

// ---------------------------------------------------------------- ends

Check& check_frames(Check& check, const taut_frame& frame_a, const taut_frame& frame_b) {
    for (int i = 0; i < 2; ++i) {
        const taut_frame& frame = i == 0 ? frame_a : frame_b;
        check.bounded(kFrameNames[i].position, frame.position, kPosition)
            .rotation(kFrameNames[i].rotation, frame.rotation);
    }
    return check;
}

Check& place_end(Check& check, const World& world, const FrameNames& names, const taut_frame& frame, JointEnd& end) {
    end.anchor = to_vec(frame.position);
    end.frame = to_quat(frame.rotation);
    if (end.node == kNone) return check;
    if (is_point(world, end.node)) {
        return check.zero(names.position,
                          {static_cast<float>(end.anchor.x()), static_cast<float>(end.anchor.y()),
                           static_cast<float>(end.anchor.z())},
                          "on a particle");
    }
    end.anchor -= world.nodes.mass[end.node].centre;
    return check.vector(names.position, frame.position, kShapeCoordinate);
}

Check& place_guides(Check& check, const World& world, uint32_t housing, const taut_frame& frame_a,
                    const taut_frame& frame_b, JointEnd (&guides)[2]) {
    guides[0].node = guides[1].node = housing;
    place_end(check, world, kFrameNames[0], frame_a, guides[0]);
    return place_end(check, world, kFrameNames[1], frame_b, guides[1]);
}

void write_ends(Joint& joint, const JointKind& kind, const JointEnd& a, const JointEnd& b) {
    if (kind.framed && !kind.housed) return write_data(joint, JointFrames{a.anchor, b.anchor, a.frame, b.frame});
    write_data(joint, JointAnchors{a.anchor, b.anchor});
    if (!kind.framed) return;
    GearData data = read_data<GearData>(joint);
    data.frame[0] = a.frame;
    data.frame[1] = b.frame;
    write_data(joint, data);
}

void write_housing(Joint& joint, const JointKind& kind, const JointEnd& a, const JointEnd& b) {
    HousedAnchors anchors = read_data<HousedAnchors>(joint);
    anchors.guide_a = a.anchor;
    anchors.apart = b.anchor - a.anchor;
    write_data(joint, anchors);
    if (!kind.framed) return;
    GearData data = read_data<GearData>(joint);
    data.housing_frame[0] = a.frame;
    data.housing_frame[1] = b.frame;
    write_data(joint, data);
}

namespace {

taut_frame placed_on(const World& world, uint32_t node, Vec3 anchor, const Quat& rotation) {
    if (node != kNone) anchor += world.nodes.mass[node].centre;
    return {to_pos(anchor), to_quat(rotation)};
}

}  // namespace

taut_frame frame_of(const World& world, const Joint& joint, int end) {
    const JointKind& kind = kind_of(joint);
    Quat rotation = Quat::Identity();
    if (kind.framed && kind.housed)
        rotation = read_data<GearData>(joint).frame[end];
    else if (kind.framed)
        rotation = end == 0 ? read_data<JointFrames>(joint).frame_a : read_data<JointFrames>(joint).frame_b;
    return placed_on(world, joint.node[end], anchor_of(joint, end), rotation);
}

taut_frame housing_frame_of(const World& world, const Joint& joint, int side) {
    const bool framed = kind_of(joint).framed;
    return placed_on(world, joint.node[2], read_data<HousedAnchors>(joint).guide(side),
                     framed ? read_data<GearData>(joint).housing_frame[side] : Quat::Identity());
}

double length_of(const Joint& joint) {
    return joint.type == &kPulley ? read_data<PulleyData>(joint).length : read_data<DistanceData>(joint).length;
}

void set_length(Joint& joint, double length) {
    const auto put = [&](auto data) {
        data.length = length;
        write_data(joint, data);
    };
    joint.type == &kPulley ? put(read_data<PulleyData>(joint)) : put(read_data<DistanceData>(joint));
}

Check& check_distance(Check& check, const World& world, const Joint& joint) {
    const double distance = (world_anchor(world.nodes, joint, 1) - world_anchor(world.nodes, joint, 0)).norm();
    return check.number("distance between the anchors", distance, kJointLength);
}

void replace_joint(const Nodes& nodes, Joint& joint, const Joint& changed) {
    const JointReading before = read_joint(nodes, joint), after = read_joint(nodes, changed);
    joint = changed;
    if (joint.fresh) return;
    for (int row = 0; row < joint.type->rows; ++row) {
        const double change = after.value[row] - before.value[row];
        joint.drift[row] += is_angle(joint, row) ? std::remainder(change, 2 * kPi) : change;
    }
}

// ---------------------------------------------------------------- axes

taut_result find_axis(const char* call, const Joint& joint, uint32_t axis, JointAxis& out) {
    const JointKind& kind = kind_of(joint);
    if (axis >= kind.axes.size()) {
        return refuse(TAUT_INVALID_ARGUMENT, "%s: axis is %u, but a %s joint has %zu", call, axis, kind.type->name,
                      kind.axes.size());
    }
    out = kind.axes[axis];
    return TAUT_OK;
}

Check& check_drive(Check& check, const taut_drive& drive, bool angular) {
    check.number("drive.target", drive.target, angular ? kJointAngle : kJointPosition)
        .number("drive.speed", drive.speed, kSpeed)
        .number("drive.stiffness", drive.stiffness, kJointForce)
        .number_or("drive.damping", drive.damping, kJointForce, INFINITY)
        .zero_or("drive.frequency", drive.frequency, kFrequency)
        .number("drive.damping_ratio", drive.damping_ratio, kDampingRatio)
        .number_or("drive.max_force", drive.max_force, kJointForce, INFINITY)
        .require(drive.frequency == 0 || (drive.stiffness == 0 && drive.damping == 0),
                 "drive.frequency stands beside drive.stiffness or drive.damping, expected one way of the two");
    return check.require(drive.damping != INFINITY || drive.stiffness == 0,
                         "drive.damping is infinite, which takes no drive.stiffness");
}

namespace {

bool drives(const taut_drive& drive) {
    return drive.max_force > 0 && (drive.stiffness > 0 || drive.damping > 0 || drive.frequency > 0);
}

Check& check_stops(Check& check, const taut_axis_def& def, bool angular) {
    const Range range = angular ? kJointAngle : kJointPosition;
    check.number_or("lower", def.lower, range, -INFINITY).number_or("upper", def.upper, range, INFINITY);
    check.require(!(def.lower > def.upper), "lower is above upper");
    return check.require(!angular || std::isinf(def.upper - def.lower) || def.upper - def.lower <= kJointAngle.hi,
                         "lower and upper are more than 2 pi apart");
}

}  // namespace

Check& check_axis(Check& check, const JointKind& kind, const JointAxis& place, const taut_axis_def& def) {
    const bool angular = kind.type->angular >> place.row & 1;
    check.nested(def.struct_size, sizeof def).choice("mode", def.mode, TAUT_AXIS_LIMITED);
    if (check && def.mode == TAUT_AXIS_LIMITED) {
        if (place.swing)
            check.number_or("upper", def.upper, kSwing, INFINITY);
        else
            check_stops(check, def, angular);
    }
    check.number("stop_compliance", def.stop_compliance, kCompliance)
        .number("stop_damping", def.stop_damping, kDamping)
        .number("friction", def.friction, kJointForce);
    check_drive(check, def.drive, angular);
    if (!check) return check;
    if (place.swing) {
        check.require(def.mode != TAUT_AXIS_LOCKED, "mode is locked, expected free or limited for a swing")
            .require(!drives(def.drive) || is_swing(def.drive.target), "drive.target is no swing, expected [0, pi]");
    }
    return check.require(def.mode != TAUT_AXIS_LOCKED || (!drives(def.drive) && def.friction == 0),
                         "mode is locked, which takes no drive and no friction");
}

Spring spring_of(double frequency, double damping_ratio, double inverse_mass) {
    const double omega = 2 * kPi * frequency, mass = 1 / inverse_mass;
    return {mass * omega * omega, 2 * damping_ratio * mass * omega};
}

void set_drive(Axis& axis, const taut_drive& drive, double inverse_mass) {
    if (!drives(drive)) return;
    Spring spring{drive.stiffness, drive.damping};
    if (drive.frequency > 0) spring = spring_of(drive.frequency, drive.damping_ratio, inverse_mass);
    axis.stiffness = static_cast<float>(spring.stiffness);
    axis.damping = static_cast<float>(spring.damping);
    axis.target = drive.target;
    axis.speed = drive.speed;
    axis.max_force = drive.max_force;
}

Axis make_axis(const JointAxis& place, const taut_axis_def& def, double inverse_mass) {
    Axis axis;
    if (def.mode == TAUT_AXIS_LOCKED) return axis;
    axis.mode = AxisMode::free;
    if (def.mode == TAUT_AXIS_LIMITED) {
        axis.mode = AxisMode::limited;
        axis.lower = place.swing ? -INFINITY : def.lower;
        axis.upper = def.upper;
        axis.limit_compliance = def.stop_compliance;
        axis.limit_damping = def.stop_damping;
    }
    set_drive(axis, def.drive, inverse_mass);
    axis.friction = def.friction;
    return axis;
}

namespace {

void change_row(Joint& joint, int row, const Axis& axis) {
    Axis& now = joint.axis[row];
    AxisMemory& memory = joint.memory[row];
    if (now.mode != axis.mode || now.lower != axis.lower || now.upper != axis.upper) {
        memory = {};
        joint.lambda[row] = 0;
    }
    if (!has_drive(axis)) memory.drive = 0;
    if (axis.friction == 0) memory.friction = 0;
    now = axis;
}

}  // namespace

void change_axis(Joint& joint, const JointAxis& place, const Axis& axis) {
    change_row(joint, place.row, axis);
    if (place.around >= 0) {
        Axis around;
        around.mode = AxisMode::free;
        around.friction = axis.friction;
        around.damping = axis.damping;
        around.max_force = axis.max_force;
        around.around = true;
        change_row(joint, place.around, around);
    }
    joint.plain = true;
    for (int r = 0; r < joint.type->rows; ++r) joint.plain = joint.plain && is_locked(joint, r);
}

}  // namespace taut
