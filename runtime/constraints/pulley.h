#pragma once

#include "constraints/housed_anchors.h"

namespace taut {

// Data of pulleys: a rope from a point of a over two sheaves, where the housing guides it, to a point of b.
struct PulleyData {
    HousedAnchors anchors;
    double ratio = 1, length = 0;  // of C; [1], [m]
};

}  // namespace taut
