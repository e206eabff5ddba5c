// Features of surfaces that may come near, by trees and lanes, against all pairs of features one by one.
#include "detect/near_features.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "detect/nearest.h"
#include "detect/surface_finder.h"
#include "detect/surface_tree.h"
#include "detect/untangle.h"
#include "world.h"

namespace taut::test {
namespace {

using Found = std::set<std::tuple<int, uint32_t, uint32_t>>;

// Crumpled sheets, their vertices on their ways.
class CrumpledSheets : public testing::Test {
protected:
    uint32_t add_sheet(uint32_t side, const Vec3& at, float height, uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> in(-1, 1);
        Soft soft(w_.memory);
        for (uint32_t i = 0; i <= side; ++i)
            for (uint32_t k = 0; k <= side; ++k) {
                const float x = static_cast<float>(i) / static_cast<float>(side) - 0.5f;
                const float z = static_cast<float>(k) / static_cast<float>(side) - 0.5f;
                const Vec3f place(0.5f * std::sin(7 * x),
                                  height * std::cos(9 * x) * std::cos(8 * z) + 0.01f * in(random), z);
                const uint32_t node = w_.nodes.add();
                w_.nodes.info[node].kind = NodeKind::particle;
                w_.nodes.info[node].collider = 0;
                w_.nodes.motion[node].x = at + place.cast<double>();
                w_.nodes.motion[node].v = Vec3(in(random), in(random), in(random));
                soft.node.push_back(node);
            }
        for (uint32_t i = 0; i < side; ++i)
            for (uint32_t k = 0; k < side; ++k) {
                const uint32_t a = i * (side + 1) + k, b = a + side + 1;
                for (const uint32_t vertex : {a, b, b + 1, a, b + 1, a + 1}) soft.triangle.push_back(vertex);
            }
        if (w_.shapes.count() == 0) {
            collision::Shape ball;
            ball.kind = collision::ShapeKind::sphere;
            ball.size = {0.004f, 0, 0};
            w_.shapes.add(ball);
        }
        soft.shape = 0;
        return w_.softs.add(std::move(soft));
    }
    void refit(Team& team) {
        refit_surfaces(team,
                       {w_.nodes, w_.colliders, w_.shapes, w_.softs, w_.elements, w_.pairs, w_.broadphase, kTime});
    }
    SurfaceSides sides(uint32_t a, uint32_t b) const {
        const Softs& softs = w_.softs;
        return {{&softs.record[a], &softs.record[b]},
                {&softs.mesh[a], &softs.mesh[b]},
                {a, b},
                (softs.mesh[b].origin - softs.mesh[a].origin).cast<float>(),
                {}};
    }
    Found find(Team& team, uint32_t a, uint32_t b) {
        refit(team);
        SurfaceContacts& out = w_.pairs.surfaces;
        find_near_features(team, sides(a, b), kRadii, kReach - kRadii, kTime, out);
        Found found;
        for (const NearFeature& near : out.near_feature.all())
            EXPECT_TRUE(found.emplace(static_cast<int>(near.of), near.one, near.other).second) << "twice";
        for (const SurfaceCrossing& cut : out.cut.all())
            EXPECT_TRUE(found.emplace(10 + static_cast<int>(cut.soft), cut.edge, cut.face).second) << "twice";
        return found;
    }

    // Of two surfaces, those nearer than the reach now within both features, and edges that go through faces.
    Found near_now(uint32_t a, uint32_t b) const {
        const SurfaceSides two = sides(a, b);
        Found found;
        const auto put = [&](int side, const uint32_t* of, int count, Vec3f(&x)[4], int at) {
            for (int k = 0; k < count; ++k) x[at + k] = two.place(side, of[k]);
        };
        for (int side = 0; side < 2; ++side)
            for (uint32_t v = 0; v < two.soft[side]->vertices(); ++v)
                for (uint32_t t = 0; t < two.soft[1 - side]->triangles(); ++t) {
                    Vec3f x[4];
                    put(side, &v, 1, x, 0);
                    put(1 - side, two.corners(1 - side, t), 3, x, 1);
                    const Nearest near = nearest_of_face(x);
                    if (near.inside && near.distance() < 0.999f * kReach)
                        found.emplace(side, side == 0 ? v : t, side == 0 ? t : v);
                }
        for (uint32_t e = 0; e < two.mesh[0]->edge.size(); ++e)
            for (uint32_t f = 0; f < two.mesh[1]->edge.size(); ++f) {
                Vec3f x[4];
                put(0, two.mesh[0]->edge[e].vertex, 2, x, 0);
                put(1, two.mesh[1]->edge[f].vertex, 2, x, 2);
                const Nearest near = nearest_of_segments(x);
                if (near.inside && near.distance() < 0.999f * kReach) found.emplace(2, e, f);
            }
        for (int side = 0; side < 2; ++side)
            for (uint32_t e = 0; e < two.mesh[side]->edge.size(); ++e)
                for (uint32_t t = 0; t < two.soft[1 - side]->triangles(); ++t) {
                    Vec3f x[4];
                    put(1 - side, two.corners(1 - side, t), 3, x, 0);
                    const Vec3f face[3] = {x[0], x[1], x[2]};
                    const uint32_t* vertex = two.mesh[side]->edge[e].vertex;
                    if (goes_through(two.place(side, vertex[0]), two.place(side, vertex[1]), face))
                        found.emplace(10 + static_cast<int>(two.index[side]), e, t);
                }
        return found;
    }

