// Distance of two convex cores by the algorithm of Gilbert, Johnson and Keerthi (1988), in a's frame.
#pragma once

#include "collision/narrowphase/convex.h"
#include "collision/narrowphase/kernel.h"

namespace taut::collision {

// A point of the difference set {q - p : p in a's core, q in b's core} and the p it came from.
struct DifferencePoint {
    Vec3 at, on_a;
};

// The difference of two cores. A unit vector n from a to b separates them by the least n . at over the set.
class Difference {
public:
    // shrink: how much smaller the cores are made, in parts of each shape's inner radius.
    explicit Difference(const Pair& pair, double shrink = 0);

    DifferencePoint lowest(const Vec3& n) const;
    // Of the cores along n [m]; of the shapes, less radii().
    double separation(const Vec3& n) const { return n.dot(lowest(n).at); }
    double radii() const { return radius_a_ + radius_b_; }

private:
    const Shape& a_;
    const Shape& b_;
    Mat3 rotation_;
    Vec3 position_;
    double radius_a_, radius_b_;
    double inset_a_, inset_b_;
};

struct Distance {
    bool apart = false;          // else the cores overlap
    Vec3 normal = Vec3::Zero();  // unit, from a to b; of overlapping cores, the best that was tried
    double separation = 0;       // along normal, at least [m]
    Vec3 on_a = Vec3::Zero();    // a's nearest point, where the cores are apart
};

// Cores nearer than this part of their extent overlap: what is left has no direction.
constexpr double kTouchingCores = 1e-10;

// b is moved by shift. Starts from the unit vector n; ends when the distance found exceeds the separation proven by
// less than gap of it: the normal is off by at most sqrt(2 gap).
Distance gjk(const Difference& difference, const Vec3& shift, const Vec3& n, double gap);

}  // namespace taut::collision
