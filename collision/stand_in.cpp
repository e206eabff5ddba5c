// Polytopes that stand in for round shapes with flat faces where they meet surfaces of triangles.
#include <cmath>
#include <vector>

#include "collision/collide.h"

namespace taut::collision {
namespace {

constexpr int kSides = 24;      // of a disc
constexpr int kBallSides = 10;  // of a ring on a ball
constexpr double kPi = 3.14159265358979323846;
constexpr float kThinnest = 1e-6f;  // [m]; the shapes' own limits are wider

// Corners of a regular polygon at height y whose mean distance from the axis is the radius.
void add_ring(std::vector<Vec3f>& points, double radius, double y, int sides) {
    const double step = 2 * kPi / sides;
    const auto spoke = [&](double angle) -> Vec3 {
        return rotation_from_vector(Vec3(0, angle, 0)) * Vec3(radius, 0, 0);
    };
    const double inside = spoke(step / 2).x() / radius;  // of the sides' middles, as a share of the corners' distance
    for (int i = 0; i < sides; ++i)
        points.push_back((spoke(i * step) * (2 / (1 + inside)) + Vec3(0, y, 0)).cast<float>());
}

// Half a ball about (0, y, 0) on the side of sign: its pole and rings at 0 and 45 degrees.
void add_half_ball(std::vector<Vec3f>& points, double radius, double y, double sign) {
    const double slant = std::sqrt(0.5) * radius;
    points.push_back(Vec3(0, y + sign * radius, 0).cast<float>());
    add_ring(points, radius, y, kBallSides);
    add_ring(points, slant, y + sign * slant, kBallSides);
}

}  // namespace

std::shared_ptr<const Hull> stand_in(const Shape& shape) {
    const Vec3 size = shape.size.cast<double>();
    std::vector<Vec3f> points;
    if (shape.kind == ShapeKind::cylinder) {
        add_ring(points, size.x(), -size.y(), kSides);
        add_ring(points, size.x(), size.y(), kSides);
    } else if (shape.kind == ShapeKind::cone) {
        add_ring(points, size.x(), -size.y(), kSides);
        points.push_back(Vec3f(0, shape.size.y(), 0));
    } else if (shape.kind == ShapeKind::tapered_capsule) {
        add_half_ball(points, size.x(), -size.y(), -1);
        add_half_ball(points, size.z(), size.y(), 1);
    } else {
        return nullptr;
    }
    const char* reason = "";
    return build_hull(points, 64, kThinnest, &reason);
}

}  // namespace taut::collision
