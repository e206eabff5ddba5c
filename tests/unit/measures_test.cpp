// What taut-bench measures of soft bodies, against answers by brute force and by another way.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bench/crossings.h"
#include "bench/overlap.h"
#include "bench/point_depth.h"

namespace measures {

namespace {

using bench::Skin;
using bench::Vec;
using Corners = std::array<taut_pos, 3>;
using Faces = std::vector<std::array<uint32_t, 3>>;

class MeasuresRandom {
public:
    explicit MeasuresRandom(uint32_t seed) : engine_(seed) {}
    double within(double half) { return half * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1); }
    taut_pos point(double half) { return {within(half), within(half), within(half)}; }

private:
    std::mt19937 engine_;
};

// Gap of two triangles' shadows on their normals and on the products of their edges: above 0 where some direction
// parts them (separating axes), below 0 where none does.
double gap(const Corners& a, const Corners& b) {
    std::array<Vec, 3> x, y, u, v;
    for (size_t k = 0; k < 3; ++k) x[k] = bench::of(a[k]), y[k] = bench::of(b[k]);
    for (size_t k = 0; k < 3; ++k) u[k] = x[(k + 1) % 3] - x[k], v[k] = y[(k + 1) % 3] - y[k];
    std::vector<Vec> axes = {cross(u[0], u[1]), cross(v[0], v[1])};
    for (const Vec& e : u)
        for (const Vec& f : v) axes.push_back(cross(e, f));
    double most = -INFINITY;
    for (const Vec& axis : axes) {
        const double size = length(axis);
        if (size < 1e-9) continue;
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (size_t k = 0; k < 3; ++k)
            for (int of = 0; of < 2; ++of) {
                const double s = dot(axis, of == 0 ? x[k] : y[k]) / size;
                low[of] = std::min(low[of], s);
                high[of] = std::max(high[of], s);
            }
        most = std::max({most, low[1] - high[0], low[0] - high[1]});
    }
    return most;
}

TEST(Crossings, OfTwoTrianglesAreWhatNoDirectionParts) {
    MeasuresRandom random(1);
    int crossing = 0, apart = 0;
    for (int i = 0; i < 100000; ++i) {
        const Corners a = {random.point(1), random.point(1), random.point(1)},
                      b = {random.point(1), random.point(1), random.point(1)};
        const double g = gap(a, b);
        if (std::fabs(g) < 1e-9) continue;
        ASSERT_EQ(bench::cross_each_other(a, b), g < 0) << "pair " << i << ", gap " << g;
        ++(g < 0 ? crossing : apart);
    }
    EXPECT_GT(crossing, 5000);
    EXPECT_GT(apart, 5000);
}

// n x n points of a crumpled sheet.
struct Crumpled {
    std::vector<taut_pos> points;
    Faces faces;

    Crumpled(uint32_t n, double fold, uint32_t seed) {
        MeasuresRandom random(seed);
        for (uint32_t i = 0; i < n; ++i)
            for (uint32_t k = 0; k < n; ++k) {
                const taut_pos r = random.point(0.6 / n);
                const double x = 1.0 * i / n, z = 1.0 * k / n;
                points.push_back({0.3 * std::sin(fold * x) + r.x, 0.2 * std::cos(fold * (x + z)) + r.y, z + r.z});
            }
        for (uint32_t i = 0; i + 1 < n; ++i)
            for (uint32_t k = 0; k + 1 < n; ++k) {
                const uint32_t a = i * n + k;
                faces.insert(faces.end(), {{a, a + 1, a + n}, {a + n, a + 1, a + n + 1}});
            }
    }
    Corners at(size_t face) const { return {points[faces[face][0]], points[faces[face][1]], points[faces[face][2]]}; }
    bool shares(size_t i, size_t k, const std::vector<uint32_t>& names) const {
        for (const uint32_t a : faces[i])
            for (const uint32_t b : faces[k])
                if (names[a] == names[b]) return true;
        return false;
    }
};

TEST(Crossings, OfSheetsAreThoseOfAllPairs) {
    const Crumpled a(18, 9, 1), b(14, 5, 2);
    std::vector<uint32_t> own(a.points.size());
    for (uint32_t v = 0; v < own.size(); ++v) own[v] = v / 2;  // pairs of points are one, as at a seam
    size_t within = 0, sewn = 0, between = 0;
    std::vector<uint32_t> names(a.points.size());
    for (uint32_t v = 0; v < names.size(); ++v) names[v] = v;
    for (size_t i = 0; i < a.faces.size(); ++i) {
        for (size_t k = i + 1; k < a.faces.size(); ++k) {
            if (!(gap(a.at(i), a.at(k)) < 0)) continue;
            within += !a.shares(i, k, names);
            sewn += !a.shares(i, k, own);
        }
        for (size_t k = 0; k < b.faces.size(); ++k) between += gap(a.at(i), b.at(k)) < 0;
    }
    ASSERT_GT(within, 100u);
    ASSERT_GT(between, 100u);
    ASSERT_LT(sewn, within);
    const Skin skins[] = {{a.points, a.faces, {}}, {b.points, b.faces, {}}};
    const bench::Crossings found = bench::count_crossings(skins);
    EXPECT_EQ(found.own[0], within);
    EXPECT_EQ(found.between, between);
    const Skin seamed[] = {{a.points, a.faces, own}};
    EXPECT_EQ(bench::count_crossings(seamed).own[0], sewn);
}

TEST(Crossings, OfNeighboursAndOfWhatTouchesAreNone) {
    const Crumpled flat(2, 0, 1);
    const std::vector<taut_pos> square = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}};
    const std::vector<taut_pos> on_it = {{0.2, 0, 0.2}, {0.4, 1, 0.2}, {0.2, 1, 0.4}, {0.6, 1, 0.6}};
    const std::vector<taut_pos> through = {{0.2, -0.1, 0.2}, {0.4, 1, 0.2}, {0.2, 1, 0.4}, {0.6, 1, 0.6}};
    const Skin touching[] = {{square, flat.faces, {}}, {on_it, flat.faces, {}}};
    const Skin crossing[] = {{square, flat.faces, {}}, {through, flat.faces, {}}};
    EXPECT_EQ(bench::count_crossings(touching).between, 0u);
    EXPECT_EQ(bench::count_crossings(crossing).between, 1u);
}

