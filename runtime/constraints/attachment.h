// Elements that hold a point of some nodes on a point of others, or at a distance from it. The way between the two is a
// sum over the nodes of both, of which those of the first count as negative:
//   d = sum_n (w_n x_n + R_n m_n) + c [m]
// A point at q_n on each of some nodes, weighed by u_n, gives w_n = +-u_n and m_n = +-u_n q_n; a point of the world is
// in c. A node of both is one node of the sum.
#pragma once

#include "constraints/element.h"

namespace taut {

// What their data begin with, one for each node; then c, and the length of a distance.
struct AttachedNode {
    double weight;     // w
    double moment[3];  // m [m], body axes
};
inline constexpr int kAttachedNumbers = sizeof(AttachedNode) / sizeof(double);

// Of so many nodes, 1 to kMaxNodes. C = d, of 3 rows: lambda acts on the second point.
const ElementType& point_attachment(int nodes);
// C = |d| - length, of 1 row: lambda > 0 pushes the two apart.
const ElementType& distance_attachment(int nodes);

}  // namespace taut
