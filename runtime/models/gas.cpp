#include "models/gas.h"

#include <algorithm>

#include "models/air.h"
#include "models/soft_reading.h"
#include "state/mesh_edges.h"

namespace taut {
namespace {

constexpr double kMostPressure = 1e8;  // of a gas that is pressed to nothing or turned inside out [Pa]

// Of a gas, not below the volume at which it has its most pressure.
double gas_volume(const AirLoad& air, double volume) { return std::max(volume, air.gas / kMostPressure); }

double pressure_at(const AirLoad& air, double volume, double outside) {
    return air.gas > 0 ? air.gas / gas_volume(air, volume) - outside : air.pressure;
}

}  // namespace

double volume_within(const World& world, const Soft& soft) {
    return soft.air.side * enclosed_volume(soft, [&](uint32_t v) -> const Vec3& { return vertex_of(world, soft, v); });
}

double pressure_within(const World& world, const Soft& soft) {
    return pressure_at(soft.air, volume_within(world, soft), world.def.air_pressure);
}

bool is_closed(std::span<const uint32_t> triangles, Memory& memory) {
    Array<MeshEdge> edges(memory);
    return find_edges(triangles, edges) == MeshFault::none &&
           std::ranges::all_of(edges, [](const MeshEdge& edge) { return edge.across[1] != kNone; });
}

bool is_one_piece(std::span<const uint32_t> triangles, uint32_t vertices, Memory& memory) {
    Array<uint32_t> parent(memory);
    parent.resize(vertices);
    for (uint32_t v = 0; v < vertices; ++v) parent[v] = v;
    const auto root = [&](uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (size_t t = 0; t < triangles.size(); t += 3)
        for (size_t k = 1; k < 3; ++k) parent[root(triangles[t + k])] = root(triangles[t]);
    return std::ranges::all_of(triangles, [&](uint32_t v) { return root(v) == root(triangles[0]); });
}

const char* set_pressure(AirLoad& air, double pressure, double volume, bool gas, double outside) {
    if (!gas) {
        air.pressure = pressure;
        air.gas = 0;
        return nullptr;
    }
    if (!(pressure + outside > 0)) return "pressure: with the world's air_pressure no gas has less than 0";
    if (!(volume > 0)) return "gas: the mesh has no volume for it";
    air.pressure = 0;
    air.gas = (pressure + outside) * volume;
    return nullptr;
}

const char* fill(World& world, Soft& soft, double pressure) {
    if (soft.air.side == 0) return "cloth: its mesh is open";
    if (!solvers()[world.def.solver]->direct || world.elements.set[soft.sets[0].set].solve == JointSolve::swept)
        return kSweptPressure;
    if (!is_one_piece(soft.triangle, soft.vertices(), world.memory)) return "cloth: its mesh is in several pieces";
    Soft listed(world.memory);
    if (soft.surface.empty()) {
        listed.triangle = soft.triangle;
        list_surface(listed, soft.vertices());
    }
    const bool gas = soft.air.gas > 0;
    const char* fault = set_pressure(soft.air, pressure, volume_within(world, soft), gas, world.def.air_pressure);
    if (fault || !soft.surface.empty()) return fault;
    soft.surface = std::move(listed.surface);
    soft.fan_begin = std::move(listed.fan_begin);
    soft.fan = std::move(listed.fan);
    return nullptr;
}

void push_by_pressure(World& world, const Soft& soft, uint32_t group, double time) {
    System& system = world.system;
    Gases& gases = system.gases;
    const auto at_time = [&](uint32_t v) { return vertex_at(world, soft, v, time); };
    const double volume = soft.air.side * enclosed_volume(soft, at_time);
    const double pressure = pressure_at(soft.air, volume, world.def.air_pressure), h = system.scheme.h;
    const auto first = static_cast<uint32_t>(gases.seat.size());
    gases.pushed.resize(system.pose.size(), Vec3(Vec3::Zero()));
    for (uint32_t i = 0; i < soft.surface.size(); ++i) {
        const uint32_t node = soft.node[soft.surface[i]];
        if (!is_solved_in(world, node, group)) continue;
        Vec3 g = Vec3::Zero();
        for (uint32_t k = soft.fan_begin[i]; k < soft.fan_begin[i + 1]; ++k) g += world.softs.area[soft.fan[k]];
        g *= soft.air.side / 3.0;
        const uint32_t at = system.at(node);
        Velocity& u = system.exact[at];
        const Vec3 push = h * pressure * world.nodes.mass[node].inv_mass * g;
        u.v += push;
        gases.pushed[at] += push;
        set_sweep_velocity(system.sweep[at].velocity, u);
        if (soft.air.gas == 0) continue;
        gases.seat.push_back(at);
        gases.gradient.push_back(g);
    }
    if (soft.air.gas == 0) return;
    const double within = gas_volume(soft.air, volume);
    gases.list.push_back({first, static_cast<uint32_t>(gases.seat.size()) - first, soft.air.gas / (within * within)});
}

}  // namespace taut
