// Double precision vectors of the bench.
#pragma once

#include <taut/math.h>

#include <cmath>

namespace bench {

struct Vec {
    double x = 0, y = 0, z = 0;
};

inline Vec of(taut_pos p) { return {p.x, p.y, p.z}; }
inline Vec of(taut_vec3 v) { return {v.x, v.y, v.z}; }
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }

// Rotates by a quaternion that is a unit one up to single precision.
inline Vec rotate(taut_quat q, Vec v) {
    Vec u = {q.x, q.y, q.z};
    double w = q.w, norm = dot(u, u) + w * w;
    return v + cross(u, cross(u, v) + v * w) * (2 / norm);
}
inline Vec rotate_back(taut_quat q, Vec v) { return rotate({-q.x, -q.y, -q.z, q.w}, v); }

}  // namespace bench
