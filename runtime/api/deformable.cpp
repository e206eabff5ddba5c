#include "api/deformable.h"

#include <cstdio>

#include "integrate/scheme.h"

namespace taut {

bool check_positions(Check& check, const char* name, const taut_pos* points, uint32_t count) {
    for (uint32_t i = 0; check && i < count; ++i) {
        char field[32];
        std::snprintf(field, sizeof field, "%s[%u]", name, i);
        check.bounded(field, points[i], kPosition);
    }
    return static_cast<bool>(check);
}

bool check_cells(Check& check, const MeshDef& mesh) {
    for (uint32_t c = 0; check && c < mesh.cell_count; ++c)
        for (uint32_t k = 0; check && k < mesh.corners; ++k) {
            const uint32_t* cell = mesh.cells + size_t{c} * mesh.corners;
            char field[48];
            std::snprintf(field, sizeof field, "%s[%u][%u]", mesh.cells_name, c, k);
            check.count(field, cell[k], 0, mesh.point_count - 1);
            for (uint32_t m = 0; check && m < k; ++m) {
                char text[96];
                std::snprintf(text, sizeof text, "%s[%u] names a vertex twice", mesh.cells_name, c);
                check.require(cell[m] != cell[k], text);
            }
        }
    return static_cast<bool>(check);
}

bool check_mesh(Check& check, const MeshDef& mesh) {
    check.count("point_count", mesh.point_count, mesh.least_points, TAUT_DEFORMABLE_MAX)
        .count(mesh.count_name, mesh.cell_count, 1, TAUT_DEFORMABLE_MAX)
        .pointer("points", mesh.points)
        .pointer(mesh.cells_name, mesh.cells);
    return check && check_positions(check, "points", mesh.points, mesh.point_count) &&
           (!mesh.rest || check_positions(check, "rest", mesh.rest, mesh.point_count)) && check_cells(check, mesh);
}

Check& check_soft(Check& check, const taut_material& surface, const MaterialNames& names, const taut_filter& filter,
                  float thickness, float damping, float gravity_scale, const taut_deformable_solve& solve) {
    check.number("thickness", thickness, kThickness)
        .number("damping", damping, kSoftDamping)
        .number("gravity_scale", gravity_scale, kGravityScale)
        .choice("solve", solve, TAUT_DEFORMABLE_AUTO);
    check_material(check, names, surface).zero("filter.reserved", filter.reserved);
    return check.require(filter.group <= 0,
                         "filter.group is positive, which makes the vertices collide with each other");
}

Check& check_rayleigh(Check& check, float mass_damping, float stiffness_damping) {
    return check.number("mass_damping", mass_damping, kMassDamping)
        .number("stiffness_damping", stiffness_damping, kSoftDamping);
}

Check& check_air(Check& check, float drag, float lift) {
    return check.number("air_drag", drag, kAirDrag)
        .number("air_lift", lift, kAirDrag)
        .require(lift <= drag, "air_lift is more than air_drag, which would push a surface along itself");
}

bool plan_checked_air(Check& check, const World& world, AirTraits traits, taut_deformable_solve solve, SoftPlan& plan) {
    traits.outside = world.def.air_pressure;
    traits.swept = solve == TAUT_DEFORMABLE_SWEPT || !solvers()[world.def.solver]->direct;
    const char* fault = plan_air(traits, plan);
    check.require(!fault, fault);
    return static_cast<bool>(check);
}

Array<Vec3> positions_of(World& world, const taut_pos* from, uint32_t count) {
    Array<Vec3> out(world.memory);
    out.resize(count);
    for (uint32_t i = 0; i < count; ++i) out[i] = to_vec(from[i]);
    return out;
}

bool may_sweep(const World& world) {
    const Solver& solver = *solvers()[world.def.solver];
    return solver.direct && solver.lanes && !scheme_types()[world.def.scheme]->start;
}

void plan_spheres(SoftPlan& plan, float thickness, const taut_material& surface, const taut_filter& filter) {
    plan.radius = filter.mask == 0 ? 0 : 0.5 * static_cast<double>(thickness);
    plan.traits.material = surface;
    plan.traits.filter = filter;
}

taut_result add_planned(Check& check, World& world, const SoftPlan& plan, uint32_t& index) {
    for (uint32_t v = 0; check && v < plan.soft.mass.size(); ++v) {
        char field[48];
        std::snprintf(field, sizeof field, plan.soft.mass[v] > 0 ? "mass of vertex %u" : "vertex %u", v);
        if (plan.soft.mass[v] > 0)
            check.number(field, plan.soft.mass[v], kParticleMass);
        else
            check.require(false, (std::strcat(field, " is of no cell"), field));
    }
    if (!check) return check.result();
    const size_t count = plan.position.size();
    taut_result room = room_for_bodies(check.call(), world, count);
    if (room == TAUT_OK && plan.radius > 0) room = room_for_colliders(check.call(), world, count);
    if (room == TAUT_OK) index = add_soft(world, plan);
    return room;
}

void ask_of_soft(World& world, const Soft& soft, uint32_t which, uint32_t bits) {
    for (const uint32_t node : soft.node) {
        for_colliders(world.nodes, world.colliders, node,
                      [&](uint32_t c) { ask_for(world.colliders.change(c), which, bits); });
        if (which & kAsksPreSolve) wake_about(world, node);
    }
}

}  // namespace taut
