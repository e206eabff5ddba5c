// Sleeping of islands: what a step does about it. Nodes connected by joints and close contacts fall asleep together,
// once all of them were slow for a while, and wake together.
//
// The pairs of sleeping nodes move from Pairs::near to Pairs::resting, where no stage of the step meets them; they keep
// their manifolds and impulses, from which the island goes on when it wakes.
#pragma once

#include "detect/obstacles.h"
#include "world.h"

namespace taut {

// Whether a pair's two bodies wake each other: a point pushes, or its gap is at most 5 mm.
bool touches_closely(const Pair& pair);
bool touches_closely(const GrainContact& contact);
bool touches_closely(const SurfaceContact& contact);

// In the step's order. Pairs of nodes that woke come back into the list ...
void recall_pairs(World& world);
// ... and those of which no side moves any more leave it.
void retire_pairs(World& world);
// Wakes what awake nodes touch, or will touch in this step. True: its pairs are to be recalled, and contacts found
// anew.
bool wake_touched(World& world);
// The same of solvers that take ways out in place of contacts: wakes soft bodies that an awake one, or a shape that its
// host moves, may come to in a time [s].
void wake_met(World& world, double time, Obstacles& obstacles);
// After the step: who falls asleep, and the events of all who did or woke.
void update_sleep(World& world);

// The island of a node that forces move, as its contacts and joints are now. Throws std::bad_alloc with nothing
// changed.
void put_to_sleep(World& world, uint32_t node);

}  // namespace taut
