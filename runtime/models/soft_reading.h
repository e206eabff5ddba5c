// What hosts read of soft bodies.
#pragma once

#include "models/softs.h"

namespace taut {

inline const Vec3& vertex_of(const World& world, const Soft& soft, uint32_t vertex) {
    return world.nodes.motion[soft.node[vertex]].x;
}

// Of the vertices as they are now, by the angle of each triangle at them: unit, or 0 where they cancel.
void soft_normals(const World& world, const Soft& soft, Array<Vec3>& out);

// Largest principal stretch of a cloth's triangle less 1.
double triangle_strain(const World& world, const Soft& soft, uint32_t triangle);

// Of a solid's cell, mean of its Gauss points.
struct CellState {
    double stress = 0;  // von Mises' of Cauchy's stress [Pa]
    double volume = 0;  // over that at rest: det F
};
uint32_t cells_of(const World& world, const Soft& soft);
// Whose cells are samples, each of the vertices about it.
bool is_meshless(const World& world, const Soft& soft);
CellState cell_state(const World& world, const Soft& soft, uint32_t cell);

}  // namespace taut
