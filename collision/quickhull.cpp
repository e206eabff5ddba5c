// Quickhull (Barber, Dobkin and Huhdanpaa, 1996): a point outside sees some of the triangles; these make way for a fan
// of triangles from their rim, the horizon, to the point. Each point that is outside waits at one triangle that it is
// above.
#include "collision/quickhull.h"

#include <algorithm>
#include <cmath>

namespace taut::collision {
namespace {

// Heights over a triangle are good to this part of the points' extent, divided by the sine of its corner: some fifty
// roundings.
constexpr double kNormalRounding = 1e-14;

struct Triangle {
    std::array<int, 3> corner;
    std::array<int, 3> beside;  // across the edge from each corner to the next
    Vec3 at, normal;            // its first corner, and unit, outward; 0 without area
    double slack;               // a point above by no more lies in its plane [m]
    Array<int> outside;         // points that wait
    bool gone = false;
    int furthest = -1;  // of them, and by how much [m]
    double most = 0;

    double height(const Vec3& p) const { return normal.dot(p - at); }
};

// An edge of the horizon, as the triangle that is seen has it.
struct Rim {
    int from, to;
    int beyond;  // the triangle that is not seen
};

class Quickhull {
public:
    Quickhull(std::span<const Vec3f> points, double near, Memory& memory)
        : points_(points), near_(near), memory_(memory), triangles_(memory), seen_(memory), horizon_(memory) {
        Vec3f lo = points[0], hi = points[0];
        for (const Vec3f& p : points) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
        extent_ = double((hi - lo).maxCoeff());
    }
    void start(const std::array<int, 4>& simplex);
    // Takes the point that is furthest outside; false if none is.
    bool grow();
    Loops loops() const;

private:
    Vec3 at(int point) const { return points_[size_t(point)].cast<double>(); }
    Triangle& triangle(int i) { return triangles_[size_t(i)]; }
    Triangle make(int a, int b, int c) const;
    void wait(int point, size_t first);
    bool find_horizon(int seen_first, const Vec3& p);
    bool put_horizon_in_order();
    bool replace(int point);

