#include "collision/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/box_tree.h"
#include "collision/sorting.h"
#include "collision/surface.h"
#include "collision/triangle_distance.h"

namespace taut::collision {
namespace {

// Where a line along x crosses the surface, and whether from its back to its front as x grows.
struct Crossing {
    double x;
    int turn;  // 1: into it, -1: out of it
};

struct CornerList final : PointSink {
    explicit CornerList(Memory& memory) : list(memory) {}
    void take(const Vec3f& point) override { list.push_back(point); }

    Array<Vec3f> list;
};

class Sampling {
public:
    Sampling(std::span<const Vec3f> corners, DistanceGrid& out, Memory& memory)
        : corners_(corners), out_(out), tree_(memory), first_(memory), crossing_(memory) {}

    void run() {
        tree_.build(static_cast<uint32_t>(corners_.size() / 3), [&](uint32_t t) {
            ItemBox box;
            for (int k = 0; k < 3; ++k) box.add(corner(t, k));
            return box;
        });
        find_crossings();
        for (uint32_t k = 0; k < out_.nodes[2]; ++k)
            for (uint32_t j = 0; j < out_.nodes[1]; ++j) sample_line(j, k);
    }

private:
    Vec3 corner(uint32_t triangle, int k) const { return corners_[3 * size_t{triangle} + size_t(k)].cast<double>(); }
    double place(int axis, uint32_t i) const { return out_.corner[axis] + out_.cell * i; }
    // Lines go a little beside the samples, lest they meet edges of meshes that lie on the grid.
    double line(int axis, uint32_t i) const {
        return place(axis, i) + out_.cell * (axis == 1 ? 1.234567e-5 : 2.345678e-5);
    }
    uint32_t line_of(uint32_t j, uint32_t k) const { return k * out_.nodes[1] + j; }

    // Those of each line, from first_[line] to first_[line + 1].
    void find_crossings() {
        put_in_groups<Crossing>(out_.nodes[1] * out_.nodes[2], first_, crossing_, [&](const auto& put) {
            for (uint32_t t = 0; t < corners_.size() / 3; ++t) cross(t, put);
        });
    }

    template <class Put>
    void cross(uint32_t t, const Put& put) {
        const Vec3 a = corner(t, 0), u = corner(t, 1) - a, v = corner(t, 2) - a;
        const double area = u.y() * v.z() - u.z() * v.y();  // of its shadow along x, twice
        if (area == 0) return;
        ItemBox box;
        for (int k = 0; k < 3; ++k) box.add(corner(t, k));
        uint32_t first[2], last[2];
        for (int axis = 1; axis < 3; ++axis) {
            first[axis - 1] =
                static_cast<uint32_t>(std::max(0.0, std::floor((box.lo[axis] - out_.corner[axis]) / out_.cell)));
            last[axis - 1] = static_cast<uint32_t>(std::ceil((box.hi[axis] - out_.corner[axis]) / out_.cell));
        }
        for (uint32_t k = first[1]; k <= std::min(last[1], out_.nodes[2] - 1); ++k)
            for (uint32_t j = first[0]; j <= std::min(last[0], out_.nodes[1] - 1); ++j) {
                const double y = line(1, j) - a.y(), z = line(2, k) - a.z();
                const double b = (y * v.z() - z * v.y()) / area, c = (u.y() * z - u.z() * y) / area;
                if (b >= 0 && c >= 0 && b + c < 1)
                    put(line_of(j, k), Crossing{a.x() + b * u.x() + c * v.x(), area < 0 ? 1 : -1});
            }
    }

    void sample_line(uint32_t j, uint32_t k) {
        const uint32_t at = line_of(j, k);
        const std::span<Crossing> crossings = std::span(crossing_).subspan(first_[at], first_[at + 1] - first_[at]);
        std::ranges::sort(crossings, {}, &Crossing::x);
        size_t next = 0;
        int winding = 0;
        for (uint32_t i = 0; i < out_.nodes[0]; ++i) {
            const Vec3 point(place(0, i), place(1, j), place(2, k));
            for (; next < crossings.size() && crossings[next].x < point.x(); ++next) winding += crossings[next].turn;
            const double distance = std::sqrt(
                distance_squared(tree_.nearest(point, [&](uint32_t t) { return distance_squared(t, point); }), point));
            out_.distance[(size_t{k} * out_.nodes[1] + j) * out_.nodes[0] + i] =
                static_cast<float>(winding > 0 ? -distance : distance);
        }
    }
    double distance_squared(uint32_t t, const Vec3& point) const {
        const Vec3 triangle[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
        return collision::distance_squared(point, triangle);
    }

    std::span<const Vec3f> corners_;
    DistanceGrid& out_;
    BoxTree tree_;
    Array<uint32_t> first_;
    Array<Crossing> crossing_;
};

// Six times the volume within [m^3]: negative where it looks inward.
double volume_of(std::span<const Vec3f> corners) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); i += 3)
        sum += corners[i].cast<double>().dot(corners[i + 1].cast<double>().cross(corners[i + 2].cast<double>()));
    return sum;
}

