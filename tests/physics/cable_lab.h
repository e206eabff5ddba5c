// Cables for the tests, made and read through the public C API.
#pragma once

#include "physics/lab.h"

namespace lab {

class CableLab : public World {
public:
    using World::World;

    static taut_cable_def plan(taut_cable_kind kind) {
        taut_cable_def d;
        taut_cable_def_init(&d);
        d.kind = kind;
        return d;
    }
    taut_cable cable(const taut_cable_def& d) const {
        taut_cable out{};
        ok(taut_world_add_cable(handle, &d, &out));
        return out;
    }
};

inline taut_cable_end_def to_world(const Vec& point) { return {1, 0, {0}, point.pos()}; }
inline taut_cable_end_def to_body(taut_body body, const Vec& anchor = {}) { return {1, 0, body, anchor.pos()}; }

inline std::vector<Vec> points_of(taut_cable cable) {
    uint32_t count = 0;
    taut_cable_get_points(cable, nullptr, 0, &count);
    std::vector<taut_pos> points(count);
    ok(taut_cable_get_points(cable, points.data(), count, &count));
    return {points.begin(), points.end()};
}
inline std::vector<double> tensions_of(taut_cable cable) {
    uint32_t count = 0;
    taut_cable_get_tensions(cable, nullptr, 0, &count);
    std::vector<float> tensions(count);
    ok(taut_cable_get_tensions(cable, tensions.data(), count, &count));
    return {tensions.begin(), tensions.end()};
}
inline std::vector<taut_body> bodies_of(taut_cable cable) {
    uint32_t count = 0;
    taut_cable_get_bodies(cable, nullptr, 0, &count);
    std::vector<taut_body> bodies(count);
    ok(taut_cable_get_bodies(cable, bodies.data(), count, &count));
    return bodies;
}
// Steps in air as thick as syrup: takes a share of each body's velocity away.
inline void settle(const World& world, const std::vector<taut_body>& bodies, int steps, double share = 0.1) {
    for (int i = 0; i < steps; ++i) {
        for (taut_body body : bodies) {
            const BodyState s = state(body);
            ok(taut_body_set_velocity(body, ((1 - share) * s.velocity).narrow(), ((1 - share) * s.spin).narrow()));
        }
        world.step();
    }
}
inline double length_of(taut_cable cable) {
    float length = 0;
    ok(taut_cable_get_length(cable, &length));
    return static_cast<double>(length);
}

}  // namespace lab
