// What is shot at walls, and the walls.
#pragma once

#include <random>

#include "physics/surface_lab.h"

namespace lab {

inline void weightless(taut_world_def& def) { def.gravity = {0, 0, 0}; }

inline double between(std::mt19937& random, double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
}

inline Vec random_direction(std::mt19937& random) {
    for (;;) {
        const Vec v(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
        if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
    }
}

enum class Wall { thick, plate, sheet, mesh, plane };

inline double half_thickness(Wall wall) {  // [m]
    return wall == Wall::thick ? 0.2 : wall == Wall::plate ? 0.01 : wall == Wall::sheet ? 0.001 : 0;
}

// Across x = 0; bodies come from the side of negative x.
inline taut_shape shape_of(const World& world, Wall wall) {
    if (half_thickness(wall) > 0) return world.box({half_thickness(wall), 6, 6});
    if (wall == Wall::plane) return world.plane({-1, 0, 0});
    Triangles triangles;
    for (int i = -6; i < 6; ++i)
        for (int k = -6; k < 6; ++k)
            triangles.add_quad({0, i * 1.0, k * 1.0}, {0, i * 1.0, k + 1.0}, {0, i + 1.0, k + 1.0},
                               {0, i + 1.0, k * 1.0}, (i + k) % 2 != 0);
    return mesh(world, triangles, true);
}

}  // namespace lab
