// The points that lie beyond all of some planes, and the nearest one of them: what is left of a way or a velocity
// beside walls, exactly, so that nothing trembles in corners.
#pragma once

#include <array>

#include "base/math.h"

namespace taut {

class HalfSpaces {
public:
    static constexpr size_t kMost = 12;

    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    size_t size() const { return count_; }
    // normal . x >= least. What more is than there is room for stops everything.
    void add(const Vec3& normal, double least = 0);
    // The point of all that is nearest to x; false: there is none, or too many planes.
    bool nearest(const Vec3& x, Vec3& out) const;
    // The point that lies least far short of them, in the sense of least squares, and near 0.
    Vec3 compromise() const;

private:
    bool holds(const Vec3& x, double tolerance) const;

    struct Plane {
        Vec3 normal;
        double least;
    };
    std::array<Plane, kMost> plane_;
    size_t count_ = 0;
    bool full_ = false;
};

}  // namespace taut