    static constexpr float kReach = 0.012f, kRadii = 0.008f, kTime = 1.0f / 120;
    static taut_world_def any_world() {
        taut_world_def def;
        taut_world_def_init(&def);
        return def;
    }

    World w_{any_world()};
    Team alone_{taut_hooks{}, 1}, three_{taut_hooks{}, 3};
};

TEST_F(CrumpledSheets, MissNothingThatIsNear) {
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        const double height = 0.02 * seed;
        const uint32_t a = add_sheet(14, Vec3(10, 0, 0), 0.1f, seed),
                       b = add_sheet(11, Vec3(10.1, height, 0), 0.12f, 100 + seed);
        const Found found = find(alone_, a, b), least = near_now(a, b);
        EXPECT_GT(least.size(), 100u);
        for (const auto& [of, one, other] : least)
            EXPECT_TRUE(found.contains({of, one, other})) << of << " " << one << " " << other;
    }
}

TEST_F(CrumpledSheets, FindTheSameOnMoreThreads) {
    const uint32_t a = add_sheet(40, Vec3::Zero(), 0.15f, 5);
    const Found alone = find(alone_, a, a);
    EXPECT_GT(alone.size(), 100u);
    EXPECT_EQ(find(three_, a, a), alone);
}

TEST_F(CrumpledSheets, MeetNothingOfThemselvesWhereTheyAreFlat) {
    constexpr uint32_t kSide = 30;
    const uint32_t a = add_sheet(kSide, Vec3::Zero(), 0, 6);
    const Soft& soft = w_.softs.record[a];
    for (uint32_t v = 0; v < soft.vertices(); ++v) {
        NodeMotion& motion = w_.nodes.motion[soft.node[v]];
        motion.x = 0.01 * Vec3(v / (kSide + 1), 0, v % (kSide + 1));
        motion.v = Vec3(0, -1, 0);
    }
    EXPECT_TRUE(find(alone_, a, a).empty());
}

// Advances in lanes against those one by one, in all builds.
TEST(FeatureLanes, MeetAsFeaturesOneByOne) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> in(-1, 1);
    constexpr float kPassingTime = 0.25f;  // [s]
    uint32_t met = 0;
    for (int run = 0; run < 400; ++run) {
        FeatureLanes lanes{};
        Passing passing[kLanes]{};
        lanes.both = 0.05f, lanes.margin = 0.02f, lanes.of_size = 0.1f;
        std::ranges::fill(lanes.time, kPassingTime);
        const bool edges = run % 2 != 0;
        for (int lane = 0; lane < kLanes; ++lane) {
            Passing& of = passing[lane];
            of.of = edges ? Passing::Of::edge_edge : Passing::Of::vertex_face;
            for (int i = 0; i < 4; ++i) {
                of.x[i] = 0.6f * Vec3f(in(random), in(random), in(random));
                of.v[i] = Vec3f(in(random), in(random), in(random));
                for (int k = 0; k < 3; ++k) lanes.x[i][k][lane] = of.x[i][k], lanes.v[i][k][lane] = of.v[i][k];
            }
        }
        unsigned expected = 0;
        for (int lane = 0; lane < kLanes; ++lane) {
            const float reach = std::min(lanes.both, lanes.of_size * passing[lane].size()) + lanes.margin;
            Nearest near;
            float met_after = 0;
            const bool meets = meet(passing[lane], reach, kPassingTime, near, met_after) && near.inside;
            expected |= static_cast<unsigned>(meets) << lane;
        }
        const auto all = [&](const TrianglePairKernel& kernel) {
            return edges ? kernel.meet_edges(lanes) : kernel.meet_faces(lanes);
        };
        EXPECT_EQ(all(kTrianglePairsScalar), expected) << run;
        EXPECT_EQ(all(triangle_pair_kernel()), all(kTrianglePairsScalar)) << run;
        met += static_cast<uint32_t>(std::popcount(expected));
    }
    EXPECT_GT(met, 500u);
}

// Boxes in lanes against boxes, in all builds.
TEST(SurfaceLeaves, MeetWhatTheirBoxesMeet) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> in(-1, 1);
    const auto any_box = [&] {
        SurfaceBox box = SurfaceBox::none();
        for (int k = 0; k < 2; ++k) box.add(Vec3f(in(random), in(random), in(random)));
        return box;
    };
    for (int run = 0; run < 200; ++run) {
        SurfaceBoxLanes lanes;
        SurfaceBox box[kLanes];
        for (int lane = 0; lane < kLanes; ++lane)
            set_lane(lanes, lane, box[lane] = lane == 5 ? SurfaceBox::none() : any_box());
        const SurfaceBox with = any_box();
        unsigned expected = 0;
        for (int lane = 0; lane < kLanes; ++lane) expected |= static_cast<unsigned>(box[lane].meets(with)) << lane;
        EXPECT_EQ(kTrianglePairsScalar.meets(lanes, ends_of(with)), expected);
        EXPECT_EQ(triangle_pair_kernel().meets(lanes, ends_of(with)), expected);
    }
}

}  // namespace
}  // namespace taut::test