    std::span<const Vec3f> points_;
    double near_, extent_;
    Memory& memory_;
    Array<Triangle> triangles_;
    Array<int> seen_;  // triangles, by the point that is taken
    Array<Rim> horizon_;
};

Triangle Quickhull::make(int a, int b, int c) const {
    const Vec3 ab = at(b) - at(a), ac = at(c) - at(a);
    const Vec3 cross = ab.cross(ac);
    const double area = cross.norm();
    Triangle out{{a, b, c}, {-1, -1, -1}, at(a), Vec3::Zero(), 0, Array<int>(memory_)};
    if (!(area > 0)) return out;
    out.normal = cross / area;
    out.slack = kNormalRounding * extent_ * ab.norm() * ac.norm() / area;
    return out;
}

// At the triangle, from the first on, that it is highest above.
void Quickhull::wait(int point, size_t first) {
    const Vec3 p = at(point);
    double most = near_;
    Triangle* best = nullptr;
    for (size_t i = first; i < triangles_.size(); ++i) {
        const double height = triangles_[i].height(p);
        if (height > most) most = height, best = &triangles_[i];
    }
    if (!best) return;
    best->outside.push_back(point);
    if (most > best->most) best->most = most, best->furthest = point;
}

void Quickhull::start(const std::array<int, 4>& simplex) {
    auto [a, b, c, d] = simplex;
    if (make(a, b, c).height(at(d)) > 0) std::swap(b, c);
    for (const auto& [p, q, r] : {std::array{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}})
        triangles_.push_back(make(p, q, r));
    triangles_[0].beside = {1, 2, 3};
    triangles_[1].beside = {3, 2, 0};
    triangles_[2].beside = {1, 3, 0};
    triangles_[3].beside = {2, 1, 0};
    for (size_t i = 0; i < points_.size(); ++i) wait(int(i), 0);
}

// The triangles that a point sees, which hang together, and their rim; false if it is not one ring, by rounding.
bool Quickhull::find_horizon(int first, const Vec3& p) {
    seen_.assign(1, first);
    horizon_.clear();
    for (size_t next = 0; next < seen_.size(); ++next) {
        const Triangle& here = triangle(seen_[next]);
        for (size_t e = 0; e < 3; ++e) {
            const int other = here.beside[e];
            if (std::find(seen_.begin(), seen_.end(), other) != seen_.end()) continue;
            if (triangle(other).height(p) > triangle(other).slack) {
                seen_.push_back(other);
            } else {
                horizon_.push_back({here.corner[e], here.corner[(e + 1) % 3], other});
            }
        }
    }
    return put_horizon_in_order();
}

bool Quickhull::put_horizon_in_order() {
    for (size_t i = 1; i < horizon_.size(); ++i) {
        const auto next = std::find_if(horizon_.begin() + std::ptrdiff_t(i), horizon_.end(),
                                       [&](const Rim& rim) { return rim.from == horizon_[i - 1].to; });
        if (next == horizon_.end()) return false;
        std::swap(horizon_[i], *next);
    }
    // A ring that meets itself at a corner passes it twice.
    Array<int> corners(memory_);
    for (const Rim& rim : horizon_) corners.push_back(rim.from);
    std::sort(corners.begin(), corners.end());
    return horizon_.size() >= 3 && horizon_.back().to == horizon_.front().from &&
           std::adjacent_find(corners.begin(), corners.end()) == corners.end();
}

// By a fan; false, and nothing done, if one of its triangles has no area.
bool Quickhull::replace(int point) {
    const int first = int(triangles_.size()), count = int(horizon_.size());
    Array<Triangle> fan(memory_);
    for (int i = 0; i < count; ++i) {
        const Rim& rim = horizon_[size_t(i)];
        fan.push_back(make(rim.from, rim.to, point));
        if (fan.back().normal == Vec3::Zero()) return false;
        fan.back().beside = {rim.beyond, first + (i + 1) % count, first + (i + count - 1) % count};
    }
    for (int i = 0; i < count; ++i) {
        Triangle& beyond = triangle(horizon_[size_t(i)].beyond);
        const auto corner = std::find(beyond.corner.begin(), beyond.corner.end(), horizon_[size_t(i)].to);
        beyond.beside[size_t(corner - beyond.corner.begin())] = first + i;
    }
    for (Triangle& each : fan) triangles_.push_back(std::move(each));
    for (const int i : seen_) {
        triangle(i).gone = true;
        Array<int> orphans(memory_);
        orphans.swap(triangle(i).outside);
        for (const int orphan : orphans)
            if (orphan != point) wait(orphan, size_t(first));
    }
    return true;
}

bool Quickhull::grow() {
    const auto nearer = [](const Triangle& one, const Triangle& other) {
        return (one.gone ? 0 : one.most) < (other.gone ? 0 : other.most);
    };
    const int best = int(std::max_element(triangles_.begin(), triangles_.end(), nearer) - triangles_.begin());
    const int point = triangle(best).furthest;
    if (triangle(best).gone || point < 0) return false;
    if (find_horizon(best, at(point)) && replace(point)) return true;
    // Left out: it is outside of what rounding cannot tell from a plane.
    Triangle& left = triangle(best);
    std::erase(left.outside, point);
    left.most = 0, left.furthest = -1;
    for (const int other : left.outside)
        if (left.height(at(other)) > left.most) left.most = left.height(at(other)), left.furthest = other;
    return true;
}

Loops Quickhull::loops() const {
    Loops loops(memory_);
    for (const Triangle& each : triangles_) {
        if (each.gone) continue;
        Loop loop(each.corner.begin(), each.corner.end(), memory_);
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    return loops;
}

}  // namespace

Loops quickhull(std::span<const Vec3f> points, const std::array<int, 4>& simplex, size_t most, double near,
                Memory& memory) {
    Quickhull hull(points, near, memory);
    hull.start(simplex);
    for (size_t corners = 4; corners < most && hull.grow();) ++corners;
    return hull.loops();
}

}  // namespace taut::collision
