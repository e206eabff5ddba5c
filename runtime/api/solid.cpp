#include <taut/solid.h>

#include <cstdio>
#include <limits>

#include "api/deformable.h"
#include "api/sized.h"
#include "models/plastic.h"
#include "models/solid.h"
#include "recover.h"

using namespace taut;

namespace {

constexpr Range kSolidDensity{1e-2, 1e6};  // [kg/m^3]
constexpr Range kYoung{1, 1e12};           // [Pa]
constexpr Range kSolidPoisson{0, 0.499};
constexpr Range kAxialPoisson{-10, 10};
constexpr Range kCreep{0, 1e6};               // [1/s]
constexpr Range kPlasticLimit{0, 10};         // [1]
constexpr Range kHardening{0, 1e12};          // [Pa]
constexpr Range kSampleVolume{1e-18, 1e12};   // [m^3]
constexpr Range kNeighbourRadius{1e-4, 1e6};  // [m]
constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr MaterialNames kSurface{"surface.friction",         "surface.restitution",      "surface.friction_rule",
                                 "surface.restitution_rule", "surface.rolling_friction", "surface.spinning_friction"};

Check& check_axes(Check& check, const taut_solid_def& def) {
    const taut_orthotropic& of = def.orthotropic;
    char field[48];
    for (int i = 0; check && i < 3; ++i) {
        const auto name = [&](const char* what) {
            std::snprintf(field, sizeof field, "orthotropic.%s[%d]", what, i);
            return field;
        };
        check.number(name("young_moduli"), of.young_moduli[i], kYoung);
        if (check) check.number(name("poisson_ratios"), of.poisson_ratios[i], kAxialPoisson);
        if (check) check.number(name("shear_moduli"), of.shear_moduli[i], kYoung);
    }
    check.rotation("orthotropic.axes", of.axes)
        .require(!of.cells || def.corners != TAUT_SOLID_MESHLESS, "orthotropic.cells: the solid has no mesh");
    for (uint32_t c = 0; of.cells && check && c < def.cell_count; ++c) {
        std::snprintf(field, sizeof field, "orthotropic.cells[%u]", c);
        check.rotation(field, of.cells[c]);
    }
    return check.require(!(def.yield_stress < kNever), "yield_stress: an orthotropic solid does not yield");
}

// What one kind has and the other does not.
bool check_kind(Check& check, const taut_solid_def& def) {
    if (def.corners != TAUT_SOLID_MESHLESS) {
        return static_cast<bool>(
            check
                .require(!def.samples && !def.sample_volumes && def.sample_count == 0,
                         "samples, sample_volumes, sample_count: the solid has a mesh")
                .require(!def.triangles && def.triangle_count == 0, "triangles, triangle_count: the solid has a mesh")
                .require(def.neighbour_radius == 0, "neighbour_radius: the solid has a mesh"));
    }
    return static_cast<bool>(
        check.require(!def.cells && def.cell_count == 0, "cells, cell_count: the solid has no mesh")
            .zero_or("neighbour_radius", def.neighbour_radius, kNeighbourRadius)
            .count("sample_count", def.sample_count, 0, TAUT_DEFORMABLE_MAX)
            .count("triangle_count", def.triangle_count, 0, TAUT_DEFORMABLE_MAX)
            .require((def.sample_count > 0) == (def.samples != nullptr) &&
                         (def.sample_count > 0) == (def.sample_volumes != nullptr),
                     "samples, sample_volumes, sample_count: some are there and others are not")
            .require((def.triangle_count > 0) == (def.triangles != nullptr),
                     "triangles, triangle_count: one is there and the other is not")
            .require(def.air_drag == 0 || def.triangle_count > 0, "air_drag: the solid has no triangles"));
}

bool check_points(Check& check, const taut_solid_def& def) {
    check.count("point_count", def.point_count, TAUT_SOLID_NEIGHBOURS, TAUT_DEFORMABLE_MAX)
        .pointer("points", def.points);
    if (!check || !check_positions(check, "points", def.points, def.point_count)) return false;
    if (def.rest && !check_positions(check, "rest", def.rest, def.point_count)) return false;
    if (def.samples && !check_positions(check, "samples", def.samples, def.sample_count)) return false;
    char field[48];
    for (uint32_t s = 0; check && s < def.sample_count; ++s) {
        std::snprintf(field, sizeof field, "sample_volumes[%u]", s);
        check.number(field, def.sample_volumes[s], kSampleVolume);
    }
    const MeshDef surface{def.points,
                          def.rest,
                          def.point_count,
                          TAUT_SOLID_NEIGHBOURS,
                          "triangles",
                          "triangle_count",
                          def.triangles,
                          def.triangle_count,
                          3};
    return check && check_cells(check, surface);
}

bool check_def(Check& check, const taut_solid_def& def) {
    check.choice("material", def.material, TAUT_SOLID_ORTHOTROPIC)
        .boolean("self_collision", def.self_collision)
        .number("density", def.density, kSolidDensity)
        .number("young_modulus", def.young_modulus, kYoung)
        .number("poisson_ratio", def.poisson_ratio, kSolidPoisson)
        .require(def.corners == 4 || def.corners == 8 || def.corners == TAUT_SOLID_MESHLESS,
                 "corners is neither 4, 8 nor TAUT_SOLID_MESHLESS")
        .require(def.material != TAUT_SOLID_FIXED_COROTATED || def.poisson_ratio > 0,
                 "poisson_ratio is 0, by which the volume does not resist, of a material that asks for it");
    check_air(check, def.air_drag, def.air_lift)
        .number_or("yield_stress", def.yield_stress, kYoung, kNever)
        .number_or("creep", def.creep, kCreep, kNever)
        .number_or("plastic_limit", def.plastic_limit, kPlasticLimit, kNever)
        .number("hardening", def.hardening, kHardening);
    check_soft(check, def.surface, kSurface, def.filter, def.thickness, def.damping, def.gravity_scale, def.solve);
    check_rayleigh(check, def.mass_damping, def.stiffness_damping);
    const MeshDef mesh{def.points,   def.rest,  def.point_count, 4,          "cells",
                       "cell_count", def.cells, def.cell_count,  def.corners};
    if (!check || !check_kind(check, def)) return false;
    if (!(def.corners == TAUT_SOLID_MESHLESS ? check_points(check, def) : check_mesh(check, mesh))) return false;
    if (def.material == TAUT_SOLID_ORTHOTROPIC) check_axes(check, def);
    return static_cast<bool>(check);
}

OrthotropicSolid axial_of(const taut_orthotropic& of) {
    OrthotropicSolid out{};
    for (int i = 0; i < 3; ++i) {
        out.young[i] = of.young_moduli[i];
        out.poisson[i] = of.poisson_ratios[i];
        out.shear[i] = of.shear_moduli[i];
    }
    return out;
}

// Of each cell, of all, or none.
Array<Quat> axes_of(World& world, const taut_solid_def& def) {
    Array<Quat> out(world.memory);
    if (def.material != TAUT_SOLID_ORTHOTROPIC) return out;
    const taut_orthotropic& of = def.orthotropic;
    const std::span<const taut_quat> from(of.cells ? of.cells : &of.axes, of.cells ? def.cell_count : 1);
    for (const taut_quat& q : from) out.push_back(to_quat(q));
    return out;
}

Array<Sample> samples_of(World& world, const taut_solid_def& def) {
    Array<Sample> out(world.memory);
    out.reserve(def.sample_count);
    for (uint32_t s = 0; s < def.sample_count; ++s)
        out.push_back({to_vec(def.samples[s]), static_cast<double>(def.sample_volumes[s])});
    return out;
}

struct SubstanceFigures {
    taut_solid_material material;
    float density, young, poisson;
};
constexpr SubstanceFigures kSubstances[] = {
    {TAUT_SOLID_NEO_HOOKEAN, 1100, 2e6f, 0.48f},         // rubber
    {TAUT_SOLID_NEO_HOOKEAN, 1000, 2e4f, 0.45f},         // jelly
    {TAUT_SOLID_NEO_HOOKEAN, 50, 1e5f, 0.1f},            // foam
    {TAUT_SOLID_NEO_HOOKEAN, 1060, 1e5f, 0.45f},         // muscle
    {TAUT_SOLID_ST_VENANT_KIRCHHOFF, 600, 1e10f, 0.3f},  // wood
};

}  // namespace

