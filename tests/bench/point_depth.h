// How deep points lie within rigid shapes, in closed form.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"
#include "vector.h"

namespace bench {

// A shape to ask about many points. Of meshes and height fields, which have no inside, every point is outside.
class PointDepth {
public:
    // among: the scene's shapes, which scaled hulls refer to.
    PointDepth(const scenes::Shape& shape, std::span<const scenes::Shape> among);

    // Distance of a point in the shape's frame to its surface [m]: above 0 within, else 0 or less, and then of boxes
    // and hulls no more than a bound.
    double at(Vec point) const;
    // Of a sphere about the origin that holds the shape [m]: infinite for a plane, 0 for what has no inside.
    double reach() const { return reach_; }

private:
    void add_hull(std::span<const taut_vec3> points, Vec scale);

    struct Plane {
        Vec normal;
        double offset;  // points inside have normal . x <= offset
    };
    scenes::ShapeKind kind_;
    std::vector<Plane> planes_;  // of planes, boxes and hulls
    double radius_ = 0, top_radius_ = 0, half_length_ = 0, reach_ = 0;
};

}  // namespace bench
