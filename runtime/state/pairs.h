// Contact pairs: one record for each overlapping pair of fat boxes, sorted by key, carried over frames.
#pragma once

#include <taut/event.h>

#include "collision/collide.h"
#include "state/nodes.h"

namespace taut {

// How far apart two surfaces get contact points [m]; tight boxes are grown by it before they enter the broadphase.
constexpr float kContactMargin = 0.02f;

struct Impulse {  // of one contact point [N s], in the frame (normal, tangent1, tangent2) of its manifold
    float normal = 0, tangent1 = 0, tangent2 = 0;
    float slip = -1;  // of points in blocks: compliance of sliding friction [1/kg]; 0: sticks; -1: new
};

struct Pair {
    uint64_t key = 0;  // a << 32 | b, a < b
    collision::PairCache cache;
    collision::Manifold manifold;  // of this frame
    Impulse impulse[4];            // by point: carried in, updated by the solver
    bool filtered = false;         // never collides (filter, joint); kept to remember the answer
    bool touching = false;         // had a point at the end of the last step

    uint32_t a() const { return static_cast<uint32_t>(key >> 32); }
    uint32_t b() const { return static_cast<uint32_t>(key); }
};

// Tangents of a contact normal: the same for the same normal, continuous but for the switch of the helper axis.
inline Vec3f tangent_of(const Vec3f& n) {
    const Vec3f axis = std::abs(n.x()) < 0.6f ? Vec3f::UnitX() : Vec3f::UnitY();
    return n.cross(axis).normalized();
}

// A pair with contact points in this frame, in brief: what partition and assembly go through.
struct ActivePair {
    uint32_t a, b;  // nodes
    uint32_t pair;  // index into Pairs::list
    uint32_t points;
};

struct Pairs {
    explicit Pairs(Memory& memory)
        : list(memory), scratch(memory), active(memory), ended(memory), joined(memory), placement(memory) {}

    Array<Pair> list;                       // sorted by key
    Array<Pair> scratch;                    // for the merge with the broadphase's list
    Array<ActivePair> active;               // sorted as list is; find_contacts()
    Array<taut_contact_event> ended;        // touching pairs forgotten since the last step; one end may be gone by then
    uint32_t world = 0;                     // id of the world, for the handles in ended
    Array<uint64_t> joined;                 // keys of bodies whose joint forbids contacts, sorted
    uint64_t joined_version = 0;            // of the joints that they were taken from
    Array<collision::Placement> placement;  // by node; find_contacts()
};

// Notes that a touching pair ended.
void report_end(Pairs& pairs, const Nodes& nodes, const Pair& pair);

// Drops the records of a pair or of every pair of a node, for which touching ones leave an end event. The step makes
// them anew from the broadphase's list, if that still holds them. Throws std::bad_alloc before anything changes, and
// not at all after reserve_ended.
void forget_pair(Pairs& pairs, const Nodes& nodes, uint32_t a, uint32_t b);
void forget_pairs_of(Pairs& pairs, const Nodes& nodes, uint32_t node);
// Room for the end events of a node's touching pairs.
void reserve_ended(Pairs& pairs, uint32_t node);

}  // namespace taut
