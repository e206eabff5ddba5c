#include <taut/cloth.h>

#include "api/deformable.h"
#include "api/sized.h"
#include "models/cloth.h"
#include "models/gas.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

constexpr Range kAreaDensity{1e-3, 1e4};     // [kg/m^2]
constexpr Range kSheetStiffness{1e-3, 1e9};  // [N/m]
constexpr Range kSheetPoisson{-0.999, 0.999};
constexpr Range kSheetBending{1e-9, 1e6};  // [N m]
constexpr Range kStretchTolerance{1e-4, 10};
constexpr Range kShare{0, 1};
constexpr Range kLimitStrain{1e-4, 100};
constexpr Range kLimitCompliance{1e-9, 1e6};  // [m/N]
constexpr Range kTetherSlack{0, 10};
constexpr Range kTearStrain{1e-3, 100};
constexpr float kNoLinks = std::numeric_limits<float>::infinity();

// What one kind has and others do not.
bool check_kind(Check& check, const taut_cloth_def& def) {
    const bool quads = def.kind == TAUT_CLOTH_QUADS;
    check.choice("strain", def.strain, TAUT_CLOTH_STRAIN_COROTATED)
        .boolean("plane_strain", def.plane_strain)
        .boolean("self_collision", def.self_collision)
        .require(quads || (!def.quads && def.quad_count == 0), "quads, quad_count: the cloth is of another kind")
        .require(!quads || (!def.triangles && def.triangle_count == 0),
                 "triangles, triangle_count: the cloth is of quadrilaterals");
    if (def.plane_strain == 1)
        check.require(def.stretch_stiffness[0] == def.stretch_stiffness[1] && def.poisson_ratio < 0.5f,
                      "plane_strain: asks for one stretch_stiffness both ways and a poisson_ratio below 1/2");
    return static_cast<bool>(check);
}

bool check_def(Check& check, const taut_cloth_def& def) {
    check.choice("kind", def.kind, TAUT_CLOTH_QUADS)
        .number("area_density", def.area_density, kAreaDensity)
        .number("stretch_stiffness[0]", def.stretch_stiffness[0], kSheetStiffness)
        .number("stretch_stiffness[1]", def.stretch_stiffness[1], kSheetStiffness)
        .number("shear_stiffness", def.shear_stiffness, kSheetStiffness)
        .number("poisson_ratio", def.poisson_ratio, kSheetPoisson)
        .zero_or("bending_stiffness", def.bending_stiffness, kSheetBending)
        .number("stretch_compliance[0]", def.stretch_compliance[0], kCompliance)
        .number("stretch_compliance[1]", def.stretch_compliance[1], kCompliance)
        .number_or("shear_compliance", def.shear_compliance, kCompliance, kNoLinks)
        .number_or("bend_compliance", def.bend_compliance, kCompliance, kNoLinks)
        .number("stretch_tolerance", def.stretch_tolerance, kStretchTolerance)
        .number("compression", def.compression, kShare)
        .number_or("strain_limit", def.strain_limit, kLimitStrain, kNoLinks)
        .number("limit_compliance", def.limit_compliance, kLimitCompliance)
        .count("tethers", def.tethers, 0, TAUT_CLOTH_MAX_TETHERS)
        .number("tether_slack", def.tether_slack, kTetherSlack)
        .zero_or("tear_strain", def.tear_strain, kTearStrain);
    check_air(check, def.air_drag, def.air_lift).number("pressure", def.pressure, kPressure).boolean("gas", def.gas);
    check_soft(check, def.material, kMaterialInDef, def.filter, def.thickness, def.damping, def.gravity_scale,
               def.solve);
    check_rayleigh(check, def.mass_damping, def.stiffness_damping);
    if (!check || !check_kind(check, def)) return false;
    const MeshDef triangles{def.points,       def.rest,      def.point_count,    3, "triangles",
                            "triangle_count", def.triangles, def.triangle_count, 3};
    const MeshDef quads{def.points, def.rest, def.point_count, 4, "quads", "quad_count", def.quads, def.quad_count, 4};
    if (!check_mesh(check, def.kind == TAUT_CLOTH_QUADS ? quads : triangles)) return false;
    for (size_t i = 0; def.uv && check && i < 2 * size_t{def.point_count}; ++i)
        check.number("uv", def.uv[i], Range{-1e6, 1e6});
    return static_cast<bool>(check);
}

