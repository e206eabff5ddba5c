// Mass, bounds and hulls against formulas, sums over tetrahedra and sampled supports.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "collision/hull.h"
#include "collision_oracle.h"
#include "starts.h"

namespace taut::collision {
namespace {

using oracle::Random;

constexpr uint32_t kSeed = 20240611;

std::vector<Vec3f> cube_points(float half) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(Vec3f(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
    return points;
}

// ---------------------------------------------------------------- mass

// Moments by midpoint quadrature over a grid: independent of every formula in use.
MassProperties by_quadrature(const Shape& shape, double density, double reach, int cells) {
    const double h = 2 * reach / cells;
    const Placement still{Vec3::Zero(), Mat3f::Identity()};
    MassProperties out;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            for (int k = 0; k < cells; ++k) {
                const Vec3 p = Vec3(i + 0.5, j + 0.5, k + 0.5) * h - Vec3::Constant(reach);
                const double distance = oracle::distance_at_least(shape, still, p);
                // Cells on the surface count in part.
                const double part = std::clamp(0.5 - distance / h, 0.0, 1.0);
                out.mass += part;
                first += part * p;
                second += part * p * p.transpose();
            }
        }
    }
    const double cell = density * h * h * h;
    out.mass *= cell;
    out.centre = cell * first / out.mass;
    second = cell * second - out.mass * out.centre * out.centre.transpose();
    out.inertia = Sym3::of(second.trace() * Mat3::Identity() - second);
    return out;
}

TEST(CollisionMass, RoundShapesMatchQuadrature) {
    for (const Shape& shape : {oracle::sphere(0.5f), oracle::capsule(0.3f, 0.4f), oracle::capsule(0.5f, 0.05f)}) {
        const double reach = shape.size.x() + shape.size.y() + 0.05;
        const MassProperties want = by_quadrature(shape, 800, reach, 80);
        const MassProperties got = mass_properties(shape, 800);
        EXPECT_NEAR(got.mass, want.mass, 2e-3 * want.mass);
        EXPECT_TRUE(got.inertia.matrix().isApprox(want.inertia.matrix(), 4e-3)) << got.inertia.matrix() << "\n\n"
                                                                                << want.inertia.matrix();
    }
}

TEST(CollisionMass, TurnedShapesMatchQuadrature) {
    for (const Shape& shape : {oracle::cylinder(0.3f, 0.4f), oracle::cylinder(0.5f, 0.1f), oracle::cone(0.4f, 0.5f),
                               oracle::cone(0.5f, 0.3f), oracle::tapered_capsule(0.4f, 0.3f, 0.15f),
                               oracle::tapered_capsule(0.1f, 0.25f, 0.45f)}) {
        const double reach = shape.size.maxCoeff() + shape.size.y() + 0.05;
        const MassProperties want = by_quadrature(shape, 800, reach, 100);
        const MassProperties got = mass_properties(shape, 800);
        EXPECT_NEAR(got.mass, want.mass, 3e-3 * want.mass) << oracle::name(shape.kind);
        EXPECT_LT((got.centre - want.centre).norm(), 1e-3) << oracle::name(shape.kind);
        EXPECT_TRUE(got.inertia.matrix().isApprox(want.inertia.matrix(), 6e-3)) << oracle::name(shape.kind);
    }
}

// m r^2 / 2 and m (3 r^2 + H^2) / 12 of a cylinder; 3/10 m r^2 and 3/20 m r^2 + 3/80 m H^2 of a cone, whose centre lies
// H / 4 above its base; a tapered capsule of one radius is a capsule.
TEST(CollisionMass, TurnedShapesAreExact) {
    constexpr double kPi = 3.14159265358979323846, kRadius = 0.5, kHeight = 1.5;
    const MassProperties cylinder = mass_properties(oracle::cylinder(0.5f, 0.75f), 10);
    EXPECT_NEAR(cylinder.mass, 10 * kPi * kRadius * kRadius * kHeight, 1e-12);
    EXPECT_NEAR(cylinder.inertia.yy, 0.5 * cylinder.mass * kRadius * kRadius, 1e-12);
    EXPECT_NEAR(cylinder.inertia.xx, cylinder.mass * (3 * kRadius * kRadius + kHeight * kHeight) / 12, 1e-12);
    const MassProperties cone = mass_properties(oracle::cone(0.5f, 0.75f), 10);
    EXPECT_NEAR(cone.mass, cylinder.mass / 3, 1e-12);
    EXPECT_NEAR(cone.centre.y(), -0.75 + kHeight / 4, 1e-12);
    EXPECT_NEAR(cone.inertia.yy, 0.3 * cone.mass * kRadius * kRadius, 1e-12);
    EXPECT_NEAR(cone.inertia.xx, cone.mass * (0.15 * kRadius * kRadius + 0.0375 * kHeight * kHeight), 1e-12);
    const MassProperties tapered = mass_properties(oracle::tapered_capsule(0.25f, 0.5f, 0.25f), 10);
    const MassProperties capsule = mass_properties(oracle::capsule(0.25f, 0.5f), 10);
    EXPECT_NEAR(tapered.mass, capsule.mass, 1e-12);
    EXPECT_TRUE(tapered.inertia.matrix().isApprox(capsule.inertia.matrix(), 1e-12));
}

TEST(CollisionMass, BoxIsExact) {
    const MassProperties got = mass_properties(oracle::box(0.5f, 1.0f, 1.5f), 10);
    EXPECT_DOUBLE_EQ(got.mass, 10 * 1 * 2 * 3);
    EXPECT_NEAR(got.inertia.xx, 60.0 / 12 * (4 + 9), 1e-12);
    EXPECT_NEAR(got.inertia.yy, 60.0 / 12 * (1 + 9), 1e-12);
    EXPECT_NEAR(got.inertia.zz, 60.0 / 12 * (1 + 4), 1e-12);
    EXPECT_EQ(got.inertia.xy, 0);
    EXPECT_EQ(mass_properties(oracle::plane(Vec3f::UnitY()), 10).mass, 0);
}

// A box given as points, shifted and turned: parallel axes and rotation of the analytic answer.
TEST(CollisionMass, HullOfTurnedBoxMatchesBox) {
    Random random(kSeed);
    for (int run = 0; run < 20; ++run) {
        const Vec3f half(float(random.uniform(0.1, 1)), float(random.uniform(0.1, 1)), float(random.uniform(0.1, 1)));
        const Mat3f turn = random.rotation();
        const Vec3f shift = (2 * random.unit()).cast<float>();
        std::vector<Vec3f> points;
        for (const Vec3f& p : cube_points(1)) points.push_back(turn * p.cwiseProduct(half) + shift);
        const Shape hull = oracle::hull(points);
        ASSERT_TRUE(hull.hull);
        const MassProperties box = mass_properties(oracle::box(half.x(), half.y(), half.z()), 500);
        const MassProperties got = mass_properties(hull, 500);
        const Mat3 r = turn.cast<double>();
        EXPECT_NEAR(got.mass, box.mass, 1e-5 * box.mass);
        EXPECT_TRUE(got.centre.isApprox(shift.cast<double>(), 1e-5));
        EXPECT_TRUE(got.inertia.matrix().isApprox(r * box.inertia.matrix() * r.transpose(), 1e-4));
    }
}

TEST(CollisionMass, RandomHullMatchesQuadrature) {
    Random random(kSeed + 1);
    const Shape hull = oracle::random_shape(ShapeKind::hull, random);
    const MassProperties want = by_quadrature(hull, 1000, 0.8, 64);
    const MassProperties got = mass_properties(hull, 1000);
    EXPECT_NEAR(got.mass, want.mass, 0.02 * want.mass);
    EXPECT_LT((got.centre - want.centre).norm(), 0.003);
    EXPECT_TRUE(got.inertia.matrix().isApprox(want.inertia.matrix(), 0.03));
}

// ---------------------------------------------------------------- bounds

TEST(CollisionBounds, TouchTheShapeOnEverySide) {
    Random random(kSeed + 2);
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::sphere, ShapeKind::capsule, ShapeKind::hull,
                                 ShapeKind::cylinder, ShapeKind::cone, ShapeKind::tapered_capsule}) {
        for (int run = 0; run < runs(100); ++run) {
            const Shape shape = oracle::random_shape(kind, random);
            const double far = run % 2 == 0 ? 1 : 10000;
            const Placement at{far * random.unit(), random.rotation()};
            const oracle::Core core = oracle::core(shape, at);
            const Box box = bounds(shape, at);
            const double ulp = far * 2.4e-7 + 1e-6;
            for (int k = 0; k < 3; ++k) {
                const double hi = core.reach(Vec3::Unit(k)) + core.radius;
                const double lo = -core.reach(-Vec3::Unit(k)) - core.radius;
                EXPECT_GE(box.hi[k], hi - 1e-6) << oracle::name(kind);
                EXPECT_LE(box.hi[k], hi + ulp) << oracle::name(kind);
                EXPECT_LE(box.lo[k], lo + 1e-6) << oracle::name(kind);
                EXPECT_GE(box.lo[k], lo - ulp) << oracle::name(kind);
            }
        }
    }
}

