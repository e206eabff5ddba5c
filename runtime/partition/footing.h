// How broad a body stands for its height.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "state/nodes.h"

namespace taut {

// Of a column of such bodies, breadth^2 over height [m]: of cubes, their side. By their moments of inertia, which for
// a slab of sides b, b and t are m b^2/6 and m (b^2 + t^2)/12: exact for cubes, too small by half for thin plates.
// What does not turn, a particle, has none.
inline double footing(const NodeMass& body) {
    const Sym3& i = body.inertia;
    const auto [least, most] = std::minmax({i.xx, i.yy, i.zz});
    return most > 0 ? least * std::sqrt(6 / (body.mass * most)) : std::numeric_limits<double>::infinity();
}

}  // namespace taut
