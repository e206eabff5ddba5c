// Air about the surfaces of soft bodies: drag and lift of their triangles; gas.h is what they enclose. And what slows
// them without air, Rayleigh's damping of masses.
//
// With w = wind - v at a vertex, the force of a triangle of area A and normal n, a third of it at each corner, is
//   1/2 rho A |w| (C_d |s| w + C_l s (|w| n - s w)) = B w,   s = n.w/|w|,
//   B = 1/2 rho A |w| (C_l n n^T + (C_d |s| - C_l s^2) 1)   [kg/s]
// symmetric, and with C_l <= C_d positive semi-definite. B is that of the begin of each substep, w that of its end:
// drag takes energy from the motion against the air and does not turn it round, whatever the step. Of a free body under
// drag alone w' = w/(1 + h k |w|), which is exact: dw/dt = -k |w| w. Each substep has its own, as light cloth follows
// the wind within less than one.
//
// What is solved directly has an element at each vertex (constraints/drag.cpp), in one system with all others: a cloth
// that is held bears all of the force of the wind. Sweeps would carry much of that force over from one substep to the
// next, and swing (measured: a flag of 50 g/m^2 at 50 m/s in substeps of 8 ms): there (M + h B) v' = M v* + h B wind
// comes before them, and what is held bears 1/(1 + h B/M) of the force; so it is with cloths that may tear.
#pragma once

#include "models/softs.h"

namespace taut {

struct AirTraits {
    double drag = 0, lift = 0;  // coefficients
    double pressure = 0;        // within, over that of the world's air [Pa]
    bool gas = false;           // the pressure is that of a gas
    double outside = 0;         // pressure of the world's air [Pa]
    bool swept = false;         // its elements are not solved directly
};
// Why a plan can have no such air; null: it has.
const char* plan_air(const AirTraits& traits, SoftPlan& plan);

// Of what gas.h and this share: a vertex as it is `time` after the frame's begin, and whether a group solves for a
// node.
Vec3 vertex_at(const World& world, const Soft& soft, uint32_t vertex, double time);
bool is_solved_in(const World& world, uint32_t node, uint32_t group);
// Vertices on triangles, and the triangles about each. Throws std::bad_alloc with nothing changed.
void list_surface(Soft& soft, uint32_t vertices);

// Lists the soft bodies of a group that either acts on, in Softs::loaded; false: none.
bool find_loaded_surfaces(World& world, uint32_t group);
// What they do in the substep that begins `time` after the frame's begin, after predict(): of the listed ones.
void load_surfaces(World& world, uint32_t group, double time);

}  // namespace taut
