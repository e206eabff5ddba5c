// Cylinders, cones and tapered capsules: contacts that can be worked out by hand, from a centimetre to a hundred
// metres, and points that stay what they are while bodies tremble, turn and roll.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "collision_oracle.h"

namespace taut::collision {
namespace {

using oracle::Random;

const Mat3f kUnturned = Mat3f::Identity();
constexpr double kQuarter = 1.57079632679489662;

Mat3f turned_by(const Vec3& vector) { return rotation_from_vector(vector).toRotationMatrix().cast<float>(); }

Manifold collide_above(const Shape& below, const Shape& above, const Vec3& position, const Mat3f& rotation,
                       float margin) {
    PairCache cache;
    Manifold out;
    collide(below, {Vec3::Zero(), kUnturned}, above, {position, rotation}, margin, cache, out);
    return out;
}

float least(const Manifold& m) {
    float least = 1e30f;
    for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[i].separation);
    return least;
}

// Area of the points' hull in the horizontal plane, at least: of the triangle of the widest three.
float spread(const Manifold& m) {
    float most = 0;
    for (int i = 0; i < m.count; ++i) {
        for (int j = 0; j < i; ++j) {
            for (int k = 0; k < j; ++k) {
                const Vec3f p = m.points[j].position - m.points[i].position;
                const Vec3f q = m.points[k].position - m.points[i].position;
                most = std::max(most, 0.5f * p.cross(q).norm());
            }
        }
    }
    return most;
}

class TurnedShapes : public testing::TestWithParam<float> {
protected:
    float size() const { return GetParam(); }
    double depth() const { return 0.01 * double(size()); }
    float margin() const { return 0.02f * size(); }
    // What a body stands on, with its top at height 0.
    std::vector<std::pair<Shape, Vec3>> grounds() const {
        const float half = 4 * size();
        std::vector<Vec3f> corners;
        for (int i = 0; i < 8; ++i) {
            corners.push_back(Vec3f(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
        }
        return {{oracle::plane(Vec3f::UnitY()), Vec3::Zero()},
                {oracle::box(half, half, half), Vec3(0, half, 0)},
                {oracle::hull(corners), Vec3(0, half, 0)},
                {oracle::cylinder(half, half), Vec3(0, half, 0)}};
    }
    void expect_flat(const Manifold& m, int count) const {
        ASSERT_EQ(m.count, count);
        EXPECT_LT((m.normal - Vec3f::UnitY()).norm(), 1e-4f);
        for (int i = 0; i < m.count; ++i) EXPECT_NEAR(m.points[i].separation, -depth(), 2e-3 * depth());
    }
};

TEST_P(TurnedShapes, StandOnFourPointsOfTheirRim) {
    for (const auto& [ground, top] : grounds()) {
        for (const Shape& body : {oracle::cylinder(size(), 1.5f * size()), oracle::cone(size(), 1.5f * size())}) {
            const Vec3 at = top + Vec3(0.2 * double(size()), 1.5 * double(size()) - depth(), 0);
            const Manifold m = collide_above(ground, body, at, turned_by(Vec3(0, 0.3, 0)), margin());
            expect_flat(m, 4);
            EXPECT_GT(spread(m), 0.9f * size() * size());
        }
    }
}

TEST_P(TurnedShapes, LieOnTwoPointsOfTheirLine) {
    const float r = size(), half = 1.5f * size();
    // Down from the axis to each shape's line on the ground, and the turn that lays the line flat.
    const double cone_turn = std::atan2(double(r), 2.0 * double(half));
    const double tapered_turn = std::asin(0.5 * double(r) / (2.0 * double(half)));
    for (const auto& [ground, top] : grounds()) {
        const Manifold lying = collide_above(ground, oracle::cylinder(r, half), top + Vec3(0, double(r) - depth(), 0),
                                             turned_by(Vec3(kQuarter, 0, 0)), margin());
        expect_flat(lying, 2);
        const Manifold cone =
            collide_above(ground, oracle::cone(r, half), top + Vec3(0, double(half) * std::sin(cone_turn) - depth(), 0),
                          turned_by(Vec3(0, 0, -kQuarter - cone_turn)), margin());
        expect_flat(cone, 2);
        const Manifold tapered = collide_above(ground, oracle::tapered_capsule(r, half, 0.5f * r),
                                               top + Vec3(0, 0.75 * double(r) - depth(), 0),
                                               turned_by(Vec3(0, 0, -kQuarter - tapered_turn)), margin());
        expect_flat(tapered, 2);
    }
}

// Side by side along a line, or across each other in a point.
TEST_P(TurnedShapes, RoundSidesMeetInLinesAndPoints) {
    const float r = size(), half = 2 * size();
    const Mat3f lying = turned_by(Vec3(kQuarter, 0, 0));
    const Shape below = oracle::cylinder(r, half);
    for (const Shape& body : {oracle::cylinder(0.5f * r, half), oracle::capsule(0.5f * r, half),
                              oracle::tapered_capsule(0.5f * r, half, 0.5f * r)}) {
        const Vec3 at(0, 1.5 * double(r) - depth(), 0.7 * double(r));
        for (const bool across : {false, true}) {
            PairCache cache;
            Manifold m;
            for (int frame = 0; frame < 2; ++frame) {  // the second one starts from the first one's normal
                collide(below, {Vec3::Zero(), lying}, body, {at, across ? turned_by(Vec3(0, 0, kQuarter)) : lying},
                        margin(), cache, m);
            }
            expect_flat(m, across ? 1 : 2);
        }
    }
}

TEST_P(TurnedShapes, ApexAndRoundEndsTouchInAPoint) {
    const float r = size();
    const Mat3f over = turned_by(Vec3(2 * kQuarter, 0, 0));
    for (const auto& [ground, top] : grounds()) {
        const Manifold apex =
            collide_above(ground, oracle::cone(r, r), top + Vec3(0, double(r) - depth(), 0), over, margin());
        ASSERT_GE(apex.count, 1);
        EXPECT_NEAR(least(apex), -depth(), 2e-3 * depth());
        const Manifold end = collide_above(ground, oracle::tapered_capsule(r, r, 0.5f * r),
                                           top + Vec3(0, 2 * double(r) - depth(), 0), kUnturned, margin());
        ASSERT_EQ(end.count, 1);
        EXPECT_NEAR(least(end), -depth(), 2e-3 * depth());
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, TurnedShapes, testing::Values(0.01f, 0.1f, 1.0f, 10.0f, 100.0f));

// ---------------------------------------------------------------- from frame to frame

// Of the points' ids over a path of poses, how many a step are new.
template <class PoseAt>
double new_ids(const Shape& below, const Shape& above, int steps, PoseAt&& pose_at, int least_count) {
    PairCache cache;
    Manifold before;
    int fresh = 0, all = 0;
    for (int step = 0; step < steps; ++step) {
        Manifold now;
        collide(below, {Vec3::Zero(), kUnturned}, above, pose_at(step), 0.02f, cache, now);
        EXPECT_GE(now.count, least_count) << step;
        for (int i = 0; i < now.count && step > 0; ++i) {
            bool known = false;
            for (int k = 0; k < before.count; ++k) known |= now.points[i].feature == before.points[k].feature;
            fresh += !known;
            ++all;
        }
        before = now;
    }
    return double(fresh) / std::max(all, 1);
}

TEST(CollisionTurned, StandingCylinderKeepsItsPointsWhileItTrembles) {
    Random random(3);
    const Shape body = oracle::cylinder(0.5f, 0.5f);
    for (const Shape& below : {oracle::box(2, 0.5f, 2), oracle::cylinder(0.5f, 0.5f), oracle::cylinder(1, 0.5f)}) {
        const double fresh = new_ids(
            below, body, 300,
            [&](int) {
                return Placement{Vec3(0, 0.998, 0) + 2e-4 * random.unit(), turned_by(2e-4 * random.unit())};
            },
            4);
        EXPECT_EQ(fresh, 0) << oracle::name(below.kind);
    }
}

// A lying cylinder that rolls keeps its two ends, at the same depth all round.
TEST(CollisionTurned, RollingCylinderHasNoCorners) {
    const Shape below = oracle::box(5, 0.5f, 5);
    const Shape body = oracle::cylinder(0.5f, 0.5f);
    const auto pose = [&](int step) {
        const double angle = 0.01 * step;
        return Placement{Vec3(0.5 * angle, 0.999, 0), turned_by(Vec3(0, 0, -angle)) * turned_by(Vec3(kQuarter, 0, 0))};
    };
    EXPECT_EQ(new_ids(below, body, 700, pose, 2), 0);
    PairCache cache;
    for (int step = 0; step < 700; ++step) {
        Manifold m;
        collide(below, {Vec3::Zero(), kUnturned}, body, pose(step), 0.02f, cache, m);
        ASSERT_EQ(m.count, 2);
        for (int i = 0; i < 2; ++i) ASSERT_NEAR(m.points[i].separation, -0.001f, 2e-6f);
    }
}

// A coin that rolls over its rim stands on the rim's lowest point, whichever that is.
TEST(CollisionTurned, CoinRollsOverItsRim) {
    const Shape coin = oracle::cylinder(0.5f, 0.05f);
    for (const Shape& below : {oracle::plane(Vec3f::UnitY()), oracle::box(2, 2, 2)}) {
        const double top = below.kind == ShapeKind::plane ? 0 : 2;
        for (const double tilt : {0.01, 0.05, 0.3, 0.9}) {
            const double height = 0.5 * std::sin(tilt) + 0.05 * std::cos(tilt) - 0.001;
            const auto pose = [&](int step) {
                const double angle = 0.02 * step;
                return Placement{Vec3(0, top + height, 0), turned_by(tilt * Vec3(std::cos(angle), 0, std::sin(angle)))};
            };
            PairCache cache;
            for (int step = 0; step < 300; ++step) {
                Manifold m;
                collide(below, {Vec3::Zero(), kUnturned}, coin, pose(step), 0.02f, cache, m);
                ASSERT_GE(m.count, 1);
                ASSERT_NEAR(least(m), -0.001f, 6e-4f) << tilt << " " << step;
            }
        }
    }
}

}  // namespace
}  // namespace taut::collision
