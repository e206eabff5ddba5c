// Which ties need a direct solve, by how far sweeps let them give way.
//
// A row that is swept yields to a force f by  y = s h^2 w |f|  [m], w = sum 1/m of its ends (kJointYield, kContactYield
// in constraints/soft_contact.h). Its strain is y over what may be seen: kSeen of the size of its smaller body. What is
// above 1 adds up over time; once that comes to kPatience, the tie needs a direct solve until it did not for as long.
// A rigid joint's gap is measured as well, as what is jammed among others opens joints far beyond y: one that may be
// seen counts so that it comes to kPatience in kJammed.
#pragma once

#include <cmath>

#include "state/elements.h"

namespace taut {

constexpr double kSeen = 0.002;     // of a body's size: a pixel where it fills half of a screen of 1000 rows
constexpr float kPatience = 0.25f;  // [s] at a strain of 2, less at larger ones
constexpr float kJammed = 1;        // [s]; what lands in a heap closes its joints sooner

// Of a body: the diagonal of the box that has its moments of inertia, sum I = m d^2 / 6 [m]. Of a particle 0.
inline double extent(const NodeMass& body) {
    const Sym3& i = body.inertia;
    return std::sqrt(6 * (i.xx + i.yy + i.zz) * body.inv_mass);
}

// Of swept joints that carry a weight of so many of a body's [1]; of what has no size infinite. h [s], gravity [m/s^2]
double strain_of_weights(const NodeMass& body, double weights, double h, double gravity);

// What moves freely for so long [s] before it feels its support falls by g t^2 / 2: sweeps carry a force from tie to
// tie in a substep.
double strain_of_fall(const NodeMass& body, double time, double gravity);

// Once a frame, from the forces of the last one. h: of the substeps that sweeps would take; frame: time step [s].
void note_needs(Joints& joints, Elements& elements, const Nodes& nodes, double h, double frame);

inline bool is_needed(float need) { return need > kPatience; }

}  // namespace taut
