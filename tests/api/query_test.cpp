// Queries of a world against what each collider alone would say: sorting, filters, batches, threads, strays.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "calls.h"

using namespace taut_test;

namespace {

using Engine = std::mt19937;
double uniform(Engine& engine, double lo, double hi) { return lo + (hi - lo) * double(engine()) / 4294967296.0; }
taut_vec3 random_vec(Engine& engine, double size) {
    const float x = float(uniform(engine, -size, size)), y = float(uniform(engine, -size, size));
    return {x, y, float(uniform(engine, -size, size))};
}
taut_pos moved(const taut_pos& p, const taut_vec3& by) {
    return {p.x + double(by.x), p.y + double(by.y), p.z + double(by.z)};
}
bool same(const taut_query_hit& a, const taut_query_hit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
double length(const taut_vec3& v) { return std::sqrt(double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z); }

taut_query_filter filter() {
    taut_query_filter out;
    taut_query_filter_init(&out);
    return out;
}

// Kinds of all sorts around a point, above a plane.
struct Field {
    explicit Field(int count, const taut_pos& place = {0, 0, 0}, uint32_t seed = 1) : engine(seed), middle(place) {
        taut_sphere_def sphere;
        taut_sphere_def_init(&sphere);
        taut_capsule_def capsule;
        taut_capsule_def_init(&capsule);
        taut_cone_def cone;
        taut_cone_def_init(&cone);
        shapes.resize(5);
        shapes[0] = add_box(world, 0.4f);
        shapes[1] = add_hull(world);
        EXPECT_OK(taut_world_add_sphere(world, &sphere, &shapes[2]));
        EXPECT_OK(taut_world_add_capsule(world, &capsule, &shapes[3]));
        EXPECT_OK(taut_world_add_cone(world, &cone, &shapes[4]));
        ground = add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world), middle.x, middle.y - 8, middle.z));
        for (int i = 0; i < count; ++i) add(i);
    }
    ~Field() { taut_world_destroy(world); }

    void add(int i) {
        const taut_pos p = moved(middle, random_vec(engine, 8));
        const taut_body_kind kind = taut_body_kind(i % 3);
        const taut_body body = add_body(world, body_def(kind, shapes[size_t(i) % 5], p.x, p.y, p.z));
        taut_pose pose = at(p.x, p.y, p.z, {0.6f, 0, 0.8f, 0});
        EXPECT_OK(set_pose(body, pose));
        bodies.push_back(body);
    }
    taut_ray ray() {
        const taut_vec3 from = random_vec(engine, 12);
        const taut_vec3 to = random_vec(engine, 8);
        return {moved(middle, from), {to.x - from.x, to.y - from.y, to.z - from.z}, 0};
    }
    taut_shape_cast cast() {
        const taut_ray way = ray();
        return {shapes[engine() % 5], {way.origin, {0, 0.6f, 0, 0.8f}, {0, 0}}, way.translation, 0};
    }
    std::vector<taut_collider> colliders() const {
        std::vector<taut_collider> out;
        std::vector<taut_body> all = bodies;
        all.push_back(ground);
        for (const taut_body body : all) {
            taut_collider collider;
            uint32_t count;
            EXPECT_OK(taut_body_get_colliders(body, &collider, 1, &count));
            out.push_back(collider);
        }
        return out;
    }

    Engine engine;
    taut_pos middle;
    taut_world world = make_world();
    std::vector<taut_shape> shapes;
    taut_body ground;
    std::vector<taut_body> bodies;
};

