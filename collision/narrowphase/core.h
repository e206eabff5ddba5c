// What is left of a shape without its radius: the axis of a sphere or capsule, the polytope of a box or hull.
#pragma once

#include <array>
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

inline std::array<Vec3f, 8> box_corners(const Vec3f& half) {
    std::array<Vec3f, 8> corners;
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) corners[size_t(i)][k] = i >> k & 1 ? half[k] : -half[k];
    }
    return corners;
}

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
