// What triangles enclose, as a mass.
#pragma once

#include "collision/collide.h"

namespace taut::collision {

// Sum over tetrahedra from a point p to the surface's triangles (a, b, c), relative to p:
// V = a . (b x c) / 6;  integral of x = V (a + b + c) / 4;
// integral of x x^T = V / 20 (a a^T + b b^T + c c^T + s s^T), s = a + b + c.
class PolyhedronMass {
public:
    explicit PolyhedronMass(const Vec3& from) : from_(from) {}

    void add(const Vec3& pa, const Vec3& pb, const Vec3& pc) {
        const Vec3 a = pa - from_, b = pb - from_, c = pc - from_;
        const Vec3 s = a + b + c;
        const double v = a.dot(b.cross(c)) / 6;
        volume_ += v;
        first_ += v / 4 * s;
        second_ += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
    double volume() const { return volume_; }  // [m^3], negative where the triangles look inward
    // For a density that has the sign of the volume.
    MassProperties properties(double density) const {
        const Vec3 centre = first_ / volume_;
        const Mat3 second = second_ - volume_ * centre * centre.transpose();
        MassProperties out;
        out.mass = density * volume_;
        out.centre = from_ + centre;
        out.inertia = Sym3::of(density * (second.trace() * Mat3::Identity() - second));
        return out;
    }

private:
    Vec3 from_;
    double volume_ = 0;
    Vec3 first_ = Vec3::Zero();
    Mat3 second_ = Mat3::Zero();
};

}  // namespace taut::collision
