// Defs of joints, and joints made from them.
#include <algorithm>
#include <array>
#include <cmath>

#include "api/joint_make.h"

using namespace taut;

namespace {

// ---------------------------------------------------------------- what the defs have in common

// The axes of each def by index, null after the last, with their names; null defs are never asked.
struct NamedAxis {
    const taut_axis_def* def = nullptr;
    const char* scope = "";  // in texts
};
using NamedAxes = std::array<NamedAxis, kMaxRows>;

NamedAxes axes_of(const taut_ball_joint_def&) { return {}; }
NamedAxes axes_of(const taut_distance_joint_def&) { return {}; }  // of its own fields
NamedAxes axes_of(const taut_fixed_joint_def&) { return {}; }
NamedAxes axes_of(const taut_hinge_joint_def& def) { return {{{&def.angle, "angle."}}}; }
NamedAxes axes_of(const taut_slider_joint_def& def) { return {{{&def.slide, "slide."}}}; }
NamedAxes axes_of(const taut_cylindrical_joint_def& def) { return {{{&def.slide, "slide."}, {&def.angle, "angle."}}}; }
NamedAxes axes_of(const taut_universal_joint_def& def) {
    return {{{&def.angle_a, "angle_a."}, {&def.angle_b, "angle_b."}}};
}
NamedAxes axes_of(const taut_cone_twist_joint_def& def) { return {{{&def.swing, "swing."}, {&def.twist, "twist."}}}; }
NamedAxes axes_of(const taut_six_dof_joint_def& def) {
    return {{{&def.axes[0], "axes[0]."},
             {&def.axes[1], "axes[1]."},
             {&def.axes[2], "axes[2]."},
             {&def.axes[3], "axes[3]."},
             {&def.axes[4], "axes[4]."},
             {&def.axes[5], "axes[5]."}}};
}

NamedAxes axes_of(const taut_wheel_joint_def& def) {
    return {{{&def.suspension, "suspension."}, {&def.steering, "steering."}, {&def.spin, "spin."}}};
}

void init_axis(taut_axis_def& def, taut_axis_mode mode) {
    def = {};
    def.struct_size = sizeof def;
    def.mode = mode;
    def.lower = -INFINITY;
    def.upper = INFINITY;
    taut_drive_init(&def.drive);
}

template <class Def>
void init_joint(Def& def, taut_axis_mode mode = TAUT_AXIS_FREE) {
    def.struct_size = sizeof def;
    taut_joint_base_init(&def.base);
    for (const NamedAxis& axis : axes_of(def))
        if (axis.def) init_axis(const_cast<taut_axis_def&>(*axis.def), mode);
}

// ---------------------------------------------------------------- check

void check_axes(Check& check, const JointKind& kind, const NamedAxes& axes) {
    for (size_t i = 0; i < kind.axes.size(); ++i) {
        check.within(axes[i].scope);
        check_axis(check, kind, kind.axes[i], *axes[i].def).within("");
    }
}

void check_range(Check& check, const taut_distance_joint_def& def) {
    const bool ranged = def.min_length > 0 || def.max_length > 0;
    check.zero_or("length", def.length, kJointLength).zero_or("min_length", def.min_length, kJointLength);
    if (def.max_length != INFINITY) check.zero_or("max_length", def.max_length, kJointLength);
    check.require(def.max_length == 0 || def.min_length <= def.max_length, "min_length is above max_length");
    check.zero_or("frequency", def.frequency, kFrequency)
        .number("damping_ratio", def.damping_ratio, kDampingRatio)
        .require(def.frequency == 0 || (def.base.compliance == 0 && def.base.damping == 0),
                 "frequency stands beside base.compliance or base.damping, expected one way of the two");
    check_drive(check, def.drive, false).number("friction", def.friction, kJointForce);
    const bool acts = def.drive.stiffness > 0 || def.drive.damping > 0 || def.drive.frequency > 0 || def.friction > 0;
    check.require(ranged || !acts, "drive or friction on a rod: min_length and max_length are 0");
}

// ---------------------------------------------------------------- act

void set_axes(const World& world, const JointKind& kind, const NamedAxes& axes, Joint& joint) {
    if (kind.axes.empty()) return;
    const JointReading reading = read_joint(world.nodes, joint);
    for (size_t i = 0; i < kind.axes.size(); ++i)  // which rows are locked decides about the masses of the others
        change_axis(joint, kind.axes[i], make_axis(kind.axes[i], *axes[i].def, 1));
    for (size_t i = 0; i < kind.axes.size(); ++i) {
        const JointAxis& place = kind.axes[i];
        const double inverse_mass = held_inverse_mass_of(world.nodes, joint, reading, place.row);
        change_axis(joint, place, make_axis(place, *axes[i].def, inverse_mass));
    }
}

// A kind that has axes at most.
template <class Def>
taut_result add(const char* call, taut_world handle, taut_joint_kind which, const Def* given, void (*init)(Def*),
                taut_joint* out) {
    return add_by_def(
        call, handle, which, given, init, out,
        [](Check& check, const JointKind& kind, const Def& def) { check_axes(check, kind, axes_of(def)); },
        [](Check&, const World& world, const JointKind& kind, const Def& def, Joint& joint) {
            set_axes(world, kind, axes_of(def), joint);
        });
}

// The length that counts as 0 of a distance joint's coordinate.
double zero_length(const taut_distance_joint_def& def, double distance) {
    if (def.length > 0) return def.length;
    if (def.max_length > 0 && std::isfinite(def.max_length)) return def.max_length;
    return def.min_length > 0 ? def.min_length : distance;
}

// Rod or range, with length and spring.
void set_distance(Check& check, const World& world, const taut_distance_joint_def& def, Joint& joint) {
    if (!check_distance(check, world, joint)) return;
    DistanceData data = read_data<DistanceData>(joint);
    const double distance = (world_anchor(world.nodes, joint, 1) - world_anchor(world.nodes, joint, 0)).norm();
    data.length = zero_length(def, distance);
    write_data(joint, data);
    const double inverse_mass = inverse_mass_of(world.nodes, joint, read_joint(world.nodes, joint), 0);
    if (def.frequency > 0) {
        const Spring spring = spring_of(def.frequency, def.damping_ratio, inverse_mass);
        joint.compliance = 1 / spring.stiffness;
        joint.damping = spring.damping;
        check.number("frequency gives a compliance that", joint.compliance, kCompliance);
        check.number("frequency gives a damping that", joint.damping, kDamping);
    }
    if (!(def.min_length > 0 || def.max_length > 0)) return;
    Axis axis;
    const float length = static_cast<float>(data.length);
    axis.lower = def.min_length > 0 ? def.min_length - length : -INFINITY;
    axis.upper = def.max_length > 0 ? def.max_length - length : INFINITY;
    axis.mode = AxisMode::limited;
    axis.limit_compliance = static_cast<float>(joint.compliance);
    axis.limit_damping = static_cast<float>(joint.damping);
    set_drive(axis, def.drive, inverse_mass);
    axis.friction = def.friction;
    change_axis(joint, {0}, axis);
}

// The world axis most square to a direction.
Vec3 square_axis(const Vec3& x) {
    Eigen::Index least;
    x.cwiseAbs().minCoeff(&least);
    return Vec3::Unit(least);
}

taut_frame frame_on(const World& world, uint32_t node, const Vec3& pivot, const Quat& rotation) {
    if (node == kNone) return {to_pos(pivot), to_quat(rotation)};
    const bool turns = world.nodes.info[node].kind != NodeKind::particle;
    const Quat body = turns ? world.nodes.motion[node].q.conjugate() : Quat::Identity();
    return {to_pos(body * (pivot - world.nodes.origin(node))), to_quat((body * rotation).normalized())};
}

// The frames of x, a unit vector, and of y made square to it.
taut_result frames_from_axes(const Check& check, taut_world handle, taut_body body_a, taut_body body_b, taut_pos pivot,
                             const Vec3& x, const Vec3& y, taut_frame* frame_a, taut_frame* frame_b) {
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        uint32_t a = kNone, b = kNone;
        taut_result found = TAUT_OK;
        if (body_a.bits != 0) found = find_body(check.call(), "body_a", world, body_a, a);
        if (found == TAUT_OK && body_b.bits != 0) found = find_body(check.call(), "body_b", world, body_b, b);
        if (found != TAUT_OK) return found;
        Mat3 axes;
        axes.col(0) = x;
        axes.col(2) = x.cross(y).normalized();
        axes.col(1) = axes.col(2).cross(x);
        const Quat rotation(axes);
        *frame_a = frame_on(world, a, to_vec(pivot), rotation);
        *frame_b = frame_on(world, b, to_vec(pivot), rotation);
        return TAUT_OK;
    });
}

}  // namespace

