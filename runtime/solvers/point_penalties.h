// Contacts of the points of an island with obstacles whose level set is sampled: a penalty within these (Gast and
// Schroeder 2014, section 5.2),  Phi = k |phi|^3 where phi < 0 [J],  k [Pa].
#pragma once

#include <span>

#include "solvers/minimisation.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

class PointPenalties {
public:
    // share: of the penalties, in E.
    PointPenalties(Team& team, const EnergyIsland& island, MinimisationMemory& memory, double share)
        : team_(team), island_(island), m_(memory), share_(share) {}

    bool any() const { return m_.obstacles.penalties; }
    // Their share of E at MinimisationMemory::pose [J].
    double evaluate();
    // Adds what they are by, in z: 3 numbers a point of the island, and blocks on the diagonal.
    void add_gradient(std::span<double> gradient) const;
    void add_matrix(Hessian which, Array<double>& matrix) const;

private:
    Team& team_;
    const EnergyIsland& island_;
    MinimisationMemory& m_;
    const double share_;
};

// As rub_points().
void rub_penalties(System& system, MinimisationMemory& memory);

}  // namespace taut
