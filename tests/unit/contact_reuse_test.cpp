// Contacts that are not asked for again, against the narrowphase asked in full at the same poses.
#include "detect/reuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "collision_oracle.h"
#include "detect/detect.h"

namespace taut::test {
namespace {

using collision::Manifold;
using collision::Shape;
using collision::ShapeKind;
using collision::oracle::Random;

struct Pose {
    Vec3 x = Vec3::Zero();
    Quat q = Quat::Identity();
};

Vec3 within(Random& random, double length) { return random.uniform(0, length) * random.unit(); }

constexpr float kReuseMargin = kContactMargin;

// Two bodies of one shape each.
struct Couple {
    Memory memory{taut_hooks{}};
    Nodes nodes{memory};
    Colliders colliders{memory};
    Shapes shapes{memory};
    Pairs pairs{memory};
    Pair pair;
    NearPair near;
    collision::PairCache cache;

    Couple(const Shape& a, const Shape& b) {
        for (const Shape& shape : {a, b}) {
            ColliderPlan collider;
            collider.node = nodes.add();
            nodes.info[collider.node].kind = NodeKind::dynamic;
            collider.shape = shapes.add(shape);
            colliders.reserve_one();
            colliders.add(collider);
        }
        pairs.placement.resize(2);
        pairs.stance.resize(2);
        pairs.travel.assign(2, Travel{.margin = kReuseMargin});
        pair.key = near.key = pair_key(0, 1);
        pair.a = 0, pair.b = 1;
    }

