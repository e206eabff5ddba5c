// Contacts of pairs that hardly move against each other are not asked for again. A manifold that was found in full goes
// on as it lies on the shape of a, and each separation changes by the way, along the normal, of b's point there:
//
//   separation = found + n . d(p),   d(p) = o - o_found + (Q - 1) (p - o_found),
//
// o: origin of b's shape, Q: its turn since then, all as seen from a. This holds as long as each d(p), and the angle of
// Q times the size r of the smaller shape, are at most s = 50 um, and r / 1000: else the pair is asked in full, and
// counting starts anew, so that errors do not add up. Where two features are nearest to each other, n . d is the exact
// change to first order, whatever they are; the next order is s^2 / r <= 50 nm. A point that a face's side cuts off
// lags by s times the slope between the faces. The normal, which may be b's, is off by s / r <= 1e-3. What the manifold
// does not hold is further than the contact margin, which is 200 s.
#pragma once

#include "state/pairs.h"

namespace taut {

// Keeps a pair's manifold as it was found at the present placements. False, and nothing kept, where the two move
// against each other: such a one is not brought to the present in the time ahead [s].
bool keep_manifold(const Pairs& pairs, double time, Pair& pair);

// Brings the manifold that a pair keeps to the present placements; false, and nothing done, if it is to be found again:
// the two moved against each other, or will in the time ahead [s].
bool reuse_manifold(const Pairs& pairs, double time, Pair& pair);

// Whether two colliders may go further against each other in a frame than they are thick; is_fast() knows.
inline bool may_be_fast(const Pairs& pairs, const NearPair& near) {
    const Travel &a = pairs.travel[near.collider_a()], &b = pairs.travel[near.collider_b()];
    return !(a.ahead + b.ahead <= a.thickness + b.thickness);
}

// How far apart two colliders get contact points [m].
inline float contact_margin(const Pairs& pairs, uint32_t a, uint32_t b) {
    return std::min(pairs.travel[a].margin, pairs.travel[b].margin);
}
// What that does not take in of how far the two swing [m].
inline float beyond_margin(float swing, float margin) { return std::max(swing - margin, 0.0f); }

// Whether two colliders that were found further apart than the contact margin still are, wherever they go in a frame.
inline bool stay_clear(const Pairs& pairs, const NearPair& near) {
    const Travel &a = pairs.travel[near.collider_a()], &b = pairs.travel[near.collider_b()];
    const float margin = std::min(a.margin, b.margin);
    const float swing = near.against_fixed ? beyond_margin(a.swing + b.swing, margin) : 0;
    const double way = a.way + b.way + static_cast<double>(a.ahead + b.ahead + swing + margin);
    const bool is_clear = way < near.clear, may_be_fast = taut::may_be_fast(pairs, near);
    return is_clear & !may_be_fast;  // which of the two holds would be mispredicted
}

// Notes that they are at least so far apart now [m]; 0: not known, or they have points.
void note_clear(const Pairs& pairs, float gap, NearPair& near);

}  // namespace taut