// Sees one collider at a time: no tree decides what is left out.
std::vector<taut_query_hit> one_by_one(const Field& field, const taut_ray& ray) {
    std::vector<taut_query_hit> out;
    for (const taut_collider collider : field.colliders()) {
        taut_query_filter only = filter();
        taut_collider wanted = collider;
        only.user_data = &wanted;
        only.accept = [](taut_body, taut_collider c, void* data) -> int32_t {
            return c.bits == static_cast<taut_collider*>(data)->bits;
        };
        taut_query_hit hit;
        EXPECT_OK(taut_world_cast_ray(field.world, &ray, &only, &hit));
        if (hit.body.bits) out.push_back(hit);
    }
    std::sort(out.begin(), out.end(), [](const taut_query_hit& a, const taut_query_hit& b) {
        return a.fraction < b.fraction || (a.fraction == b.fraction && a.collider.bits < b.collider.bits);
    });
    return out;
}

TEST(Queries, ARayMeetsAllThatItPassesInOrder) {
    Field field(200);
    int hits = 0;
    for (int i = 0; i < 100; ++i) {
        const taut_ray ray = field.ray();
        const std::vector<taut_query_hit> expected = one_by_one(field, ray);
        std::vector<taut_query_hit> all(expected.size());
        uint32_t count = 0;
        ASSERT_OK(taut_world_cast_ray_all(field.world, &ray, nullptr, all.data(), uint32_t(all.size()), &count));
        ASSERT_EQ(count, expected.size());
        for (uint32_t k = 0; k < count; ++k) EXPECT_TRUE(same(all[k], expected[k])) << i << " " << k;
        taut_query_hit first;
        int32_t any = -1;
        ASSERT_OK(taut_world_cast_ray(field.world, &ray, nullptr, &first));
        ASSERT_OK(taut_world_cast_ray_any(field.world, &ray, nullptr, &any));
        EXPECT_EQ(any, count > 0);
        if (count > 0) {
            EXPECT_TRUE(same(first, all[0]));
        }
        if (count == 0) {
            EXPECT_EQ(first.fraction, 1);
        }
        hits += int(count);
    }
    EXPECT_GT(hits, 40);
}

