// Calls of shape.h.
#pragma once

#include "host.h"

namespace taut_test {

class ShapeCalls : protected virtual Host {
protected:
    void remove_shape() {
        if (!one_in(2)) return;
        const taut_shape shape = pick(shapes_, pick_world());
        if (run("taut_shape_remove", [&] { return taut_shape_remove(shape); }))
            expect(!taut_shape_is_valid(shape), "a removed shape that lives");
    }

    void add_scaled_shape() {
        if (live(shapes_, taut_shape_is_valid) >= kMostShapes) return;
        const size_t w = pick_world();
        const taut_shape mesh = pick(shapes_, w);
        const taut_vec3 scale = vec(2);
        taut_shape out = {0};
        if (run("taut_shape_add_scaled", [&] { return taut_shape_add_scaled(mesh, scale, &out); }))
            keep(shapes_, out, world_of(shapes_, mesh, w));
    }

    void add_shape() {
        if (live(shapes_, taut_shape_is_valid) >= kMostShapes) return;
        const size_t w = pick_world();
        const taut_world world = worlds_[w];
        taut_shape out = {0};
        bool added = false;
        switch (byte() % 11) {
            case 0: {
                taut_plane_def def;
                taut_plane_def_init(&def);
                if (one_in(2)) def.normal = vec(1);
                spoil(def.struct_size);
                added = run("taut_world_add_plane", [&] { return taut_world_add_plane(world, &def, &out); });
                break;
            }
            case 1: {
                taut_box_def def;
                taut_box_def_init(&def);
                def.half_extents = {real(0.01, 2), real(0.01, 2), real(0.01, 2)};
                spoil(def.struct_size);
                added = run("taut_world_add_box", [&] { return taut_world_add_box(world, &def, &out); });
                break;
            }
            case 2: {
                taut_sphere_def def;
                taut_sphere_def_init(&def);
                def.radius = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_sphere", [&] { return taut_world_add_sphere(world, &def, &out); });
                break;
            }
            case 3: {
                taut_capsule_def def;
                taut_capsule_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_capsule", [&] { return taut_world_add_capsule(world, &def, &out); });
                break;
            }
            case 4: {
                taut_cylinder_def def;
                taut_cylinder_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_cylinder", [&] { return taut_world_add_cylinder(world, &def, &out); });
                break;
            }
            case 5: {
                taut_cone_def def;
                taut_cone_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_cone", [&] { return taut_world_add_cone(world, &def, &out); });
                break;
            }
            case 6: {
                taut_tapered_capsule_def def;
                taut_tapered_capsule_def_init(&def);
                def.bottom_radius = real(0.01, 1);
                def.top_radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_tapered_capsule",
                            [&] { return taut_world_add_tapered_capsule(world, &def, &out); });
                break;
            }
            case 7: {
                taut_scaled_hull_def def;
                taut_scaled_hull_def_init(&def);
                def.hull = pick(shapes_, w);
                def.scale = vec(3);
                spoil(def.struct_size);
                added =
                    run("taut_world_add_scaled_hull", [&] { return taut_world_add_scaled_hull(world, &def, &out); });
                break;
            }
            case 8: {
                std::vector<taut_vec3> vertices(byte() % 20);
                for (taut_vec3& vertex : vertices) vertex = vec(2);
                std::vector<uint32_t> indices(byte() % 30 * 3u);
                for (uint32_t& index : indices) index = one_in(64) ? word() : byte() % 20;
                taut_mesh_def def;
                taut_mesh_def_init(&def);
                def.vertices = vertices.data();
                def.vertex_count = static_cast<uint32_t>(vertices.size());
                def.indices = indices.data();
                def.triangle_count = static_cast<uint32_t>(indices.size() / 3);
                def.two_sided = byte() % 2;
                spoil(def.struct_size);
                added = run("taut_world_add_mesh", [&] { return taut_world_add_mesh(world, &def, &out); });
                break;
            }
            case 9: {
                float heights[36];
                for (float& height : heights) height = real(-1, 1);
                taut_height_field_def def;
                taut_height_field_def_init(&def);
                def.heights = heights;
                def.rows = byte() % 7;
                def.columns = byte() % 7;
                def.row_spacing = real(0.1, 2);
                def.column_spacing = real(0.1, 2);
                spoil(def.struct_size);
                added =
                    run("taut_world_add_height_field", [&] { return taut_world_add_height_field(world, &def, &out); });
                break;
            }
            default: {
                std::vector<taut_vec3> points(byte() % 40);
                for (taut_vec3& point : points) point = vec(1);
                taut_hull_def def;
                taut_hull_def_init(&def);
                def.points = points.data();
                def.point_count = static_cast<uint32_t>(points.size());
                spoil(def.struct_size);
                added = run("taut_world_add_hull", [&] { return taut_world_add_hull(world, &def, &out); });
            }
        }
        if (added) keep(shapes_, out, w);
    }

