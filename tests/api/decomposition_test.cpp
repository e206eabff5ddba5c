// Convex decomposition: parts against the solids that they stand for, by distances and volumes known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

constexpr double kTorusPi = 3.14159265358979323846;

struct Triangles {
    std::vector<taut_vec3> vertices;
    std::vector<uint32_t> indices;

    void add(std::initializer_list<uint32_t> corners) { indices.insert(indices.end(), corners); }
    void turn_inside_out() {
        for (size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
    }
    taut_decomposition_def def() const {
        taut_decomposition_def out;
        taut_decomposition_def_init(&out);
        out.vertices = vertices.data();
        out.vertex_count = static_cast<uint32_t>(vertices.size());
        out.indices = indices.data();
        out.triangle_count = static_cast<uint32_t>(indices.size() / 3);
        return out;
    }
};

void put_box(Triangles& out, taut_vec3 low, taut_vec3 high) {
    const auto first = static_cast<uint32_t>(out.vertices.size());
    for (int i = 0; i < 8; ++i)
        out.vertices.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    for (const std::array<uint32_t, 4>& f :
         {std::array<uint32_t, 4>{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        out.add({first + f[0], first + f[1], first + f[2], first + f[0], first + f[2], first + f[3]});
}

// Around the y axis.
Triangles torus(double big, double small, uint32_t around, uint32_t across) {
    Triangles out;
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t k = 0; k < across; ++k) {
            const double a = 2 * kTorusPi * i / around, b = 2 * kTorusPi * k / across, r = big + small * std::cos(b);
            out.vertices.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(small * std::sin(b)),
                                    static_cast<float>(r * std::sin(a))});
        }
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t k = 0; k < across; ++k) {
            const uint32_t j = (i + 1) % around, l = (k + 1) % across;
            const uint32_t a = i * across + k, b = j * across + k, c = j * across + l, d = i * across + l;
            out.add({a, c, b, a, d, c});
        }
    return out;
}
double torus_distance(const taut_vec3& p, double big, double small) {
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
    return std::hypot(std::hypot(x, z) - big, y) - small;
}

// Of the steps' boxes, from below, as one surface: a profile pulled along z.
Triangles stairs(int steps) {
    std::vector<std::array<float, 2>> profile = {{0, 0}, {static_cast<float>(steps), 0}};
    for (int i = steps; i > 0; --i) {
        profile.push_back({static_cast<float>(i), static_cast<float>(steps - i + 1)});
        profile.push_back({static_cast<float>(i - 1), static_cast<float>(steps - i + 1)});
    }
    Triangles out;
    const auto count = static_cast<uint32_t>(profile.size());
    for (const float z : {0.0f, 1.0f})
        for (const auto& p : profile) out.vertices.push_back({p[0], p[1], z});
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t k = (i + 1) % count;
        out.add({i, k, count + k, i, count + k, count + i});
    }
    // Ends: a fan from the corner at the origin sees all of the profile.
    for (uint32_t i = 1; i + 1 < count; ++i) out.add({0, i + 1, i, count, count + i, count + i + 1});
    return out;
}

class Decomposition : public testing::Test {
protected:
    void SetUp() override {
        taut_world_def def;
        taut_world_def_init(&def);
        ASSERT_OK(taut_world_create(&def, &world));
    }
    void TearDown() override {
        for (const taut_baked part : parts) taut_baked_release(part);
        ASSERT_OK(taut_world_destroy(world));
    }

