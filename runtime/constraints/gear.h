#pragma once

#include "constraints/housed_anchors.h"

namespace taut {

// Data of gears, and of racks with their pinions. In the order of the arrays, coordinates of a and b in the housing:
// angles, counted over whole turns, or of a rack its slide.
struct GearData {
    HousedAnchors anchors;
    Quat frame[2] = {Quat::Identity(), Quat::Identity()};          // body from joint frame, whose x is the axis
    Quat housing_frame[2] = {Quat::Identity(), Quat::Identity()};  // housing from joint frame
    double ratio = 1;                                              // of b's coordinate to a's [1], of a rack [m/rad]
    double value[2] = {};                                          // as last followed [rad or m]
    double rest = 0;                                               // what C is counted from, see gear.cpp
};

}  // namespace taut
