// The nearest of many points to a place, by a tree of halves.
#pragma once

#include <span>

#include "base/math.h"
#include "base/memory.h"

namespace taut {

struct Neighbour {
    double squared;  // distance [m^2]
    uint32_t point;
};

// Points stay where they are as long as it is asked.
class Neighbours {
public:
    Neighbours(std::span<const Vec3> points, Memory& memory);

    // As many as there are, up to `count` and no further than `reach` [m]: nearest first, of like ones the first.
    uint32_t nearest(const Vec3& to, uint32_t count, double reach, Neighbour* out) const;

private:
    struct Search;
    void split(uint32_t begin, uint32_t end);
    void visit(Search& search, uint32_t begin, uint32_t end) const;

    std::span<const Vec3> points_;
    Array<uint32_t> order_;  // the middle of a range parts what is below it along its axis from what is above
    Array<uint8_t> axis_;    // of each place in order_
};

}  // namespace taut
