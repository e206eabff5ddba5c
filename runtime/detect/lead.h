// Contacts that move over a round body, which are found where they will be halfway through the frame; see Shaped.
#pragma once

#include "detect/manifolds.h"

namespace taut {

// The radius of the patch in which the two touch, where one is round: a guess in parts of the smaller one's size, of
// what neither is so hard nor so smooth as to touch in a point [m].
float patch_of(const Pairs& pairs, const PairEnds& pair);

// The lead time of a pair's contact [s]: of one between bodies that moves over a round surface and bore in the last
// frame, unless it moves so little in that time that it may as well be kept.
double lead_of(const Detection& of, const Pair& pair);

// Points found where the two will be in a lead time, from a's origin then to a's node, told at the present poses: less
// the growth of the gap until then, and with the levers of then, of the lighter node exactly,
//   gap now = gap then - T n . ((v_b + w_b x r_b) - (v_a + w_a x r_a)).
// A body that turns so far that its levers follow it within the frame has those of now, and the growth along its arc.
void bring_back(const Detection& of, double lead, const Vec3f& from_a, Pair& pair);

}  // namespace taut