void taut_axis_def_init_sized(taut_axis_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_axis_def& own) { init_axis(own, TAUT_AXIS_FREE); });
}
void taut_ball_joint_def_init_sized(taut_ball_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_ball_joint_def& own) { init_joint(own); });
}
void taut_distance_joint_def_init_sized(taut_distance_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_distance_joint_def& own) {
        init_joint(own);
        own.damping_ratio = 1;
        taut_drive_init(&own.drive);
    });
}
void taut_fixed_joint_def_init_sized(taut_fixed_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_fixed_joint_def& own) { init_joint(own); });
}
void taut_hinge_joint_def_init_sized(taut_hinge_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_hinge_joint_def& own) { init_joint(own); });
}
void taut_slider_joint_def_init_sized(taut_slider_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_slider_joint_def& own) { init_joint(own); });
}
void taut_cylindrical_joint_def_init_sized(taut_cylindrical_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cylindrical_joint_def& own) { init_joint(own); });
}
void taut_universal_joint_def_init_sized(taut_universal_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_universal_joint_def& own) { init_joint(own); });
}
void taut_cone_twist_joint_def_init_sized(taut_cone_twist_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cone_twist_joint_def& own) { init_joint(own); });
}
void taut_wheel_joint_def_init_sized(taut_wheel_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_wheel_joint_def& own) {
        init_joint(own);
        own.suspension.mode = own.steering.mode = TAUT_AXIS_LOCKED;
    });
}
void taut_six_dof_joint_def_init_sized(taut_six_dof_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_six_dof_joint_def& own) { init_joint(own, TAUT_AXIS_LOCKED); });
}

