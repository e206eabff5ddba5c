// What is left of a shape without its radius: the axis of a sphere or capsule, the polytope of a box or hull.
#pragma once

#include <optional>

#include "collision/collide.h"
#include "collision/hull.h"
#include "collision/narrowphase/segment.h"
#include "collision/polytope.h"

namespace taut::collision {

// Axis and radius of a sphere or capsule in its own frame.
inline Segment round_axis(const Shape& shape) {
    const float half = shape.kind == ShapeKind::capsule ? shape.size.y() : 0.0f;
    return {Vec3f(0, -half, 0), Vec3f(0, 2 * half, 0)};
}
inline float round_radius(const Shape& shape) { return shape.size.x(); }

// Spells a box out; a hull is viewed where it lies.
class PolytopeOf {
public:
    explicit PolytopeOf(const Shape& shape) {
        if (!shape.hull) box_.emplace(shape.size);
        view_ = shape.hull ? &shape.hull->view() : &box_->view();
    }
    const Polytope& view() const { return *view_; }

private:
    std::optional<BoxPolytope> box_;
    const Polytope* view_;
};

}  // namespace taut::collision
