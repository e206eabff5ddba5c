// Queries of the triangles of cloths and solids, against all triangles one by one.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

struct V {
    double x = 0, y = 0, z = 0;
};
V operator-(const V& a, const V& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
V operator+(const V& a, const V& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V operator*(double s, const V& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const V& a, const V& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V cross(const V& a, const V& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
V of(const taut_pos& p) { return {p.x, p.y, p.z}; }

// The distance of a point from a triangle: within its plane's prism, else from its edges.
double distance_of(const V& p, const V (&x)[3]) {
    const V n = cross(x[1] - x[0], x[2] - x[0]);
    double best = 1e30;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        const V edge = x[(k + 1) % 3] - x[k], from = p - x[k];
        inside = inside && dot(cross(n, edge), from) >= 0;
        const double t = std::clamp(dot(from, edge) / dot(edge, edge), 0.0, 1.0);
        const V off = from - t * edge;
        best = std::min(best, std::sqrt(dot(off, off)));
    }
    if (inside) best = std::abs(dot(n, p - x[0])) / std::sqrt(dot(n, n));
    return best;
}
// Way along a ray from p over d to a triangle's plane within it, in lengths of d (Cramer's rule); above 1: none.
double fraction_of(const V& p, const V& d, const V (&x)[3]) {
    const V e = x[1] - x[0], f = x[2] - x[0], h = cross(d, f);
    const double det = dot(e, h);
    if (det == 0) return 2;
    const V s = p - x[0], q = cross(s, e);
    const double u = dot(s, h) / det, v = dot(d, q) / det, t = dot(f, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1 ? t : 2;
}

// A crumpled sheet, a block beside it, and a ball that falls between: settled for a while.
struct SurfaceWorld : testing::Test {
    static constexpr int kSide = 12;
    SurfaceWorld() {
        taut_world_def def;
        taut_world_def_init(&def);
        EXPECT_OK(taut_world_create(&def, &world));
        std::vector<taut_pos> points;
        std::vector<uint32_t> triangles;
        for (uint32_t i = 0; i < kSide; ++i)
            for (uint32_t k = 0; k < kSide; ++k) points.push_back({0.1 * i, 1, 0.1 * k});
        for (uint32_t i = 0; i + 1 < kSide; ++i)
            for (uint32_t k = 0; k + 1 < kSide; ++k) {
                const uint32_t a = i * kSide + k;
                triangles.insert(triangles.end(), {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide});
            }
        taut_cloth_def sheet;
        taut_cloth_def_init(&sheet);
        sheet.points = points.data();
        sheet.point_count = kSide * kSide;
        sheet.triangles = triangles.data();
        sheet.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
        sheet.filter.category = 2;
        EXPECT_OK(taut_world_add_cloth(world, &sheet, &cloth));
        EXPECT_OK(taut_cloth_pin(cloth, 0, 1));
        EXPECT_OK(taut_cloth_pin(cloth, kSide - 1, 1));
        const taut_pos corner[] = {{2, 0.6, 0}, {2.5, 0.6, 0}, {2.5, 0.6, 0.5}, {2, 0.6, 0.5},
                                   {2, 1.1, 0}, {2.5, 1.1, 0}, {2.5, 1.1, 0.5}, {2, 1.1, 0.5}};
        const uint32_t cell[] = {0, 3, 2, 1, 4, 7, 6, 5};
        taut_solid_def block;
        taut_solid_def_init(&block);
        block.points = corner;
        block.point_count = 8;
        block.cells = cell;
        block.cell_count = 1;
        block.corners = 8;
        block.filter.mask = 0;  // touches nothing, and is seen all the same
        block.gravity_scale = 0.1f;
        EXPECT_OK(taut_world_add_solid(world, &block, &solid));
        for (int i = 0; i < 30; ++i) EXPECT_OK(taut_world_step(world));
        read(cloth, taut_cloth_get_points, taut_cloth_get_triangles, 0);
        read(solid, taut_solid_get_points, taut_solid_get_triangles, 1);
    }
    ~SurfaceWorld() override { taut_world_destroy(world); }

    template <class Handle, class Points, class Triangles>
    void read(Handle handle, Points points_of, Triangles triangles_of, int which) {
        std::vector<taut_pos> points(1000);
        std::vector<uint32_t> corners(3000);
        uint32_t count = 0;
        EXPECT_OK(points_of(handle, points.data(), 1000, &count));
        EXPECT_OK(triangles_of(handle, corners.data(), 1000, &count));
        for (uint32_t t = 0; t < count; ++t) {
            Triangle out{which, t, {}};
            for (size_t k = 0; k < 3; ++k) out.x[k] = of(points[corners[3 * t + k]]);
            all.push_back(out);
        }
    }
    struct Triangle {
        int which;
        uint32_t index;
        V x[3];
    };
    const Triangle& named(const taut_surface_hit& hit) const {
        EXPECT_TRUE((hit.cloth.bits == cloth.bits) != (hit.solid.bits == solid.bits));
        const int which = hit.cloth.bits != 0 ? 0 : 1;
        return *std::find_if(all.begin(), all.end(),
                             [&](const Triangle& t) { return t.which == which && t.index == hit.triangle; });
    }
    // Weights give the point that is told.
    void expect_weights(const taut_surface_hit& hit) const {
        const Triangle& on = named(hit);
        V at;
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(hit.weights[k], 0);
            sum += static_cast<double>(hit.weights[k]);
            at = at + static_cast<double>(hit.weights[k]) * on.x[k];
        }
        EXPECT_NEAR(sum, 1, 1e-6);
        const V off = at - of(hit.point);
        EXPECT_LE(std::sqrt(dot(off, off)), 1e-6);
        const V n = cross(on.x[1] - on.x[0], on.x[2] - on.x[0]);
        EXPECT_NEAR(dot(n, {hit.normal.x, hit.normal.y, hit.normal.z}) / std::sqrt(dot(n, n)), 1, 1e-6);
    }

    taut_world world{};
    taut_cloth cloth{};
    taut_solid solid{};
    std::vector<Triangle> all;
    std::mt19937 engine{3};
    double uniform(double lo, double hi) { return lo + (hi - lo) * double(engine()) / 4294967296.0; }
};

TEST_F(SurfaceWorld, RaysMeetTheFirstTriangle) {
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
        const V from{uniform(-1, 3), uniform(-1, 2.5), uniform(-1, 2)},
            to{uniform(0, 2.5), uniform(0, 1.1), uniform(0, 1)};
        const V d = 1.5 * (to - from);
        const taut_ray ray{{from.x, from.y, from.z}, {float(d.x), float(d.y), float(d.z)}, 0};
        const V along{double(ray.translation.x), double(ray.translation.y), double(ray.translation.z)};
        double best = 2;
        for (const Triangle& t : all) best = std::min(best, fraction_of(from, along, t.x));
        taut_surface_hit hit;
        EXPECT_OK(taut_world_cast_ray_surface(world, &ray, nullptr, &hit));
        if (best > 1) {
            EXPECT_EQ(hit.cloth.bits | hit.solid.bits, 0u);
            continue;
        }
        ++met;
        EXPECT_NEAR(hit.distance, best * std::sqrt(dot(along, along)), 1e-5);
        EXPECT_LE(fraction_of(from, along, named(hit).x), best + 1e-9);
        expect_weights(hit);
    }
    EXPECT_GT(met, 300);
}

TEST_F(SurfaceWorld, NearestIsTheNearestOfAll) {
    for (int i = 0; i < 1000; ++i) {
        const V at{uniform(-1, 3), uniform(-1, 2.5), uniform(-1, 2)};
        double best = 1e30;
        for (const Triangle& t : all) best = std::min(best, distance_of(at, t.x));
        taut_surface_hit hit;
        EXPECT_OK(taut_world_closest_surface(world, {at.x, at.y, at.z}, 0.5f, nullptr, &hit));
        if (best > 0.5 + 1e-6) {
            EXPECT_EQ(hit.cloth.bits | hit.solid.bits, 0u);
            continue;
        }
        if (best > 0.5 - 1e-6) continue;
        EXPECT_NEAR(hit.distance, best, 1e-6);
        EXPECT_NEAR(distance_of(at, named(hit).x), best, 1e-6);
        expect_weights(hit);
    }
}

TEST_F(SurfaceWorld, OverlapsAreAllThatComeNear) {
    for (int i = 0; i < 200; ++i) {
        const V at{uniform(-0.5, 3), uniform(-0.2, 1.5), uniform(-0.5, 1.5)};
        const double radius = uniform(0.01, 1);
        size_t least = 0, most = 0;
        for (const Triangle& t : all) {
            least += distance_of(at, t.x) <= radius - 1e-6;
            most += distance_of(at, t.x) <= radius + 1e-6;
        }
        uint32_t count = 0;
        const taut_pos place{at.x, at.y, at.z};
        const taut_result sized =
            taut_world_overlap_surfaces(world, place, static_cast<float>(radius), nullptr, nullptr, 0, &count);
        EXPECT_EQ(sized, count == 0 ? TAUT_OK : TAUT_TOO_SMALL);
        EXPECT_GE(count, least);
        EXPECT_LE(count, most);
        std::vector<taut_surface_hit> hits(count);
        EXPECT_OK(
            taut_world_overlap_surfaces(world, place, static_cast<float>(radius), nullptr, hits.data(), count, &count));
        for (size_t k = 0; k < hits.size(); ++k) {
            EXPECT_NEAR(hits[k].distance, distance_of(at, named(hits[k]).x), 1e-6);
            expect_weights(hits[k]);
            if (k == 0 || hits[k].cloth.bits != hits[k - 1].cloth.bits) continue;
            EXPECT_GT(hits[k].triangle, hits[k - 1].triangle);
        }
    }
}

// No ray through a common edge or vertex goes between the triangles there.
TEST_F(SurfaceWorld, RaysDoNotGoBetweenTriangles) {
    for (const Triangle& t : all)
        for (int k = 0; k < 3; ++k) {
            if (t.which == 0) continue;  // of the block, which is closed
            const V on = 0.5 * (t.x[k] + t.x[(k + 1) % 3]), inside{2.25, 0.5 * (t.x[0].y + 0.8), 0.25};
            const V d = 3.0 * (on - inside);
            const taut_ray ray{{inside.x, inside.y, inside.z}, {float(d.x), float(d.y), float(d.z)}, 0};
            taut_surface_hit hit;
            EXPECT_OK(taut_world_cast_ray_surface(world, &ray, nullptr, &hit));
            EXPECT_EQ(hit.solid.bits, solid.bits);
        }
}

TEST_F(SurfaceWorld, FiltersTakeTrianglesByTheirVertices) {
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    const taut_pos by_cloth{0.5, 0.9, 0.1};
    taut_surface_hit hit;
    const auto sees_cloth = [&] {
        EXPECT_OK(taut_world_closest_surface(world, by_cloth, 10, &filter, &hit));
        return hit.cloth.bits == cloth.bits;
    };
    EXPECT_TRUE(sees_cloth());
    filter.mask = ~uint64_t{2};
    EXPECT_FALSE(sees_cloth());
    EXPECT_EQ(hit.solid.bits, solid.bits);  // without a collider: by its kind
    filter.kinds = TAUT_QUERY_DYNAMIC;
    EXPECT_FALSE(sees_cloth());
    EXPECT_EQ(hit.solid.bits, 0u);
    taut_query_filter_init(&filter);
    filter.kinds = TAUT_QUERY_PARTICLE;
    EXPECT_TRUE(sees_cloth());
    std::vector<taut_body> bodies(kSide * kSide);
    uint32_t count = 0;
    EXPECT_OK(taut_cloth_get_bodies(cloth, bodies.data(), kSide * kSide, &count));
    const std::vector<taut_body> first(bodies.begin(), bodies.begin() + 3 * kSide);
    EXPECT_OK(taut_world_closest_surface(world, {0, 1, 0}, 10, nullptr, &hit));
    EXPECT_EQ(hit.triangle, 0u);
    filter.ignored_bodies = first.data();
    filter.ignored_body_count = static_cast<uint32_t>(first.size());
    EXPECT_OK(taut_world_closest_surface(world, {0, 1, 0}, 10, &filter, &hit));
    EXPECT_GE(hit.triangle, 2u * 2 * (kSide - 1));
}

TEST_F(SurfaceWorld, ArgumentsAreChecked) {
    taut_surface_hit hit;
    uint32_t count = 0;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const taut_ray none{{0, 0, 0}, {0, 0, 0}, 0}, ray{{0, 0, 0}, {1, 0, 0}, 0};
    EXPECT_EQ(taut_world_cast_ray_surface(world, nullptr, nullptr, &hit), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_cast_ray_surface(world, &ray, nullptr, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_cast_ray_surface(world, &none, nullptr, &hit), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_closest_surface(world, {0, 0, 0}, nan, nullptr, &hit), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_closest_surface(world, {0, 0, 0}, -1, nullptr, &hit), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_closest_surface(world, {0, 0, double(nan)}, 1, nullptr, &hit), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_overlap_surfaces(world, {0, 0, 0}, 1, nullptr, nullptr, 0, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_overlap_surfaces(world, {0, 0, 0}, 1e8f, nullptr, nullptr, 0, &count), TAUT_INVALID_ARGUMENT);
}

// Any number of threads may ask at once.
TEST_F(SurfaceWorld, ThreadsAskAtOnce) {
    taut_surface_hit alone;
    EXPECT_OK(taut_world_closest_surface(world, {0.4, 0.7, 0.3}, 10, nullptr, &alone));
    std::vector<std::thread> team;
    for (int i = 0; i < 4; ++i)
        team.emplace_back([&] {
            for (int k = 0; k < 50; ++k) {
                taut_surface_hit hit;
                EXPECT_EQ(taut_world_closest_surface(world, {0.4, 0.7, 0.3}, 10, nullptr, &hit), TAUT_OK);
                EXPECT_EQ(std::memcmp(&hit, &alone, sizeof hit), 0);
            }
        });
    for (std::thread& each : team) each.join();
}

}  // namespace