bool is_open(const Surface& surface) {
    for (uint32_t t = 0; t < surface.slots(); ++t)
        for (int edge = 0; edge < 3; ++edge)
            if (!surface.has(t) || surface.neighbour(t, edge) == kNoTriangle) return true;
    return false;
}

}  // namespace

// phi = sum over the 27 nodes around the nearest one of w_x w_y w_z phi_i, w the quadratic B-spline: with t from there
// in cells, (1/2 - t)^2/2, 3/4 - t^2, (1/2 + t)^2/2.
LevelSet DistanceGrid::at(const Vec3& point) const {
    LevelSet out;
    out.distance = std::numeric_limits<double>::infinity();
    const Vec3 from = (point - corner) / cell;
    uint32_t first[3];
    double weight[3][3][3];  // axis, derivative, node
    for (int axis = 0; axis < 3; ++axis) {
        if (!(from[axis] >= 0.5 && from[axis] < nodes[axis] - 1.5)) return out;
        const double nearest = std::floor(from[axis] + 0.5), t = from[axis] - nearest;
        first[axis] = static_cast<uint32_t>(nearest) - 1;
        const double of[3][3] = {{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
                                 {t - 0.5, -2 * t, t + 0.5},
                                 {1, -2, 1}};
        double scale = 1;
        for (int order = 0; order < 3; ++order, scale /= cell)
            for (int i = 0; i < 3; ++i) weight[axis][order][i] = scale * of[order][i];
    }
    const auto sum = [&](int x, int y, int z) {  // of the derivatives of these orders
        double all = 0;
        for (uint32_t k = 0; k < 3; ++k)
            for (uint32_t j = 0; j < 3; ++j) {
                const float* const row =
                    &distance[(size_t{first[2] + k} * nodes[1] + first[1] + j) * nodes[0] + first[0]];
                double line = 0;
                for (uint32_t i = 0; i < 3; ++i) line += weight[0][x][i] * static_cast<double>(row[i]);
                all += weight[1][y][j] * weight[2][z][k] * line;
            }
        return all;
    };
    out.distance = sum(0, 0, 0);
    out.gradient = {sum(1, 0, 0), sum(0, 1, 0), sum(0, 0, 1)};
    const double xy = sum(1, 1, 0), yz = sum(0, 1, 1), zx = sum(1, 0, 1);
    out.curvature << sum(2, 0, 0), xy, zx, xy, sum(0, 2, 0), yz, zx, yz, sum(0, 0, 2);
    return out;
}

std::shared_ptr<const DistanceGrid> sample_distance(const Shape& shape, double cell, const char** reason,
                                                    Memory& memory) {
    if (is_open(*shape.surface)) {
        *reason = "an open surface has no inside";
        return nullptr;
    }
    CornerList corners(memory);
    corners.list.reserve(3 * size_t{surface_counts(shape).triangles});
    surface_triangles(shape, corners);
    if (!(volume_of(corners.list) > 0)) {
        *reason = "its triangles look inward";
        return nullptr;
    }
    auto out = std::allocate_shared<DistanceGrid>(HostAllocator<DistanceGrid>(memory), memory);
    ItemBox box;
    for (const Vec3f& each : corners.list) box.add(each.cast<double>());
    out->cell = cell;
    out->corner = box.lo - Vec3::Constant(2 * cell);
    double samples = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double along = std::ceil((box.hi[axis] - box.lo[axis]) / cell) + 5;
        samples *= along;
        out->nodes[axis] = static_cast<uint32_t>(std::min(along, 1e9));
    }
    if (!(samples <= kMostSamples)) {
        *reason = "the cells are too small: more than 16777216 samples";
        return nullptr;
    }
    out->distance.resize(static_cast<size_t>(samples));
    Sampling(corners.list, *out, memory).run();
    return out;
}

}  // namespace taut::collision
