// What the calls of cloth.h and solid.h share: checks of a mesh, and what is read of a soft body alike.
#pragma once

#include <taut/deformable.h>

#include "api/access.h"
#include "api/collider_def.h"
#include "api/copy_out.h"
#include "models/air.h"
#include "models/soft_cost.h"
#include "models/soft_reading.h"
#include "sleep/wake.h"

namespace taut {

constexpr Range kThickness{1e-4, 1};   // [m]
constexpr Range kSoftDamping{0, 10};   // [s]
constexpr Range kMassDamping{0, 1e4};  // [1/s]
constexpr Range kAirDrag{0, 100};
constexpr Range kPressure{-1e7, 1e7};      // over that of the air [Pa]
constexpr double kLeastVertexMass = 1e-9;  // [kg], as of particles

// The mesh of a def.
struct MeshDef {
    const taut_pos *points, *rest;  // rest may be null
    uint32_t point_count, least_points;
    const char *cells_name, *count_name;  // fields, for refusals
    const uint32_t* cells;
    uint32_t cell_count, corners;
};
// Counts, pointers, positions and indices: each cell has corners that differ.
bool check_mesh(Check& check, const MeshDef& mesh);
bool check_positions(Check& check, const char* name, const taut_pos* points, uint32_t count);
bool check_cells(Check& check, const MeshDef& mesh);
// What def structs have in common, but for the mesh.
Check& check_soft(Check& check, const taut_material& surface, const MaterialNames& names, const taut_filter& filter,
                  float thickness, float damping, float gravity_scale, const taut_deformable_solve& solve);

Check& check_rayleigh(Check& check, float mass_damping, float stiffness_damping);
Check& check_air(Check& check, float drag, float lift);
// Of a plan that has all else; false: refused.
bool plan_checked_air(Check& check, const World& world, AirTraits traits, taut_deformable_solve solve, SoftPlan& plan);

Array<Vec3> positions_of(World& world, const taut_pos* from, uint32_t count);
// Whether the world's solver takes what is swept apart from the rest.
bool may_sweep(const World& world);
// plan_as(solve, plan) fills an empty plan, of which air has no part yet, and says why it cannot; null: it has. As a
// def asks for it or, left to choose, as is cheapest; then `solve` says which.
template <class PlanAs>
const char* plan_soft(World& world, bool encloses, PlanAs&& plan_as, taut_deformable_solve& solve, SoftPlan& plan) {
    const JointSolve first = solve == TAUT_DEFORMABLE_SWEPT ? JointSolve::swept : JointSolve::direct;
    if (const char* fault = plan_as(first, plan)) return fault;
    if (solve != TAUT_DEFORMABLE_AUTO) return nullptr;
    solve = TAUT_DEFORMABLE_DIRECT;
    if (encloses || !may_sweep(world) || cheapest_solve(world, plan) == JointSolve::direct) return nullptr;
    solve = TAUT_DEFORMABLE_SWEPT;
    plan.element.clear();
    plan.soft.triangle.clear();
    return plan_as(JointSolve::swept, plan);
}
// Spheres of the vertices.
void plan_spheres(SoftPlan& plan, float thickness, const taut_material& surface, const taut_filter& filter);
// Room for the plan, masses that a particle may have; then it is added.
taut_result add_planned(Check& check, World& world, const SoftPlan& plan, uint32_t& index);

// ---------------------------------------------------------------- read

// act(world, soft) for a handle of a cloth or solid.
template <class Handle, class Act>
taut_result read_soft(const char* call, Handle handle, Act&& act) {
    return with(call, handle, Use::read,
                [&](const World& world, uint32_t index) { return act(world, world.softs.record[index]); });
}

template <class Handle>
taut_result soft_user_data(Check& check, Handle handle, uint64_t* out) {
    if (!check.pointer("out", out)) return check.result();
    return read_soft(check.call(), handle, [&](const World&, const Soft& soft) {
        *out = soft.user_data;
        return TAUT_OK;
    });
}

template <class Handle>
taut_result soft_solve(Check& check, Handle handle, taut_deformable_solve* out) {
    if (!check.pointer("out", out)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        const bool swept = world.elements.set[soft.sets[0].set].solve == JointSolve::swept;
        *out = swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
        return TAUT_OK;
    });
}