taut_result taut_world_add_ball_joint(taut_world world, const taut_ball_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_ball_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_BALL, def, taut_ball_joint_def_init, out);
}
taut_result taut_world_add_fixed_joint(taut_world world, const taut_fixed_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_fixed_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_FIXED, def, taut_fixed_joint_def_init, out);
}
taut_result taut_world_add_hinge_joint(taut_world world, const taut_hinge_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_hinge_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_HINGE, def, taut_hinge_joint_def_init, out);
}
taut_result taut_world_add_slider_joint(taut_world world, const taut_slider_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_slider_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_SLIDER, def, taut_slider_joint_def_init, out);
}
taut_result taut_world_add_cylindrical_joint(taut_world world, const taut_cylindrical_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_cylindrical_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_CYLINDRICAL, def, taut_cylindrical_joint_def_init, out);
}
taut_result taut_world_add_universal_joint(taut_world world, const taut_universal_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_universal_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_UNIVERSAL, def, taut_universal_joint_def_init, out);
}
taut_result taut_world_add_cone_twist_joint(taut_world world, const taut_cone_twist_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_cone_twist_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_CONE_TWIST, def, taut_cone_twist_joint_def_init, out);
}
taut_result taut_world_add_six_dof_joint(taut_world world, const taut_six_dof_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_six_dof_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_SIX_DOF, def, taut_six_dof_joint_def_init, out);
}
taut_result taut_world_add_wheel_joint(taut_world world, const taut_wheel_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_wheel_joint, world, def, out);
    return add(__func__, world, TAUT_JOINT_WHEEL, def, taut_wheel_joint_def_init, out);
}

taut_result taut_world_add_distance_joint(taut_world world, const taut_distance_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_distance_joint, world, def, out);
    return add_by_def(
        __func__, world, TAUT_JOINT_DISTANCE, def, taut_distance_joint_def_init, out,
        [](Check& check, const JointKind&, const taut_distance_joint_def& own) { check_range(check, own); },
        [](Check& check, const World& held, const JointKind&, const taut_distance_joint_def& own, Joint& joint) {
            set_distance(check, held, own, joint);
        });
}

taut_result taut_joint_frames_from_world(taut_world world, taut_body body_a, taut_body body_b, taut_pos pivot,
                                         taut_vec3 axis, taut_frame* frame_a, taut_frame* frame_b) {
    Check check(__func__);
    if (!check.pointer("frame_a", frame_a).pointer("frame_b", frame_b)) return check.result();
    check.bounded("pivot", pivot, kPosition).vector("axis", axis, kDirection);
    const double length = to_vec(axis).norm();
    if (!check.require(!check || length > 0, "axis is 0")) return check.result();
    const Vec3 x = to_vec(axis) / length;
    return frames_from_axes(check, world, body_a, body_b, pivot, x, square_axis(x), frame_a, frame_b);
}

taut_result taut_joint_frames_from_two_axes(taut_world world, taut_body body_a, taut_body body_b, taut_pos pivot,
                                            taut_vec3 axis_x, taut_vec3 axis_y, taut_frame* frame_a,
                                            taut_frame* frame_b) {
    constexpr double kLeastAngle = 1e-3;  // between them [rad]: y comes out within 1e-4 of it in floats
    Check check(__func__);
    if (!check.pointer("frame_a", frame_a).pointer("frame_b", frame_b)) return check.result();
    check.bounded("pivot", pivot, kPosition).vector("axis_x", axis_x, kDirection).vector("axis_y", axis_y, kDirection);
    const double length_x = to_vec(axis_x).norm(), length_y = to_vec(axis_y).norm();
    check.require(!check || length_x > 0, "axis_x is 0").require(!check || length_y > 0, "axis_y is 0");
    if (!check) return check.result();
    const Vec3 x = to_vec(axis_x) / length_x, y = to_vec(axis_y) / length_y;
    if (!check.require(x.cross(y).norm() >= kLeastAngle, "axis_x and axis_y are parallel")) return check.result();
    return frames_from_axes(check, world, body_a, body_b, pivot, x, y, frame_a, frame_b);
}
