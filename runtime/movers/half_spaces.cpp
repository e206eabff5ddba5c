#include "movers/half_spaces.h"

#include <algorithm>

namespace taut {
namespace {

constexpr double kSame = 1e-6;       // of two normals' difference
constexpr double kParallel = 1e-9;   // of a determinant of unit normals
constexpr double kTolerance = 1e-9;  // of what a point is short of a plane, in parts of the sizes at hand

}  // namespace

// Normals of queries are of unit length in single precision only.
void HalfSpaces::add(const Vec3& direction, double least) {
    const Vec3 normal = direction.normalized();
    for (size_t i = 0; i < count_; ++i) {
        if ((plane_[i].normal - normal).norm() > kSame) continue;
        plane_[i].least = std::max(plane_[i].least, least);
        return;
    }
    if (count_ == kMost) {
        full_ = true;
        return;
    }
    plane_[count_++] = {normal, least};
}

bool HalfSpaces::holds(const Vec3& x, double tolerance) const {
    return std::all_of(plane_.begin(), plane_.begin() + static_cast<ptrdiff_t>(count_),
                       [&](const Plane& plane) { return plane.normal.dot(x) >= plane.least - tolerance; });
}

// The nearest point lies on at most three of the planes and is nearest on these: of all such points that are beyond
// the rest, the one nearest to x. A few planes as a rule, so that asking all of them is cheap.
bool HalfSpaces::nearest(const Vec3& x, Vec3& out) const {
    if (full_) return false;
    double size = x.norm();
    for (size_t i = 0; i < count_; ++i) size = std::max(size, std::abs(plane_[i].least));
    const double tolerance = kTolerance * size;
    if (holds(x, 0)) {
        out = x;
        return true;
    }
    bool found = false;
    double least = 0;
    const auto offer = [&](const Vec3& y) {
        const double distance = (y - x).squaredNorm();
        if ((found && distance >= least) || !holds(y, tolerance)) return;
        found = true;
        least = distance;
        out = y;
    };
    for (size_t i = 0; i < count_; ++i) {
        const Plane& a = plane_[i];
        offer(x + (a.least - a.normal.dot(x)) * a.normal);
        for (size_t k = i + 1; k < count_; ++k) {
            const Plane& b = plane_[k];
            const Vec3 along = a.normal.cross(b.normal);
            const double det = along.squaredNorm();
            if (det < kParallel) continue;
            offer((a.least * b.normal.cross(along) + b.least * along.cross(a.normal) + along.dot(x) * along) / det);
            for (size_t m = k + 1; m < count_; ++m) {
                const Plane& c = plane_[m];
                const double volume = along.dot(c.normal);
                if (volume * volume < kParallel) continue;
                offer((a.least * b.normal.cross(c.normal) + b.least * c.normal.cross(a.normal) + c.least * along) /
                      volume);
            }
        }
    }
    return found;
}

// Landweber's iteration on what is missing, in steps below the inverse of the most that planes can add up to.
Vec3 HalfSpaces::compromise() const {
    constexpr int kSteps = 100;
    Vec3 x = Vec3::Zero();
    for (int step = 0; step < kSteps; ++step) {
        Vec3 missing = Vec3::Zero();
        for (size_t i = 0; i < count_; ++i)
            missing += std::max(plane_[i].least - plane_[i].normal.dot(x), 0.0) * plane_[i].normal;
        x += missing / static_cast<double>(count_);
    }
    return x;
}

}  // namespace taut