TEST(Queries, ARayThroughAHundredBoxesTellsTheNumberNeeded) {
    const taut_world world = make_world();
    const taut_shape box = add_box(world, 0.4f);
    for (int i = 0; i < 100; ++i) add_body(world, body_def(TAUT_BODY_STATIC, box, 99 - i, 0, 0));
    const taut_ray ray = {{-5, 0, 0}, {200, 0, 0}, 0};
    std::vector<taut_query_hit> hits(100);
    std::memset(static_cast<void*>(hits.data()), 0x5a, sizeof hits[0] * hits.size());
    const std::vector<taut_query_hit> before = hits;
    uint32_t count = 0;
    EXPECT_EQ(taut_world_cast_ray_all(world, &ray, nullptr, hits.data(), 99, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 100u);
    EXPECT_EQ(std::memcmp(hits.data(), before.data(), sizeof hits[0] * hits.size()), 0);
    EXPECT_EQ(taut_world_cast_ray_all(world, &ray, nullptr, nullptr, 100, &count), TAUT_NULL_POINTER);
    ASSERT_OK(taut_world_cast_ray_all(world, &ray, nullptr, hits.data(), 100, &count));
    ASSERT_EQ(count, 100u);
    for (int i = 0; i < 100; ++i) {
        EXPECT_NEAR(hits[size_t(i)].fraction, (4.6 + i) / 200, 1e-6);
        EXPECT_NEAR(hits[size_t(i)].point.x, i - 0.4, 1e-6);
        EXPECT_NEAR(hits[size_t(i)].normal.x, -1, 1e-6);
    }
    taut_world_destroy(world);
}

TEST(Queries, ShapesOnTheirWayMeetInOrderAndTouchThere) {
    Field field(200);
    for (int i = 0; i < 100; ++i) {
        const taut_shape_cast cast = field.cast();
        taut_query_hit first, all[201];
        uint32_t count = 0;
        ASSERT_OK(taut_world_cast_shape_all(field.world, &cast, nullptr, all, 201, &count));
        ASSERT_OK(taut_world_cast_shape(field.world, &cast, nullptr, &first));
        EXPECT_EQ(first.body.bits != 0, count > 0);
        if (count == 0) continue;
        EXPECT_TRUE(same(first, all[0])) << i;
        for (uint32_t k = 1; k < count; ++k) EXPECT_LE(all[k - 1].fraction, all[k].fraction);
        if (first.inside) continue;
        taut_pose there = cast.pose;
        const taut_vec3 t = cast.translation;
        const float f = first.fraction;
        there.position = moved(cast.pose.position, {t.x * f, t.y * f, t.z * f});
        taut_distance nearest;
        ASSERT_OK(taut_world_nearest_collider(field.world, cast.shape, &there, 1, nullptr, &nearest));
        EXPECT_NEAR(nearest.distance, 0, 1e-4) << i;
    }
}

TEST(Queries, OverlapsAreWhoIsNoFurtherThanNothing) {
    Field field(300);
    int found = 0;
    for (int i = 0; i < 100; ++i) {
        const taut_shape_cast cast = field.cast();
        taut_collider overlaps[301];
        uint32_t count = 0;
        ASSERT_OK(taut_world_overlap_shape(field.world, cast.shape, &cast.pose, nullptr, overlaps, 301, &count));
        EXPECT_TRUE(std::is_sorted(overlaps, overlaps + count, [](auto a, auto b) { return a.bits < b.bits; }));
        found += int(count);
        taut_distance nearest;
        ASSERT_OK(taut_world_nearest_collider(field.world, cast.shape, &cast.pose, 100, nullptr, &nearest));
        EXPECT_EQ(nearest.distance <= 0, count > 0);

        const taut_pos point = cast.pose.position;
        uint32_t holding = 0, expected = 0;
        ASSERT_OK(taut_world_overlap_point(field.world, point, nullptr, overlaps, 301, &holding));
        for (const taut_collider collider : field.colliders()) {
            taut_distance d;
            ASSERT_OK(taut_collider_closest_point(collider, point, &d));
            expected += d.distance <= 0;
        }
        EXPECT_EQ(holding, expected);
    }
    EXPECT_GT(found, 20);
}

TEST(Queries, ABoxOverlapsTightBoxes) {
    Populated p;
    const auto in_box = [&](taut_pos low, taut_pos high) {
        taut_query_filter dynamic = filter();
        dynamic.kinds = TAUT_QUERY_DYNAMIC;
        taut_collider out[8];
        uint32_t count = 0;
        EXPECT_OK(taut_world_overlap_box(p.world, low, high, &dynamic, out, 8, &count));
        return count;
    };
    EXPECT_EQ(in_box({0.501, 0, 0}, {1, 1, 1}), 0u);
    EXPECT_EQ(in_box({0.499, 0, 0}, {1, 1, 1}), 1u);
    EXPECT_EQ(in_box({-20, -20, -20}, {20, 20, 20}), 2u);
    taut_collider out[8];
    uint32_t count = 0;
    EXPECT_EQ(taut_world_overlap_box(p.world, {1, 0, 0}, {0, 1, 1}, nullptr, out, 8, &count), TAUT_INVALID_ARGUMENT);
}

TEST(Queries, NearestIsTheLeastOfAllDistances) {
    Field field(100);
    for (int i = 0; i < 50; ++i) {
        const taut_shape_cast cast = field.cast();
        taut_body_def def = body_def(TAUT_BODY_STATIC, cast.shape, 0, 500, 0);
        const taut_body probe = add_body(field.world, def);
        ASSERT_OK(set_pose(probe, cast.pose));
        taut_collider own;
        uint32_t count;
        ASSERT_OK(taut_body_get_colliders(probe, &own, 1, &count));
        taut_query_filter others = filter();
        others.ignored_bodies = &probe;
        others.ignored_body_count = 1;
        float least = 1e9f;
        for (const taut_collider collider : field.colliders()) {
            taut_distance d;
            ASSERT_OK(taut_collider_distance(own, collider, &d));
            least = std::min(least, d.distance);
        }
        taut_distance nearest;
        ASSERT_OK(taut_world_nearest_collider(field.world, cast.shape, &cast.pose, 1000, &others, &nearest));
        EXPECT_NEAR(nearest.distance, least, 1e-5);
        if (least > 0.01f) {
            ASSERT_OK(
                taut_world_nearest_collider(field.world, cast.shape, &cast.pose, 0.9f * least, &others, &nearest));
            EXPECT_EQ(nearest.body.bits, 0u);
        }
        ASSERT_OK(taut_body_remove(probe));
    }
}

TEST(Queries, TheSameTenKilometresAway) {
    Field here(150), there(150, {10000, -10000, 10000});
    for (int i = 0; i < 300; ++i) {
        const taut_ray near = here.ray(), far = there.ray();
        taut_query_hit a, b;
        ASSERT_OK(taut_world_cast_ray(here.world, &near, nullptr, &a));
        ASSERT_OK(taut_world_cast_ray(there.world, &far, nullptr, &b));
        EXPECT_EQ(a.body.bits >> 40, b.body.bits >> 40) << i;
        EXPECT_NEAR(a.fraction, b.fraction, 1e-6);
        EXPECT_EQ(a.inside, b.inside);
    }
}

TEST(Queries, ABatchSaysWhatOneByOneSays) {
    Field field(200);
    std::vector<taut_ray> rays;
    std::vector<taut_shape_cast> casts;
    for (int i = 0; i < 200; ++i) {
        rays.push_back(field.ray());
        casts.push_back(field.cast());
    }
    std::vector<taut_query_hit> hits(200), swept(200);
    ASSERT_OK(taut_world_cast_rays(field.world, rays.data(), 200, nullptr, hits.data()));
    ASSERT_OK(taut_world_cast_shapes(field.world, casts.data(), 200, nullptr, swept.data()));
    for (size_t i = 0; i < 200; ++i) {
        taut_query_hit one;
        ASSERT_OK(taut_world_cast_ray(field.world, &rays[i], nullptr, &one));
        EXPECT_TRUE(same(one, hits[i])) << i;
        ASSERT_OK(taut_world_cast_shape(field.world, &casts[i], nullptr, &one));
        EXPECT_TRUE(same(one, swept[i])) << i;
    }
    EXPECT_OK(taut_world_cast_rays(field.world, nullptr, 0, nullptr, nullptr));
    rays[7].translation.y = NAN;
    const taut_query_hit kept = hits[0];
    EXPECT_EQ(taut_world_cast_rays(field.world, rays.data(), 200, nullptr, hits.data()), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "rays[7].translation.y")) << taut_last_error();
    EXPECT_TRUE(same(hits[0], kept));
}

