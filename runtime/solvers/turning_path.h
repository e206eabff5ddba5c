// Path of a line search that turns what its direction turns. Of each piece of points that elements tie together and
// nothing holds, of mass centre c, and r = x - c,
//   x(t) = c + t v + R(t w) (r + t e),   e = d - v - w x r
// with the velocity v of c and the angular velocity w that have the momenta of d: x'(0) = d. Along a line a turn by t
// stretches lengths by t^2/2, so that stiff pieces could turn but little in a step of Newton's method. Pieces that are
// held go along the line.
#pragma once

#include <span>

#include "solvers/minimisation.h"
#include "threads/team.h"

namespace taut {

class TurningPath {
public:
    TurningPath(Team& team, const EnergyIsland& island, MinimisationMemory& memory)
        : team_(team), island_(island), m_(memory) {}

    // From z along d, 3 numbers a point of the island.
    void begin(std::span<const double> z, std::span<const double> d);
    void follow(std::span<const double> z, std::span<const double> d, double part, std::span<double> place,
                std::span<double> way) const;

private:
    Vec3 position(std::span<const double> z, uint32_t i) const;

    Team& team_;
    const EnergyIsland& island_;
    MinimisationMemory& m_;
};

}  // namespace taut
