// Pairs of colliders, carried over frames. Those whose fat boxes overlap are near and have a small record each; only
// those with contact points have a large one besides, a Pair: one for each part where one shape is a surface.
#pragma once

#include <taut/event.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/exchange.h"
#include "base/segmented_array.h"
#include "collision/collide.h"
#include "state/colliders.h"
#include "state/grains.h"
#include "state/motion.h"
#include "state/surface_contacts.h"
#include "threads/homes.h"

namespace taut {

// A box is kept until its collider moved, or is about to move, so far from where it was made, in parts of its margin.
constexpr double kBoxLag = 0.5;
// A frame's motion counts towards the contact margin up to this [m].
constexpr double kMaxReach = 0.5;

// Who meets whom.
struct PairEnds {
    uint64_t key = 0;                 // of the two colliders, see pair_key
    uint32_t a = 0, b = 0;            // their nodes, in the order of the key
    uint32_t a2 = kNone, b2 = kNone;  // second nodes of colliders that span two

    uint32_t collider_a() const { return static_cast<uint32_t>(key >> 32); }
    uint32_t collider_b() const { return static_cast<uint32_t>(key); }
    bool spans() const { return a2 != kNone || b2 != kNone; }
};
template <class Visitor, Like<PairEnds> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [key, a, b, a2, b2] = of;
    TAUT_FIELDS(visitor, key, a, b, a2, b2);
}

// What collision::PairCache begins with, kept of all pairs that are near, and what it ends with, of those with points:
// shapes that touch alone read it again.
using NearCache = std::array<uint32_t, 4>;
using PointsCache = std::array<uint32_t, 4>;
static_assert(sizeof(NearCache) + sizeof(PointsCache) == sizeof(collision::PairCache));
struct NearPair {
    uint64_t key = 0;  // of the two colliders, see pair_key
    NearCache cache{};
    double clear = 0;                // the ways of its colliders until they may touch [m]; detect/reuse.h
    uint32_t pair = kNone;           // the first of its records in Pairs::list, while it has points
    uint8_t asks = 0;                // bits of contact events, as its pair's
    bool filtered : 1 = false;       // never collides (filter, joint); kept to remember the answer
    bool on_surface : 1 = false;     // a shape has parts
    bool against_fixed : 1 = false;  // a side does not yield: is_against_fixed()
    bool fast : 1 = false;           // looked for along its way in this frame; detect/impact.h
    bool arrives : 1 = false;        // got its first points in this frame; find_contacts()
    bool changes : 1 = false;        // its records come or go in this frame; find_contacts()
    bool touching : 1 = false;       // overlapped or was pushed in the last step, by any part
    bool touched : 1 = false;        // the same of the step before
    bool hit : 1 = false;            // gave a hit event in the last step
    bool kept : 1 = false;           // all its records hold their manifolds as found; detect/reuse.h
    bool reused : 1 = false;         // and these go on in this frame
    bool changed : 1 = false;        // the host may have changed a collider since the pair was looked at
    bool crowded : 1 = false;        // left out in this frame; detect/crowds.h

    uint32_t collider_a() const { return static_cast<uint32_t>(key >> 32); }
    uint32_t collider_b() const { return static_cast<uint32_t>(key); }
    // After a change of a shape: all that was found out about it.
    void forget_shapes() {
        cache = {};
        clear = 0;
        kept = false;
        changed = true;
    }
    PairEnds ends(const Colliders& colliders) const {
        const Collider &a = colliders.record[collider_a()], &b = colliders.record[collider_b()];
        return {key, a.node, b.node, a.node_b, b.node_b};
    }
};
template <class Visitor, Like<NearPair> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [key, cache, clear, pair, asks, filtered, on_surface, against_fixed, fast, arrives, changes, touching,
           touched, hit, kept, reused, changed, crowded] =
        of;  // pair: the record is found by its key; fast to changes: within a step
    bool bits[] = {filtered, on_surface, against_fixed, touching, touched, hit, kept, reused, changed};
    TAUT_FIELDS(visitor, key, cache, clear, bits);
    TAUT_ASIDE(visitor, asks);  // what decides motion its colliders ask for too
    if constexpr (!std::is_const_v<Of>) {
        filtered = bits[0], on_surface = bits[1], against_fixed = bits[2], touching = bits[3], touched = bits[4];
        hit = bits[5], kept = bits[6], reused = bits[7], changed = bits[8];
    }
}

