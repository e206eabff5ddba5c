// Things of every kind that touch each other, for the tests of contacts of soft bodies.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "physics/cable_lab.h"
#include "physics/contact_lab.h"
#include "physics/deformable_lab.h"

namespace lab {

// How a thing is to be made: about a point, some 0.4 m across.
struct ThingPlan {
    Vec at{}, velocity{};
    double friction = 0.5;
    bool swept = false;  // elements of cloths and solids, joints of cables have no such choice
    uint32_t category = 1, mask = ~0u;

    // But for its group, which keeps parts of one apart.
    void filter(taut_filter& out) const { out.category = category, out.mask = mask; }
};

// Whether a segment goes through a triangle: volumes of the tetrahedra of its ends and of its line with the edges.
inline bool crosses(const Vec& p, const Vec& q, const Vec& a, const Vec& b, const Vec& c) {
    const auto volume = [](const Vec& o, const Vec& u, const Vec& v, const Vec& w) {
        return dot(u - o, cross(v - o, w - o));
    };
    if (volume(p, a, b, c) * volume(q, a, b, c) >= 0) return false;
    const double one = volume(p, q, a, b), two = volume(p, q, b, c), three = volume(p, q, c, a);
    return (one > 0 && two > 0 && three > 0) || (one < 0 && two < 0 && three < 0);
}

// What a kind is called, and how one of it is made; its bodies.
struct ThingKind {
    const char* name;
    bool soft;
    std::vector<taut_body> (*make)(const World& world, const ThingPlan& plan);
};

inline taut_deformable_solve solve_of(const ThingPlan& plan) {
    return plan.swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
}

inline taut_cloth make_cloth(const World& world, const ThingPlan& plan, int vertices = 5, double side = 0.4) {
    Sheet sheet(vertices, vertices, side, side, 0);
    for (taut_pos& point : sheet.points) point = (Vec(point) + plan.at - Vec{0.5 * side, 0, 0.5 * side}).pos();
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    def.area_density = 1;
    def.material.friction = static_cast<float>(plan.friction);
    def.material.restitution = 0;
    def.solve = solve_of(plan);
    plan.filter(def.filter);
    const taut_cloth cloth = add(world, def);
    set_velocities(bodies_of(cloth), plan.velocity);
    return cloth;
}
inline taut_solid make_solid(const World& world, const ThingPlan& plan, int vertices = 3, double side = 0.3,
                             double young = 1e5) {
    Beam cube({side, side, side}, vertices, vertices, vertices, false);
    for (taut_pos& point : cube.points) point = (Vec(point) + plan.at - 0.5 * Vec{side, side, side}).pos();
    taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, young, 0.3);
    def.damping = 0.01f;
    def.thickness = 0.02f;
    def.surface.friction = static_cast<float>(plan.friction);
    def.surface.restitution = 0;
    def.solve = solve_of(plan);
    plan.filter(def.filter);
    const taut_solid solid = add(world, def);
    set_velocities(bodies_of(solid), plan.velocity);
    return solid;
}
inline taut_cable make_cable(const World& world, const ThingPlan& plan, taut_cable_kind kind, double length = 0.5) {
    const taut_pos path[] = {(plan.at - Vec{0.5 * length, 0, 0}).pos(), (plan.at + Vec{0.5 * length, 0, 0}).pos()};
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = kind;
    def.points = path;
    def.point_count = 2;
    def.segment_count = 6;
    def.diameter = 0.04f;
    def.mass_per_metre = 2;
    def.material.friction = static_cast<float>(plan.friction);
    plan.filter(def.filter);
    taut_cable cable{};
    ok(taut_world_add_cable(world.handle, &def, &cable));
    set_velocities(bodies_of(cable), plan.velocity);
    return cable;
}
inline taut_body make_rigid(const World& world, const ThingPlan& plan, taut_shape shape) {
    const taut_body body = world.add(
        {.shape = shape, .position = plan.at, .velocity = plan.velocity, .mass = 2, .friction = plan.friction});
    taut_filter filter{};
    plan.filter(filter);
    ok(taut_collider_set_filter(collider_of(body), &filter));
    return body;
}
inline taut_body make_grain(const World& world, const ThingPlan& plan, bool grain) {
    taut_particle_def def;
    taut_particle_def_init(&def);
    def.mass = 0.5;
    def.position = plan.at.pos();
    def.velocity = plan.velocity.narrow();
    def.shape = world.sphere(0.05);
    def.material.friction = static_cast<float>(plan.friction);
    def.collider_flags = grain ? TAUT_COLLIDER_GRAIN : 0;
    plan.filter(def.filter);
    taut_body out{};
    ok(taut_world_add_particle(world.handle, &def, &out));
    return out;
}

inline const std::vector<ThingKind>& thing_kinds() {
    using List = std::vector<taut_body>;
    static const std::vector<ThingKind> all = {
        {"cloth", true, [](const World& w, const ThingPlan& p) { return bodies_of(make_cloth(w, p)); }},
        {"solid", true, [](const World& w, const ThingPlan& p) { return bodies_of(make_solid(w, p)); }},
        {"cable", false,
         [](const World& w, const ThingPlan& p) { return bodies_of(make_cable(w, p, TAUT_CABLE_PARTICLES)); }},
        {"links", false,
         [](const World& w, const ThingPlan& p) { return bodies_of(make_cable(w, p, TAUT_CABLE_LINKS)); }},
        {"grain", false, [](const World& w, const ThingPlan& p) { return List{make_grain(w, p, true)}; }},
        {"particle", false, [](const World& w, const ThingPlan& p) { return List{make_grain(w, p, false)}; }},
        {"ball", false, [](const World& w, const ThingPlan& p) { return List{make_rigid(w, p, w.sphere(0.1))}; }},
        {"box", false,
         [](const World& w, const ThingPlan& p) {
             return List{make_rigid(w, p, w.box({0.1, 0.07, 0.08}))};
         }},
        {"capsule", false,
         [](const World& w, const ThingPlan& p) { return List{make_rigid(w, p, w.capsule(0.05, 0.1))}; }},
        {"cylinder", false,
         [](const World& w, const ThingPlan& p) { return List{make_rigid(w, p, w.cylinder(0.08, 0.06))}; }},
        {"cone", false, [](const World& w, const ThingPlan& p) { return List{make_rigid(w, p, w.cone(0.08, 0.1))}; }},
    };
    return all;
}

// Something soft and what it meets.
struct Meeting {
    const ThingKind *one, *other;
    bool swept;

    std::string name() const { return std::string(one->name) + "_" + other->name + (swept ? "_swept" : ""); }
};

// Every pair of kinds that meet, soft ones with each other once, direct and swept.
inline std::vector<Meeting> meetings() {
    std::vector<Meeting> out;
    for (const ThingKind& one : thing_kinds())
        for (const ThingKind& other : thing_kinds())
            for (const bool swept : {false, true})
                if (one.soft && (!other.soft || &one <= &other)) out.push_back({&one, &other, swept});
    return out;
}

}  // namespace lab
