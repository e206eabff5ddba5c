// How far shapes are apart, or how deep in each other, one row of functions a kind of the shape that is asked.
#include <array>

#include "collision/queries/couple.h"
#include "collision/queries/surface.h"

namespace taut::collision {

bool convex_overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Couple couple(a, at_a, b, at_b);
    const Distance cores = couple.distance(Vec3::Zero(), couple.hint());
    return !cores.apart || cores.separation <= couple.radii();
}

Gap convex_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Couple couple(a, at_a, b, at_b);
    const Distance cores = couple.distance(Vec3::Zero(), couple.hint());
    Push push = {cores.normal, cores.separation - couple.radii(), cores.on_a};
    if (!cores.apart) push = couple.push();
    Gap gap;
    gap.distance = push.separation;
    gap.normal = couple.to_world(push.normal).normalized();
    gap.on_a = couple.surface_of_a(push.on_a, push.normal);
    gap.on_b = gap.on_a + gap.distance * gap.normal;
    return gap;
}

namespace {

// b is the plane.
bool plane_overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    return clearance(b, at_b, a, at_a).height <= 0;
}

Gap plane_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Clearance clear = clearance(b, at_b, a, at_a);
    return {clear.height, -clear.normal, clear.lowest, clear.lowest - clear.height * clear.normal};
}

// Of the kind of b; a is convex and bounded.
struct GapFunctions {
    bool (*overlap)(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
    Gap (*gap)(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
};

constexpr GapFunctions kPlane = {plane_overlap, plane_gap};
constexpr GapFunctions kConvex = {convex_overlap, convex_gap};
constexpr GapFunctions kSurface = {surface_overlap, surface_gap};

constexpr std::array<GapFunctions, kShapeKinds> kGaps = {kPlane,  kConvex, kConvex, kConvex, kConvex,
                                                         kConvex, kConvex, kConvex, kSurface};

const GapFunctions& functions_of(const Shape& shape) { return kGaps[size_t(shape.kind)]; }

// With a reach, and in one piece.
// A ball for a point, which has no inside that a search for the least push could go by: its core is the point.
Shape ball_for_point(const Shape& other) {
    Shape ball;
    ball.kind = ShapeKind::sphere;
    ball.size = Vec3f(is_convex(other) ? inner_radius(other) : 1e-3f, 0, 0);
    return ball;
}

}  // namespace

bool overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    return functions_of(b).overlap(a, at_a, b, at_b);
}

Gap find_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    if (is_convex(a)) return functions_of(b).gap(a, at_a, b, at_b);
    const Gap turned = functions_of(a).gap(b, at_b, a, at_a);
    return {turned.distance, -turned.normal, turned.on_b, turned.on_a};
}

bool contains(const Shape& b, const Placement& at_b, const Vec3& point) {
    Hit hit;
    return cast_ray(b, at_b, point, Vec3::UnitY(), 0, hit);
}

Gap find_gap(const Vec3& point, const Shape& b, const Placement& at_b) {
    const Shape ball = ball_for_point(b);
    Gap gap = find_gap(ball, {point, Mat3f::Identity()}, b, at_b);
    gap.distance += double(ball.size.x());
    gap.on_a = point;
    return gap;
}

}  // namespace taut::collision
