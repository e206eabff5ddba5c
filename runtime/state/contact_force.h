// What a contact point carries from substep to substep.
#pragma once

#include "base/describe.h"

namespace taut {

struct ContactForce {  // of one contact point [N], in the frame (normal, tangent1, tangent2) of its manifold
    float normal = 0, tangent1 = 0, tangent2 = 0;
    // Of points in blocks and of those with static friction: compliance of sliding friction [1/kg]; 0: sticks; -1: new.
    float slip = -1;
};
template <class Visitor, Like<ContactForce> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [normal, tangent1, tangent2, slip] = of;
    TAUT_FIELDS(visitor, normal, tangent1, tangent2, slip);
}

}  // namespace taut
