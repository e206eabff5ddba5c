// What a flat face of one shape and the feature of another that meets it have in common.
#pragma once

#include "collision/manifold.h"
#include "collision/narrowphase/convex.h"
#include "collision/narrowphase/kernel.h"

namespace taut::collision {

// The points that a face, in its shape's frame, and the feature of the other that meets it have in common, with ids
// below 1 << 14. slack [m]: what lies outside of the face by less is on it. Returns what is to be added to the ids' base.
uint32_t common_points(const FlatFace& face, const Solid& other, const Pose& other_in_face, float slack, Polygon& out);
// Of such a point's id: that it is a corner of the face, or that a side of the face cuts the rim of the other's disc.
constexpr uint32_t kFaceCorners = kMaxVertices;
inline bool is_corner_of_face(uint32_t id) { return id < kFaceCorners; }
inline bool is_crossing(uint32_t id) { return id >= kFaceCorners && id < 3 * kFaceCorners; }
inline int side_of_crossing(uint32_t id) { return int(id - kFaceCorners) / 2; }

// The contact of a face, in its shape's frame, with the normal out of it. base: the id of the face (face_base).
void face_contact(const FlatFace& face, const Solid& other, const Pose& other_in_face, uint32_t base, float slack,
                  const Wanted& wanted, Manifold& out);

}  // namespace taut::collision