    // Corners of the parts' triangles.
    void bake(const taut_decomposition_def& def) {
        parts.resize(def.max_parts);
        uint32_t count = 0;
        const taut_result result = taut_bake_decomposition(&def, nullptr, parts.data(), def.max_parts, &count, &info);
        parts.resize(count);
        ASSERT_OK(result);
        ASSERT_EQ(count, info.parts);
        ASSERT_GE(count, 1u);
        for (const taut_baked part : parts) {
            taut_shape shape;
            ASSERT_OK(taut_world_add_baked(world, part, &shape));
            shapes.push_back(shape);
            uint32_t points = 0;
            taut_shape_get_triangles(shape, nullptr, 0, &points);
            std::vector<taut_vec3> corners(points);
            ASSERT_OK(taut_shape_get_triangles(shape, corners.data(), points, &points));
            hulls.push_back(corners);
        }
    }
    // How far a point is over the faces of the nearest part; negative within.
    double over_union(const taut_vec3& p) const {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& hull : hulls) {
            double most = -std::numeric_limits<double>::infinity();
            for (size_t i = 0; i < hull.size(); i += 3) most = std::max(most, height(p, &hull[i]));
            least = std::min(least, most);
        }
        return least;
    }
    static double height(const taut_vec3& p, const taut_vec3* t) {
        const double u[3] = {double(t[1].x) - double(t[0].x), double(t[1].y) - double(t[0].y),
                             double(t[1].z) - double(t[0].z)},
                     v[3] = {double(t[2].x) - double(t[0].x), double(t[2].y) - double(t[0].y),
                             double(t[2].z) - double(t[0].z)};
        const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const double size = std::hypot(n[0], n[1], n[2]);
        if (!(size > 0)) return -std::numeric_limits<double>::infinity();
        return (n[0] * (double(p.x) - double(t[0].x)) + n[1] * (double(p.y) - double(t[0].y)) +
                n[2] * (double(p.z) - double(t[0].z))) /
               size;
    }
    // Of the union, by points of a grid.
    double volume(taut_vec3 low, taut_vec3 high, int n) const {
        uint64_t within = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                for (int k = 0; k < n; ++k) {
                    const auto at = [&](float lo, float hi, int m) {
                        return lo + (hi - lo) * (float(m) + 0.5f) / float(n);
                    };
                    if (over_union({at(low.x, high.x, i), at(low.y, high.y, j), at(low.z, high.z, k)}) <= 0) ++within;
                }
        return double(within) * double(high.x - low.x) * double(high.y - low.y) * double(high.z - low.z) /
               (double(n) * n * n);
    }
    template <class Act>
    void for_surface_points(Act&& act) const {
        std::mt19937 random(3);
        const auto unit = [&] { return static_cast<float>(random() % 4096) / 4096; };
        for (const auto& hull : hulls)
            for (size_t i = 0; i < hull.size(); i += 3)
                for (int k = 0; k < 40; ++k) {
                    float a = unit(), b = unit();
                    if (a + b > 1) a = 1 - a, b = 1 - b;
                    const taut_vec3 &p = hull[i], &q = hull[i + 1], &r = hull[i + 2];
                    act(taut_vec3{p.x + a * (q.x - p.x) + b * (r.x - p.x), p.y + a * (q.y - p.y) + b * (r.y - p.y),
                                  p.z + a * (q.z - p.z) + b * (r.z - p.z)});
                }
    }

    taut_world world{};
    std::vector<taut_baked> parts;
    std::vector<taut_shape> shapes;
    std::vector<std::vector<taut_vec3>> hulls;
    taut_decomposition_info info{};
};

TEST_F(Decomposition, TorusStaysWithinItsTolerance) {
    constexpr double kBig = 1, kSmall = 0.3, kTolerance = 0.06;
    const Triangles mesh = torus(kBig, kSmall, 96, 40);
    taut_decomposition_def def = mesh.def();
    def.tolerance = static_cast<float>(kTolerance);
    bake(def);
    EXPECT_LE(info.departure, kTolerance);
    EXPECT_LE(info.shortfall, kTolerance);
    // The mesh lies within its torus, by the sag of its facets.
    const double sag = (kBig + kSmall) * (1 - std::cos(kTorusPi / 96)) + kSmall * (1 - std::cos(kTorusPi / 40));
    double most = 0, short_of = 0;
    for_surface_points([&](const taut_vec3& p) { most = std::max(most, torus_distance(p, kBig, kSmall)); });
    for (const taut_vec3& p : mesh.vertices) short_of = std::max(short_of, over_union(p));
    EXPECT_LE(most, kTolerance);
    EXPECT_GT(most, 0.3 * kTolerance);
    EXPECT_LE(most, static_cast<double>(info.departure) + sag);
    EXPECT_LE(short_of, static_cast<double>(info.shortfall) + 1e-3);
    // Volumes: of the mesh by the information, of the union between that and the torus grown by the tolerance.
    const double solid = 2 * kTorusPi * kTorusPi * kBig * kSmall * kSmall;
    EXPECT_NEAR(static_cast<double>(info.solid.mass), solid, 0.01 * solid);
    const double own = volume({-1.4f, -0.4f, -1.4f}, {1.4f, 0.4f, 1.4f}, 48);
    EXPECT_GT(own, 0.97 * solid);
    EXPECT_LT(own, solid * std::pow(1 + kTolerance / kSmall, 2));
    EXPECT_LE(info.parts, 24u);
}

