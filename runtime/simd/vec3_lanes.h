// Vectors in lanes, for kernels that are templates over these (lanes.h).
#pragma once

namespace taut {

template <class F>
struct Vec3Lanes {
    F x, y, z;
    friend Vec3Lanes operator+(const Vec3Lanes& a, const Vec3Lanes& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3Lanes operator-(const Vec3Lanes& a, const Vec3Lanes& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3Lanes operator*(const F& s, const Vec3Lanes& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend F dot(const Vec3Lanes& a, const Vec3Lanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Vec3Lanes cross(const Vec3Lanes& a, const Vec3Lanes& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    // a > b ? yes : no
    friend Vec3Lanes if_greater(const F& a, const F& b, const Vec3Lanes& yes, const Vec3Lanes& no) {
        return {F::if_greater(a, b, yes.x, no.x), F::if_greater(a, b, yes.y, no.y), F::if_greater(a, b, yes.z, no.z)};
    }
    // From and to lanes of x, y and z that follow each other.
    template <class Number>
    static Vec3Lanes load(const Number* p) {
        return {F::load(p), F::load(p + F::kWidth), F::load(p + 2 * F::kWidth)};
    }
    template <class Number>
    void store(Number* p) const {
        x.store(p);
        y.store(p + F::kWidth);
        z.store(p + 2 * F::kWidth);
    }
};

}  // namespace taut
