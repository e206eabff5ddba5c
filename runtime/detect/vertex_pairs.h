// Contacts of vertices of surfaces with shapes, which are pairs: their normals within the cones of what is about the
// vertex; detect/surface_cone.h.
#pragma once

#include "detect/surface_cone.h"
#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Which side of a pair is a vertex of a surface.
class VertexPair {
public:
    VertexPair(const Nodes& nodes, const Softs& softs, const ActivePair& pair);

    const SurfaceMesh* mesh() const { return feature_.mesh; }  // null: neither
    bool is_second() const { return second_; }
    uint32_t vertex() const { return feature_.index; }
    const SurfaceFeature& feature() const { return feature_; }

private:
    SurfaceFeature feature_;
    bool second_ = false;
};

// A normal of a surface's cone in place of the direction from its feature to a shape, and how far the shape is from the
// plane across it [m]; -infinity: the direction stays.
struct Turned {
    Vec3f normal;
    float clear;
};
// x: a point of the feature [m]. The direction stays where it is in the cone; against planes and what has parts; and
// where the shape goes further through that plane than depth_within(): it is not within what is flat that it meets
// then.
Turned turn_normal(const SurfaceFeature& feature, const collision::Shape& shape, const collision::Placement& at,
                   const Vec3& x, const Vec3f& direction, float margin);

// Turns the normal of a pair of a vertex that is held. Its separation stays that of the two. A sheet that moves bends
// about what it meets, and its triangles are then elsewhere.
void turn_into_cone(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
                    Pairs& pairs, const ActivePair& active);

}  // namespace taut