// What was removed and added, and fell and bounced, leaves no trace but the poses.
TEST(Queries, AnswersDoNotDependOnTheTreesHistory) {
    Field moved_often(120), moved_once(120);
    for (int round = 0; round < 5; ++round)
        for (const taut_body body : moved_often.bodies) {
            taut_pose pose, away;
            ASSERT_OK(taut_body_get_pose(body, &pose));
            away = pose;
            away.position.x += 40 + round;
            ASSERT_OK(set_pose(body, away));
            ASSERT_OK(set_pose(body, pose));
        }
    for (int i = 0; i < 200; ++i) {
        const taut_ray ray = moved_often.ray();
        taut_query_hit a, b;
        ASSERT_OK(taut_world_cast_ray(moved_often.world, &ray, nullptr, &a));
        ASSERT_OK(taut_world_cast_ray(moved_once.world, &ray, nullptr, &b));
        EXPECT_EQ(a.fraction, b.fraction);
        EXPECT_EQ(a.body.bits >> 40, b.body.bits >> 40);
    }
}

// A ball shot at a wall leaves the box that its flight foresaw; it is found where it is.
TEST(Queries, FindsBodiesThatLeftTheirForeseenBoxes) {
    const taut_world world = make_world();
    ASSERT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    taut_sphere_def def;
    taut_sphere_def_init(&def);
    taut_shape sphere;
    ASSERT_OK(taut_world_add_sphere(world, &def, &sphere));
    taut_body_def wall = body_def(TAUT_BODY_STATIC, add_box(world, 3), 5, 0, 0);
    wall.material.restitution = 1;
    add_body(world, wall);
    taut_body_def ball = body_def(TAUT_BODY_DYNAMIC, sphere, 0, 0, 0);
    ball.material.restitution = 1;
    ball.linear_velocity = {200, 30, 0};
    const taut_body body = add_body(world, ball);
    for (int i = 0; i < 20; ++i) {
        ASSERT_OK(taut_world_step(world));
        taut_pose pose;
        ASSERT_OK(taut_body_get_pose(body, &pose));
        const taut_ray ray = {moved(pose.position, {0, 0, 5}), {0, 0, -10}, 0};
        taut_query_filter dynamic = filter();
        dynamic.kinds = TAUT_QUERY_DYNAMIC;
        taut_query_hit hit;
        ASSERT_OK(taut_world_cast_ray(world, &ray, &dynamic, &hit));
        ASSERT_EQ(hit.body.bits, body.bits) << i;
        EXPECT_NEAR(hit.fraction, 0.45, 1e-5);
    }
    taut_world_destroy(world);
}

