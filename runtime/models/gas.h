// Pressure within closed surfaces of soft bodies. Its force on a vertex is p dV/dx, a third of the areas about it along
// their normals: the gradient of the volume V within. Of a gas p V stays (isothermal), p less that of the world's air.
//
// The force is that of the pressure and the surface at the begin of a substep. A gas is stiff: a balloon of radius r
// and a mass m of each square metre breathes at sqrt(3 p/(r m)), 4000 rad/s of a toy, so its answer to what the substep
// does to the volume is solved with it (solvers/block_gas.cpp). Sweeps hold neither: what a vertex of a toy's hull
// takes up in a substep from its pressure is 100 m/s.
#pragma once

#include "models/softs.h"

namespace taut {

inline constexpr const char* kSweptPressure = "pressure: of what is solved directly alone, by the world's solver too";

// Of the vertices x(v), by the divergence theorem [m^3]: positive where normals point outward.
template <class At>
double enclosed_volume(const Soft& soft, At&& x) {
    if (soft.triangles() == 0) return 0;
    const Vec3 from = x(soft.triangle[0]);
    double sum = 0;
    for (uint32_t t = 0; t < soft.triangles(); ++t) {
        const uint32_t* corner = &soft.triangle[3 * size_t{t}];
        const Vec3 a = x(corner[0]) - from, b = x(corner[1]) - from, c = x(corner[2]) - from;
        sum += a.dot(b.cross(c));
    }
    return sum / 6;
}
// As it is now, by the side that is outside; for closed ones.
double volume_within(const World& world, const Soft& soft);
// Over that of the world's air [Pa].
double pressure_within(const World& world, const Soft& soft);

// Whether it has no rim, or none and one piece.
bool is_closed(std::span<const uint32_t> triangles, Memory& memory);
bool is_one_piece(std::span<const uint32_t> triangles, uint32_t vertices, Memory& memory);
// Of a gas within a volume, or that stays. Why that cannot be; null: it is.
const char* set_pressure(AirLoad& air, double pressure, double volume, bool gas, double outside);

// The same of one that lives: why not; null: done. Throws std::bad_alloc with nothing changed.
const char* fill(World& world, Soft& soft, double pressure);

// Forces of the pressure within a surface whose areas are in Softs::area: onto the velocities of a group, and into
// System::gases.
void push_by_pressure(World& world, const Soft& soft, uint32_t group, double time);

}  // namespace taut
