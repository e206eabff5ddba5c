// Calls of query.h about what is at a place: overlaps and distances, checked against each other.
#pragma once

#include "query_values.h"

namespace taut_test {

class NearCalls : protected virtual QueryValues {
protected:
    void overlap() {
        const size_t w = pick_world();
        const taut_world world = worlds_[w];
        const Filter filter = query_filter(w);
        std::vector<taut_collider> found(byte());
        const uint32_t room = static_cast<uint32_t>(found.size());
        uint32_t count = 0;
        switch (byte() % 3) {
            case 0: {
                const taut_shape shape = pick(shapes_, w);
                const taut_pose at = pose();
                if (ask("taut_world_overlap_shape", [&] {
                        return taut_world_overlap_shape(world, shape, &at, filter.get(), found.data(), room, &count);
                    }))
                    expect_distinct(found, count);
                break;
            }
            case 1: {
                const taut_pos low = pos(10);
                const taut_vec3 size = {real(0, 5), real(0, 5), real(0, 5)};
                const taut_pos high = {low.x + static_cast<double>(size.x), low.y + static_cast<double>(size.y),
                                       low.z + static_cast<double>(size.z)};
                if (ask("taut_world_overlap_box", [&] {
                        return taut_world_overlap_box(world, low, high, filter.get(), found.data(), room, &count);
                    }))
                    expect_distinct(found, count);
                break;
            }
            default: {
                const taut_pos point = pos(5);
                if (ask("taut_world_overlap_point", [&] {
                        return taut_world_overlap_point(world, point, filter.get(), found.data(), room, &count);
                    }))
                    expect_distinct(found, count);
                if (finite(point)) expect_same_inside(w, point);
            }
        }
    }

    // As much as there is room for, all of it finite.
    void draw() {
        const taut_world world = worlds_[pick_world()];
        taut_draw_def def;
        taut_draw_def_init(&def);
        def.what = byte();
        def.colours = static_cast<taut_draw_colours>(byte() % 3);
        def.force_scale = real(0, 1);
        if (byte() % 2) def.low = pos(10), def.high = pos(20);
        std::vector<taut_draw_line> lines(byte());
        std::vector<taut_draw_triangle> triangles(byte());
        std::vector<taut_draw_label> labels(byte());
        taut_drawing drawing;
        taut_drawing_init(&drawing);
        drawing.lines = lines.data(), drawing.line_capacity = static_cast<uint32_t>(lines.size());
        drawing.triangles = triangles.data(), drawing.triangle_capacity = static_cast<uint32_t>(triangles.size());
        drawing.labels = labels.data(), drawing.label_capacity = static_cast<uint32_t>(labels.size());
        if (!ask("taut_world_draw", [&] { return taut_world_draw(world, &def, &drawing); })) return;
        for (uint32_t i = 0; i < drawing.line_count; ++i)
            expect(finite(lines[i].from) && finite(lines[i].to), "a line is not finite");
    }

    void ask_one() {
        const size_t w = pick_world();
        const taut_collider collider = pick(colliders_, w);
        taut_pos low, high;
        const bool known =
            ask("taut_collider_get_bounds", [&] { return taut_collider_get_bounds(collider, &low, &high); });
        if (known) expect(low.x <= high.x && low.y <= high.y && low.z <= high.z, "a box that is none");
        taut_ray ray;
        taut_ray_init(&ray);
        ray.origin = pos(10);
        ray.translation = vec(20);
        taut_query_hit hit;
        if (ask("taut_collider_cast_ray", [&] { return taut_collider_cast_ray(collider, &ray, &hit); }))
            expect(hit.fraction >= 0 && hit.fraction <= 1 &&
                       (hit.collider.bits == collider.bits || hit.collider.bits == 0),
                   "a hit of another");
        const taut_pos point = pos(5);
        int32_t inside = 2;
        if (ask("taut_collider_overlap_point", [&] { return taut_collider_overlap_point(collider, point, &inside); }))
            expect(inside == 0 || inside == 1, "an answer that is none");
        const taut_shape shape = pick(shapes_, w);
        const taut_pose at = pose();
        if (ask("taut_collider_overlap_shape",
                [&] { return taut_collider_overlap_shape(collider, shape, &at, &inside); }))
            expect(inside == 0 || inside == 1, "an answer that is none");
    }

