// Contacts that can be worked out by hand: how many points, where, and what happens in the corner cases.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "collision/manifold.h"
#include "collision_oracle.h"
#include "starts.h"

namespace taut::collision {
namespace {

using oracle::Random;

constexpr float kMargin = 0.02f;
const Mat3f kUpright = Mat3f::Identity();

Mat3f turned(const Vec3& vector) { return rotation_from_vector(vector).toRotationMatrix().cast<float>(); }

Manifold collide_at(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    PairCache cache;
    Manifold out;
    collide(a, at_a, b, at_b, kMargin, cache, out);
    return out;
}

Manifold collide_above(const Shape& below, const Shape& above, const Vec3& position,
                       const Mat3f& rotation = Mat3f::Identity()) {
    return collide_at(below, {Vec3::Zero(), kUpright}, above, {position, rotation});
}

Shape cube_hull(float half) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(Vec3f(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
    return oracle::hull(points);
}

Shape hull_of(const Shape& box) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(box.size.cwiseProduct(Vec3f(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return oracle::hull(points);
}

// Every expected point is there, in any order.
void expect_points(const Manifold& m, const std::vector<Vec3f>& expected, float tolerance) {
    ASSERT_EQ(m.count, int(expected.size()));
    for (const Vec3f& want : expected) {
        float nearest = 1e30f;
        for (int i = 0; i < m.count; ++i) nearest = std::min(nearest, (m.points[i].position - want).norm());
        EXPECT_LT(nearest, tolerance) << want.transpose();
    }
}

// ---------------------------------------------------------------- counts and places

TEST(CollisionContacts, BoxOnBoxStandsOnTheOverlapsCorners) {
    const std::vector<Vec3f> corners = {Vec3f(-0.2f, 0.5f, -0.1f), Vec3f(-0.2f, 0.5f, 0.5f), Vec3f(0.5f, 0.5f, -0.1f),
                                        Vec3f(0.5f, 0.5f, 0.5f)};
    for (const Shape& below : {oracle::box(0.5f, 0.5f, 0.5f), cube_hull(0.5f)}) {
        for (const Shape& above : {oracle::box(0.5f, 0.5f, 0.5f), cube_hull(0.5f)}) {
            const Manifold m = collide_above(below, above, Vec3(0.3, 0.99, 0.4));
            EXPECT_LT((m.normal - Vec3f::UnitY()).norm(), 1e-5f);
            expect_points(m,
                          {corners[0] - Vec3f(0, 0.005f, 0), corners[1] - Vec3f(0, 0.005f, 0),
                           corners[2] - Vec3f(0, 0.005f, 0), corners[3] - Vec3f(0, 0.005f, 0)},
                          1e-4f);
            for (int i = 0; i < m.count; ++i) EXPECT_NEAR(m.points[i].separation, -0.01f, 1e-5f);
        }
    }
}

TEST(CollisionContacts, NearBoxesGiveSpeculativePoints) {
    const Shape cube = oracle::box(0.5f, 0.5f, 0.5f);
    const Manifold near = collide_above(cube, cube, Vec3(0, 1.015, 0));
    EXPECT_EQ(near.count, 4);
    for (int i = 0; i < near.count; ++i) EXPECT_NEAR(near.points[i].separation, 0.015f, 1e-5f);
    EXPECT_EQ(collide_above(cube, cube, Vec3(0, 1.025, 0)).count, 0);
}

TEST(CollisionContacts, CrossedBoxesKeepFourWideSpreadPoints) {
    const Shape cube = oracle::box(0.5f, 0.5f, 0.5f);
    const Manifold m = collide_above(cube, cube, Vec3(0, 0.99, 0), turned(Vec3(0, 0.7853982, 0)));
    ASSERT_EQ(m.count, 4);
    Vec3f sum = Vec3f::Zero();
    for (int i = 0; i < 4; ++i) {
        sum += m.points[i].position;
        EXPECT_GT(Eigen::Vector2f(m.points[i].position.x(), m.points[i].position.z()).norm(), 0.5f);
    }
    EXPECT_LT(Eigen::Vector2f(sum.x(), sum.z()).norm(), 1.2f);  // not all on one side
}

TEST(CollisionContacts, EdgeAcrossEdgeIsOnePoint) {
    const Shape beam = oracle::box(0.1f, 0.1f, 1.0f);
    const double diagonal = 0.1 * std::sqrt(2.0);
    const Mat3f on_edge = turned(Vec3(0, 0, 0.7853982));
    const Mat3f across = turned(Vec3(0, 1.5707963, 0)) * on_edge;
    const Manifold m =
        collide_at(beam, {Vec3::Zero(), on_edge}, beam, {Vec3(0.05, 2 * diagonal - 0.004, 0.03), across});
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, -0.004f, 1e-4f);
    EXPECT_LT((m.normal - Vec3f::UnitY()).norm(), 1e-4f);
    EXPECT_LT((m.points[0].position - Vec3f(0, float(diagonal) - 0.002f, 0.03f)).norm(), 1e-3f);
}

// A link of a chain over the rim of a table, twisted a little: its lower side misses the rim's far ends by more than
// the table's own sides do, yet it is that side which lies on the rim, from one of its long edges to the other.
TEST(CollisionContacts, TwistedBeamOverALongRimTouchesOnBothSides) {
    const Shape boxes[2] = {oracle::box(4, 2.5f, 2), oracle::box(0.15f, 0.03f, 0.03f)};
    const Shape hulls[2] = {hull_of(boxes[0]), hull_of(boxes[1])};
    for (const Shape* shape : {boxes, hulls})
        for (double steep : {20.0, 45.0, 64.0, 75.0})
            for (double twist : {-4.0, -2.0, 2.0, 4.0}) {
                SCOPED_TRACE(testing::Message() << (shape == boxes ? "boxes " : "hulls ") << steep << ", " << twist);
                constexpr double kDegree = 0.017453292519943295, kDeep = 0.012;
                const Mat3f down = turned(Vec3(0, 0, -steep * kDegree));
                const Mat3f rotation = down * turned(Vec3(twist * kDegree, 0, 0));
                const Vec3 out = down.col(1).cast<double>();
                const Placement table = {Vec3::Zero(), kUpright},
                                beam = {Vec3(4, 2.5, 0) + (0.03 - kDeep) * out, rotation};
                for (const bool swapped : {false, true}) {
                    const Manifold m = swapped ? collide_at(shape[1], beam, shape[0], table)
                                               : collide_at(shape[0], table, shape[1], beam);
                    float least = 0, most = 0;  // along the rim
                    for (int i = 0; i < m.count; ++i) {
                        const Vec3f p = swapped ? Vec3f(rotation * m.points[i].position) : m.points[i].position;
                        least = std::min(least, p.z()), most = std::max(most, p.z());
                        EXPECT_LT(m.points[i].separation, 0);
                    }
                    EXPECT_GE(m.count, 2);
                    EXPECT_LT(least, -0.025f);
                    EXPECT_GT(most, 0.025f);
                }
            }
}

// A link that comes down on a table with its end at the rim tilts over it, twisted a little and some tenths of a
// millimetre deep. It overlaps the table less beyond the rim's side than below its top then, but lies on the rim.
TEST(CollisionContacts, LinkThatTiltsOverTheRimDoesNotCatchOnIt) {
    constexpr double kHalf = 0.15, kThick = 0.03;
    const Shape boxes[2] = {oracle::box(4, 2.5f, 2), oracle::box(float(kHalf), float(kThick), float(kThick))};
    for (const bool hulls : {false, true}) {
        const Shape table = hulls ? hull_of(boxes[0]) : boxes[0], link = hulls ? hull_of(boxes[1]) : boxes[1];
        PairCache cache;
        Random random(5);
        for (int step = 0; step < 40; ++step) {
            const double angle = 0.002 * step, twist = 0.004 * random.uniform(-1, 1);
            const Mat3f rotation = turned(Vec3(0, 0, -angle)) * turned(Vec3(twist, 0, 0));
            // The end's middle stays over the rim, at x = 0 and y = 0, once it has come down.
            const Vec3 end(0, kThick + (step == 0 ? 1e-3 : -3e-4), 0);
            const Placement at = {end + rotation.cast<double>() * Vec3(kHalf, 0, 0), rotation};
            Manifold m;
            collide(table, {Vec3(-4, -2.5, 0), kUpright}, link, at, kMargin, cache, m);
            ASSERT_GT(m.count, 0) << step;
            EXPECT_GT(m.normal.y(), 0.9f) << (hulls ? "hulls, " : "boxes, ") << angle << " rad";
        }
    }
}

TEST(CollisionContacts, CapsuleLiesOnTwoPoints) {
    const Shape capsule = oracle::capsule(0.2f, 0.4f);
    const Mat3f lying = turned(Vec3(0, 0, 1.5707963));
    for (const Shape& ground : {oracle::plane(Vec3f::UnitY()), oracle::box(2, 0.5f, 2), cube_hull(1.0f)}) {
        const float top = ground.kind == ShapeKind::plane ? 0.0f : ground.kind == ShapeKind::box ? 0.5f : 1.0f;
        const Manifold m = collide_above(ground, capsule, Vec3(0.1, double(top) + 0.195, 0.2), lying);
        expect_points(m, {Vec3f(-0.3f, top - 0.0025f, 0.2f), Vec3f(0.5f, top - 0.0025f, 0.2f)}, 1e-4f);
        EXPECT_LT((m.normal - Vec3f::UnitY()).norm(), 1e-4f);
        EXPECT_EQ(collide_above(ground, capsule, Vec3(0, double(top) + 0.595, 0)).count, 1) << "standing";
    }
}

TEST(CollisionContacts, CapsuleOverTheRimTouchesAtTheRim) {
    const Manifold m = collide_above(oracle::box(0.5f, 0.5f, 0.5f), oracle::capsule(0.1f, 0.4f), Vec3(0.5, 0.595, 0),
                                     turned(Vec3(0, 0, 1.5707963)));
    expect_points(m, {Vec3f(0.1f, 0.4975f, 0), Vec3f(0.5f, 0.4975f, 0)}, 1e-4f);
}

TEST(CollisionContacts, CapsulesSideBySideTouchAlongALine) {
    const Shape capsule = oracle::capsule(0.2f, 0.5f);
    const Manifold along = collide_above(capsule, capsule, Vec3(0.39, 0.3, 0));
    expect_points(along, {Vec3f(0.195f, -0.2f, 0), Vec3f(0.195f, 0.5f, 0)}, 1e-4f);
    EXPECT_EQ(collide_above(capsule, capsule, Vec3(0.39, 0, 0), turned(Vec3(1.2, 0, 0))).count, 1);
    EXPECT_EQ(collide_above(capsule, capsule, Vec3(0.39, 1.0, 0)).count, 1) << "end beside end";
}

TEST(CollisionContacts, BoxOnPlaneOnFaceEdgeAndCorner) {
    const Shape ground = oracle::plane(Vec3f::UnitY());
    for (const Shape& cube : {oracle::box(0.5f, 0.5f, 0.5f), cube_hull(0.5f)}) {
        EXPECT_EQ(collide_above(ground, cube, Vec3(0, 0.495, 0)).count, 4);
        EXPECT_EQ(collide_above(ground, cube, Vec3(0, 0.705, 0), turned(Vec3(0.7853982, 0, 0))).count, 2);
        const Mat3f on_corner = turned(Vec3(0.6154797, 0, 0)) * turned(Vec3(0, 0, 0.7853982));
        EXPECT_EQ(collide_above(ground, cube, Vec3(0, 0.865, 0), on_corner).count, 1);
    }
}

TEST(CollisionContacts, PlanesNeverTouch) {
    const Shape up = oracle::plane(Vec3f::UnitY());
    EXPECT_EQ(collide_above(up, up, Vec3::Zero()).count, 0);
}

// ---------------------------------------------------------------- scale and distance

TEST(CollisionContacts, SizesFromCentimetresToKilometres) {
    for (const float half : {0.005f, 0.05f, 0.5f, 5.0f, 50.0f}) {
        const Shape cube = oracle::box(half, half, half);
        const Manifold m = collide_above(cube, cube, Vec3(0.2, 1.99, 0.1) * double(half));
        ASSERT_EQ(m.count, 4) << half;
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(m.points[i].separation, -0.01f * half, 1e-5f * half);
        const Manifold on_ground =
            collide_above(oracle::box(500, 500, 500), cube, Vec3(123.4, 500 + 0.99 * double(half), -321));
        ASSERT_EQ(on_ground.count, 4) << half;
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(on_ground.points[i].separation, -0.01f * half, 2e-4f);
    }
}

// The plane's own origin stays behind while the box is far out on it.
TEST(CollisionContacts, PlaneIsExactFarFromItsOrigin) {
    Random random(99);
    const Shape ground = oracle::plane(Vec3f(0, 0, 1));
    const Shape cube = oracle::box(0.5f, 0.5f, 0.5f);
    for (int run = 0; run < 50; ++run) {
        const Vec3 position(random.uniform(-3e4, 3e4), random.uniform(-3e4, 3e4), 0.4875);
        const Manifold m = collide_at(cube, {position, kUpright}, ground, {Vec3::Zero(), kUpright});
        ASSERT_EQ(m.count, 4);
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(m.points[i].separation, -0.0125f, 1e-6f);
            EXPECT_LT(std::fabs(std::fabs(m.points[i].position.x()) - 0.5f), 1e-5f);
        }
    }
}

// ---------------------------------------------------------------- ids

// Equal boxes stacked flush: corners, edges and sides all coincide, and still every id must stay.
TEST(CollisionContacts, FlushStackKeepsItsIdsWhileItJitters) {
    Random random(7);
    for (const Shape& below : {oracle::box(0.5f, 0.5f, 0.5f), cube_hull(0.5f)}) {
        for (const Shape& above : {oracle::box(0.5f, 0.5f, 0.5f), cube_hull(0.5f)}) {
            PairCache cache;
            std::set<uint32_t> ids;
            for (int step = 0; step < 300; ++step) {
                const Vec3 at = Vec3(0, 0.998, 0) + 3e-4 * random.unit();
                Manifold m;
                collide(below, {Vec3::Zero(), turned(2e-4 * random.unit())}, above, {at, turned(2e-4 * random.unit())},
                        kMargin, cache, m);
                ASSERT_EQ(m.count, 4);
                for (int i = 0; i < 4; ++i) ids.insert(m.points[i].feature);
            }
            EXPECT_EQ(ids.size(), 4u);
        }
    }
}

// Of two that lie crosswise on each other, lean and rock by a millimetre.
TEST(CollisionContacts, ContactOfManyPointsKeepsThoseThatItHad) {
    Random random(19);
    int changes = 0, changes_without = 0;
    for (int run = 0; run < 300; ++run) {
        const Shape shapes[3] = {oracle::cylinder(0.28f, 0.15f), oracle::box(0.2f, 0.15f, 0.25f), cube_hull(0.15f)};
        const Shape &below = shapes[run % 3], &above = shapes[run / 3 % 3];
        const Vec3 beside(random.uniform(-0.15, 0.15), 0.299, random.uniform(-0.15, 0.15));
        const double turn = random.uniform(0, 3);
        const Vec3 leaning = 8e-3 * random.unit();
        PairCache cache, cache_without;
        Manifold had;
        std::set<uint32_t> last, last_without;
        for (int step = 0; step < 20; ++step) {
            const Mat3f tilt = turned(leaning + 2e-3 * random.unit());
            const Placement at_b{beside + 5e-4 * random.unit(), tilt * turned(Vec3(0, turn, 0))};
            Manifold without;
            collide(below, {Vec3::Zero(), kUpright}, above, at_b, kMargin, cache, had);
            collide(below, {Vec3::Zero(), kUpright}, above, at_b, kMargin, cache_without, without);
            ASSERT_GT(had.count, 0);
            EXPECT_LT(deepest(had), deepest(without) + 1.01e-3f) << "seed 19 run " << run;
            const auto features = [](const Manifold& m) {
                std::set<uint32_t> ids;
                for (int i = 0; i < m.count; ++i) ids.insert(m.points[i].feature);
                return ids;
            };
            const std::set<uint32_t> now = features(had), now_without = features(without);
            changes += step > 0 && now != last;
            changes_without += step > 0 && now_without != last_without;
            last = now;
            last_without = now_without;
        }
    }
    std::printf("sets of points changed %d times, without memory %d times\n", changes, changes_without);
    EXPECT_LT(2 * changes, changes_without);
}

// Where the patch moves on, the points follow it: none that they had keeps a contact narrow.
TEST(CollisionContacts, PointsFollowAPatchThatMoves) {
    const Shape plank = oracle::box(1, 0.1f, 0.3f), box = oracle::box(0.2f, 0.1f, 0.25f);
    PairCache cache;
    Manifold had;
    for (int step = 0; step <= 400; ++step) {
        const Vec3 at(-1.1 + 2.2 * step / 400, 0.1995, 0.1);
        Manifold without;
        PairCache fresh;
        const Placement at_b{at, turned(Vec3(0, 0.5, 0))};
        collide(plank, {Vec3::Zero(), kUpright}, box, at_b, kMargin, cache, had);
        collide(plank, {Vec3::Zero(), kUpright}, box, at_b, kMargin, fresh, without);
        const auto width = [](const Manifold& m) {
            float most = 0;
            for (int i = 0; i < m.count; ++i)
                for (int j = 0; j < i; ++j) most = std::max(most, (m.points[i].position - m.points[j].position).norm());
            return most;
        };
        EXPECT_GT(width(had), 0.75f * width(without)) << "step " << step;
    }
}

// Asked again where they stand, two touch at the same points.
TEST(CollisionContacts, PairThatStandsKeepsAllItsPoints) {
    Random random(17);
    int touching = 0, on_many = 0;
    for (int run = 0; run < runs(40000); ++run) {
        const Shape a = oracle::random_shape(ShapeKind(1 + run % 4), random);
        const Shape b = oracle::random_shape(ShapeKind(1 + run / 4 % 4), random);
        const Placement at_a{Vec3::Zero(), random.rotation()};
        const Placement at_b{random.uniform(0.2, 0.9) * random.unit(), random.rotation()};
        PairCache cache;
        Manifold first, again;
        collide(a, at_a, b, at_b, kMargin, cache, first);
        if (first.count == 0 || deepest(first) < -0.02f) continue;
        ++touching;
        on_many += first.count > 1;
        collide(a, at_a, b, at_b, kMargin, cache, again);
        ASSERT_EQ(again.count, first.count) << "seed 17 run " << run;
        for (int i = 0; i < first.count; ++i) {
            EXPECT_EQ(again.points[i].feature, first.points[i].feature) << "seed 17 run " << run;
            EXPECT_LT((again.points[i].position - first.points[i].position).norm(), 1e-5f) << "seed 17 run " << run;
        }
    }
    EXPECT_GT(touching, runs(1000));
    EXPECT_GT(on_many, runs(250));
}

// Ridges that cross turn parallel, less at a time than the pair would look anew for, and have no normal of their own.
TEST(CollisionContacts, EdgesThatTurnParallelLeaveTheirContact) {
    Random random(23);
    int touching = 0;
    for (int run = 0; run < 200; ++run) {
        const float steep = float(random.uniform(1, 4)), length = float(random.uniform(0.3, 2));
        std::vector<Vec3f> points;
        for (const float x : {-length, length})
            for (const Vec3f& corner : {Vec3f(x, 0, 0), Vec3f(x, -0.2f * steep, 0.2f), Vec3f(x, -0.2f * steep, -0.2f)})
                points.push_back(corner);
        const Shape roof = oracle::hull(points);
        const Vec3 at(0, random.uniform(-0.01, 0.015), 0);
        const Quat over(Eigen::AngleAxisd(3.14159265358979, Vec3::UnitX()));
        PairCache cache;
        Manifold out;
        for (double angle = 2e-3; angle > -2e-3; angle -= random.uniform(0, 2e-5)) {
            const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
            collide(roof, {Vec3::Zero(), kUpright}, roof, {at, (turn * over).toRotationMatrix().cast<float>()}, kMargin,
                    cache, out);
            if (out.count == 0) continue;
            ++touching;
            ASSERT_NEAR(out.normal.norm(), 1, 1e-5) << "seed 23 run " << run << " angle " << angle;
        }
    }
    EXPECT_GT(touching, 20000);
}

// The cache is a hint: whatever it holds, the same overlap is found.
TEST(CollisionContacts, ForeignCacheDoesNoHarm) {
    Random random(11);
    for (int run = 0; run < 2000; ++run) {
        const Shape a = oracle::random_shape(ShapeKind(1 + run % 4), random);
        const Shape b = oracle::random_shape(ShapeKind(1 + run / 4 % 4), random);
        const Placement at_a{Vec3::Zero(), random.rotation()};
        const Placement at_b{0.3 * random.unit(), random.rotation()};
        PairCache cache;
        for (uint32_t& word : cache.words) word = uint32_t(random.uniform(0, 4294967295.0));
        Manifold m;
        collide(a, at_a, b, at_b, kMargin, cache, m);
        if (oracle::separation(oracle::core(a, at_a), oracle::core(b, at_b)) < -1e-4) {
            EXPECT_GT(m.count, 0) << "seed 11 run " << run;
        }
    }
}

// Whatever axis is on record as the one that parted the pair, two that overlap do touch.
TEST(CollisionContacts, NoAxisOnRecordHidesAnOverlap) {
    Random random(12);
    int overlaps = 0;
    for (int run = 0; run < runs(4000); ++run) {
        const Shape a = oracle::random_shape(run % 2 ? ShapeKind::box : ShapeKind::hull, random);
        const Shape b = oracle::random_shape(run / 2 % 2 ? ShapeKind::box : ShapeKind::hull, random);
        const Placement at_a{Vec3::Zero(), random.rotation()};
        const Placement at_b{random.uniform(0.3, 0.9) * random.unit(), random.rotation()};
        if (oracle::separation(oracle::core(a, at_a), oracle::core(b, at_b)) > -1e-4) continue;
        ++overlaps;
        PairCache cache;
        // A kind of axis and a feature of each, numbers that every box and hull has.
        const auto number = [&](double most) { return uint32_t(random.uniform(0, most)); };
        cache.words[0] = number(16) | number(6) << 8 | number(6) << 16;
        Manifold m;
        collide(a, at_a, b, at_b, kMargin, cache, m);
        EXPECT_GT(m.count, 0) << "seed 12 run " << run;
    }
    EXPECT_GT(overlaps, runs(1000));
}

// Of many low corners four are kept, and none that is left out lies more than a millimetre deeper.
TEST(CollisionContacts, HullOnAPlaneStandsOnItsDeepestCorner) {
    Random random(13);
    const Shape ground = oracle::plane(Vec3f::UnitY());
    for (int run = 0; run < 500; ++run) {
        std::vector<Vec3f> points = {Vec3f(0, 1, 0)};
        for (int i = 0; i < 12; ++i) {
            const double angle = random.uniform(0, 6.28);
            points.push_back(
                Vec3f(0.4f * float(std::cos(angle)), float(random.uniform(0, 0.01)), 0.4f * float(std::sin(angle))));
        }
        const Shape hull = oracle::hull(points);
        const Manifold m = collide_above(ground, hull, Vec3(0, -0.006, 0));
        float lowest = 1;
        for (const Vec3f& v : hull_vertices(*hull.hull)) lowest = std::min(lowest, v.y() - 0.006f);
        ASSERT_GT(m.count, 0);
        float deepest = 1;
        for (int i = 0; i < m.count; ++i) deepest = std::min(deepest, m.points[i].separation);
        EXPECT_LT(deepest, lowest + 0.00101f) << "seed 13 run " << run;
        EXPECT_GT(deepest, lowest - 1e-5f);
    }
}

// ---------------------------------------------------------------- degenerate poses

TEST(CollisionContacts, CoincidentShapesGetAUnitNormal) {
    Random random(5);
    for (int a = 1; a < kConvexKinds; ++a) {
        for (int b = 1; b < kConvexKinds; ++b) {
            for (int run = 0; run < 20; ++run) {
                const Shape shape_a =
                    ShapeKind(a) == ShapeKind::hull ? cube_hull(0.4f) : oracle::random_shape(ShapeKind(a), random);
                const Shape shape_b =
                    ShapeKind(b) == ShapeKind::hull ? cube_hull(0.4f) : oracle::random_shape(ShapeKind(b), random);
                const Mat3f rotation = run == 0 ? kUpright : random.rotation();
                const Placement at{Vec3(1, 2, 3), kUpright};
                for (const bool mapped : {false, true}) {
                    Manifold m = collide_at(shape_a, at, shape_b, {at.position, rotation});
                    if (mapped) collide_support_mapped(shape_a, at, shape_b, {at.position, rotation}, kMargin, m);
                    ASSERT_GT(m.count, 0) << oracle::name(shape_a.kind) << " " << oracle::name(shape_b.kind);
                    EXPECT_NEAR(m.normal.norm(), 1, 1e-4);
                    float least = 1;
                    for (int i = 0; i < m.count; ++i) {
                        EXPECT_TRUE(m.points[i].position.allFinite());
                        least = std::min(least, m.points[i].separation);
                    }
                    EXPECT_LT(least, 0);
                }
            }
        }
    }
}

// ---------------------------------------------------------------- support mapped

// MPR's depth is never less than the true one, and its direction frees the pair.
TEST(CollisionSupportMapped, FindsEveryOverlapAndFreesIt) {
    const uint32_t seed = 31;
    Random random(seed);
    double excess = 0, depths = 0;
    int overlaps = 0;
    for (int run = 0; run < runs(4000); ++run) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << " run " << run);
        const Shape a = oracle::random_shape(ShapeKind(1 + run % 4), random);
        const Shape b = oracle::random_shape(ShapeKind(1 + run / 4 % 4), random);
        const Placement at_a{Vec3::Zero(), random.rotation()};
        const Placement at_b{random.uniform(0.3, 1.2) * random.unit(), random.rotation()};
        const double want = oracle::separation(oracle::core(a, at_a), oracle::core(b, at_b));
        Manifold m;
        collide_support_mapped(a, at_a, b, at_b, kMargin, m);
        if (want > -1e-3) continue;
        ASSERT_GT(m.count, 0);
        double depth = -1e30;
        for (int i = 0; i < m.count; ++i) depth = std::max(depth, -double(m.points[i].separation));
        ++overlaps;
        excess += depth + want;
        depths -= want;
        ASSERT_GT(depth, -want - 0.012);
        const Placement freed{at_b.position + (depth + 0.012) * m.normal.cast<double>(), at_b.rotation};
        ASSERT_GT(oracle::separation(oracle::core(a, at_a), oracle::core(b, freed)), -2e-3);
    }
    EXPECT_GT(overlaps, runs(500));
    EXPECT_LT(excess, 0.15 * depths);
}

TEST(CollisionSupportMapped, ClipsFaces) {
    const Shape cube = oracle::box(0.5f, 0.5f, 0.5f);
    Manifold m;
    collide_support_mapped(cube, {Vec3::Zero(), kUpright}, cube, {Vec3(0.3, 0.99, 0.4), kUpright}, kMargin, m);
    expect_points(m,
                  {Vec3f(-0.2f, 0.495f, -0.1f), Vec3f(-0.2f, 0.495f, 0.5f), Vec3f(0.5f, 0.495f, -0.1f),
                   Vec3f(0.5f, 0.495f, 0.5f)},
                  5e-3f);
}

}  // namespace
}  // namespace taut::collision