using NearPairs = SegmentedArray<NearPair>;

// A pair that may have gone through each other in this frame, as it is asked again each time that some were put back;
// hold_back().
struct AskedPair {
    explicit AskedPair(const NearPair& near) : a(near.collider_a()), b(near.collider_b()), fast(near.fast) {}

    uint32_t a, b;  // colliders, the smaller index first
    bool fast;
    bool passed = false;  // did so
};

// The ball inside a collider, less its contact margin: of no radius where it does not yield or spans two nodes.
struct InnerBall {
    Vec3 middle = Vec3::Zero();
    double radius = 0;  // [m]
};

// The deepest of what is sunk into a collider; detect/crowds.h.
struct Crowd {
    static constexpr uint32_t kMost = 12;  // as many balls as touch one of their size (Schuette, van der Waerden 1953)

    InnerBall ball;
    uint32_t count = 0;       // of what is sunk in
    uint32_t least = 0;       // how many of the deepest are as deep as the least of them
    float depth[kMost] = {};  // of these [m], least first
};

// A manifold as it was found, and how b's shape lay then, all as seen from a's shape; detect/reuse.h.
struct FoundManifold {
    Quatf turn;    // of b's shape
    Vec3f origin;  // of b's shape [m]
    Vec3f normal;
    Vec3f position[4];    // of points, from the origin of a's shape [m]
    float separation[4];  // [m]
};
template <class Visitor, Like<FoundManifold> Of>
void describe(Visitor& visitor, Of& of, int points) {
    auto& [turn, origin, normal, position, separation] = of;
    TAUT_FIELDS(visitor, turn, origin, normal);
    for (int k = 0; k < points; ++k) TAUT_FIELDS(visitor, position[k], separation[k]);
}

// What a pair with points has besides its ends.
struct PairRecord {
    uint32_t part = 0;             // of a surface, see collision::PartManifold; else 0
    uint32_t next = kNone;         // record of the next part, in their order
    collision::Manifold manifold;  // of this frame; positions relative to the origin of node a
    float then = 0;                // when the two meet, for a manifold found there [s]; 0: now; detect/impact.h
    // Radii of the balls that grow the two cores to their shapes [m]; see state/levers.h.
    float round_a = 0, round_b = 0;
    ContactForce force[4];  // by point: carried in, updated by the solver
    float friction = 0;     // of the two surfaces together
    float restitution = 0;
    float spinning = 0, rolling = 0;  // arms of the friction torques [m]
    float stiffness = 1;   // of its normal rows in sweeps, in parts of what contacts have; partition/squeezed.cpp
    float patch = 0;       // radius of the patch in which a round side touches [m]; see spinning_arm()
    ContactForce torque;   // of these, as forces [N m]; slip: of rolling [rad^2/(kg m^2)]
    float spin_slip = -1;  // the same of spinning
    // Velocity of body b against a that friction drives to, that of a's surface less that of b's, both against their
    // bodies: drive + drive_spin x p [m/s], world axes, p as the points of the manifold.
    Vec3f drive = Vec3f::Zero(), drive_spin = Vec3f::Zero();
    float sticking = 0;      // friction of a point that does not slide, where that is more
    float slide_factor = 1;  // friction along `slide_direction` is so many times that across it
    // Unit, world axes, along the contact; where slide_factor is 1 it means nothing.
    Vec3f slide_direction = Vec3f::Zero();
    bool driven = false;                    // else drive and drive_spin mean nothing
    bool directed = false;                  // a side has a direction of friction, which turns with it
    bool rolls_a = false, rolls_b = false;  // contact levers stay while the shape turns: collision::rolls()
    bool touching = false;                  // overlapped or was pushed in the last step
    bool pushed = false;                    // some point was in this step, in any of its substeps
    bool answered = false;                  // the host gave this step's friction and restitution
    bool in_block = false;                  // was solved directly when it was solved last
    uint8_t loaded = 0;  // frames in which it bore much, one after another in a small island; partition/pressed.cpp
    uint8_t asks = 0;    // bits of contact events, kAsks: of the world and the two colliders

