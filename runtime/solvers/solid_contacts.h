// Contacts of an island between soft bodies, and of one with itself: vertices that are within cells are pushed to the
// nearest place of the surface by a penalty (Gast and Schroeder 2014, section 5.3; constraints/point_penalty.h).
// Friction comes after the solve.
#pragma once

#include <span>

#include "solvers/minimisation.h"
#include "threads/team.h"

namespace taut {

class SolidContacts {
public:
    // share: of the penalties, in E.
    SolidContacts(Team& team, const EnergyIsland& island, MinimisationMemory& memory, double share);

    bool any() const { return any_; }
    // Their share of E [J] at MinimisationMemory::pose: who is within whom, and where the surface is nearest.
    double evaluate();
    // Adds what they are by, in z, 3 numbers a point of the island.
    void add_gradient(std::span<double> gradient) const;
    // Matrices in z of what evaluate() found, restricted as points are held.
    void linearise(Hessian which);
    // Adds their blocks on the diagonal, of all points of the island.
    void add_diagonal(std::span<Mat3> blocks) const;
    // out += matrix d, of all points of the island.
    void add_product(const double* d, double* out) const;

private:
    const Vec3& place(uint32_t node) const { return m_.pose[m_.point_of_node[node]].x; }
    uint32_t pairs() const { return static_cast<uint32_t>(m_.pair.size() - first_pair_); }
    PenaltyPair& pair_at(uint32_t i) const { return m_.pair[first_pair_ + i]; }
    bool is_own(const SoftShape& shape) const;
    uint32_t find_exit(uint32_t vertex, const SoftShape& other) const;
    void list_vertices();
    void refit();
    void find_within();
    void list_pairs();

    Team& team_;
    const EnergyIsland& island_;
    MinimisationMemory& m_;
    const double share_;
    const size_t first_pair_;  // of the island, in MinimisationMemory::pair
    bool any_ = false;
};

// As rub_points().
void rub_solids(System& system, MinimisationMemory& memory);

}  // namespace taut
