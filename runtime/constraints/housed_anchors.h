#pragma once

#include "base/math.h"

namespace taut {

// What the data of joints with a housing begin with. Anchors relative to the centre of mass, body axes; world position
// where the end is the world [m].
struct HousedAnchors {
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    Vec3 guide_a = Vec3::Zero();  // where the housing guides a
    Vec3 apart = Vec3::Zero();    // from there to where it guides b, axes of the housing

    const Vec3& of(int side) const { return side == 0 ? a : b; }
    Vec3 guide(int side) const { return side == 0 ? guide_a : Vec3(guide_a + apart); }
};

}  // namespace taut
