// Joints between frames, made and read through the public C API.
#pragma once

#include "physics/lab.h"

namespace lab {

constexpr double kDegree = kPi / 180;

inline taut_axis_def free_axis() {
    taut_axis_def axis;
    taut_axis_def_init(&axis);
    return axis;
}

inline taut_axis_def limited(double lower, double upper) {
    taut_axis_def axis = free_axis();
    axis.mode = TAUT_AXIS_LIMITED;
    axis.lower = static_cast<float>(lower);
    axis.upper = static_cast<float>(upper);
    return axis;
}

inline taut_axis_def motor(double speed, double max_force) {
    taut_axis_def axis = free_axis();
    axis.drive.speed = static_cast<float>(speed);
    axis.drive.damping = INFINITY;
    axis.drive.max_force = static_cast<float>(max_force);
    return axis;
}

inline taut_axis_def with_friction(double force) {
    taut_axis_def axis = free_axis();
    axis.friction = static_cast<float>(force);
    return axis;
}

// Both frames of a joint at a point and along an axis of the world.
template <class Def>
Def at(const World& world, void (*init)(Def*), taut_body a, taut_body b, const Vec& pivot, const Vec& axis) {
    Def def;
    init(&def);
    def.base.body_a = a;
    def.base.body_b = b;
    ok(taut_joint_frames_from_world(world.handle, a, b, pivot.pos(), axis.narrow(), &def.base.frame_a,
                                    &def.base.frame_b));
    return def;
}

inline taut_joint hinge(const World& world, taut_body a, taut_body b, const Vec& pivot, const Vec& axis,
                        const taut_axis_def& angle = free_axis()) {
    auto def = at(world, taut_hinge_joint_def_init, a, b, pivot, axis);
    def.angle = angle;
    taut_joint out{};
    ok(taut_world_add_hinge_joint(world.handle, &def, &out));
    return out;
}

inline taut_joint slider(const World& world, taut_body a, taut_body b, const Vec& pivot, const Vec& axis,
                         const taut_axis_def& slide = free_axis()) {
    auto def = at(world, taut_slider_joint_def_init, a, b, pivot, axis);
    def.slide = slide;
    taut_joint out{};
    ok(taut_world_add_slider_joint(world.handle, &def, &out));
    return out;
}

struct Motion {
    double value, rate;
};

inline Motion motion(taut_joint joint, uint32_t axis = 0) {
    float value = 0, rate = 0;
    ok(taut_joint_get_coordinates(joint, axis, &value, &rate));
    return {static_cast<double>(value), static_cast<double>(rate)};
}

inline taut_axis_forces forces(taut_joint joint, uint32_t axis = 0) {
    taut_axis_forces out;
    ok(taut_joint_get_axis_forces(joint, axis, &out));
    return out;
}

inline double error(taut_joint joint) {
    float out = 0;
    ok(taut_joint_get_error(joint, &out));
    return static_cast<double>(out);
}

inline double angular_error(taut_joint joint) {
    float out = 0;
    ok(taut_joint_get_angular_error(joint, &out));
    return static_cast<double>(out);
}

inline World weightless() {
    return World([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
}

// A bar of 1 m along x with its left end in the origin.
constexpr double kBarMass = 2, kBarInertia = 0.2;
inline taut_body bar(const World& world) {
    return world.add({.position = {0.5, 0, 0}, .mass = kBarMass, .inertia = {0.05, kBarInertia, kBarInertia}});
}
constexpr double kAboutEnd = kBarInertia + kBarMass * 0.25;  // its inertia about the left end

}  // namespace lab