// ---------------------------------------------------------------- hulls

// Scaling keeps the surface: faces, their normals turned by the inverse factors, and the volume's product.
TEST(CollisionHull, ScaledHullKeepsItsFaces) {
    Random random(kSeed + 9);
    for (int run = 0; run < 50; ++run) {
        const Shape source = oracle::random_shape(ShapeKind::hull, random);
        Vec3f factors;
        for (int k = 0; k < 3; ++k) factors[k] = float(random.uniform(0.3, 3)) * (random.uniform(0, 1) < 0.5 ? -1 : 1);
        const char* reason = "";
        Shape scaled;
        scaled.kind = ShapeKind::hull;
        scaled.hull = scale_hull(*source.hull, factors, 1e-3f, &reason, oracle::memory());
        ASSERT_TRUE(scaled.hull) << reason;
        EXPECT_EQ(scaled.hull->faces.size(), source.hull->faces.size());
        EXPECT_EQ(scaled.hull->edges.size(), source.hull->edges.size());
        EXPECT_GT(scaled.hull->inner_radius, 0);
        const double volume = mass_properties(source, 1).mass * double(std::fabs(factors.prod()));
        EXPECT_NEAR(mass_properties(scaled, 1).mass, volume, 1e-4 * volume);
        for (const Vec3f& v : source.hull->vertices) {
            const Vec3f there = v.cwiseProduct(factors);
            float nearest = 1e30f;
            for (const Vec3f& p : scaled.hull->vertices) nearest = std::min(nearest, (p - there).norm());
            EXPECT_EQ(nearest, 0);
        }
    }
    const Shape cube = oracle::hull(cube_points(0.5f));
    const char* reason = "";
    EXPECT_FALSE(scale_hull(*cube.hull, Vec3f(1, 1e-3f, 1), 2e-3f, &reason, oracle::memory()));
    EXPECT_STREQ(reason, "hull is thinner than allowed");
}