    // What find_contacts() alone asks for: the last kSought bytes.
    PointsCache cache{};
    FoundManifold found;  // while NearPair::kept
    static constexpr size_t kSought = sizeof(PointsCache) + sizeof(FoundManifold);

    // Of a point of the manifold.
    Vec3f drive_at(int k) const { return drive + drive_spin.cross(manifold.points[k].position); }
    bool sticks_better() const { return sticking > friction; }
    float most_friction() const { return std::max(sticking, friction); }
    bool turns() const { return spinning > 0 || rolling > 0; }
    bool twists() const { return turns() || patch > 0; }
    // Arms of the torques in sweeps [m]: of the surfaces, or of the patch, whichever resist more. Friction in a patch
    // of even pressure resists spinning by 2/3 mu a of the force; one that loses a part alpha of what it takes to
    // flatten the patch resists rolling by 3/16 alpha a (Johnson, Contact Mechanics, 1985, section 9.4). Balls and
    // capsules roll on as on rigid ground.
    float spinning_arm() const { return std::max(spinning, 2.0f / 3 * friction * patch); }
    float rolling_arm() const {
        constexpr float kLoss = 0.008f;  // about that of steel
        return std::max(rolling, rolls_a || rolls_b ? 3.0f / 16 * kLoss * patch : 0);
    }
};
template <class Visitor, Like<PairRecord> Of>
void describe(Visitor& visitor, Of& of, bool kept) {
    auto& [part, next, manifold, then, round_a, round_b, force, friction, restitution, spinning, rolling, stiffness,
           patch, torque, spin_slip, drive, drive_spin, sticking, slide_factor, slide_direction, driven, directed,
           rolls_a, rolls_b, touching, pushed, answered, in_block, loaded, asks, cache, found] =
        of;  // next: follows from the order of records
    TAUT_FIELDS(visitor, part, manifold, then, round_a, round_b);
    for (int k = 0; k < manifold.count; ++k) TAUT_FIELDS(visitor, force[k]);
    TAUT_FIELDS(visitor, friction, restitution, spinning, rolling, stiffness, patch, torque, spin_slip, drive,
                drive_spin, driven, rolls_a, rolls_b, touching, pushed, answered, in_block, loaded, cache);
    bool own_friction = sticking != 0 || slide_factor != 1 || directed;  // by laws of its own
    TAUT_ASIDE(visitor, own_friction);
    if (own_friction)
        TAUT_FIELDS(visitor, sticking, slide_factor, slide_direction, directed);
    else if constexpr (!std::is_const_v<Of>)
        sticking = 0, slide_factor = 1, directed = false;
    TAUT_ASIDE(visitor, asks);
    if (kept) describe(visitor, found, manifold.count);
}

struct Pair : PairEnds, PairRecord {};
// A record and whether its NearPair keeps what was found; of others that means nothing.
template <class Visitor, Like<Pair> Of>
void describe(Visitor& visitor, Of& of, bool kept = false) {
    TAUT_FIELDS(visitor, kept, static_cast<copy_const_t<Of, PairEnds>&>(of));
    describe(visitor, static_cast<copy_const_t<Of, PairRecord>&>(of), kept);
}

// The sum of the points' normal forces [N].
inline float push_of(const collision::Manifold& manifold, const ContactForce* force) {
    float sum = 0;
    for (int k = 0; k < manifold.count; ++k) sum += force[k].normal;
    return sum;
}

// What was found of a pair that has no record yet.
struct Arrival {
    uint64_t key = 0;
    collision::Manifold manifold;
    PointsCache cache{};
    float then = 0;  // as Pair's
};

// The smaller index first; of colliders or of nodes.
constexpr uint64_t pair_key(uint32_t one, uint32_t other) {
    return one < other ? static_cast<uint64_t>(one) << 32 | other : static_cast<uint64_t>(other) << 32 | one;
}

// Calls act(node of a, node of b) for all nodes of the two sides of a pair.
template <class Act>
void for_sides(const PairEnds& pair, Act&& act) {
    for (uint32_t a : {pair.a, pair.a2})
        for (uint32_t b : {pair.b, pair.b2})
            if (a != kNone && b != kNone) act(a, b);
}

