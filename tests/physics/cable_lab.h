// Cables for the tests, made and read through the public C API.
#pragma once

#include "physics/lab.h"

namespace lab {

inline taut_cable_end_def to_world(const Vec& point) { return {1, 0, {0}, point.pos()}; }
inline taut_cable_end_def to_body(taut_body body, const Vec& anchor = {}) { return {1, 0, body, anchor.pos()}; }

class CableLab : public World {
public:
    using World::World;

    static taut_cable_def plan(taut_cable_kind kind) {
        taut_cable_def d;
        taut_cable_def_init(&d);
        d.kind = kind;
        return d;
    }
    // From the origin of the world to a body.
    static taut_cable_def plan(taut_cable_kind kind, taut_body load) {
        taut_cable_def d = plan(kind);
        d.end[0] = to_world({0, 0, 0});
        d.end[1] = to_body(load);
        return d;
    }
    taut_cable cable(const taut_cable_def& d) const {
        taut_cable out{};
        ok(taut_world_add_cable(handle, &d, &out));
        return out;
    }
};

// Twenty segments from the origin, where the cable is clamped, straight to a point.
struct CableBeam {
    CableBeam(taut_cable_kind kind, const Vec& tip) : path{{0, 0, 0}, tip.pos()}, def(CableLab::plan(kind)) {
        def.points = path;
        def.point_count = 2;
        def.end[0] = to_world({0, 0, 0});
        def.end[0].clamped = 1;
        def.segment_count = 20;
    }
    CableBeam(const CableBeam&) = delete;
    CableBeam& operator=(const CableBeam&) = delete;

    taut_pos path[2];
    taut_cable_def def;
};

// What one of the calls that fill an array says of a cable.
template <class T>
std::vector<T> list_of(taut_cable cable, taut_result (*get)(taut_cable, T*, uint32_t, uint32_t*)) {
    uint32_t count = 0;
    get(cable, nullptr, 0, &count);
    std::vector<T> out(count);
    ok(get(cable, out.data(), count, &count));
    return out;
}
inline std::vector<Vec> points_of(taut_cable cable) {
    const auto points = list_of(cable, taut_cable_get_points);
    return {points.begin(), points.end()};
}
inline std::vector<double> tensions_of(taut_cable cable) {
    const auto tensions = list_of(cable, taut_cable_get_tensions);
    return {tensions.begin(), tensions.end()};
}
inline std::vector<taut_body> bodies_of(taut_cable cable) { return list_of(cable, taut_cable_get_bodies); }

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
