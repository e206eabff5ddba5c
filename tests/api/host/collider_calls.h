// Calls of collider.h, and of sensor.h that change a collider.
#pragma once

#include "host.h"

namespace taut_test {

class ColliderCalls : protected virtual Host {
protected:
    void add_collider() {
        if (live(colliders_, taut_collider_is_valid) >= kMostColliders) return;
        const size_t w = pick_world();
        const taut_body body = pick_body(w);
        const taut_collider_def def = collider_def(w);
        taut_collider out = {0};
        if (run("taut_body_add_collider", [&] { return taut_body_add_collider(body, &def, &out); }))
            keep(colliders_, out, world_of(bodies_, body, world_of(cable_bodies_, body, w)));
    }

    void remove_collider() {
        const taut_collider collider = pick(colliders_, pick_world());
        if (run("taut_collider_remove", [&] { return taut_collider_remove(collider); }))
            expect(!taut_collider_is_valid(collider), "a removed collider that lives");
    }

    void read_collider() {
        const taut_collider collider = pick(colliders_, pick_world());
        taut_collider_def def;
        if (ask("taut_collider_get_def", [&] { return taut_collider_get_def(collider, &def); })) {
            expect(def.struct_size == sizeof def && taut_shape_is_valid(def.shape), "a def that is none");
            expect(finite(def.position) && def.density >= 0, "a def with numbers that are none");
        }
        taut_body body;
        if (ask("taut_collider_get_body", [&] { return taut_collider_get_body(collider, &body); }))
            expect(taut_body_is_valid(body), "a collider of a dead body");
        uint64_t data = word();
        run("taut_collider_set_user_data", [&] { return taut_collider_set_user_data(collider, data); });
        ask("taut_collider_get_user_data", [&] { return taut_collider_get_user_data(collider, &data); });
        taut_vec3 velocity, spin;
        if (ask("taut_collider_get_surface_velocity",
                [&] { return taut_collider_get_surface_velocity(collider, &velocity, &spin); }))
            expect(finite(velocity) && finite(spin), "a surface velocity that is not finite");
        std::vector<taut_collider> overlaps(byte() % 8);
        uint32_t count = 0;
        if (ask("taut_collider_get_overlaps", [&] {
                return taut_collider_get_overlaps(collider, overlaps.data(), static_cast<uint32_t>(overlaps.size()),
                                                  &count);
            }))
            for (uint32_t i = 0; i < count; ++i)
                expect(taut_collider_is_valid(overlaps[i]) && overlaps[i].bits != collider.bits, "a visitor of none");
    }

    void write_collider() {
        const size_t w = pick_world();
        const taut_collider collider = pick(colliders_, w);
        switch (byte() % 10) {
            case 0: {
                const taut_shape shape = pick(shapes_, w);
                const taut_vec3 position = vec(1);
                const taut_quat rotation = quat();
                run("taut_collider_set_shape",
                    [&] { return taut_collider_set_shape(collider, shape, position, rotation); });
                break;
            }
            case 1: {
                const taut_material changed = material(100);
                run("taut_collider_set_material", [&] { return taut_collider_set_material(collider, &changed); });
                break;
            }
            case 2: {
                taut_filter filter;
                taut_filter_init(&filter);
                if (one_in(2)) filter.category = word(), filter.mask = word();
                filter.group = byte() % 5 - 2;
                spoil(filter.reserved);
                run("taut_collider_set_filter", [&] { return taut_collider_set_filter(collider, &filter); });
                break;
            }
            case 3: {
                const float density = real(0, 5000);
                run("taut_collider_set_density", [&] { return taut_collider_set_density(collider, density); });
                break;
            }
            case 4: {
                const taut_vec3 velocity = vec(10), spin = vec(10);
                run("taut_collider_set_surface_velocity",
                    [&] { return taut_collider_set_surface_velocity(collider, velocity, spin); });
                break;
            }
            case 5: {
                const uint32_t asked = byte() % (one_in(16) ? 32 : 16);
                run("taut_collider_set_contact_events",
                    [&] { return taut_collider_set_contact_events(collider, asked); });
                break;
            }
            case 6: {
                const int32_t asked = byte() % (one_in(16) ? 3 : 2);
                run("taut_collider_set_pre_solve", [&] { return taut_collider_set_pre_solve(collider, asked); });
                break;
            }
            case 7: {
                const taut_vec3 direction = one_in(2) ? taut_vec3{0, 0, 0} : vec(1);
                run("taut_collider_set_one_way", [&] { return taut_collider_set_one_way(collider, direction); });
                break;
            }
            case 8: {
                const taut_friction changed = friction();
                run("taut_collider_set_friction", [&] { return taut_collider_set_friction(collider, &changed); });
                break;
            }
            default: {
                const uint32_t sensor = byte() % (one_in(16) ? 3 : 2);
                run("taut_collider_set_sensor", [&] { return taut_collider_set_sensor(collider, sensor); });
            }
        }
    }

private:
    static constexpr size_t kMostColliders = 60;
};

}  // namespace taut_test