Fabric fabric_of(const taut_cloth_def& def) {
    Fabric fabric;
    fabric.area_density = def.area_density;
    fabric.thickness = def.thickness;
    for (int i = 0; i < 2; ++i) {
        fabric.stretch_stiffness[i] = def.stretch_stiffness[i];
        fabric.stretch_compliance[i] = def.stretch_compliance[i];
    }
    fabric.shear_stiffness = def.shear_stiffness;
    fabric.poisson = def.poisson_ratio;
    fabric.bending_stiffness = def.bending_stiffness;
    fabric.shear_compliance = def.shear_compliance;
    fabric.bend_compliance = def.bend_compliance;
    fabric.damping = def.damping;
    fabric.rayleigh = def.stiffness_damping;
    fabric.strain = static_cast<SheetStrain>(def.strain);
    fabric.plane_strain = def.plane_strain != 0;
    fabric.tolerance = def.stretch_tolerance;
    fabric.compression = def.compression;
    fabric.strain_limit = def.strain_limit;
    fabric.limit_compliance = def.limit_compliance;
    fabric.tethers = def.tethers;
    fabric.tether_slack = def.tether_slack;
    fabric.tear_strain = def.tear_strain;
    return fabric;
}

// Those of the def, or two of each of its quadrilaterals.
Array<uint32_t> triangles_of(World& world, const taut_cloth_def& def) {
    Array<uint32_t> out(world.memory);
    if (def.triangles) out.assign(def.triangles, def.triangles + 3 * size_t{def.triangle_count});
    for (uint32_t q = 0; q < def.quad_count; ++q) {
        const uint32_t* v = def.quads + 4 * size_t{q};
        out.insert(out.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
    }
    return out;
}

// get(world, soft) of a cloth without a rim.
template <class T, class Get>
taut_result read_closed(Check& check, taut_cloth handle, T* out, Get&& get) {
    if (!check.pointer("out", out)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        if (!check.require(soft.air.side != 0, "cloth: its mesh is open")) return check.result();
        *out = get(world, soft);
        return TAUT_OK;
    });
}

// Of no single sample: the order of common fabrics.
struct FabricFigures {
    float area_density, thickness, stretch[2], shear, bending;
};
constexpr FabricFigures kFabrics[] = {
    {0.15f, 0.0005f, {4000, 3000}, 600, 1e-5f},     // cotton
    {0.07f, 0.0003f, {2500, 2000}, 250, 2e-6f},     // silk
    {0.4f, 0.001f, {15000, 10000}, 3000, 1e-4f},    // denim
    {0.9f, 0.0015f, {30000, 30000}, 10000, 1e-3f},  // leather
};

}  // namespace

void taut_cloth_def_init_sized(taut_cloth_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cloth_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.area_density = 0.2f;
        own.thickness = 0.005f;
        own.stretch_stiffness[0] = own.stretch_stiffness[1] = 5000;
        own.shear_stiffness = 2000;
        own.poisson_ratio = 0.3f;
        own.stretch_compliance[0] = own.stretch_compliance[1] = 1e-6f;
        own.shear_compliance = 1e-4f;
        own.bend_compliance = kNoLinks;
        own.stretch_tolerance = 0.2f;
        own.compression = 1;
        own.strain_limit = kNoLinks;
        own.limit_compliance = 1e-6f;
        own.tether_slack = 0.01f;
        own.gravity_scale = 1;
        own.material = kDefaultMaterial;
        own.filter = kDefaultFilter;
    });
}

taut_result taut_cloth_def_set_fabric(taut_cloth_def* def, taut_fabric fabric) {
    Check check(__func__);
    if (!check.pointer("def", def)) return check.result();
    check.struct_size(def->struct_size, sizeof *def, alignof(taut_cloth_def))
        .choice("fabric", fabric, TAUT_FABRIC_LEATHER);
    if (!check) return check.result();
    const FabricFigures& of = kFabrics[fabric];
    def->area_density = of.area_density;
    def->thickness = of.thickness;
    def->stretch_stiffness[0] = of.stretch[0];
    def->stretch_stiffness[1] = of.stretch[1];
    def->shear_stiffness = of.shear;
    def->bending_stiffness = of.bending;
    return TAUT_OK;
}

