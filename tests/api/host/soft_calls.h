// Calls of cloth.h, solid.h and deformable.h, and those of query.h and attachment.h about surfaces. Cloths and solids
// are in world 1, whose events nobody keeps books of.
#pragma once

#include "host.h"

namespace taut_test {

class SoftCalls : protected virtual Host {
protected:
    void add_soft() {
        if (live(cloths_, taut_cloth_is_valid) + live(solids_, taut_solid_is_valid) >= 4) return;
        const size_t side = 2 + byte() % 4;
        const taut_pos at = {number(-3, 3), number(0, 3), number(-3, 3)};
        one_in(2) ? add_cloth(at, side) : add_solid(at);
    }

    void remove_soft() {
        if (!one_in(4)) return;
        const taut_cloth cloth = pick(cloths_, 1);
        if (run("taut_cloth_remove", [&] { return taut_cloth_remove(cloth); }))
            expect(!taut_cloth_is_valid(cloth), "a removed cloth that lives");
        const taut_solid solid = pick(solids_, 1);
        if (run("taut_solid_remove", [&] { return taut_solid_remove(solid); }))
            expect(!taut_solid_is_valid(solid), "a removed solid that lives");
    }

    void read_cloth() {
        const taut_cloth cloth = pick(cloths_, 1);
        read_points("taut_cloth_get_points", cloth, taut_cloth_get_points);
        read_list<taut_vec3>("taut_cloth_get_velocities", cloth, taut_cloth_get_velocities);
        read_list<taut_vec3>("taut_cloth_get_normals", cloth, taut_cloth_get_normals);
        read_list<float>("taut_cloth_get_strains", cloth, taut_cloth_get_strains);
        read_list<uint32_t>("taut_cloth_get_triangles", cloth, taut_cloth_get_triangles);
        read_bodies("taut_cloth_get_bodies", cloth, taut_cloth_get_bodies, taut_body_get_cloth);
        uint64_t data = 0;
        taut_deformable_solve solve;
        double volume = 0;
        float pressure = 0;
        ask("taut_cloth_get_user_data", [&] { return taut_cloth_get_user_data(cloth, &data); });
        ask("taut_cloth_get_solve", [&] { return taut_cloth_get_solve(cloth, &solve); });
        if (ask("taut_cloth_get_volume", [&] { return taut_cloth_get_volume(cloth, &volume); }))
            expect(std::isfinite(volume), "a volume that is not finite");
        if (ask("taut_cloth_get_pressure", [&] { return taut_cloth_get_pressure(cloth, &pressure); }))
            expect(std::isfinite(pressure), "a pressure that is not finite");
    }

    void read_solid() {
        const taut_solid solid = pick(solids_, 1);
        read_points("taut_solid_get_points", solid, taut_solid_get_points);
        read_list<taut_vec3>("taut_solid_get_velocities", solid, taut_solid_get_velocities);
        read_list<taut_vec3>("taut_solid_get_normals", solid, taut_solid_get_normals);
        read_list<float>("taut_solid_get_stresses", solid, taut_solid_get_stresses);
        read_list<float>("taut_solid_get_volumes", solid, taut_solid_get_volumes);
        read_list<float>("taut_solid_get_plastic_strains", solid, taut_solid_get_plastic_strains);
        read_list<uint32_t>("taut_solid_get_triangles", solid, taut_solid_get_triangles);
        read_bodies("taut_solid_get_bodies", solid, taut_solid_get_bodies, taut_body_get_solid);
        uint64_t data = 0;
        taut_deformable_solve solve;
        ask("taut_solid_get_user_data", [&] { return taut_solid_get_user_data(solid, &data); });
        ask("taut_solid_get_solve", [&] { return taut_solid_get_solve(solid, &solve); });
    }