TEST_F(Decomposition, RodFallsThroughATorus) {
    const Triangles mesh = torus(1, 0.3, 64, 24);
    bake(mesh.def());
    taut_body_def ring_def;
    taut_body_def_init(&ring_def);
    ring_def.kind = TAUT_BODY_STATIC;
    taut_body ring;
    ASSERT_OK(taut_world_add_body(world, &ring_def, &ring));
    for (const taut_shape shape : shapes) {
        taut_collider_def collider;
        taut_collider_def_init(&collider);
        collider.shape = shape;
        taut_collider out;
        ASSERT_OK(taut_body_add_collider(ring, &collider, &out));
    }
    taut_capsule_def capsule;
    taut_capsule_def_init(&capsule);
    capsule.radius = 0.5f;  // the hole's is 0.7
    capsule.half_length = 1;
    taut_body_def rod_def;
    taut_body_def_init(&rod_def);
    ASSERT_OK(taut_world_add_capsule(world, &capsule, &rod_def.shape));
    rod_def.position = {0, 3, 0};
    taut_body rod, ball;
    ASSERT_OK(taut_world_add_body(world, &rod_def, &rod));
    taut_sphere_def sphere;
    taut_sphere_def_init(&sphere);
    sphere.radius = 0.8f;  // which does not fit
    taut_body_def ball_def;
    taut_body_def_init(&ball_def);
    ASSERT_OK(taut_world_add_sphere(world, &sphere, &ball_def.shape));
    ball_def.position = {0, 40, 0};
    ASSERT_OK(taut_world_add_body(world, &ball_def, &ball));
    for (int i = 0; i < 480; ++i) ASSERT_OK(taut_world_step(world));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(rod, &pose));
    EXPECT_LT(pose.position.y, -10);
    EXPECT_NEAR(pose.position.x, 0, 1e-3);
    ASSERT_OK(taut_body_get_pose(ball, &pose));
    EXPECT_GT(pose.position.y, 0);
}

TEST_F(Decomposition, StairsBecomeBoxes) {
    const Triangles mesh = stairs(4);
    taut_decomposition_def def = mesh.def();
    def.tolerance = 0.05f;
    bake(def);
    EXPECT_EQ(info.parts, 4u);
    EXPECT_LE(info.departure, 0.05f);
    EXPECT_NEAR(volume({-0.51f, -0.51f, -0.51f}, {4.49f, 4.49f, 1.49f}, 60), 10, 0.5);
    EXPECT_NEAR(static_cast<double>(info.solid.mass), 10, 1e-4);
    for_surface_points([&](const taut_vec3& p) {
        const float step = std::floor(p.x), over = p.y - (4 - step);
        EXPECT_LE(std::min(over, p.x - step), 0.05f) << p.x << ' ' << p.y;
    });
}

TEST_F(Decomposition, WhatIsConvexIsOnePart) {
    Triangles mesh;
    put_box(mesh, {-1, -2, -3}, {1, 2, 3});
    for (const bool inside_out : {false, true}) {
        if (inside_out) mesh.turn_inside_out();
        hulls.clear(), shapes.clear();
        for (const taut_baked part : parts) taut_baked_release(part);
        bake(mesh.def());
        EXPECT_EQ(info.parts, 1u);
        EXPECT_LE(info.departure, 6 / 40.f);
        EXPECT_NEAR(static_cast<double>(info.solid.mass), 48, 1e-4);
        EXPECT_NEAR(static_cast<double>(info.solid.inertia.xx), 48 / 3. * (4 + 9), 1e-2);
        EXPECT_NEAR(volume({-2, -4, -6}, {2, 4, 6}, 40), 48, 1e-9);
    }
}

