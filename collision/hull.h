// The stored convex hull behind Shape::hull.
#pragma once

#include <memory>

#include "base/memory.h"
#include "collision/polytope.h"

namespace taut::collision {

// Vertices are sorted by x, then y, then z; faces by their loops, each loop from its smallest vertex on; edges by
// (from, to), from < to. The centre is the mean of the vertices.
struct Hull : Polytope {
    const Polytope& view() const { return *this; }
};

// So many numbers of each thing, which number(thing, column) tells, into as many columns of lanes.
template <class Number>
Columns fill_columns(size_t things, uint32_t numbers, std::span<FloatLanes> lanes, Number&& number) {
    const uint32_t length = column_length(things), blocks = length / kLanes;
    for (uint32_t c = 0; c < numbers; ++c) {
        for (uint32_t i = 0; i < length; ++i) {
            const size_t thing = std::min(size_t(i), things - 1);
            lanes[c * blocks + i / kLanes].of[i % kLanes] = number(thing, int(c));
        }
    }
    return {lanes[0].of, length};
}

// Corner loops of a closed convex surface, counter-clockwise from outside; indices into some list of points.
using Loop = Array<int>;
using Loops = Array<Loop>;

// Merges faces within tolerance [m] of one plane and drops points that no longer lie on an edge's end. Null
// where the merged surface would not be closed. Points must be sorted; at most kMaxVertices of them are used.
std::shared_ptr<const Hull> hull_of_surface(std::span<const Vec3f> points, const Loops& surface, double tolerance,
                                            Memory& memory);

}  // namespace taut::collision
