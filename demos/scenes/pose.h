// Rotations and points of bodies, as scenes are laid out with them.
#pragma once

#include <cmath>

#include "random.h"
#include "scene.h"

namespace scenes {

inline taut_pos plus(taut_pos p, double dx, double dy, double dz) { return {p.x + dx, p.y + dy, p.z + dz}; }
// A place up to `far` from another along x and z and `up` along y [m], by chance. In double precision all along: g++ 12
// leaves out roundings to float on the way where it works on two numbers at once.
inline taut_pos scattered(taut_pos at, double far, double up, Random& random) {
    const double x = far * random.around_zero(), y = up * random.around_zero(), z = far * random.around_zero();
    return plus(at, x, y, z);
}
inline taut_pos minus(taut_pos a, taut_pos b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline taut_pos middle(taut_pos a, taut_pos b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2}; }
inline double length(taut_pos v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
inline taut_pos toward(taut_pos a, taut_pos b, double distance) {  // from a
    const double s = distance / length(minus(b, a));
    return plus(a, s * (b.x - a.x), s * (b.y - a.y), s * (b.z - a.z));
}

inline taut_quat times(taut_quat a, taut_quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

inline taut_quat inverse(taut_quat q) { return {-q.x, -q.y, -q.z, q.w}; }

inline taut_pos rotated(taut_quat q, taut_pos v) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const taut_pos t = {2 * (y * v.z - z * v.y), 2 * (z * v.x - x * v.z), 2 * (x * v.y - y * v.x)};
    return {v.x + w * t.x + y * t.z - z * t.y, v.y + w * t.y + z * t.x - x * t.z, v.z + w * t.z + x * t.y - y * t.x};
}

// The shortest rotation from one direction to another; about z where they are opposite.
inline taut_quat turn_from_to(taut_pos from, taut_pos to) {
    const double a = length(from), b = length(to), w = 1 + (from.x * to.x + from.y * to.y + from.z * to.z) / (a * b);
    if (w < 1e-6) return {0, 0, 1, 0};
    const double x = (from.y * to.z - from.z * to.y) / (a * b), y = (from.z * to.x - from.x * to.z) / (a * b),
                 z = (from.x * to.y - from.y * to.x) / (a * b), s = 1 / std::sqrt(x * x + y * y + z * z + w * w);
    return {static_cast<float>(x * s), static_cast<float>(y * s), static_cast<float>(z * s), static_cast<float>(w * s)};
}

// A world point and rotation in the frame of a body at its start; unchanged for kWorld.
inline taut_pos in_body(const Scene& scene, int body, taut_pos point) {
    if (body == kWorld) return point;
    const Body& b = scene.bodies[static_cast<size_t>(body)];
    return rotated(inverse(b.rotation), minus(point, b.position));
}

inline taut_quat in_body(const Scene& scene, int body, taut_quat rotation) {
    if (body == kWorld) return rotation;
    return times(inverse(scene.bodies[static_cast<size_t>(body)].rotation), rotation);
}

}  // namespace scenes
