// Calls of query.h along a way: rays and shapes, checked against the same question to each collider alone.
#pragma once

#include "query_values.h"

namespace taut_test {

class QueryCalls : protected virtual QueryValues {
protected:
    void cast_ray() {
        const size_t w = pick_world();
        const taut_ray at = ray();
        const Filter filter = query_filter(w);
        taut_query_hit first;
        const bool known =
            ask("taut_world_cast_ray", [&] { return taut_world_cast_ray(worlds_[w], &at, filter.get(), &first); });
        if (known) expect_hit(first);
        std::vector<taut_query_hit> hits(byte());
        uint32_t count = 0;
        if (ask("taut_world_cast_ray_all", [&] {
                return taut_world_cast_ray_all(worlds_[w], &at, filter.get(), hits.data(),
                                               static_cast<uint32_t>(hits.size()), &count);
            }))
            expect_agree(first, hits, count);
        int32_t any = 0;
        if (ask("taut_world_cast_ray_any",
                [&] { return taut_world_cast_ray_any(worlds_[w], &at, filter.get(), &any); }))
            expect((any != 0) == (first.body.bits != 0), "a ray that meets and meets nothing");
        if (known) expect_first_of_each(w, at);
    }

    void cast_rays() {
        const size_t w = pick_world();
        taut_ray rays[4];
        for (taut_ray& one : rays) one = ray();
        const Filter filter = query_filter(w);
        const uint32_t count = byte() % 5;
        taut_query_hit hits[4], alone;
        if (!ask("taut_world_cast_rays",
                 [&] { return taut_world_cast_rays(worlds_[w], rays, count, filter.get(), hits); }))
            return;
        for (uint32_t i = 0; i < count; ++i)
            expect(taut_world_cast_ray(worlds_[w], &rays[i], filter.get(), &alone) == TAUT_OK && same(alone, hits[i]),
                   "a ray of many that is not the same alone");
    }

    void cast_shape() {
        const size_t w = pick_world();
        taut_shape_cast casts[3];
        for (taut_shape_cast& one : casts) {
            taut_shape_cast_init(&one);
            one.shape = pick(shapes_, w);
            one.pose = pose();
            one.translation = vec(20);
            spoil(one.reserved);
        }
        const Filter filter = query_filter(w);
        taut_query_hit first{}, hits[3];
        const bool known = ask("taut_world_cast_shape",
                               [&] { return taut_world_cast_shape(worlds_[w], casts, filter.get(), &first); });
        if (known) expect_hit(first);
        std::vector<taut_query_hit> all(byte());
        uint32_t count = 0;
        if (ask("taut_world_cast_shape_all", [&] {
                return taut_world_cast_shape_all(worlds_[w], casts, filter.get(), all.data(),
                                                 static_cast<uint32_t>(all.size()), &count);
            }))
            expect_agree(first, all, count);
        const uint32_t many = byte() % 4;
        if (ask("taut_world_cast_shapes",
                [&] { return taut_world_cast_shapes(worlds_[w], casts, many, filter.get(), hits); }) &&
            many > 0 && known)
            expect(same(first, hits[0]), "a shape of many that is not the same alone");
    }

private:
    taut_ray ray() {
        taut_ray out = {pos(12), vec(20), 0};
        spoil(out.reserved);
        return out;
    }
    static bool same(const taut_query_hit& a, const taut_query_hit& b) {
        return a.collider.bits == b.collider.bits && a.fraction == b.fraction && a.inside == b.inside;
    }
    void expect_hit(const taut_query_hit& hit) {
        expect(finite(hit.point) && finite(hit.normal), "a hit that is not finite");
        expect(hit.fraction >= 0 && hit.fraction <= 1, "a fraction that is none");
        if (hit.body.bits == 0) {
            expect(hit.fraction == 1 && hit.collider.bits == 0 && hit.inside == 0, "a miss that says more");
            return;
        }
        taut_body body;
        expect(taut_collider_get_body(hit.collider, &body) == TAUT_OK && body.bits == hit.body.bits, "a hit of none");
        const taut_vec3& n = hit.normal;
        const float size = n.x * n.x + n.y * n.y + n.z * n.z;
        expect(size > 0.99f && size < 1.01f, "a normal that is none");
        expect(!hit.inside || hit.fraction == 0, "an inside that is on the way");
    }
    void expect_agree(const taut_query_hit& first, const std::vector<taut_query_hit>& hits, uint32_t count) {
        expect((first.body.bits != 0) == (count > 0), "a first hit that is none of all");
        for (uint32_t i = 0; i < count; ++i) {
            expect_hit(hits[i]);
            expect(i == 0 || hits[i - 1].fraction <= hits[i].fraction, "hits that are not in order");
        }
        if (count > 0) expect(hits[0].fraction == first.fraction, "a first hit that is not the first of all");
    }
    // The first hit of all is the least of those of each collider asked alone. Bodies of cables are not all known.
    void expect_first_of_each(size_t w, const taut_ray& at) {
        taut_query_hit all, alone;
        Filter filter;
        filter.def.kinds = TAUT_QUERY_ALL_KINDS | TAUT_QUERY_SENSOR;
        if (taut_world_cast_ray(worlds_[w], &at, filter.get(), &all) != TAUT_OK) return;
        bool seen = false;
        for (const Known<taut_collider>& one : colliders_) {
            if (one.world != w || !taut_collider_is_valid(one.handle)) continue;
            filter.only(one.handle);
            if (taut_world_cast_ray(worlds_[w], &at, filter.get(), &alone) != TAUT_OK) continue;
            expect(alone.body.bits == 0 || alone.fraction >= all.fraction, "a collider before the first");
            if (one.handle.bits == all.collider.bits)
                seen = true, expect(same(alone, all), "a collider that is met otherwise alone");
        }
        if (live(cables_, taut_cable_is_valid, w) == 0)
            expect(seen || all.body.bits == 0, "a hit of a collider that nobody knows");
    }
};

}  // namespace taut_test