TEST_F(Decomposition, CrossingBoxesAreOneSolid) {
    Triangles mesh;
    put_box(mesh, {-3, -0.5f, -0.5f}, {3, 0.5f, 0.5f});
    put_box(mesh, {-0.5f, -3, -0.5f}, {0.5f, 3, 0.5f});
    taut_decomposition_def def = mesh.def();
    def.tolerance = 0.1f;
    bake(def);
    EXPECT_LE(info.parts, 3u);
    EXPECT_NEAR(volume({-4, -4, -1}, {4, 4, 1}, 64), 11, 0.2);
    EXPECT_LE(info.departure, 0.1f);
}

TEST_F(Decomposition, HolesAreClosedOnDemand) {
    Triangles mesh;
    put_box(mesh, {0, 0, 0}, {1, 1, 1});
    mesh.indices.resize(mesh.indices.size() - 6);  // a face
    taut_decomposition_def def = mesh.def();
    taut_baked out[32];
    uint32_t count = 77;
    EXPECT_EQ(taut_bake_decomposition(&def, nullptr, out, 32, &count, nullptr), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "open at 4 edges"));
    EXPECT_EQ(count, 77u);
    def.close_holes = 1;
    bake(def);
    EXPECT_EQ(info.open_edges, 4u);
    EXPECT_NEAR(static_cast<double>(info.solid.mass), 1, 1e-5);
    EXPECT_NEAR(volume({-1, -1, -1}, {2, 2, 2}, 30), 1, 1e-9);
}

TEST_F(Decomposition, KeepsToTheNumberOfParts) {
    const Triangles mesh = torus(1, 0.2, 48, 16);
    taut_decomposition_def def = mesh.def();
    def.tolerance = 0.01f;
    def.max_parts = 3;
    def.max_vertices = 20;
    bake(def);
    EXPECT_LE(info.parts, 3u);
    EXPECT_GT(info.departure, 0.01f);  // and says so
    for (const auto& hull : hulls) {
        std::vector<std::array<float, 3>> corners;
        for (const taut_vec3& p : hull) corners.push_back({p.x, p.y, p.z});
        std::sort(corners.begin(), corners.end());
        EXPECT_LE(std::unique(corners.begin(), corners.end()) - corners.begin(), 20);
    }
    for (const taut_vec3& p : mesh.vertices) EXPECT_LE(over_union(p), static_cast<double>(info.shortfall) + 1e-3);
}

TEST_F(Decomposition, IsTheSameOnAnyThread) {
    const Triangles mesh = torus(1, 0.3, 40, 16);
    const taut_decomposition_def def = mesh.def();
    bake(def);
    const auto first = hulls;
    std::vector<std::vector<taut_baked>> others(2, std::vector<taut_baked>(32));
    std::vector<uint32_t> counts(2);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 2; ++i)
        threads.emplace_back(
            [&, i] { EXPECT_OK(taut_bake_decomposition(&def, nullptr, others[i].data(), 32, &counts[i], nullptr)); });
    for (std::thread& thread : threads) thread.join();
    for (size_t i = 0; i < 2; ++i) {
        ASSERT_EQ(counts[i], first.size());
        for (size_t k = 0; k < first.size(); ++k) {
            taut_shape shape;
            ASSERT_OK(taut_world_add_baked(world, others[i][k], &shape));
            uint32_t points = 0;
            taut_shape_get_triangles(shape, nullptr, 0, &points);
            ASSERT_EQ(points, first[k].size());
            std::vector<taut_vec3> corners(points);
            ASSERT_OK(taut_shape_get_triangles(shape, corners.data(), points, &points));
            EXPECT_EQ(std::memcmp(corners.data(), first[k].data(), points * sizeof(taut_vec3)), 0);
            ASSERT_OK(taut_baked_release(others[i][k]));
        }
    }
}