// Reach of a round shape in the direction (out, up) of the half plane through its axis.
double round_reach(const scenes::Shape& shape, double out, double up) {
    const double r = shape.radius, h = shape.half_length, top = shape.top_radius;
    switch (shape.kind) {
        case scenes::ShapeKind::sphere:
            return r;
        case scenes::ShapeKind::capsule:
            return r + h * std::fabs(up);
        case scenes::ShapeKind::cylinder:
            return r * std::fabs(out) + h * std::fabs(up);
        case scenes::ShapeKind::cone:
            return std::max(h * up, r * std::fabs(out) - h * up);
        default:
            return std::max(r - h * up, top + h * up);
    }
}

// The shortest way out of a convex shape: of all directions that in which it reaches least beyond the point. Of round
// ones that lies in the plane of the axis and the point.
double way_out(const scenes::Shape& shape, const taut_pos& p) {
    scenes::Shape point;
    point.kind = scenes::ShapeKind::sphere;
    if (shape.kind == scenes::ShapeKind::box || shape.kind == scenes::ShapeKind::hull)
        return bench::overlap_depth({&shape, {}, {0, 0, 0, 1}}, {&point, p, {0, 0, 0, 1}});
    constexpr int kAngles = 360;
    double best = std::numbers::pi, width = std::numbers::pi, least = INFINITY;
    for (int round = 0; round < 3; ++round, width *= 2.0 / kAngles) {  // ever closer about the best
        const double middle = best;
        for (int i = -kAngles; i <= kAngles; ++i) {
            const double angle = middle + width * i / kAngles, out = std::cos(angle), up = std::sin(angle);
            const double way = round_reach(shape, out, up) - out * std::hypot(p.x, p.z) - up * p.y;
            if (way < least) least = way, best = angle;
        }
    }
    return least;
}

TEST(PointDepth, IsTheWayOutOfTheShape) {
    MeasuresRandom random(4);
    std::vector<scenes::Shape> shapes;
    const auto add = [&](scenes::ShapeKind kind) -> scenes::Shape& {
        shapes.emplace_back().kind = kind;
        return shapes.back();
    };
    add(scenes::ShapeKind::box).half_extents = {0.3f, 0.5f, 0.2f};
    add(scenes::ShapeKind::sphere).radius = 0.4f;
    for (const auto kind : {scenes::ShapeKind::capsule, scenes::ShapeKind::cylinder, scenes::ShapeKind::cone}) {
        scenes::Shape& shape = add(kind);
        shape.radius = 0.3f, shape.half_length = 0.4f;
    }
    for (const float top : {0.1f, 0.5f}) {
        scenes::Shape& shape = add(scenes::ShapeKind::tapered_capsule);
        shape.radius = 0.3f, shape.top_radius = top, shape.half_length = 0.4f;
    }
    scenes::Shape& hull = add(scenes::ShapeKind::hull);
    for (int i = 0; i < 12; ++i) {
        const taut_pos p = random.point(0.5);
        hull.points.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    for (size_t s = 0; s < shapes.size(); ++s) {
        const bench::PointDepth depth(shapes[s], shapes);
        int inside = 0;
        for (int i = 0; i < 200; ++i) {
            const taut_pos p = random.point(0.5);
            const double expected = way_out(shapes[s], p), got = depth.at(bench::of(p));
            if (expected > 1e-4) {
                ++inside;
                EXPECT_NEAR(got, expected, 1e-6) << "shape " << s << ", point " << i;
                EXPECT_LE(bench::length(bench::of(p)), depth.reach()) << "shape " << s;
            } else if (expected < -1e-4) {
                EXPECT_LE(got, 0) << "shape " << s << ", point " << i;
            }
        }
        EXPECT_GT(inside, 3) << "shape " << s;
    }
}

TEST(PointDepth, OfPlanesAndScaledHulls) {
    std::vector<scenes::Shape> shapes(3);
    shapes[0].kind = scenes::ShapeKind::plane;
    shapes[0].normal = {0, 2, 0};
    shapes[1].kind = scenes::ShapeKind::hull;
    for (const float x : {-1.0f, 1.0f})
        for (const float y : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f}) shapes[1].points.push_back({x, y, z});
    shapes[2].kind = scenes::ShapeKind::scaled_hull;
    shapes[2].hull = 1;
    shapes[2].scale = {0.5f, -2, 1};
    EXPECT_NEAR(bench::PointDepth(shapes[0], shapes).at({5, -0.25, 3}), 0.25, 1e-12);
    const bench::PointDepth brick(shapes[2], shapes);
    EXPECT_NEAR(brick.at({0.4, 1.7, 0}), 0.1, 1e-12);
    EXPECT_NEAR(brick.at({0, 1.95, 0}), 0.05, 1e-12);
    EXPECT_LT(brick.at({0.6, 0, 0}), 0);
    EXPECT_NEAR(brick.reach(), std::sqrt(0.25 + 4 + 1), 1e-12);
}

}  // namespace

}  // namespace measures
