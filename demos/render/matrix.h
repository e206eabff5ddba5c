// Vectors and matrices of the renderer: single precision, column-major, right-handed, y up.
#pragma once

#include <array>
#include <cmath>

namespace render {

struct Vec3 {
    float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalised(Vec3 a) { return a * (1.0f / std::fmax(length(a), 1e-20f)); }
inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a * (1.0f - t) + b * t; }

// Rotation x i + y j + z k + w.
struct Quat {
    float x = 0, y = 0, z = 0, w = 1;
};

inline Vec3 rotate(Quat q, Vec3 v) {
    Vec3 u = {q.x, q.y, q.z};
    return v + cross(u, cross(u, v) + v * q.w) * 2.0f;
}

// Shortest rotation that brings +y to a unit direction.
inline Quat from_y_to(Vec3 direction) {
    if (direction.y < -0.99999f) return {1, 0, 0, 0};
    float w = 1.0f + direction.y;
    float s = 1.0f / std::sqrt(w * w + direction.x * direction.x + direction.z * direction.z);
    return {direction.z * s, 0, -direction.x * s, w * s};
}

struct Mat4 {
    std::array<float, 16> m{};  // m[4 * column + row]
};

inline Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 r;
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 4; ++k) r.m[4 * c + i] += a.m[4 * k + i] * b.m[4 * c + k];
    return r;
}

inline Mat4 perspective(float vertical_fov, float aspect, float near, float far) {
    float t = 1.0f / std::tan(0.5f * vertical_fov);
    Mat4 r;
    r.m = {t / aspect, 0, 0, 0, 0, t, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far),
           0};
    return r;
}

// Maps the box low..high of view space (z towards the viewer) to clip space.
inline Mat4 orthographic(Vec3 low, Vec3 high) {
    Vec3 s = {2 / (high.x - low.x), 2 / (high.y - low.y), 2 / (high.z - low.z)};
    Mat4 r;
    r.m = {s.x,
           0,
           0,
           0,
           0,
           s.y,
           0,
           0,
           0,
           0,
           -s.z,
           0,
           -(high.x + low.x) / (high.x - low.x),
           -(high.y + low.y) / (high.y - low.y),
           (high.z + low.z) / (high.z - low.z),
           1};
    return r;
}

// Axes of a viewer: right, up and backwards.
struct ViewAxes {
    Vec3 right, up, back;
};

inline ViewAxes view_axes(Vec3 forward) {
    Vec3 reference = std::fabs(forward.y) > 0.999f ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
    Vec3 right = normalised(cross(forward, reference));
    return {right, cross(right, forward), forward * -1.0f};
}

inline Mat4 view_matrix(Vec3 eye, const ViewAxes& a) {
    Mat4 r;
    r.m = {a.right.x, a.up.x, a.back.x, 0, a.right.y,          a.up.y,          a.back.y,          0,
           a.right.z, a.up.z, a.back.z, 0, -dot(a.right, eye), -dot(a.up, eye), -dot(a.back, eye), 1};
    return r;
}

}  // namespace render