TEST_F(Decomposition, RefusesWhatItCannotTake) {
    Triangles mesh;
    put_box(mesh, {0, 0, 0}, {1, 1, 1});
    taut_baked out[32];
    uint32_t count = 5;
    const auto refused = [&](taut_result expected, const char* text, auto&& change) {
        taut_decomposition_def def = mesh.def();
        change(def);
        EXPECT_EQ(taut_bake_decomposition(&def, nullptr, out, 32, &count, nullptr), expected) << text;
        EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
    };
    using Def = taut_decomposition_def;
    refused(TAUT_STRUCT_SIZE, "struct_size", [](Def& def) { def.struct_size = 0; });
    refused(TAUT_NULL_POINTER, "vertices", [](Def& def) { def.vertices = nullptr; });
    refused(TAUT_NULL_POINTER, "indices", [](Def& def) { def.indices = nullptr; });
    refused(TAUT_INVALID_ARGUMENT, "vertex_count", [](Def& def) { def.vertex_count = 3; });
    refused(TAUT_INVALID_ARGUMENT, "indices", [](Def& def) { def.vertex_count = 7; });
    refused(TAUT_INVALID_ARGUMENT, "triangle_count", [](Def& def) { def.triangle_count = 0; });
    refused(TAUT_INVALID_ARGUMENT, "tolerance", [](Def& def) { def.tolerance = NAN; });
    refused(TAUT_INVALID_ARGUMENT, "tolerance", [](Def& def) { def.tolerance = 1e-4f; });
    refused(TAUT_INVALID_ARGUMENT, "max_parts", [](Def& def) { def.max_parts = 257; });
    refused(TAUT_INVALID_ARGUMENT, "max_vertices", [](Def& def) { def.max_vertices = 3; });
    refused(TAUT_INVALID_ARGUMENT, "close_holes", [](Def& def) { def.close_holes = 2; });
    refused(TAUT_INVALID_ARGUMENT, "reserved", [](Def& def) { def.reserved = 1; });
    EXPECT_EQ(count, 5u);
    refused(TAUT_TOO_SMALL, "capacity", [](Def& def) { def.max_parts = 33; });
    EXPECT_EQ(count, 33u);
    mesh.vertices[3].x = NAN;
    refused(TAUT_INVALID_ARGUMENT, "vertices", [](Def&) {});
    mesh.vertices[3].x = 1;
    std::swap(mesh.indices[0], mesh.indices[1]);  // one triangle that looks inward
    refused(TAUT_INVALID_ARGUMENT, "open at 3 edges", [](Def&) {});
    std::swap(mesh.indices[0], mesh.indices[1]);
    for (taut_vec3& p : mesh.vertices) p.y = 0;
    refused(TAUT_INVALID_ARGUMENT, "no volume", [](Def&) {});
    for (taut_vec3& p : mesh.vertices) p = {1, 1, 1};
    refused(TAUT_INVALID_ARGUMENT, "no triangle", [](Def&) {});
}

TEST_F(Decomposition, LeavesNothingBehindWithoutMemory) {
    const Triangles mesh = torus(1, 0.3, 16, 8);
    taut_decomposition_def def = mesh.def();
    def.max_parts = 4;
    uint64_t all = 0;
    for (uint64_t fail = 0;; fail = fail == 0 ? 1 : fail + std::max<uint64_t>(1, all / 12)) {
        Ledger ledger;
        ledger.fail_from = fail == 0 ? UINT64_MAX : fail;
        const taut_hooks hooks = ledger.hooks();
        const taut_allocator allocator = {hooks.allocate, hooks.free, hooks.memory_user_data};
        taut_baked out[4];
        uint32_t count = 0;
        const taut_result result = taut_bake_decomposition(&def, &allocator, out, 4, &count, nullptr);
        if (fail == 0) {
            ASSERT_OK(result);
            all = ledger.calls;
            for (uint32_t i = 0; i < count; ++i) ASSERT_OK(taut_baked_release(out[i]));
        } else {
            ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << fail;
            ASSERT_EQ(count, 0u);
        }
        ASSERT_TRUE(ledger.empty()) << fail;
        ASSERT_EQ(ledger.errors, 0u);
        if (fail + all / 12 > all) break;
    }
}

}  // namespace