    void read_shape() {
        const taut_shape shape = pick(shapes_, pick_world());
        const float density = real(1, 1e4);
        taut_mass_properties mass;
        if (ask("taut_shape_get_mass_properties",
                [&] { return taut_shape_get_mass_properties(shape, density, &mass); })) {
            expect(mass.mass >= 0 && finite(mass.centre_of_mass) && mass.inertia.xx >= 0, "a mass that is none");
        }
        std::vector<taut_vec3> points(byte() * 2u);
        uint32_t count = 0;
        ask("taut_shape_get_triangles", [&] {
            return taut_shape_get_triangles(shape, points.data(), static_cast<uint32_t>(points.size()), &count);
        });
        expect(count % 3 == 0, "triangles that are none");
        taut_shape_kind kind;
        if (ask("taut_shape_get_kind", [&] { return taut_shape_get_kind(shape, &kind); })) {
            expect(kind <= TAUT_SHAPE_SURFACE, "a kind that is none");
        }
        taut_vec3 low, high;
        if (ask("taut_shape_get_bounds", [&] { return taut_shape_get_bounds(shape, &low, &high); })) {
            expect(finite(low) && finite(high) && low.x < high.x && low.y < high.y && low.z < high.z, "no bounds");
        }
        read_def("taut_shape_get_plane", shape, taut_plane_def_init, taut_shape_get_plane);
        read_def("taut_shape_get_box", shape, taut_box_def_init, taut_shape_get_box);
        read_def("taut_shape_get_sphere", shape, taut_sphere_def_init, taut_shape_get_sphere);
        read_def("taut_shape_get_capsule", shape, taut_capsule_def_init, taut_shape_get_capsule);
        read_def("taut_shape_get_cylinder", shape, taut_cylinder_def_init, taut_shape_get_cylinder);
        read_def("taut_shape_get_cone", shape, taut_cone_def_init, taut_shape_get_cone);
        read_def("taut_shape_get_tapered_capsule", shape, taut_tapered_capsule_def_init,
                 taut_shape_get_tapered_capsule);
        if (one_in(8)) {
            const float cell = one_in(2) ? 0 : real(0.05, 1);
            run("taut_shape_sample_distance", [&] { return taut_shape_sample_distance(shape, cell); });
        }
        taut_mesh_info info;
        if (ask("taut_shape_get_mesh_info", [&] { return taut_shape_get_mesh_info(shape, &info); }))
            expect(info.facets > 0 && info.facets <= info.triangles, "facets that are none");
    }

    void bake_any() {
        if (live(baked_, taut_baked_is_valid) >= kMostBaked) return release_baked();
        std::vector<taut_vec3> points(8);
        std::vector<float> heights(9);
        std::vector<uint32_t> indices(12);
        for (taut_vec3& point : points) point = vec(2);
        for (float& height : heights) height = one_in(8) ? NAN : real(-1, 1);
        for (uint32_t& index : indices) index = word() % (one_in(64) ? 9 : 8);
        taut_baked out = {0};
        bool baked = false;
        switch (byte() % 3) {
            case 0: {
                taut_hull_def def;
                taut_hull_def_init(&def);
                def.points = points.data();
                def.point_count = 4 + word() % 5;
                spoil(def.struct_size);
                baked = run("taut_bake_hull", [&] { return taut_bake_hull(&def, nullptr, &out); });
                break;
            }
            case 1: {
                taut_mesh_def def;
                taut_mesh_def_init(&def);
                def.vertices = points.data();
                def.vertex_count = 8;
                def.indices = indices.data();
                def.triangle_count = 1 + word() % 4;
                baked = run("taut_bake_mesh", [&] { return taut_bake_mesh(&def, nullptr, &out); });
                break;
            }
            default: {
                taut_height_field_def def;
                taut_height_field_def_init(&def);
                def.rows = def.columns = 3;
                def.heights = heights.data();
                baked = run("taut_bake_height_field", [&] { return taut_bake_height_field(&def, nullptr, &out); });
            }
        }
        if (!baked) return;
        keep(baked_, out, 0);
        uint64_t bytes = 0;
        if (ask("taut_baked_get_bytes", [&] { return taut_baked_get_bytes(out, &bytes); }))
            expect(bytes > 0, "bytes that are none");
    }

    // Tetrahedra, which are closed, and now and then what is not.
    void decompose_any() {
        if (!one_in(6)) return;  // it takes long
        if (live(baked_, taut_baked_is_valid) >= kMostBaked) return release_baked();
        std::vector<taut_vec3> points(4);
        for (taut_vec3& point : points) point = vec(2);
        std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
        if (one_in(8)) indices[word() % 12] = word() % 5;
        taut_decomposition_def def;
        taut_decomposition_def_init(&def);
        spoil(def.struct_size);
        def.vertices = points.data();
        def.vertex_count = 4;
        def.indices = indices.data();
        def.triangle_count = 4;
        def.max_parts = 1 + byte() % (one_in(16) ? 255 : 2);
        def.close_holes = one_in(8);
        if (one_in(4)) def.tolerance = real(0.2, 1);
        taut_baked out[2] = {{0}, {0}};
        uint32_t count = 0;
        taut_decomposition_info info;
        if (!run("taut_bake_decomposition",
                 [&] { return taut_bake_decomposition(&def, nullptr, out, 2, &count, &info); }))
            return;
        expect(count > 0 && count <= def.max_parts, "parts that are none or too many");
        for (uint32_t i = 0; i < count; ++i) keep(baked_, out[i], 0);
    }

    void add_baked_shape() {
        if (live(shapes_, taut_shape_is_valid) >= kMostShapes) return;
        const size_t w = pick_world();
        const taut_baked baked = pick(baked_, 0);
        taut_shape out = {0};
        if (run("taut_world_add_baked", [&] { return taut_world_add_baked(worlds_[w], baked, &out); }))
            keep(shapes_, out, w);
    }

    void release_all() {
        for (const Known<taut_baked>& each : baked_) taut_baked_release(each.handle);
    }

private:
    static constexpr size_t kMostBaked = 6;

    void release_baked() {
        const taut_baked baked = pick(baked_, 0);
        if (run("taut_baked_release", [&] { return taut_baked_release(baked); }))
            expect(!taut_baked_is_valid(baked), "what was released and lives");
    }
    template <class Def>
    void read_def(const char* name, taut_shape shape, void (*init)(Def*), taut_result (*get)(taut_shape, Def*)) {
        Def def;
        init(&def);
        if (ask(name, [&] { return get(shape, &def); })) expect(def.struct_size == sizeof def, "a def that is none");
    }
};

}  // namespace taut_test
