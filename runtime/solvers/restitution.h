// Restitution: what hits within a substep leaves at once, before the constraints are solved.
//
//   path     A body's velocity v is that of the end of a substep, and its places at the substeps' ends lie on the
//            parabola of u = v - h a / 2 through them, a: of its forces (symplectic Euler). A gap c closes as
//              c + u t + a t^2 / 2,  at t with  w = -sqrt(u^2 - 2 a c) = v - a (h/2 - t),  v: at the substep's end
//            and J dv = -(1 + e) w leaves the gap of the reflected parabola at the end of the substep, where dv moves
//            the body for the rest of it: x += h v + (h - t) dv. The path begins at x - t dv instead.
//   energy   E = sum m |v + h a / 2|^2 / 2 - m a.x, that of the parabolas, is the same in each substep, and an impact
//            changes it by p (w + w+) / 2, whatever t is and in whatever order impacts come. Paths of bodies that
//            joints hold begin where they are: they leave at t = 0, above the surface, with the energy of one there.
//   rounds   Impacts at one time are solved at once: compression as if inelastic, then each point gets its restitution
//            times that impulse again (Poisson's hypothesis), but together no more than the square of the largest
//            restitution of the energy that compression took (Stronge's hypothesis). What closes then is hit in the
//            next round: touching balls pass a blow on (Smith et al. 2012, Reflections on Simultaneous Impact).
//   support  Contacts without restitution that what is hit presses on join its impacts: a crate on the floor is as hard
//            as the floor. They give back nothing, and hold while the others do.
//   rest     What rests closes at g h / 2 by that u. Impacts of up to g h do not bounce; they meet the contacts.
#pragma once

#include <span>

#include "system/impacts.h"

namespace taut {

struct Substep;

// From v* on: velocities after impacts in System::exact and the sweeps; System::shift and the errors of contact rows as
// paths begin then. Leaves Impacts::struck and strikes.
void restitute(Substep& s);

// Impacts of one cluster, one after the other in memory.
void solve_impacts(std::span<Impact> impacts, Array<ImpactBody>& bodies);
// Some sweeps of compression.
void press_impacts(std::span<Impact> impacts, Array<ImpactBody>& bodies);

// Speed at which a directly solved contact leaves, whose gap closes until the end of the substep and not before;
// 0: it does not bounce. rate: J v*; gained: what forces gave of it [m/s].
double rebound(const Substep& s, double restitution, double gap, double rate, double gained);

}  // namespace taut
