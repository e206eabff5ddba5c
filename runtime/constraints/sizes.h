// How large a constraint may be. Apart from constraint.h for what is built for one processor alone: an inline function
// of Eigen, which that takes in, must not come from such a build.
#pragma once

namespace taut {

constexpr int kMaxRows = 6;
constexpr int kMaxNodes = 8;  // of an element
constexpr int kMaxEnds = 4;   // of a joint or contact
constexpr int kDof = 6;       // columns of J a node; a particle leaves the last three zero

}  // namespace taut
