// What the calls that make joints and those that change them share: placing ends, checking and setting axes.
#pragma once

#include <limits>

#include "api/access.h"
#include "api/joint_kinds.h"
#include "constraints/distance.h"
#include "constraints/gear.h"
#include "constraints/joint_frames.h"
#include "constraints/pulley.h"
#include "sleep/wake.h"
#include "state/joint_data.h"
#include "state/joint_reading.h"

namespace taut {

// ---------------------------------------------------------------- ends

struct JointEnd {
    uint32_t node = kNone;
    Vec3 anchor = Vec3::Zero();  // as the joint's data wants it: relative to the centre of mass, or in the world
    Quat frame = Quat::Identity();
};

// What a def calls the places on its two ends, after what it calls where they are.
struct FrameNames {
    const char *position, *rotation;
};
constexpr FrameNames kFrameNames[2] = {{"frame_a.position", "frame_a.rotation"},
                                       {"frame_b.position", "frame_b.rotation"}};

inline bool is_point(const World& world, uint32_t node) {
    return node != kNone && world.nodes.info[node].kind == NodeKind::particle;
}

// Frames that the host gives, wherever they are to be.
Check& check_frames(Check& check, const taut_frame& frame_a, const taut_frame& frame_b);
// Places an end whose node is known on a checked frame.
Check& place_end(Check& check, const World& world, const FrameNames& names, const taut_frame& frame, JointEnd& end);
// Both places on a housing.
Check& place_guides(Check& check, const World& world, uint32_t housing, const taut_frame& frame_a,
                    const taut_frame& frame_b, JointEnd (&guides)[2]);
void write_ends(Joint& joint, const JointKind& kind, const JointEnd& a, const JointEnd& b);
// Where the housing guides a and b.
void write_housing(Joint& joint, const JointKind& kind, const JointEnd& a, const JointEnd& b);
// What place_end() placed, but for its node: in the end's frame, in the world's if that is null.
taut_frame frame_of(const World& world, const Joint& joint, int end);
taut_frame housing_frame_of(const World& world, const Joint& joint, int side);
// Whether its axis 0 counts from a length.
inline bool has_length(const Joint& joint) { return joint.type == &kDistance || joint.type == &kPulley; }
double length_of(const Joint& joint);
void set_length(Joint& joint, double length);
// Between points that are closer than a distance joint can be long there is no direction.
Check& check_distance(Check& check, const World& world, const Joint& joint);

// What a joint holds goes on in another way.
inline void wake_ends(World& world, const Joint& joint) {
    for (uint32_t node : joint.ends()) wake(world, node);
}

// Puts a changed joint in the place of the old one. What the change does to coordinates comes bit by bit over the next
// step, unless the joint was never solved: then it is where the host wants it.
void replace_joint(const Nodes& nodes, Joint& joint, const Joint& changed);

// ---------------------------------------------------------------- axes

// The axis of a joint, or a refusal.
taut_result find_axis(const char* call, const Joint& joint, uint32_t axis, JointAxis& out);
Check& check_drive(Check& check, const taut_drive& drive, bool angular);
// An angle that a swing can have: from 0 to half a turn.
inline bool is_swing(float angle) { return angle >= 0 && static_cast<double>(angle) <= kSwing.hi; }
Check& check_axis(Check& check, const JointKind& kind, const JointAxis& place, const taut_axis_def& def);

struct Spring {
    double stiffness, damping;  // [N/m], [N s/m]
};
// Of a frequency [Hz] on a mass of which the inverse is given.
Spring spring_of(double frequency, double damping_ratio, double inverse_mass);

void set_drive(Axis& axis, const taut_drive& drive, double inverse_mass);
// The axis that a checked def asks for. inverse_mass: of its row, see held_inverse_mass_of().
Axis make_axis(const JointAxis& place, const taut_axis_def& def, double inverse_mass);
// Changes an axis' rows and what they carry.
void change_axis(Joint& joint, const JointAxis& place, const Axis& axis);

// Of what a joint breaks at: 0 stands for never.
inline double or_never(float threshold) { return threshold == 0 ? std::numeric_limits<double>::infinity() : threshold; }

inline bool has_drive(const Axis& axis) { return axis.max_force > 0; }

}  // namespace taut