TEST(CollisionHull, CubeWithInnerPointsIsACube) {
    Random random(kSeed + 3);
    std::vector<Vec3f> points = cube_points(0.5f);
    for (int i = 0; i < 200; ++i) points.push_back((random.uniform(0, 0.49) * random.unit()).cast<float>());
    for (int i = 0; i < 50; ++i) {  // on faces and edges
        points.push_back(Vec3f(float(random.uniform(-0.5, 0.5)), 0.5f, float(random.uniform(-0.5, 0.5))));
        points.push_back(Vec3f(0.5f, -0.5f, float(random.uniform(-0.5, 0.5))));
    }
    for (const bool turned : {false, true}) {
        const Mat3f turn = turned ? random.rotation() : Mat3f(Mat3f::Identity());
        for (Vec3f& p : points) p = turn * p;
        const Shape shape = oracle::hull(points);
        ASSERT_TRUE(shape.hull);
        EXPECT_EQ(shape.hull->vertices.size(), 8u);
        EXPECT_EQ(shape.hull->faces.size(), 6u);
        EXPECT_EQ(shape.hull->edges.size(), 12u);
    }
}

// Closed, convex, outward, and every edge between its two faces.
void check_hull(const Hull& hull, double tolerance) {
    const Polytope p = hull.view();
    EXPECT_EQ(p.vertices.size() + p.faces.size(), p.edges.size() + 2);
    for (const Face& face : p.faces) {
        EXPECT_NEAR(face.normal.norm(), 1, 1e-5);
        EXPECT_GT(face.offset, face.normal.dot(p.centre));
        for (const Vec3f& v : p.vertices) EXPECT_LE(face.normal.dot(v), face.offset);
        for (const int corner : p.loop_of(face)) {
            EXPECT_NEAR(face.normal.dot(p.vertices[size_t(corner)]), face.offset, tolerance);
        }
    }
    for (const Edge& edge : p.edges) {
        const Vec3f across = p.faces[edge.left].normal.cross(p.faces[edge.right].normal);
        EXPECT_GT(across.dot(p.direction(edge)), 0);
    }
}