    void measure() {
        const size_t w = pick_world();
        const taut_collider a = pick(colliders_, w), b = pick(colliders_, w);
        const taut_pos point = pos(10);
        taut_distance out;
        if (ask("taut_collider_closest_point", [&] { return taut_collider_closest_point(a, point, &out); }))
            expect_distance(out);
        taut_distance back;
        if (ask("taut_collider_distance", [&] { return taut_collider_distance(a, b, &out); })) {
            expect_distance(out);
            // Both parted: the distance is the same from either side. Overlaps have no unique least push.
            if (taut_collider_distance(b, a, &back) == TAUT_OK && out.distance > 0 && back.distance > 0)
                expect(std::abs(out.distance - back.distance) <= 1e-3f + 1e-3f * out.distance,
                       "a distance that is another from the other side");
        }
        const taut_shape shape = pick(shapes_, w);
        const taut_pose at = pose();
        const float most = real(0, 20);
        const Filter filter = query_filter(w);
        if (ask("taut_world_nearest_collider",
                [&] { return taut_world_nearest_collider(worlds_[w], shape, &at, most, filter.get(), &out); })) {
            if (out.body.bits != 0) expect_distance(out);
            expect(out.distance <= most, "a nearest that is too far");
            expect_nearest_of_each(w, shape, at, most);
        }
    }

private:
    void expect_distinct(const std::vector<taut_collider>& found, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) {
            expect(taut_collider_is_valid(found[i]), "a dead collider found");
            for (uint32_t j = 0; j < i; ++j) expect(found[i].bits != found[j].bits, "a collider found twice");
        }
    }
    void expect_distance(const taut_distance& out) {
        expect(finite(out.on_a) && finite(out.on_b) && finite(out.normal), "a distance that is not finite");
        expect(std::isfinite(out.distance) && taut_body_is_valid(out.body), "a distance to none");
    }
    // A collider holds a point where the distance to it is negative, but for those without an inside.
    void expect_same_inside(size_t w, const taut_pos& point) {
        Filter filter;
        filter.def.kinds = TAUT_QUERY_ALL_KINDS | TAUT_QUERY_SENSOR;
        taut_collider found[2];
        for (const Known<taut_collider>& one : colliders_) {
            taut_distance out;
            if (one.world != w || taut_collider_closest_point(one.handle, point, &out) != TAUT_OK) continue;
            uint32_t enabled = 0;
            if (std::abs(out.distance) < 1e-3f || taut_body_get_enabled(out.body, &enabled) != TAUT_OK || !enabled)
                continue;
            taut_collider_def def;
            taut_shape_kind kind = TAUT_SHAPE_SURFACE;
            if (taut_collider_get_def(one.handle, &def) == TAUT_OK) taut_shape_get_kind(def.shape, &kind);
            uint32_t count = 0;
            filter.only(one.handle);
            expect(taut_world_overlap_point(worlds_[w], point, filter.get(), found, 2, &count) == TAUT_OK, "a refusal");
            expect(count == (out.distance < 0 && kind != TAUT_SHAPE_SURFACE ? 1u : 0u), "a point in and out at once");
        }
    }
    void expect_nearest_of_each(size_t w, taut_shape shape, const taut_pose& at, float most) {
        Filter filter;
        taut_distance all, alone;
        if (taut_world_nearest_collider(worlds_[w], shape, &at, most, filter.get(), &all) != TAUT_OK) return;
        for (const Known<taut_collider>& one : colliders_) {
            if (one.world != w || !taut_collider_is_valid(one.handle)) continue;
            filter.only(one.handle);
            if (taut_world_nearest_collider(worlds_[w], shape, &at, most, filter.get(), &alone) != TAUT_OK) continue;
            if (alone.body.bits == 0) continue;
            expect(all.body.bits != 0, "a nearest that is missed");
            // Of overlaps the depth is that of the least push, to the accuracy of the penetration search.
            if (all.distance > 0 || alone.distance > 0)
                expect(all.distance <= alone.distance + 1e-3f + 1e-3f * std::abs(alone.distance), "one that is nearer");
        }
    }
};

}  // namespace taut_test
