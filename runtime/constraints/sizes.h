// How large a constraint may be; for code that is built for several processors, which shares no other header with the
// rest: an inline function of a library, Eigen's say, must not come from the build for one of them.
#pragma once

namespace taut {

constexpr int kMaxRows = 6;
constexpr int kMaxNodes = 4;
constexpr int kDof = 6;  // columns of J a node; a particle leaves the last three zero

}  // namespace taut