    void write_soft() {
        const taut_cloth cloth = pick(cloths_, 1);
        const taut_solid solid = pick(solids_, 1);
        const uint32_t vertex = byte() % (one_in(16) ? 256 : 8), pinned = byte() % (one_in(16) ? 3 : 2);
        const uint32_t events = byte() % (one_in(16) ? 32 : 16);
        const int32_t asks = byte() % (one_in(16) ? 3 : 2);
        const float pressure = real(-100, 100);
        uint32_t inverted = 0;
        run("taut_cloth_pin", [&] { return taut_cloth_pin(cloth, vertex, pinned); });
        run("taut_solid_pin", [&] { return taut_solid_pin(solid, vertex, pinned); });
        run("taut_cloth_set_contact_events", [&] { return taut_cloth_set_contact_events(cloth, events); });
        run("taut_solid_set_contact_events", [&] { return taut_solid_set_contact_events(solid, events); });
        run("taut_cloth_set_pre_solve", [&] { return taut_cloth_set_pre_solve(cloth, asks); });
        run("taut_solid_set_pre_solve", [&] { return taut_solid_set_pre_solve(solid, asks); });
        run("taut_cloth_set_pressure", [&] { return taut_cloth_set_pressure(cloth, pressure); });
        if (one_in(4)) run("taut_solid_recover", [&] { return taut_solid_recover(solid, 1 + byte() % 3, &inverted); });
    }

    void read_surfaces() {
        const taut_world world = worlds_[pick_world()];
        const taut_pos point = pos(5);
        const float reach = real(0, 5);
        const taut_ray ray = {pos(5), vec(10), 0};
        taut_surface_hit hits[8];
        uint32_t count = 0;
        ask("taut_world_cast_ray_surface", [&] { return taut_world_cast_ray_surface(world, &ray, nullptr, hits); });
        ask("taut_world_closest_surface",
            [&] { return taut_world_closest_surface(world, point, reach, nullptr, hits); });
        ask("taut_world_overlap_surfaces",
            [&] { return taut_world_overlap_surfaces(world, point, reach, nullptr, hits, 8, &count); });
        taut_anchor anchor;
        const taut_cloth cloth = pick(cloths_, 1);
        const taut_solid solid = pick(solids_, 1);
        const taut_body body = pick_body(1);
        const float weights[3] = {0.25f, 0.25f, 0.5f};
        const uint32_t triangle = byte() % 16;
        ask("taut_world_get_anchor", [&] { return taut_world_get_anchor(worlds_[1], body, point, &anchor); });
        ask("taut_cloth_get_anchor", [&] { return taut_cloth_get_anchor(cloth, triangle, weights, &anchor); });
        ask("taut_solid_get_anchor", [&] { return taut_solid_get_anchor(solid, triangle, weights, &anchor); });
        ask("taut_cloth_find_anchor", [&] { return taut_cloth_find_anchor(cloth, point, &anchor, &count); });
        ask("taut_solid_find_anchor", [&] { return taut_solid_find_anchor(solid, point, &anchor, &count); });
    }

private:
    // A sheet of side x side vertices.
    void add_cloth(const taut_pos& at, size_t side) {
        std::vector<taut_pos> points;
        std::vector<uint32_t> triangles, quads;
        const double cell = one_in(8) ? number(1e-3, 5) : 0.2;
        for (size_t i = 0; i < side * side; ++i)
            points.push_back(
                {at.x + cell * static_cast<double>(i % side), at.y, at.z + cell * static_cast<double>(i / side)});
        for (size_t row = 0; row + 1 < side; ++row)
            for (size_t column = 0; column + 1 < side; ++column) {
                const auto a = static_cast<uint32_t>(row * side + column), n = static_cast<uint32_t>(side);
                for (const uint32_t corner : {a, a + n, a + 1, a + 1, a + n, a + n + 1}) triangles.push_back(corner);
                for (const uint32_t corner : {a, a + n, a + n + 1, a + 1}) quads.push_back(corner);
            }
        if (one_in(32)) triangles[word() % triangles.size()] = word() % 40;
        taut_cloth_def def;
        taut_cloth_def_init(&def);
        if (one_in(3)) taut_cloth_def_set_fabric(&def, static_cast<taut_fabric>(byte() % 8));
        spoil(def.struct_size);
        def.kind = static_cast<taut_cloth_kind>(byte() % (one_in(16) ? 4 : 3));
        def.points = points.data();
        def.point_count = static_cast<uint32_t>(points.size());
        if (def.kind == TAUT_CLOTH_QUADS) {
            def.quads = quads.data();
            def.quad_count = static_cast<uint32_t>(quads.size() / 4);
        } else {
            def.triangles = triangles.data();
            def.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
        }
        if (one_in(4)) def.area_density = real(1e-3, 100);
        if (one_in(4)) def.thickness = real(1e-3, 0.1);
        if (one_in(3)) def.solve = static_cast<taut_deformable_solve>(byte() % (one_in(16) ? 5 : 3));
        if (one_in(4)) def.air_drag = real(0, 1);
        if (one_in(4)) def.self_collision = 1;
        taut_cloth out = {0};
        if (!run("taut_world_add_cloth", [&] { return taut_world_add_cloth(worlds_[1], &def, &out); })) return;
        keep(cloths_, out, 1);
        keep_bodies(out, taut_cloth_get_bodies);
    }

