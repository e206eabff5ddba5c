// Whom a query sees, and what it refuses.
#include <cmath>

#include "calls.h"

using namespace taut_test;

namespace {

struct Filter : testing::Test {
    Filter() { taut_query_filter_init(&filter); }

    // The first body below five metres over the crate; null for none.
    taut_body below() {
        taut_query_hit hit = {};
        EXPECT_OK(taut_world_cast_ray(p.world, &kDown, &filter, &hit));
        return hit.body;
    }
    void set_crate_filter(uint64_t category, uint64_t mask) {
        const taut_filter crate = {category, mask, 0, 0};
        ASSERT_OK(taut_collider_set_filter(p.collider, &crate));
    }

    Populated p;
    taut_query_filter filter;
};

TEST_F(Filter, DefaultSeesAll) { EXPECT_EQ(below().bits, p.crate.bits); }

TEST_F(Filter, KindsOfBodies) {
    filter.kinds = TAUT_QUERY_ALL_KINDS & ~TAUT_QUERY_DYNAMIC;
    EXPECT_EQ(below().bits, p.ground.bits);
    filter.kinds = TAUT_QUERY_PARTICLE | TAUT_QUERY_KINEMATIC;
    EXPECT_EQ(below().bits, 0u);
}

TEST_F(Filter, CategoryAndMaskAsAColliderWould) {
    set_crate_filter(4, 8);
    EXPECT_EQ(below().bits, p.crate.bits);
    filter.mask = 4;
    filter.category = 8;
    EXPECT_EQ(below().bits, p.crate.bits);
    filter.category = 16;  // not in the crate's mask
    EXPECT_EQ(below().bits, 0u);
    filter.category = 8;
    filter.mask = 1;  // the ground's category, not the crate's
    EXPECT_EQ(below().bits, p.ground.bits);
    set_crate_filter(1, 8);
    EXPECT_EQ(below().bits, p.crate.bits);
}

TEST_F(Filter, WhatIsIgnored) {
    filter.ignored_bodies = &p.crate;
    filter.ignored_body_count = 1;
    EXPECT_EQ(below().bits, p.ground.bits);
    filter.ignored_body_count = 0;
    filter.ignored_colliders = &p.collider;
    filter.ignored_collider_count = 1;
    EXPECT_EQ(below().bits, p.ground.bits);
    const taut_body both[] = {p.ground, p.crate};
    filter.ignored_bodies = both;
    filter.ignored_body_count = 2;
    EXPECT_EQ(below().bits, 0u);
}

TEST_F(Filter, AHostDecides) {
    struct Asked {
        taut_body unwanted;
        int calls = 0;
    } asked = {p.crate, 0};
    filter.user_data = &asked;
    filter.accept = [](taut_body body, taut_collider collider, void* data) -> int32_t {
        Asked& a = *static_cast<Asked*>(data);
        ++a.calls;
        taut_body owner;  // reading is allowed
        EXPECT_OK(taut_collider_get_body(collider, &owner));
        EXPECT_EQ(owner.bits, body.bits);
        EXPECT_EQ(taut_body_remove(body), TAUT_LOCKED);
        return body.bits != a.unwanted.bits;
    };
    EXPECT_EQ(below().bits, p.ground.bits);
    EXPECT_GE(asked.calls, 2);
}

struct QueryRefusals : Filter {
    // Refused with this word in the text and nothing written.
    void refuse_ray(const taut_ray& ray, taut_result code, const char* word) {
        taut_query_hit hit = {}, hits[2] = {};
        uint32_t count = 77;
        int32_t any = 77;
        EXPECT_EQ(taut_world_cast_ray(p.world, &ray, &filter, &hit), code) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(taut_world_cast_ray_all(p.world, &ray, &filter, hits, 2, &count), code);
        EXPECT_EQ(taut_world_cast_ray_any(p.world, &ray, &filter, &any), code);
        EXPECT_EQ(taut_world_cast_rays(p.world, &ray, 1, &filter, hits), code);
        EXPECT_EQ(hit.fraction, 0);
        EXPECT_EQ(hits[0].fraction, 0);
        EXPECT_EQ(count, 77u);
        EXPECT_EQ(any, 77);
    }
    void refuse_cast(const taut_shape_cast& cast, taut_result code, const char* word) {
        taut_query_hit hit = {};
        uint32_t count = 77;
        EXPECT_EQ(taut_world_cast_shape(p.world, &cast, &filter, &hit), code) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(taut_world_cast_shape_all(p.world, &cast, &filter, &hit, 1, &count), code);
        EXPECT_EQ(taut_world_cast_shapes(p.world, &cast, 1, &filter, &hit), code);
        EXPECT_EQ(hit.fraction, 0);
        EXPECT_EQ(count, 77u);
    }
};

const float kBad[] = {NAN, INFINITY, -INFINITY, 2e7f, -2e7f};

TEST_F(QueryRefusals, Rays) {
    for (const float bad : kBad) {
        taut_ray ray = kDown;
        ray.origin.y = double(bad);
        refuse_ray(ray, TAUT_INVALID_ARGUMENT, "origin.y");
        ray = kDown;
        ray.translation.z = bad;
        refuse_ray(ray, TAUT_INVALID_ARGUMENT, "translation.z");
    }
    for (const float small : {0.0f, -0.0f, 1e-7f, 1e-40f})
        refuse_ray({{0, 5, 0}, {0, small, 0}, 0}, TAUT_INVALID_ARGUMENT, "translation is shorter");
    refuse_ray({{0, 5, 0}, {0, -1, 0}, 3}, TAUT_INVALID_ARGUMENT, "reserved");
}

TEST_F(QueryRefusals, Casts) {
    const taut_shape_cast good = {p.box, kIdentity, {0, -1, 0}, 0};
    for (const float bad : kBad) {
        taut_shape_cast cast = good;
        cast.pose.position.x = double(bad);
        refuse_cast(cast, TAUT_INVALID_ARGUMENT, "pose.position.x");
        cast = good;
        cast.pose.rotation.w = bad;
        refuse_cast(cast, TAUT_INVALID_ARGUMENT, "pose.rotation.w");
        cast = good;
        cast.translation.y = bad;
        refuse_cast(cast, TAUT_INVALID_ARGUMENT, "translation.y");
    }
    taut_shape_cast cast = good;
    cast.translation = {0, 0, 0};
    refuse_cast(cast, TAUT_INVALID_ARGUMENT, "translation is shorter");
    cast = good;
    cast.shape = p.plane;
    refuse_cast(cast, TAUT_INVALID_ARGUMENT, "shape is a plane");
    cast.shape = {0};
    refuse_cast(cast, TAUT_STALE_HANDLE, "shape");
}

TEST_F(QueryRefusals, Filters) {
    const auto refuse = [&](taut_result code, const char* word, auto change) {
        taut_query_filter_init(&filter);
        change(filter);
        refuse_ray(kDown, code, word);
    };
    refuse(TAUT_STRUCT_SIZE, "filter.struct_size", [](taut_query_filter& f) { f.struct_size = 0; });
    refuse(TAUT_INVALID_ARGUMENT, "filter.kinds", [](taut_query_filter& f) { f.kinds = 32; });
    refuse(TAUT_INVALID_ARGUMENT, "ignored_body_count", [](taut_query_filter& f) { f.ignored_body_count = 65; });
    refuse(TAUT_NULL_POINTER, "ignored_bodies", [](taut_query_filter& f) { f.ignored_body_count = 1; });
    refuse(TAUT_NULL_POINTER, "ignored_colliders", [](taut_query_filter& f) { f.ignored_collider_count = 1; });
    const taut_body none = {0};
    refuse(TAUT_STALE_HANDLE, "ignored_bodies", [&](taut_query_filter& f) {
        f.ignored_bodies = &none;
        f.ignored_body_count = 1;
    });
    const Populated other;
    refuse(TAUT_FOREIGN_HANDLE, "ignored_colliders", [&](taut_query_filter& f) {
        f.ignored_colliders = &other.collider;
        f.ignored_collider_count = 1;
    });
}

TEST_F(QueryRefusals, PointsAndDistances) {
    taut_collider out[4];
    uint32_t count = 77;
    taut_distance distance = {};
    for (const float bad : kBad) {
        EXPECT_EQ(taut_world_overlap_point(p.world, {0, double(bad), 0}, nullptr, out, 4, &count),
                  TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_world_overlap_box(p.world, {0, 0, 0}, {1, double(bad), 1}, nullptr, out, 4, &count),
                  TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_collider_closest_point(p.collider, {double(bad), 0, 0}, &distance), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_world_nearest_collider(p.world, p.box, &kIdentity, bad, nullptr, &distance),
                  TAUT_INVALID_ARGUMENT);
    }
    EXPECT_EQ(taut_world_overlap_shape(p.world, p.box, nullptr, nullptr, out, 4, &count), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_nearest_collider(p.world, p.box, nullptr, 1, nullptr, &distance), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_overlap_shape(p.world, p.plane, &kIdentity, nullptr, out, 4, &count), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(count, 77u);
    taut_collider ground;
    ASSERT_OK(taut_body_get_colliders(p.ground, &ground, 1, &count));
    EXPECT_EQ(taut_collider_distance(ground, ground, &distance), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "planes"));
    EXPECT_EQ(taut_collider_distance(p.collider, {0}, &distance), TAUT_STALE_HANDLE);
    EXPECT_EQ(distance.distance, 0);
    EXPECT_OK(taut_collider_distance(p.collider, ground, &distance));
    EXPECT_NEAR(distance.distance, 0, 0.01);
    taut_query_filter_init(nullptr);
}

}  // namespace