// Whether a side does not yield: what swings into it gets no further out of the way.
inline bool is_against_fixed(const Nodes& nodes, const PairEnds& pair) {
    return !moves_by_forces(nodes.info[pair.a].kind) || !moves_by_forces(nodes.info[pair.b].kind);
}

// Tangents of a contact normal: the same for the same normal, continuous but for the switch of the helper axis.
inline Vec3f tangent_of(const Vec3f& n) {
    const Vec3f across = std::abs(n.x()) < 0.6f ? Vec3f(0, n.z(), -n.y()) : Vec3f(-n.z(), 0, n.x());
    return across * (1 / across.norm());
}

// Whether they go over into each other from one normal to another nearby.
inline bool same_tangents(const Vec3f& one, const Vec3f& other) {
    return (std::abs(one.x()) < 0.6f) == (std::abs(other.x()) < 0.6f);
}

// The tangents that the rows of a pair's friction are along, t2 = n x t1. The row of t2 counts `part` times: with
// coefficients mu and part mu along the two the ellipse of forces is the disc of radius mu for the impulses of the
// rows.
struct Tangents {
    Vec3f t1, t2;    // unit
    float part = 1;  // in (0, 1]
};
inline Tangents tangents_of(const PairRecord& pair) {
    const Vec3f &n = pair.manifold.normal, along = pair.slide_direction - n.dot(pair.slide_direction) * n;
    const float size = pair.slide_factor < 1 ? along.norm() : 0;
    if (!(size > 0)) {  // all ways alike
        const Vec3f t1 = tangent_of(n);
        return {t1, n.cross(t1), 1};
    }
    const Vec3f t2 = along / size;
    return {t2.cross(n), t2, pair.slide_factor};
}
// What rows have of a friction, and back; world axes.
inline std::array<float, 2> rows_of(const Tangents& of, const Vec3f& friction) {
    return {friction.dot(of.t1), friction.dot(of.t2) / of.part};
}
inline Vec3f friction_of(const Tangents& of, float row1, float row2) { return row1 * of.t1 + of.part * row2 * of.t2; }

// A force of a pair, in the frame of tangent_of(normal), as its rows have it, and back.
inline ContactForce to_rows(const PairRecord& pair, const ContactForce& force, const Tangents& of) {
    const Vec3f &n = pair.manifold.normal, o1 = tangent_of(n);
    const auto [row1, row2] = rows_of(of, force.tangent1 * o1 + force.tangent2 * n.cross(o1));
    return {force.normal, row1, row2, force.slip};
}
inline ContactForce from_rows(const PairRecord& pair, const ContactForce& rows, const Tangents& of) {
    const Vec3f &n = pair.manifold.normal, o1 = tangent_of(n);
    const Vec3f friction = friction_of(of, rows.tangent1, rows.tangent2);
    return {rows.normal, friction.dot(o1), friction.dot(n.cross(o1)), rows.slip};
}
inline ContactForce to_rows(const PairRecord& pair, const ContactForce& force) {
    return pair.slide_factor < 1 ? to_rows(pair, force, tangents_of(pair)) : force;
}
inline ContactForce from_rows(const PairRecord& pair, const ContactForce& rows) {
    return pair.slide_factor < 1 ? from_rows(pair, rows, tangents_of(pair)) : rows;
}
// The same of friction torques, which know no direction.
inline Tangents torque_tangents_of(const PairRecord& pair) {
    Tangents of = tangents_of(pair);
    of.part = 1;
    return of;
}
inline ContactForce torque_to_rows(const PairRecord& pair) {
    return pair.slide_factor < 1 ? to_rows(pair, pair.torque, torque_tangents_of(pair)) : pair.torque;
}
inline ContactForce torque_from_rows(const PairRecord& pair, const ContactForce& rows) {
    return pair.slide_factor < 1 ? from_rows(pair, rows, torque_tangents_of(pair)) : rows;
}

// A pair with contact points in this frame, in brief: what partition and assembly go through.
struct ActivePair {
    uint32_t a, b;   // nodes
    uint32_t pair;   // index into Pairs::list
    uint8_t points;  // of these, as of the pair: asks, loaded, in_block
    uint8_t asks = 0;
    uint8_t loaded = 0;
    bool in_block = false;
    uint32_t a2 = kNone, b2 = kNone;  // the second nodes of sides that span two
    float borne = 0;                  // by its points in the last substep [N]
    uint32_t near = 0;                // index into Pairs::near