taut_result taut_world_add_cloth(taut_world handle, const taut_cloth_def* given, taut_cloth* out) {
    TAUT_RECORD(taut_world_add_cloth, handle, given, out);
    Check check(__func__);
    taut_cloth_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_cloth_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const Array<Vec3> at = positions_of(world, def.points, def.point_count);
        const Array<Vec3> rest = positions_of(world, def.rest ? def.rest : def.points, def.point_count);
        const std::span<const float> uv(def.uv, def.uv ? 2 * size_t{def.point_count} : 0);
        const Array<uint32_t> triangles = triangles_of(world, def);
        const ClothMesh mesh{at, rest, triangles, uv};
        const auto kind = static_cast<ClothKind>(def.kind);
        SoftPlan plan(world.memory);
        plan.soft.mass_damping = def.mass_damping;
        plan.soft.self = def.self_collision != 0;
        plan.soft.gravity_scale = def.gravity_scale;
        plan.soft.user_data = def.user_data;
        plan_spheres(plan, def.thickness, def.material, def.filter);
        Fabric fabric = fabric_of(def);
        fabric.shortest_substep = static_cast<double>(world.def.time_step) / kMostElasticSubsteps;
        const AirTraits air{def.air_drag, def.air_lift, def.pressure, def.gas != 0};
        taut_deformable_solve solve = def.solve;
        const auto plan_as = [&](JointSolve as, SoftPlan& to) { return plan_cloth(mesh, kind, fabric, as, to); };
        const char* fault = plan_soft(world, air.pressure != 0 || air.gas, plan_as, solve, plan);
        if (!check.require(!fault, fault)) return check.result();
        if (!plan_checked_air(check, world, air, solve, plan)) return check.result();
        uint32_t index;
        const taut_result added = add_planned(check, world, plan, index);
        if (added == TAUT_OK) *out = world.cloth_handle(index);
        return added;
    });
}

taut_result taut_cloth_remove(taut_cloth handle) {
    TAUT_RECORD(taut_cloth_remove, handle);
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        remove_soft(world, index);
        return TAUT_OK;
    });
}

int32_t taut_cloth_is_valid(taut_cloth handle) { return is_valid(handle); }

taut_result taut_cloth_get_user_data(taut_cloth handle, uint64_t* out) {
    Check check(__func__);
    return soft_user_data(check, handle, out);
}

taut_result taut_cloth_get_solve(taut_cloth handle, taut_deformable_solve* out) {
    Check check(__func__);
    return soft_solve(check, handle, out);
}

taut_result taut_cloth_set_contact_events(taut_cloth handle, uint32_t contact_events) {
    TAUT_RECORD(taut_cloth_set_contact_events, handle, contact_events);
    Check check(__func__);
    return set_soft_contact_events(check, handle, contact_events);
}

taut_result taut_cloth_set_pre_solve(taut_cloth handle, int32_t pre_solve) {
    TAUT_RECORD(taut_cloth_set_pre_solve, handle, pre_solve);
    Check check(__func__);
    return set_soft_pre_solve(check, handle, pre_solve);
}

taut_result taut_body_get_cloth(taut_body handle, taut_cloth* out) {
    Check check(__func__);
    return soft_of_body(check, handle, out, [](const World& world, uint32_t soft) { return world.cloth_handle(soft); });
}

taut_result taut_cloth_pin(taut_cloth handle, uint32_t vertex, uint32_t pinned) {
    TAUT_RECORD(taut_cloth_pin, handle, vertex, pinned);
    Check check(__func__);
    return pin_soft(check, handle, vertex, pinned);
}

taut_result taut_cloth_get_points(taut_cloth handle, taut_pos* points, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_points(check, handle, points, capacity, count);
}

taut_result taut_cloth_get_velocities(taut_cloth handle, taut_vec3* velocities, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_velocities(check, handle, velocities, capacity, count);
}

taut_result taut_cloth_get_normals(taut_cloth handle, taut_vec3* normals, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_normals(check, handle, normals, capacity, count);
}

taut_result taut_cloth_get_bodies(taut_cloth handle, taut_body* bodies, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_bodies(check, handle, bodies, capacity, count);
}

taut_result taut_cloth_get_triangles(taut_cloth handle, uint32_t* triangles, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    return read_triangles(check, handle, triangles, capacity, count);
}

taut_result taut_cloth_get_strains(taut_cloth handle, float* strains, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return read_soft(check.call(), handle, [&](const World& world, const Soft& soft) {
        return copy_out(soft.triangles(), strains, capacity, count, check.call(), "strains",
                        [&](uint32_t t) { return to_float(triangle_strain(world, soft, t)); });
    });
}

taut_result taut_cloth_get_volume(taut_cloth handle, double* out) {
    Check check(__func__);
    return read_closed(check, handle, out,
                       [](const World& world, const Soft& soft) { return volume_within(world, soft); });
}

taut_result taut_cloth_get_pressure(taut_cloth handle, float* out) {
    Check check(__func__);
    return read_closed(check, handle, out,
                       [](const World& world, const Soft& soft) { return to_float(pressure_within(world, soft)); });
}

taut_result taut_cloth_set_pressure(taut_cloth handle, float pressure) {
    TAUT_RECORD(taut_cloth_set_pressure, handle, pressure);
    Check check(__func__);
    if (!check.number("pressure", pressure, kPressure)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Soft& soft = world.softs.record[index];
        const char* fault = fill(world, soft, pressure);
        if (!check.require(!fault, fault)) return check.result();
        for (const uint32_t node : soft.node) wake(world, node);
        return TAUT_OK;
    });
}
