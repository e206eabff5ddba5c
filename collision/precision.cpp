// Debian ships Bullet twice, in single and in double precision, under headers that differ by one define only.
#include <LinearMath/btConvexHullComputer.h>

#include "collision/collide.h"

namespace taut::collision {

static_assert(sizeof(btScalar) == sizeof(float) && sizeof(btVector3) == 4 * sizeof(float),
              "this room is written for Bullet in single precision");

// The library writes the corners of a tetrahedron with its own scalars; ours must read them back.
bool precision_matches() {
    constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    btConvexHullComputer computer;
    computer.compute(&kCorners[0][0], int(sizeof(kCorners[0])), 4, 0, 0);
    if (computer.vertices.size() != 4 || computer.original_vertex_index.size() != 4) return false;
    for (int i = 0; i < 4; ++i) {
        const int from = computer.original_vertex_index[i];
        if (from < 0 || from >= 4) return false;
        for (int k = 0; k < 3; ++k) {
            // Compared so that not-a-number fails; the library rounds to 1e-4 of the extent.
            const float error = computer.vertices[i][k] - kCorners[from][k];
            if (!(error > -1e-3f && error < 1e-3f)) return false;
        }
    }
    return true;
}

}  // namespace taut::collision