    bool spans() const { return a2 != kNone || b2 != kNone; }
    std::array<uint32_t, 2> sides() const { return {a, b}; }
    std::array<uint32_t, 4> nodes() const { return {a, b, a2, b2}; }
};

// Where a body lies that a kinematic one carries: its pose as seen from there when friction last did not hold it;
// detect/carried.h.
struct Carried {
    uint64_t key;   // of the pair
    uint32_t part;  // as of the pair
    Vec3 x;         // of centres of mass, axes of a [m]
    Quat q;
};
template <class Visitor, Like<Carried> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [key, part, x, q] = of;
    TAUT_FIELDS(visitor, key, part, x, q);
}
template <class Visitor, Like<taut_contact_event> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [body_a, body_b, collider_a, collider_b, first_point, point_count, step, reserved] = of;
    TAUT_FIELDS(visitor, body_a.bits, body_b.bits, collider_a.bits, collider_b.bits, first_point, point_count, step);
}

struct Pairs {
    explicit Pairs(Memory& memory)
        : near(memory),
          resting(memory),
          late(memory),
          list(memory),
          free(memory),
          arrived(memory),
          departed(memory),
          active(memory),
          by_depth(memory),
          ended(memory),
          joined(memory),
          met(memory),
          reach(memory),
          pace(memory),
          courses(memory),
          asked(memory),
          marks(memory),
          bearings(memory),
          crowds(memory),
          crowd_of(memory),
          mechanisms(memory),
          placement(memory),
          stance(memory),
          travel(memory),
          picked(memory),
          arriving(memory),
          unheld(memory),
          homes(memory),
          carried(memory),
          carried_before(memory),
          parts(memory),
          grains(memory),
          surfaces(memory) {}

    // In what update_bounds() fills, for so many colliders: as they come, not in the step that sees them first.
    void make_room(size_t colliders) {
        grow_to(met, colliders), grow_to(reach, colliders), grow_to(pace, colliders), grow_to(placement, colliders);
        grow_to(stance, colliders), grow_to(travel, colliders);
    }
    // Of a new collider in a slot, or of one that gets another shape.
    void forget_place(uint32_t collider) {
        if (collider >= stance.size()) return;
        placement[collider] = {};
        stance[collider] = {};
        travel[collider] = {};
        reach[collider] = {};
    }

    NearPairs near;                   // sorted by key
    NearPairs resting;                // sorted likewise: pairs of which no side moves and one is asleep
    Array<NearPair> late;             // sorted likewise, of this step: whom ways led together that nobody foresaw
    bool complete = false;            // all pairs of the broadphase are in one of the two
    SegmentedArray<Pair> list;        // slots, in no order; free ones have no points
    Array<uint32_t> free;             // of them; room for all
    uint32_t next_ordered = 0;        // in active, whose slot is looked at next; order_slots()
    Array<uint64_t> arrived;          // keys that near does not hold yet, sorted; update_pairs()
    Array<uint64_t> departed;         // keys that it holds no more, sorted; update_pairs()
    Array<ActivePair> active;         // in the order of near and of parts; find_contacts()
    Array<uint32_t> by_depth;         // in active, in the order of depth; limit_contacts()
    Array<taut_contact_event> ended;  // touching pairs forgotten since the last step; one end may be gone by then
    uint32_t world = 0;               // id of the world, for the handles in ended
    uint8_t asks = 0;                 // of all pairs: the world's contact events
    Array<uint64_t> joined;           // keys of nodes whose joint forbids contacts, sorted
    uint64_t joined_version = 0;      // of the joints that they were taken from
    uint64_t colliders_version = 0;   // that NearPair::changed knows
    Array<uint8_t> met;               // by collider: 1 if it may have a record in near or resting; has_met()
    Array<Reach> reach;               // by collider; update_bounds()
    Array<Pace> pace;                 // by collider; update_bounds()
    Array<Course> courses;            // by collider, scratch; hold_back()
    Array<AskedPair> asked;           // of near and late, in the order of their keys; scratch of hold_back()
    Array<uint8_t> marks;             // by collider, scratch: bits of hold_back()
    Array<uint8_t> bearings;          // by collider, scratch of open_internal_faces()
    bool any_fast = false;            // of near, in this frame; find_contacts()
    bool any_crowded = false;         // likewise; thin_crowds()
    Array<Crowd> crowds;              // scratch of thin_crowds()
    Array<uint32_t> crowd_of;         // by collider, likewise
    Mechanisms mechanisms;
    Array<collision::Placement> placement;  // by collider; place_collider()
    Array<Stance> stance;                   // by collider; place_collider()
    Array<Travel> travel;                   // by collider; place_collider(), ahead: update_bounds()
    Array<uint32_t> picked;                 // scratch: what gather() found last
    Array<Arrival> arriving;                // scratch; find_contacts()
    Array<uint8_t> unheld;                  // by node: 1 where others pushed against one that is gone; find_contacts()
    uint8_t any_unheld = 0;                 // 1 where there is one
    Homes homes;                            // of near; share_out()
    Array<Carried> carried;                 // in the order of active; hold_carried()
    Array<Carried> carried_before;          // those of the step before; hold_carried()
    collision::Parts parts;                 // of the pair looked at last
    Grains grains;                          // contacts that are no pairs,
    SurfaceContacts surfaces;               // likewise
};

