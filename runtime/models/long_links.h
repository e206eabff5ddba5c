// Long links of a mesh of links that do not stretch: what lies along a thread of so many links is never further apart
// than these are long. Sweeps carry a correction from link to link; along long links, level by level, in long strides.
//
// A level has threads, rows of vertices: at first those that links go straight on along. The next level keeps some of
// them, of which no two lie side by side, and of each the vertices where two cross, and its ends. On a grid that is
// every other vertex of every other thread: there are a third as many long links as links.
#pragma once

#include <span>

#include "base/math.h"
#include "base/memory.h"

namespace taut {

struct LongLink {
    uint32_t a, b;   // vertices
    uint32_t level;  // 1: over the fewest links
    uint32_t links;  // that it goes along
    double length;   // of these together [m]
};

struct ThreadLink {
    uint32_t a, b;
};

// From the longest level to the shortest, none where no two links go straight on.
void find_long_links(std::span<const Vec3> rest, std::span<const ThreadLink> links, uint32_t most_levels,
                     Array<LongLink>& out);

}  // namespace taut
