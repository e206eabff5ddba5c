// Continuous collision: what moves past its own thickness in a frame is looked for along its way. The contact is that
// of the moment at which the two shapes meet, told at the present poses: its separation is what is left of the way. So
// the solver, which lets a gap close but no more, stops them where they meet, two-way and in one system with the rest.
//
//   gap now = gap then - n . ((x_b + R_b r_b) - (x_a + R_a r_a)) from now to then, r as they are then
#pragma once

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/elements.h"
#include "state/pairs.h"
#include "state/shapes.h"
#include "threads/team.h"

namespace taut {

// Forces of the frame may speed up what is under way: so many frames are looked ahead.
constexpr double kAhead = 1.25;

Pace pace_of(const Nodes& nodes, const Collider& collider, const ShapeRecord& record, double time);

// Whether two colliders move further against each other in time [s] than they are thick.
bool is_fast(const Nodes& nodes, const Pairs& pairs, const PairEnds& pair, double time);

// After the solve: contacts are found once a frame, and what they turn or turn aside may pass a wall in the rest of it.
// Of pairs that were fast, or of which one went elsewhere than its speed told, the way of the smaller one's core (of
// the ball inside, about collision::middle(); of a segment between two particles also about its ends) against the other
// ends where it meets it. What the broadphase did not foresee is asked for then. What is too much both go back, each
// along its own way, which was free. A mechanism goes back as one and without turning, so that its joints stay as they
// are, and only across the surface; where it hangs on the world, each of it a share of its own way, so that it does not
// stand in the air for good, and its joints are closed after that; where it still passes something, it stays where it
// was before the step. Velocities stay: the next frame finds the contact. No pair is looked after that the host or a
// one-way collider may ignore.
// followed: by node, 1 for vertices of surfaces whose contacts went along their ways, or empty. Such that are clear of
// what a straight way goes through went round it, and held back alone would leave their edges there.
void hold_back(Team& team, const Colliders& colliders, const Shapes& shapes, const Joints& joints,
               const Elements& elements, std::span<const uint8_t> followed, Pairs& pairs,
               collision::Broadphase& broadphase, Nodes& nodes);

// Whether balls about two colliders' origins, each as large as to hold its shape, stay apart on their ways: such two do
// not meet, which costs less to know than when they do. False in doubt.
bool stay_apart(const Nodes& nodes, const Pairs& pairs, const PairEnds& pair, double time);

// Two colliders under way.
class Encounter {
public:
    Encounter(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
              const PairEnds& pair);

    // When they meet within time [s]: infinite if they do not, 0 where they are close by now.
    double meeting(double time) const;
    collision::Placement a_after(double time) const { return motion_a_.after(time); }
    collision::Placement b_after(double time) const { return motion_b_.after(time); }
    // Separations of a manifold found at the moment Pair::then as they are now; its positions stay as they are then.
    void bring_to_present(Pair& pair) const;

private:
    Encounter(const Nodes& nodes, const Shapes& shapes, const Collider& a, const collision::Placement& at_a,
              const Collider& b, const collision::Placement& at_b);

    const collision::Shape &a_, &b_;
    collision::Motion motion_a_, motion_b_;
    Vec3 arm_a_;  // from the origin of a's node, which positions are relative to, to its centre of mass [m]
};

}  // namespace taut