TEST(CollisionHull, SpherePointsAreReducedWithLittleLoss) {
    Random random(kSeed + 4);
    std::vector<Vec3f> points;
    for (int i = 0; i < 1000; ++i) points.push_back(random.unit().cast<float>());
    const Shape shape = oracle::hull(points);
    ASSERT_TRUE(shape.hull);
    EXPECT_LE(shape.hull->vertices.size(), 64u);
    EXPECT_GE(shape.hull->vertices.size(), 60u);
    check_hull(*shape.hull, 1e-3);
    const double volume = mass_properties(shape, 1).mass;
    // 64 points spread evenly span 0.884 of the ball; ours must lose no more than 16 %.
    EXPECT_GT(volume, 0.84 * 4.18879);
    EXPECT_LT(volume, 4.18879);
    for (const int most : {4, 8, 20}) {
        const auto small = build_hull(points, most, 1e-3f, nullptr, oracle::memory());
        ASSERT_TRUE(small);
        EXPECT_LE(int(small->vertices.size()), most);
        check_hull(*small, 1e-3);
    }
}

TEST(CollisionHull, RandomHullsAreConvexAndOrderedByThePointsAlone) {
    Random random(kSeed + 5);
    for (int run = 0; run < 200; ++run) {
        std::vector<Vec3f> points;
        const Vec3 stretch(random.uniform(0.02, 2), random.uniform(0.02, 2), random.uniform(0.02, 2));
        const int count = int(random.uniform(5, 60));
        for (int i = 0; i < count; ++i) points.push_back(random.unit().cwiseProduct(stretch).cast<float>());
        const char* reason = "";
        const auto hull = build_hull(points, 64, 1e-3f, &reason, oracle::memory());
        ASSERT_TRUE(hull) << run << ": " << reason;
        check_hull(*hull, 2e-3);
        for (const Vec3f& p : points) {
            for (const Face& face : hull->faces) ASSERT_LT(face.normal.dot(p) - face.offset, 2e-3) << run;
        }
        std::vector<Vec3f> reversed(points.rbegin(), points.rend());
        reversed.push_back(points[0]);
        const auto again = build_hull(reversed, 64, 1e-3f, nullptr, oracle::memory());
        ASSERT_TRUE(again);
        EXPECT_TRUE(std::ranges::equal(hull->vertices, again->vertices));
        EXPECT_TRUE(std::ranges::equal(hull->loops, again->loops));
    }
}

// Sheets 1 to 6 mm thick and up to 20 km wide, whose corners single precision leaves hardly room for.
TEST(CollisionHull, FlatOnesAreNeverInsideOut) {
    Random random(29);
    std::vector<std::vector<Vec3f>> given = {
        {{-10.6641645f, -33.2903099f, -11.9818182f},
         {-17.7835293f, -24.3827572f, 11.1626091f},
         {15.7900658f, 28.8209877f, -2.7204051f},
         {2.77933121f, 23.8778515f, 18.3323898f}},
        {{3566, 6986, -147}, {1352, 8, -2696}, {-1192, 312, 2695}, {-2594, -5573, -385}}};
    for (int i = 0; i < starts(30000); ++i) {
        const Mat3 rotation = random.rotation().cast<double>();
        const double wide = std::pow(10, random.uniform(-1, 3.7)), thick = std::pow(10, random.uniform(-3.3, -2.5));
        given.emplace_back();
        const int count = 4 + int(random.uniform(0, 12));
        for (int k = 0; k < count; ++k) {
            const Vec3 p(random.uniform(-wide, wide), random.uniform(-wide, wide), random.uniform(-thick, thick));
            given.back().push_back((rotation * p).cast<float>());
        }
    }
    int built = 0;
    for (const auto& points : given) {
        Shape shape;
        shape.kind = ShapeKind::hull;
        shape.hull = build_hull(points, 64, 1e-3f, nullptr, oracle::memory());
        if (!shape.hull) continue;
        ++built;
        const MassProperties mass = mass_properties(shape, 1000);
        ASSERT_GT(mass.mass, 0);
        ASSERT_GT(mass.inertia.matrix().determinant(), 0);
        for (const Face& face : shape.hull->faces)
            ASSERT_GT(face.offset, face.normal.dot(shape.hull->centre)) << points.size();
    }
    EXPECT_GT(3 * built, starts(30000));
}