    // A cube of five or six tetrahedra, or of one hexahedron.
    void add_solid(const taut_pos& at) {
        const double side = one_in(8) ? number(1e-2, 3) : 0.4;
        std::vector<taut_pos> points;
        for (int i = 0; i < 8; ++i)
            points.push_back({at.x + side * (i & 1), at.y + side * (i >> 1 & 1), at.z + side * (i >> 2)});
        std::vector<uint32_t> tetrahedra = {0, 1, 2, 4, 3, 2, 1, 7, 5, 1, 4, 7, 6, 4, 2, 7, 1, 2, 4, 7};
        std::vector<uint32_t> hexahedron = {0, 1, 3, 2, 4, 5, 7, 6};
        if (one_in(32)) tetrahedra[word() % tetrahedra.size()] = word() % 10;
        taut_solid_def def;
        taut_solid_def_init(&def);
        if (one_in(3)) taut_solid_def_set_substance(&def, static_cast<taut_substance>(byte() % 8));
        spoil(def.struct_size);
        def.material = static_cast<taut_solid_material>(byte() % (one_in(16) ? 6 : 4));
        def.points = points.data();
        def.point_count = 8;
        def.corners = one_in(3) ? 8 : 4;
        def.cells = def.corners == 8 ? hexahedron.data() : tetrahedra.data();
        def.cell_count = def.corners == 8 ? 1 : 5;
        if (one_in(3)) def.young_modulus = real(1e3, 1e8);
        if (one_in(4)) def.density = real(1, 5000);
        if (one_in(3)) def.solve = static_cast<taut_deformable_solve>(byte() % (one_in(16) ? 5 : 3));
        if (one_in(4)) def.yield_stress = real(100, 1e5);
        taut_solid out = {0};
        if (!run("taut_world_add_solid", [&] { return taut_world_add_solid(worlds_[1], &def, &out); })) return;
        keep(solids_, out, 1);
        keep_bodies(out, taut_solid_get_bodies);
    }

    template <class Handle, class Get>
    void keep_bodies(Handle handle, Get get) {
        taut_body bodies[64];
        uint32_t count = 0;
        if (get(handle, bodies, 64, &count) != TAUT_OK) return expect(false, "vertices that are not told");
        for (uint32_t i = 0; i < count; ++i) keep(cable_bodies_, bodies[i], 1);
    }
    template <class Item, class Handle, class Get>
    std::vector<Item> read_list(const char* name, Handle handle, Get get) {
        const uint32_t room = 1 + byte() % 128, items = std::is_same_v<Item, uint32_t> ? 3 : 1;  // a triangle's corners
        std::vector<Item> out(items * room);
        uint32_t count = 0;
        const bool told = ask(name, [&] { return get(handle, out.data(), room, &count); });
        out.resize(told ? count : 0);
        if constexpr (std::is_same_v<Item, taut_vec3>)
            for (const taut_vec3& each : out) expect(finite(each), "a vector that is not finite");
        if constexpr (std::is_same_v<Item, float>)
            for (const float each : out) expect(!std::isnan(each), "a strain or stress that is none");
        return out;
    }
    template <class Handle, class Get>
    void read_points(const char* name, Handle handle, Get get) {
        for (const taut_pos& each : read_list<taut_pos>(name, handle, get))
            expect(finite(each), "a point that is not finite");
    }
    template <class Handle, class Get, class Of>
    void read_bodies(const char* name, Handle handle, Get get, Of of) {
        for (const taut_body& each : read_list<taut_body>(name, handle, get)) {
            Handle owner = {0};
            expect(of(each, &owner) == TAUT_OK && owner.bits == handle.bits, "a vertex of nobody");
        }
    }
};

}  // namespace taut_test
