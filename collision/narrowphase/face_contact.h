// What a flat face of one shape and the feature of another that meets it have in common.
#pragma once

#include "collision/manifold.h"
#include "collision/narrowphase/convex.h"
#include "collision/narrowphase/kernel.h"

namespace taut::collision {

// The contact of a face, in its shape's frame, with the normal out of it. base: the id of the face (face_base).
// slack [m]: what lies outside of the face by less is on it.
void face_contact(const FlatFace& face, const Solid& other, const Pose& other_in_face, uint32_t base, float slack,
                  const Wanted& wanted, Manifold& out);

}  // namespace taut::collision