TEST(Queries, ManyThreadsAskAtOnce) {
    Field field(300);
    std::vector<taut_ray> rays;
    std::vector<taut_shape_cast> casts;
    for (int i = 0; i < 500; ++i) {
        rays.push_back(field.ray());
        casts.push_back(field.cast());
    }
    std::vector<taut_query_hit> hits(500), swept(500);
    ASSERT_OK(taut_world_cast_rays(field.world, rays.data(), 500, nullptr, hits.data()));
    ASSERT_OK(taut_world_cast_shapes(field.world, casts.data(), 500, nullptr, swept.data()));
    std::vector<int> wrong(6);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
            for (size_t i = 0; i < 500; ++i) {
                const size_t k = (i + 80 * t) % 500;
                taut_query_hit one;
                if (taut_world_cast_ray(field.world, &rays[k], nullptr, &one) || !same(one, hits[k])) ++wrong[t];
                if (taut_world_cast_shape(field.world, &casts[k], nullptr, &one) || !same(one, swept[k])) ++wrong[t];
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, std::vector<int>(6, 0));
}

TEST(Queries, TakeNoMemory) {
    Ledger ledger;
    Populated p(ledger.hooks());
    const uint64_t before = ledger.calls;
    for (const auto& call : world_calls(p)) {
        const bool query =
            contains(call.name, "cast") || contains(call.name, "overlap") || contains(call.name, "nearest");
        if (query) {
            EXPECT_OK(call.run(p.world));
        }
    }
    EXPECT_EQ(ledger.calls, before);
}

TEST(Queries, ARayFromInsideSaysSo) {
    Populated p;
    const taut_ray ray = {{0, 0.5, 0}, {0, 4, 0}, 0};
    taut_query_hit hit;
    ASSERT_OK(taut_world_cast_ray(p.world, &ray, nullptr, &hit));
    EXPECT_EQ(hit.body.bits, p.crate.bits);
    EXPECT_EQ(hit.collider.bits, p.collider.bits);
    EXPECT_EQ(hit.inside, 1u);
    EXPECT_EQ(hit.fraction, 0);
    EXPECT_EQ(hit.normal.y, -1);
    EXPECT_EQ(hit.point.y, 0.5);
    EXPECT_NEAR(length(hit.normal), 1, 1e-6);
}

}  // namespace
