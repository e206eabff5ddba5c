// Contacts of the points of an island with what forces do not move, as ways out of it (Gast and Schroeder 2014,
// sections 3.2 and 5.1): E(x) = E'(P(x)), where P takes a point that is within an obstacle, or held on its surface, to
// the nearest point of that. Which points are held is settled once a Newton step. Friction comes after the solve.
#pragma once

#include <span>

#include "solvers/minimisation.h"
#include "threads/team.h"

namespace taut {

class PointContacts {
public:
    // pose and touch of the island's points are its own from here on; none is held.
    PointContacts(Team& team, const EnergyIsland& island, MinimisationMemory& memory);

    bool any() const { return any_; }
    // P of MinimisationMemory::pose; what it did to each point goes into touch.
    void project();
    // From dE'/dz to dE/dz, of the last projection: 3 numbers a point of the island.
    void pull_back(std::span<double> gradient) const;
    // At a place where project() left it: of the surfaces that each point was taken to, those that E' pushes it onto
    // hold it until the next call. gradient, of E' in z, loses what they take.
    void hold(std::span<double> gradient);
    // From the matrix of E' in z to that of E at the place of hold(): T A T - sum mu d2phi/dx2 + N N^T, with
    // T = 1 - N N^T, N the normals that hold a point and mu [N] what it weighs on them.
    void restrict(Hessian which, Array<double>& matrix) const;
    // None of the island is held any longer.
    void release();

private:
    std::span<const Meeting> meetings_of(uint32_t point) const;
    void project_point(uint32_t point);
    // Takes a point to all the surfaces of a touch at once, by Newton's method.
    void take_out(PointTouch& touch, std::span<const Meeting> meetings, double radius, Vec3& x) const;
    // Deepest of the obstacles that a point is in and that the touch does not have; kNone: it is in none.
    uint32_t deepest(const PointTouch& touch, std::span<const Meeting> meetings, double radius, const Vec3& x) const;
    void hold_point(uint32_t point, Vec3& gradient);

    Team& team_;
    const EnergyIsland& island_;
    MinimisationMemory& m_;
    const size_t first_hold_;  // of the island, in MinimisationMemory::hold
    bool any_ = false;
};

// What an obstacle pushes a point by in a substep.
struct ObstaclePush {
    const Obstacle* obstacle;
    double friction;
    Vec3 normal;     // out of it
    double impulse;  // along that [N s]
    double gap;      // [m]
};

// The velocity of a point after the positions of a substep: friction takes what it can within the cone of the pushes,
// never more than all of the way along the surface (along: 1 - N N^T), so that it adds no energy. Tells of the contacts
// in Obstacles::push.
void rub_point(System& system, MinimisationMemory& memory, uint32_t point, const Mat3& along,
               std::span<const ObstaclePush> pushes);
// The same of all that are held.
void rub_points(System& system, MinimisationMemory& memory);

}  // namespace taut