    const Shape& shape(uint32_t i) const { return shapes[i].shape; }
    float size() const { return std::min(shapes[0].size, shapes[1].size); }
    void place(uint32_t i, const Pose& pose) {
        nodes.motion[i].x = pose.x;
        nodes.motion[i].q = pose.q;
        place_collider(nodes, shapes, colliders.record[i], 0, pairs, i);
    }
    float find(float margin, Manifold& out) {
        return collision::collide(shape(0), pairs.placement[0], shape(1), pairs.placement[1], margin, cache, out);
    }
};

// The direction from a to b that makes them part in the end.
Vec3 apart_along(const Couple& couple, Random& random) {
    for (const uint32_t i : {0u, 1u}) {
        if (couple.shape(i).kind != ShapeKind::plane) continue;
        const Vec3 up = (couple.pairs.placement[i].rotation * couple.shape(i).size).cast<double>();
        return i == 0 ? up : Vec3(-up);
    }
    return random.unit();
}

// Puts b so that the two are about as near as the margin, or overlap by up to twice that; false if they do not touch.
bool bring_together(Couple& couple, Random& random) {
    Pose a, b;
    a.q = rotation_from_vector(within(random, 3));
    b.q = rotation_from_vector(within(random, 3));
    couple.place(0, a);
    couple.place(1, b);
    const Vec3 along = apart_along(couple, random);
    double touching = 0, parted = 20;
    for (int i = 0; i < 16; ++i) {
        const double middle = 0.5 * (touching + parted);
        b.x = middle * along;
        couple.place(1, b);
        Manifold m;
        couple.cache = {};
        couple.find(kReuseMargin, m);
        (m.count > 0 ? touching : parted) = middle;
    }
    b.x = (touching - random.uniform(0, 0.04)) * along;
    couple.place(1, b);
    couple.cache = {};
    couple.find(kReuseMargin, couple.pair.manifold);
    return couple.pair.manifold.count > 0;
}

// Both go somewhere else together, and b a little on its own: up to `little` [m], turned by as much of the smaller
// size.
void move(Couple& couple, Random& random, double little) {
    const Quat turn = rotation_from_vector(within(random, 3));
    const Vec3 way = within(random, 100);
    for (const uint32_t i : {0u, 1u})
        couple.place(i, {way + turn * couple.nodes.motion[i].x, turn * couple.nodes.motion[i].q});
    const auto turned = rotation_from_vector(within(random, little / static_cast<double>(couple.size())));
    Manifold& m = couple.pair.manifold;
    const Vec3 pivot = couple.nodes.motion[0].x + turn * m.points[0].position.cast<double>();
    const NodeMotion& b = couple.nodes.motion[1];
    couple.place(1, {pivot + turned * (b.x - pivot) + within(random, little), turned * b.q});
}

float deepest_of(const Manifold& m) {
    float least = 1e30f;
    for (int k = 0; k < m.count; ++k) least = std::min(least, m.points[k].separation);
    return least;
}

class ReusedPairs : public testing::TestWithParam<std::tuple<int, int>> {
protected:
    ShapeKind one() const { return ShapeKind(std::get<0>(GetParam())); }
    ShapeKind other() const { return ShapeKind(std::get<1>(GetParam())); }
};

// The deepest_of point is as deep as found in full, within the bound of reuse.h, and so are nearly all. One in a
// hundred of shapes that are some mm apart, and one in some thousands that touch, is told up to 2.5 mm off, by which
// one axis is taken for another.
TEST_P(ReusedPairs, AreAsFoundInFull) {
    Random random(static_cast<uint32_t>(17 + 8 * std::get<0>(GetParam()) + std::get<1>(GetParam())));
    int reused = 0, tried = 0, others = 0, points = 0, beyond = 0, off_apart = 0, off_touching = 0;
    double sum = 0;
    for (int round = 0; round < 300; ++round) {
        Couple couple(random_shape(one(), random), random_shape(other(), random));
        if (!bring_together(couple, random)) continue;
        ASSERT_TRUE(keep_manifold(couple.pairs, 1.0 / 60, couple.pair));
        const float slide = std::min(5e-5f, 1e-3f * couple.size());
        ++tried;
        move(couple, random, 0.6 * static_cast<double>(slide));
        if (!reuse_manifold(couple.pairs, 1.0 / 60, couple.pair)) continue;
        ++reused;
        Manifold full;
        couple.find(kReuseMargin + slide, full);
        const Manifold& m = couple.pair.manifold;
        if (full.count == 0) {  // corner to corner, nearness is no contact yet
            EXPECT_GT(deepest_of(m), 0) << round;
            ++off_apart;
            continue;
        }
        const float off = std::abs(deepest_of(m) - deepest_of(full));
        EXPECT_LE(off, 2.6e-3f) << round;
        (deepest_of(full) > 1e-3f ? off_apart : off_touching) += off > slide;
        if (m.normal.dot(full.normal) < 0.999f) {
            ++others;  // another axis of two about as good
            continue;
        }
        for (int k = 0; k < m.count; ++k)
            for (int i = 0; i < full.count; ++i)
                if (full.points[i].feature == m.points[k].feature) {
                    const float moved = std::abs(full.points[i].separation - m.points[k].separation);
                    beyond += moved > slide;
                    sum += static_cast<double>(moved / slide);
                    ++points;
                }
    }
    EXPECT_GE(2 * reused, tried);
    EXPECT_LE(20 * others, reused);
    EXPECT_LE(100 * off_apart, reused);
    EXPECT_LE(off_touching, 1);
    EXPECT_LE(40 * beyond, points);  // cut off where faces lie steeply to each other
    EXPECT_LE(sum, 0.25 * points);
}

// A pair that is said to stay clear gets no points wherever it goes.
TEST_P(ReusedPairs, StayClearWhileTheyAre) {
    Random random(static_cast<uint32_t>(91 + 8 * std::get<0>(GetParam()) + std::get<1>(GetParam())));
    int clear = 0;
    for (int round = 0; round < 40; ++round) {
        Couple couple(random_shape(one(), random), random_shape(other(), random));
        if (!bring_together(couple, random)) continue;
        const Vec3 along = couple.nodes.motion[1].x.normalized();
        NodeMotion& b = couple.nodes.motion[1];
        couple.place(1, {b.x + random.uniform(0.05, 0.3) * along, b.q});
        for (int step = 0; step < 60; ++step) {
            const bool said = stay_clear(couple.pairs, couple.near);
            clear += said;
            Manifold m;
            const float gap = couple.find(kReuseMargin, m);
            EXPECT_FALSE(said && m.count > 0);
            if (!said) note_clear(couple.pairs, gap, couple.near);
            couple.place(
                1, {b.x - 0.005 * along + within(random, 0.005), rotation_from_vector(within(random, 0.01)) * b.q});
        }
    }
    const bool told = one() != ShapeKind::plane || other() < ShapeKind::cylinder;
    EXPECT_TRUE(!told || clear > 100) << clear;
}

// No more than the exact distance, and more than the margin.
TEST_P(ReusedPairs, GapIsNoMoreThanTheDistance) {
    if (one() == ShapeKind::plane) GTEST_SKIP() << "the exact distance knows no planes";
    Random random(static_cast<uint32_t>(5 + 8 * std::get<0>(GetParam()) + std::get<1>(GetParam())));
    for (int round = 0; round < 60; ++round) {
        Couple couple(random_shape(one(), random), random_shape(other(), random));
        couple.place(0, {Vec3::Zero(), rotation_from_vector(within(random, 3))});
        couple.place(1, {within(random, 4), rotation_from_vector(within(random, 3))});
        for (int ask = 0; ask < 2; ++ask) {  // the second time along the axis that parted them
            Manifold m;
            const float gap = couple.find(kReuseMargin, m);
            if (m.count > 0 || gap == 0) break;
            EXPECT_GT(gap, kReuseMargin);
            const auto core = [&](uint32_t i) {
                return collision::oracle::core(couple.shape(i), couple.pairs.placement[i]);
            };
            const double exact = collision::oracle::separation(core(0), core(1));
            EXPECT_LE(static_cast<double>(gap), 1.002 * exact + 1e-4);  // that of round shapes is a search's
        }
    }
}

std::vector<std::tuple<int, int>> kind_pairs() {
    std::vector<std::tuple<int, int>> all;
    for (int a = 0; a < collision::kConvexKinds; ++a)
        for (int b = std::max(a, 1); b < collision::kConvexKinds; ++b) all.emplace_back(a, b);
    return all;
}
INSTANTIATE_TEST_SUITE_P(Kinds, ReusedPairs, testing::ValuesIn(kind_pairs()), [](const auto& test) {
    const auto named = [](int kind) { return std::string(collision::oracle::name(ShapeKind(kind))); };
    std::string name = named(std::get<0>(test.param)) + "_" + named(std::get<1>(test.param));
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

TEST(Reuse, EndsWhereThePairMovesFastOrTurns) {
    const auto pair_of_boxes = [] {
        return Couple(collision::oracle::box(0.5f, 0.5f, 0.5f), collision::oracle::box(0.5f, 0.5f, 0.5f));
    };
    struct Case {
        Vec3 way, turn, velocity, spin;
        bool reused;
    };
    const Vec3 zero = Vec3::Zero(), x = Vec3::UnitX();
    for (const Case& c : {Case{zero, zero, zero, zero, true}, Case{4e-5 * x, zero, zero, zero, true},
                          Case{6e-5 * x, zero, zero, zero, false}, Case{zero, 3e-5 * x, zero, zero, true},
                          Case{zero, 2e-4 * x, zero, zero, false}, Case{zero, zero, 0.05 * x, zero, true},
                          Case{zero, zero, 0.07 * x, zero, false}, Case{zero, zero, zero, 0.2 * x, false}}) {
        Couple couple = pair_of_boxes();
        couple.place(0, {});
        couple.place(1, {Vec3(0, 0.999, 0), Quat::Identity()});
        couple.find(kReuseMargin, couple.pair.manifold);
        ASSERT_EQ(couple.pair.manifold.count, 4);
        ASSERT_TRUE(keep_manifold(couple.pairs, 1.0 / 60, couple.pair));
        couple.nodes.motion[1].v = c.velocity;
        couple.nodes.motion[1].w = c.spin;
        couple.place(1, {Vec3(0, 0.999, 0) + c.way, rotation_from_vector(c.turn)});
        EXPECT_EQ(reuse_manifold(couple.pairs, 1.0 / 60, couple.pair), c.reused);
    }
}

}  // namespace
}  // namespace taut::test
