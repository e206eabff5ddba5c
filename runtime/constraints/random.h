// Random samples for the tests that loop over the constraint types.
#pragma once

#include "constraints/constraint.h"

namespace taut {

class Random {
public:
    explicit Random(uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ull + 1) {}

    double unit() {  // [0, 1), splitmix64
        uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    Vec3 vector() {
        const double x = unit(), y = unit(), z = unit();
        return 2 * Vec3(x, y, z) - Vec3::Ones();
    }
    double between(double lower, double upper) { return lower + (upper - lower) * unit(); }
    Quat rotation() { return rotation_from_vector(3 * vector()); }
    void poses(Pose* x, int count) {
        for (int i = 0; i < count; ++i) {
            x[i].x = 2 * vector();
            x[i].R = rotation().toRotationMatrix();
        }
    }

private:
    uint64_t state_;
};

}  // namespace taut