// get(world, soft, vertex) of each vertex.
template <class Handle, class T, class Get>
taut_result read_vertices(Check& check, Handle handle, const char* name, T* out, uint32_t capacity, uint32_t* count,
                          Get&& get) {
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        return copy_out(soft.vertices(), out, capacity, count, check.call(), name,
                        [&](uint32_t v) { return get(world, soft, v); });
    });
}
template <class Handle>
taut_result read_points(Check& check, Handle handle, taut_pos* out, uint32_t capacity, uint32_t* count) {
    return read_vertices(
        check, handle, "points", out, capacity, count,
        [](const World& world, const Soft& soft, uint32_t v) { return to_pos(vertex_of(world, soft, v)); });
}
template <class Handle>
taut_result read_velocities(Check& check, Handle handle, taut_vec3* out, uint32_t capacity, uint32_t* count) {
    return read_vertices(
        check, handle, "velocities", out, capacity, count,
        [](const World& world, const Soft& soft, uint32_t v) { return to_vec3(world.nodes.motion[soft.node[v]].v); });
}
template <class Handle>
taut_result read_bodies(Check& check, Handle handle, taut_body* out, uint32_t capacity, uint32_t* count) {
    return read_vertices(
        check, handle, "bodies", out, capacity, count,
        [](const World& world, const Soft& soft, uint32_t v) { return world.body_handle(soft.node[v]); });
}
template <class Handle>
taut_result read_normals(Check& check, Handle handle, taut_vec3* out, uint32_t capacity, uint32_t* count) {
    if (!check.pointer("count", count)) return check.result();
    // Scratch of the world's memory: a reader holds it alone in that.
    return with(check.call(), handle, Use::alone, [&](World& world, uint32_t index) {
        const Soft& soft = world.softs.record[index];
        Array<Vec3> normal(world.memory);
        soft_normals(world, soft, normal);
        return copy_out(soft.vertices(), out, capacity, count, check.call(), "normals",
                        [&](uint32_t v) { return to_vec3(normal[v]); });
    });
}
template <class Handle>
taut_result read_triangles(Check& check, Handle handle, uint32_t* out, uint32_t capacity, uint32_t* count) {
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World&, const Soft& soft) {
        *count = soft.triangles();
        if (capacity < *count)
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, %u needed", check.call(), capacity, *count);
        if (!out) return refuse(TAUT_NULL_POINTER, "%s: triangles is null", check.call());
        std::copy(soft.triangle.begin(), soft.triangle.end(), out);
        return TAUT_OK;
    });
}

template <class Handle>
taut_result pin_soft(Check& check, Handle handle, uint32_t vertex, uint32_t pinned) {
    if (!check.boolean("pinned", pinned)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        const Soft& soft = world.softs.record[index];
        if (!check.count("vertex", vertex, 0, soft.vertices() - 1)) return check.result();
        pin_vertex(world, soft, vertex, pinned != 0);
        return TAUT_OK;
    });
}

// Bits of all its colliders; which: those that bits may be of.
void ask_of_soft(World& world, const Soft& soft, uint32_t which, uint32_t bits);

template <class Handle>
taut_result set_soft_asks(Check& check, Handle handle, uint32_t which, uint32_t bits) {
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        ask_of_soft(world, world.softs.record[index], which, bits);
        return TAUT_OK;
    });
}
template <class Handle>
taut_result set_soft_contact_events(Check& check, Handle handle, uint32_t contact_events) {
    check.count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL);
    return set_soft_asks(check, handle, TAUT_CONTACT_EVENTS_ALL, contact_events);
}
template <class Handle>
taut_result set_soft_pre_solve(Check& check, Handle handle, int32_t pre_solve) {
    check.boolean("pre_solve", static_cast<uint32_t>(pre_solve));
    return set_soft_asks(check, handle, kAsksPreSolve, pre_solve ? kAsksPreSolve : 0);
}

// The soft body that a body is a vertex of: its handle by get(world, soft), null for any other.
template <class Handle, class Get>
taut_result soft_of_body(Check& check, taut_body handle, Handle* out, Get&& get) {
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = get(world, world.nodes.info[node].soft);
        return TAUT_OK;
    });
}

}  // namespace taut
