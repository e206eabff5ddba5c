// The host's time in steps: what it asks of the time until its next call, and what it sees in between.
//
// An accumulator [s] holds the time of the host's calls that no step took yet. Forces and kinematic targets are the
// host's, in its time: a force F applied before a call of T seconds is an impulse F T, and each step takes what the
// stretch of the host's time that it stands for holds of it; a kinematic body goes evenly from where it was led before
// to its target in the T seconds, and each step brings it to where it is at the step's end.
#pragma once

#include "world.h"

namespace taut {

struct Advance {
    uint32_t steps = 0;
    double dropped = 0;  // [s]
};

// One step, beside the accumulator: forces act over it, and targets are reached at its end. Throws as step().
void take_step(World& world);
// A step of no time: statics by the world's solver. Kinematic nodes stay, and go on as before after it; what moves by
// forces is at rest then. Throws as step().
void take_rest(World& world, Relaxation& relaxation);
// As many whole steps as seconds more of frame time give. A failed first step throws, with nothing changed; a later one
// only ends it: the time left stays in the accumulator, and the next call meets the failure.
Advance advance(World& world, double seconds);

// Where between the poses before and after the last step the host's time stands, [0, 1]. That is one step behind.
double render_weight(const World& world);

// The velocity that brings a node from one pose of its origin to another in a time [s], by at most half a turn.
Speed speed_between(const Nodes& nodes, uint32_t node, const NodePose& from, const NodePose& to, double time);
// Sends a kinematic node to a pose of its origin, which it reaches by the end of the host's next call. Throws
// std::bad_alloc with nothing changed.
void lead_to(World& world, uint32_t node, const NodePose& target);
// A kinematic node has a velocity of its own again, or was put to another place.
void forget_path(Nodes& nodes, uint32_t node);
void restart_path(World& world, uint32_t node);

// Another length of the step [s]: what pushes goes on as hard.
void change_time_step(World& world, float time_step);

}  // namespace taut