// The record of a key in a sorted list; null: it has none.
template <class List>
const NearPair* find_pair(const List& list, uint64_t key) {
    const auto at = std::ranges::lower_bound(list, key, {}, &NearPair::key);
    return at != list.end() && at->key == key ? &*at : nullptr;
}

// Room for so many pairs with points beyond those that there are.
void reserve_slots(Pairs& pairs, size_t more);
// A slot with a new record; reserve_slots() went before.
uint32_t take_slot(Pairs& pairs, const PairEnds& ends);
// The records of a pair that is left without points.
void give_slots(Pairs& pairs, NearPair& near);

// What the host says of a contact's friction, if that is another, holds where it sticks too.
inline void answer(float friction, float restitution, PairRecord& pair) {
    if (friction != pair.friction) pair.sticking = 0;
    pair.friction = friction;
    pair.restitution = restitution;
}
inline void answer(float friction, float restitution, SurfaceContact& contact) {
    contact.friction = friction;
    contact.restitution = restitution;
}
// As if the two had just met.
void forget_forces(Pair& pair);
// Of a pair that is swept from now on. A direct solve sets hundreds of times a light body's momentum against as much
// from its other side, and sweeps that begin with what is left of that throw it out at kilometres a second.
void leave_block(Pair& pair);

// Gives back the room of what is no more, if that is most of it.
void trim(Pairs& pairs) noexcept;

// Before the active pairs are listed anew: brings the records of a few of them to where they lie in the order of near.
// A thread that goes through a part of near then has them for itself: of neighbours in memory processors fetch what
// another thread writes.
void order_slots(Pairs& pairs);

// Changes a list that is sorted by key; make(key) gives a new record.
template <class Make>
void exchange_pairs(NearPairs& list, const Changes& changes, Make&& make) {
    Exchange(
        list, changes, [](const NearPair& near) { return near.key; }, make)
        .run();
}

// Notes that a touching pair ended, if anybody asks.
void report_end(Pairs& pairs, const Nodes& nodes, const Colliders& colliders, const NearPair& near);

// Whether a node may be in a record of near pairs, which what stands alone need not look for among those of others.
inline bool has_met(const Pairs& pairs, const Nodes& nodes, const Colliders& colliders, uint32_t node) {
    bool met = nodes.info[node].is_part();  // whose colliders may be another node's
    for_colliders(nodes, colliders, node, [&](uint32_t c) { met = met || pairs.met[c]; });
    return met;
}

// Calls act(near) for all near pairs, resting ones too, in the order of keys.
template <class SomePairs, class Act>
void for_near(SomePairs& pairs, Act&& act) {
    auto resting = pairs.resting.begin();
    for (auto& near : pairs.near) {
        while (resting != pairs.resting.end() && resting->key < near.key) act(*resting++);
        act(near);
    }
    while (resting != pairs.resting.end()) act(*resting++);
}