void taut_solid_def_init_sized(taut_solid_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_solid_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.corners = 4;
        own.density = 1000;
        own.young_modulus = 1e6f;
        own.poisson_ratio = 0.3f;
        own.thickness = 0.01f;
        for (int i = 0; i < 3; ++i) {
            own.orthotropic.young_moduli[i] = 1e6f;
            own.orthotropic.poisson_ratios[i] = 0.3f;
            own.orthotropic.shear_moduli[i] = 384615;
        }
        own.orthotropic.axes = {0, 0, 0, 1};
        own.yield_stress = own.creep = kNever;
        own.plastic_limit = 1;
        own.gravity_scale = 1;
        own.surface = kDefaultMaterial;
        own.filter = kDefaultFilter;
    });
}

taut_result taut_solid_def_set_substance(taut_solid_def* def, taut_substance substance) {
    Check check(__func__);
    if (!check.pointer("def", def)) return check.result();
    check.struct_size(def->struct_size, sizeof *def, alignof(taut_solid_def))
        .choice("substance", substance, TAUT_SUBSTANCE_WOOD);
    if (!check) return check.result();
    const SubstanceFigures& of = kSubstances[substance];
    def->material = of.material;
    def->density = of.density;
    def->young_modulus = of.young;
    def->poisson_ratio = of.poisson;
    return TAUT_OK;
}

