#include "models/cable_path.h"

#include <algorithm>
#include <cmath>

namespace taut {

double path_length(std::span<const Vec3> path) {
    double length = 0;
    for (size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
    return length;
}

void cut_path(std::span<const Vec3> path, uint32_t segments, Array<Vec3>& out) {
    const double step = path_length(path) / segments;
    out.clear();
    out.reserve(segments + 1);
    out.push_back(path.front());
    size_t at = 1;
    double passed = 0, stretch = (path[1] - path[0]).norm();  // before the stretch that ends at `at`, and its own
    for (uint32_t i = 1; i < segments; ++i) {
        while (at + 1 < path.size() && passed + stretch < i * step) {
            passed += stretch;
            ++at;
            stretch = (path[at] - path[at - 1]).norm();
        }
        const double t = stretch > 0 ? std::clamp((i * step - passed) / stretch, 0.0, 1.0) : 0.0;
        out.push_back(path[at - 1] + t * (path[at] - path[at - 1]));
    }
    out.push_back(path.back());
}

void sag_path(const Vec3& a, const Vec3& b, const Vec3& down, double length, uint32_t segments, Array<Vec3>& out) {
    const Vec3 along = (b - a).normalized();
    Vec3 across = down - down.dot(along) * along;
    if (across.norm() <= 1e-3 * down.norm()) {
        const Vec3 axis = std::abs(along.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitZ();
        across = axis - axis.dot(along) * along;
    }
    across.normalize();
    // Points of the curve, close enough that it does not matter that they lie evenly along the chord.
    Array<Vec3> curve(out.get_allocator());
    const uint32_t points = 16 * std::max(segments, 16u);
    curve.resize(points + 1);
    double lo = 0, hi = length;  // depth; at hi the chords are longer than asked for
    for (int i = 0; i < 60; ++i) {
        const double depth = 0.5 * (lo + hi);
        for (uint32_t k = 0; k <= points; ++k) {
            const double t = static_cast<double>(k) / points;
            curve[k] = a + t * (b - a) + 4 * t * (1 - t) * depth * across;
        }
        cut_path(curve, segments, out);
        (path_length(out) < length ? lo : hi) = depth;
    }
}

}  // namespace taut
