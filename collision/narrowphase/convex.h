// Convex shapes as the general kernel sees them: their reach along a direction, their flat faces, and the feature that
// looks along a direction. One row of functions a kind, in convex.cpp. All in the shape's frame.
#pragma once

#include <span>

#include "collision/collide.h"
#include "collision/narrowphase/core.h"
#include "collision/narrowphase/segment.h"

namespace taut::collision {

// A shape is its core grown by a ball of this radius [m]: all of a sphere's and capsule's, the smaller of a tapered
// capsule's, else 0.
double core_radius(const Shape& shape);
// The point furthest along the unit vector d, of the whole shape.
Vec3 furthest_point(const Shape& shape, const Vec3& d);
// Where a point of the surface lies on the shape that is about m [m] smaller on every side, m < inner_radius.
Vec3 inset(const Shape& shape, const Vec3& p, double m);
// Of a ball inside the shape; how coarse a tolerance the shape bears [m].
float inner_radius(const Shape& shape);
// The line of centres of a round shape; of others, their centre.
Segment centre_line(const Shape& shape);

// A flat face: a polygon with sides, a disc about the origin of u and v, or a whole plane.
struct FlatFace {
    Vec3f normal, u, v;  // right-handed, unit
    float offset = 0;    // normal . p of the face's points [m]
    float radius = 0;    // of a disc [m]
    std::span<const Side> sides;
    std::span<const uint8_t> loop;  // a polygon's corners, counter-clockwise, indices into vertices
    std::span<const Vec3f> vertices;

    bool is_disc() const { return radius > 0; }
};

// What of a shape meets a direction: a flat face, or a line on its surface whose ends have ids (0: at -y, 1: at +y);
// a sphere's line has no length.
struct Feature {
    int face = -1;  // number of the flat face; -1: the line
    Segment line;
};

// A shape with its faces at hand.
class Solid {
public:
    explicit Solid(const Shape& shape);

    const Shape& shape() const { return shape_; }
    int faces() const;
    FlatFace face(int number) const;
    // The face that looks most along d; -1 for none.
    int face_along(const Vec3f& d) const;
    Feature feature_along(const Vec3f& d) const;
    // The line or edge that looks along d; of no length where a point or a face does.
    Segment line_along(const Vec3f& d) const;
    const Polytope* polytope() const { return polytope_ ? &polytope_->view() : nullptr; }

private:
    const Shape& shape_;
    std::optional<PolytopeOf> polytope_;
};

}  // namespace taut::collision