// Calls act(pair) for the pairs with points that a near pair has, in the order of parts.
template <class SomePairs, class Act>
void for_parts(SomePairs& pairs, const NearPair& near, Act&& act) {
    for (uint32_t index = near.pair; index != kNone; index = pairs.list[index].next) act(pairs.list[index]);
}

// Calls act(pair) for all pairs with points, resting ones too, in the order of key and part.
template <class SomePairs, class Act>
void for_pairs(SomePairs& pairs, Act&& act) {
    for_near(pairs, [&](const NearPair& near) { for_parts(pairs, near, act); });
}

// Which slots records lie in depends on all that was before, and changes no result: they are told in their order, and
// lie in it after a restoration, before which the lists of their slots mean nothing.
template <class Visitor, Like<Pairs> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [near, resting, late, complete, list, free, next_ordered, arrived, departed, active, by_depth, ended, world,
           asks, joined, joined_version, colliders_version, met, reach, pace, courses, asked, marks, bearings, any_fast,
           any_crowded, crowds, crowd_of, mechanisms, placement, stance, travel, picked, arriving, unheld, any_unheld,
           homes, carried, carried_before, parts, grains, surfaces] = of;
    TAUT_FIELDS(visitor, near, resting, mechanisms, carried, grains, surfaces);
    TAUT_ASIDE(visitor, complete, ended, asks, colliders_version);
    visitor.ordered(list, [&](auto&& act) {
        for_near(of,
                 [&](const NearPair& pair) { for_parts(of, pair, [&](const Pair& part) { act(part, pair.kept); }); });
    });
    // reach, placement, stance, travel: rows of the colliders, world.h. joined, pace: found by the next step; met:
    // link_records(). All others are what steps work with.
}
// Once a restoration filled it: room for what link_records() makes, which may throw std::bad_alloc, and that.
void reserve_links(Pairs& pairs);
void link_records(Pairs& pairs);

// The same without the resting ones.
template <class SomePairs, class Act>
void for_awake_pairs(SomePairs& pairs, Act&& act) {
    for (const NearPair& near : pairs.near) for_parts(pairs, near, act);
}

// Room for the end events of the touching pairs that meet a condition.
template <class Condition>
void reserve_ended(Pairs& pairs, Condition&& condition) {
    size_t needed = pairs.ended.size();
    for_near(pairs, [&](const NearPair& near) { needed += near.touching && condition(pairs.list[near.pair]); });
    if (needed > pairs.ended.capacity()) pairs.ended.reserve(std::max(needed, 2 * pairs.ended.capacity()));
}

// Drops the records of the pairs that meet a condition, for which touching ones leave an end event. The step makes them
// anew from the broadphase's list, if that still holds them. Throws std::bad_alloc before anything changes, and not at
// all after reserve_ended.
template <class Condition>
void forget_pairs(Pairs& pairs, const Nodes& nodes, const Colliders& colliders, Condition&& condition) {
    reserve_ended(pairs, condition);
    for_near(pairs, [&](NearPair& near) {
        if (!condition(near.ends(colliders))) return;
        if (near.touching) report_end(pairs, nodes, colliders, near);
        give_slots(pairs, near);
    });
    const auto met = [&](const NearPair& near) { return condition(near.ends(colliders)); };
    pairs.near.erase_if(met);
    pairs.resting.erase_if(met);
    pairs.complete = false;
}

// Conditions: pairs of one node, pairs of one collider, pairs of two nodes.
inline auto ends_on(uint32_t node) {
    return [node](const PairEnds& of) { return of.a == node || of.b == node || of.a2 == node || of.b2 == node; };
}
inline auto ends_on_collider(uint32_t collider) {
    return [collider](const PairEnds& of) { return of.collider_a() == collider || of.collider_b() == collider; };
}
inline auto between_nodes(uint32_t a, uint32_t b) {
    return [a, b](const PairEnds& of) {
        auto on = [](uint32_t node, uint32_t one, uint32_t two) { return node == one || node == two; };
        return (on(a, of.a, of.a2) && on(b, of.b, of.b2)) || (on(b, of.a, of.a2) && on(a, of.b, of.b2));
    };
}

}  // namespace taut