TEST(CollisionHull, PrismKeepsItsPolygons) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 32; ++i) {
        const double angle = 2 * 3.14159265358979 * i / 32;
        for (const float y : {-0.5f, 0.5f}) points.push_back(Vec3f(float(std::cos(angle)), y, float(std::sin(angle))));
    }
    const Shape shape = oracle::hull(points);
    ASSERT_TRUE(shape.hull);
    EXPECT_EQ(shape.hull->vertices.size(), 64u);
    EXPECT_EQ(shape.hull->faces.size(), 34u);
    check_hull(*shape.hull, 1e-5);
}

TEST(CollisionHull, FlatHullsKeepTheirRim) {
    Random random(kSeed + 6);
    for (int run = 0; run < 50; ++run) {
        const Mat3f turn = random.rotation();
        std::vector<Vec3f> points;
        for (const Vec3f& p : cube_points(1)) points.push_back(turn * p.cwiseProduct(Vec3f(1, 0.01f, 1)));
        const Shape shape = oracle::hull(points);
        ASSERT_TRUE(shape.hull) << run;
        EXPECT_EQ(shape.hull->vertices.size(), 8u) << run;
        EXPECT_EQ(shape.hull->faces.size(), 6u) << run;
    }
}

// From thin to the thinnest that is a hull, as wide as single precision allows and wider.
TEST(CollisionHull, ThinWideHullsAreNotInsideOut) {
    Random random(kSeed + 8);
    int made = 0;
    for (int run = 0; run < starts(3000); ++run) {
        const double wide = std::pow(10, random.uniform(-2, 4)), thick = random.uniform(1e-3, 2e-3);
        const double narrow = run % 3 ? wide : 0.01 * wide;
        const Mat3f turn = random.rotation();
        std::vector<Vec3f> points;
        for (int count = int(random.uniform(4, 20)); count > 0; --count) {
            const float x = float(random.uniform(-wide, wide)), y = float(random.uniform(-0.7, 0.7) * thick);
            points.push_back(turn * Vec3f(x, y, float(random.uniform(-narrow, narrow))));
        }
        const Shape shape = oracle::hull(points);
        if (!shape.hull) continue;
        ++made;
        const MassProperties mass = mass_properties(shape, 1000);
        const Sym3& i = mass.inertia;
        EXPECT_GT(shape.hull->inner_radius, 0) << run;
        EXPECT_GT(mass.mass, 0) << run;
        EXPECT_GT(i.xx, 0) << run;
        EXPECT_GT(i.xx * i.yy - i.xy * i.xy, 0) << run;
        EXPECT_GT(i.matrix().determinant(), 0) << run;
    }
    EXPECT_GT(made, starts(1000));
}

TEST(CollisionHull, RefusesWhatHasNoVolume) {
    Random random(kSeed + 7);
    const auto refused = [](const std::vector<Vec3f>& points) {
        const char* reason = nullptr;
        const auto hull = build_hull(points, 64, 1e-3f, &reason, oracle::memory());
        EXPECT_FALSE(hull);
        return std::string(reason ? reason : "no reason");
    };
    EXPECT_EQ(refused({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}), "fewer than 4 points");
    EXPECT_EQ(refused(std::vector<Vec3f>(10, Vec3f(1, 2, 3))), "fewer than 4 distinct points");
    std::vector<Vec3f> flat, line, tiny;
    const Mat3f turn = random.rotation();
    for (int i = 0; i < 30; ++i) {
        const float x = float(random.uniform(-1, 1)), y = float(random.uniform(-1, 1));
        flat.push_back(turn * Vec3f(x, y, 0));
        line.push_back(turn * Vec3f(x, 0, 0));
        tiny.push_back((1e-4 * random.unit()).cast<float>());
    }
    EXPECT_EQ(refused(flat), "points lie in one plane");
    EXPECT_EQ(refused(line), "points lie on one line");
    EXPECT_EQ(refused(tiny), "points lie in one place");
    std::vector<Vec3f> broken = cube_points(1);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        broken[3].y() = bad;
        EXPECT_EQ(refused(broken), "a point is not finite");
    }
    EXPECT_TRUE(build_hull(cube_points(1), 64, 1e-3f, nullptr, oracle::memory()));
}

TEST(CollisionLibrary, BulletIsSinglePrecision) { EXPECT_TRUE(precision_matches()); }

}  // namespace
}  // namespace taut::collision
