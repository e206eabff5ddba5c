// Columns and walls within an island, and how much they bear for their breadth.
//
// What stands on others by three points and more puts its weight on them, as much on each. What stands on more than one
// is bonded with these, as bricks are, and what is bonded tilts course by course. A body counts as far as it may lean
// out: if most bodies of the column that stands on it have no neighbour on one side, the same one. Those at the side of
// a block do, and those of a wall; what stands in the middle of a heap is held by others around it.
#pragma once

#include <array>
#include <span>

#include "partition/touch_graph.h"

namespace taut {

class Walls {
public:
    explicit Walls(Memory& memory);

    // What stands in some islands.
    struct Site {
        const TouchGraph& graph;
        Adjacency adjacent;
        const Nodes& nodes;
        const Pairs& pairs;
        std::span<const uint32_t> bodies;  // all of theirs
        Vec3f up;                          // unit vector against gravity
    };
    // Bodies of a course that may lean out.
    struct Row {
        uint32_t node = kNone;       // one of them
        double borne = 0, mass = 0;  // themselves counted [kg]
        double footing = 0;          // least [m]
        uint32_t column = 0;         // most on one another, from here up
        bool bonded = false;

        // That each bears on average; of what is heavy, which has rules of its own, no more than twice the column.
        double weights() const { return std::min(borne / mass, 2.0 * column); }
    };
    // Of some of the bodies.
    std::span<const Row> find_rows(const Site& site, std::span<const uint32_t> of);

private:
    static constexpr uint32_t kWays = 32;  // horizontal, 11.25 degrees apart
    // How many from a body up, along the longest column, have no neighbour that way.
    using Open = std::array<uint16_t, kWays>;

    struct Body {
        double borne = 0;        // what it puts on those below, itself counted [kg]
        uint32_t column = 1;     // of the longest that stands on it, itself counted
        uint32_t above = kNone;  // the next of these
        uint32_t course = 1;     // as high as it stands, itself counted
        uint32_t bases = 0;      // on which it stands
        uint32_t waits_for = 0;  // that stand on it and had no turn yet
        uint32_t bond = kNone;   // parent in the union-find
        uint32_t courses = 0;    // of a root: the highest that a body is in,
        uint32_t first_row = 0;  // and where its rows begin
    };

    struct Compass;

    void begin(const Site& site);
    void look(const Site& site, const Compass& compass, uint32_t node, uint32_t touch);
    void bear(const Site& site);
    void put_on(uint32_t base, uint32_t upper);
    void lay_courses(const Site& site);
    uint32_t make_room(std::span<const uint32_t> of);
    void list_rows(const Nodes& nodes, std::span<const uint32_t> of);
    static bool may_lean_out(const Body& body, const Open& open);
    uint32_t base_of(const Site& site, uint32_t node, uint32_t touch) const;
    uint32_t root_of(uint32_t node);

    Array<Body> body_;       // by slot
    Array<Open> open_;       // by slot
    Array<uint32_t> upper_;  // by touch: which end stands on the other, or kNone
    Array<uint32_t> order_;  // from the top down: each after all that stand on it
    Array<Row> rows_;
};

}  // namespace taut
