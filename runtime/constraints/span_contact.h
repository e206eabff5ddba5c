#pragma once

#include "base/math.h"

namespace taut {

// A contact point of which a side moves with more than one node. Of pairs, nodes 0 and 2 are of side a, 1 and 3 of side
// b; of surfaces in any order.
struct SpanContactData {
    Vec3 anchor[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // as in ContactData [m]
    Vec3 skin = Vec3::Zero();       // as in ContactData, of the first node [m]
    double weight[4] = {};          // share of the node in the point of its side, negative on side a; 0: unused
    Vec3 offset = Vec3::Zero();     // makes C the separation and no slip at detection [m]
    Mat3 basis = Mat3::Identity();  // rows: normal from a to b, tangent 1, tangent 2; world axes
};

}  // namespace taut