taut_result taut_world_add_solid(taut_world handle, const taut_solid_def* given, taut_solid* out) {
    TAUT_RECORD(taut_world_add_solid, handle, given, out);
    Check check(__func__);
    taut_solid_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_solid_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const Array<Vec3> at = positions_of(world, def.points, def.point_count);
        const Array<Vec3> rest = positions_of(world, def.rest ? def.rest : def.points, def.point_count);
        const Array<Quat> axes = axes_of(world, def);
        const Array<Sample> samples = samples_of(world, def);
        const SolidMesh mesh{at,   rest,    {def.cells, size_t{def.corners} * def.cell_count}, def.corners,
                             axes, samples, {def.triangles, 3 * size_t{def.triangle_count}},   def.neighbour_radius};
        const Solid solid{static_cast<SolidMaterial>(def.material),
                          {def.young_modulus, def.poisson_ratio},
                          axial_of(def.orthotropic),
                          def.density,
                          def.damping,
                          def.stiffness_damping,
                          def.yield_stress,
                          def.hardening,
                          {0, def.creep, def.plastic_limit}};
        SoftPlan plan(world.memory);
        plan.soft.gravity_scale = def.gravity_scale;
        plan.soft.mass_damping = def.mass_damping;
        plan.soft.self = def.self_collision != 0;
        plan.soft.user_data = def.user_data;
        plan_spheres(plan, def.thickness, def.surface, def.filter);
        uint32_t cell;
        taut_deformable_solve solve = def.solve;
        const auto plan_as = [&](JointSolve as, SoftPlan& to) { return plan_solid(mesh, solid, as, to, cell); };
        if (const char* fault = plan_soft(world, false, plan_as, solve, plan)) {
            char text[96];
            const char* kind = def.corners == TAUT_SOLID_MESHLESS ? "samples" : "cells";
            std::snprintf(text, sizeof text, "%s[%u] %s", kind, cell, fault);
            check.require(false, cell == kNone ? fault : text);
            return check.result();
        }
        const AirTraits air{def.air_drag, def.air_lift};
        if (plan.element[0].solve == JointSolve::direct) solve = TAUT_DEFORMABLE_DIRECT;
        if (!plan.soft.triangle.empty() && !plan_checked_air(check, world, air, solve, plan)) return check.result();
        uint32_t index;
        const taut_result added = add_planned(check, world, plan, index);
        if (added == TAUT_OK) *out = world.solid_handle(index);
        return added;
    });
}

taut_result taut_solid_remove(taut_solid handle) {
    TAUT_RECORD(taut_solid_remove, handle);
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        remove_soft(world, index);
        return TAUT_OK;
    });
}

int32_t taut_solid_is_valid(taut_solid handle) { return is_valid(handle); }

taut_result taut_solid_get_user_data(taut_solid handle, uint64_t* out) {
    Check check(__func__);
    return soft_user_data(check, handle, out);
}

taut_result taut_solid_get_solve(taut_solid handle, taut_deformable_solve* out) {
    Check check(__func__);
    return soft_solve(check, handle, out);
}

taut_result taut_solid_set_contact_events(taut_solid handle, uint32_t contact_events) {
    TAUT_RECORD(taut_solid_set_contact_events, handle, contact_events);
    Check check(__func__);
    return set_soft_contact_events(check, handle, contact_events);
}

taut_result taut_solid_set_pre_solve(taut_solid handle, int32_t pre_solve) {
    TAUT_RECORD(taut_solid_set_pre_solve, handle, pre_solve);
    Check check(__func__);
    return set_soft_pre_solve(check, handle, pre_solve);
}

taut_result taut_body_get_solid(taut_body handle, taut_solid* out) {
    Check check(__func__);
    return soft_of_body(check, handle, out, [](const World& world, uint32_t soft) { return world.solid_handle(soft); });
}

taut_result taut_solid_pin(taut_solid handle, uint32_t vertex, uint32_t pinned) {
    TAUT_RECORD(taut_solid_pin, handle, vertex, pinned);
    Check check(__func__);
    return pin_soft(check, handle, vertex, pinned);
}

taut_result taut_solid_get_points(taut_solid handle, taut_pos* points, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_points(check, handle, points, capacity, count);
}

taut_result taut_solid_get_velocities(taut_solid handle, taut_vec3* velocities, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_velocities(check, handle, velocities, capacity, count);
}

taut_result taut_solid_get_normals(taut_solid handle, taut_vec3* normals, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_normals(check, handle, normals, capacity, count);
}

taut_result taut_solid_get_bodies(taut_solid handle, taut_body* bodies, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_bodies(check, handle, bodies, capacity, count);
}

taut_result taut_solid_get_triangles(taut_solid handle, uint32_t* triangles, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_triangles(check, handle, triangles, capacity, count);
}

taut_result taut_solid_get_stresses(taut_solid handle, float* stresses, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        return copy_out(cells_of(world, soft), stresses, capacity, count, check.call(), "stresses",
                        [&](uint32_t c) { return to_float(cell_state(world, soft, c).stress); });
    });
}

taut_result taut_solid_get_volumes(taut_solid handle, float* ratios, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        return copy_out(cells_of(world, soft), ratios, capacity, count, check.call(), "ratios",
                        [&](uint32_t c) { return to_float(cell_state(world, soft, c).volume); });
    });
}

taut_result taut_solid_recover(taut_solid handle, uint32_t max_steps, uint32_t* inverted) {
    TAUT_RECORD(taut_solid_recover, handle, max_steps, inverted);
    constexpr uint32_t kMostSteps = 1000;  // as of a minimisation that nobody bounds
    Check check(__func__);
    if (!check.count("max_steps", max_steps, 1, kMostSteps)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        if (solvers()[world.def.solver]->energies)
            return refuse(TAUT_UNSUPPORTED, "%s: steps of TAUT_SOLVER_MINIMISATION recover by themselves",
                          check.call());
        const Soft& soft = world.softs.record[index];
        if (inverted_cells(world, soft) > 0) {
            for (const uint32_t node : soft.node) wake_about(world, node);
            recover(world, soft, max_steps);
        }
        if (inverted) *inverted = inverted_cells(world, soft);
        return TAUT_OK;
    });
}

taut_result taut_solid_get_plastic_strains(taut_solid handle, float* strains, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        return copy_out(cells_of(world, soft), strains, capacity, count, check.call(), "strains",
                        [&](uint32_t c) { return to_float(plastic_strain(soft, c)); });
    });
}
