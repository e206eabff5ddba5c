// A shape on its way: a plane that parts it from a convex shape by s holds it off for s / (-n . v) of the way v, so
// that steps of that size never pass the first contact (conservative advancement; Mirtich 1996). As near contact GJK's
// normal is poor, it is taken with the shape lifted off along the last one, as least_push.cpp does: s cannot fall.
#include <algorithm>
#include <array>

#include "collision/queries/couple.h"
#include "collision/queries/surface.h"

namespace taut::collision {
namespace {

// As near as so much of the smaller inner radius is contact.
constexpr double kContact = 1e-5;
// How far it is lifted, in the same parts.
constexpr double kLift = 0.25;
// Of heights over faces, in parts of how far from the shape the ends of the way are.
constexpr float kHeightRounding = 1e-6f;
// A few as a rule; where the way grazes the surface each halves the distance.
constexpr int kMaxCastSteps = 64;

// Overlap at the start, told from the still shape a.
Hit inside(const Couple& couple, const Distance& cores) {
    Push push = {cores.normal, 0, cores.on_a};
    if (!cores.apart) push = couple.push();
    return {0, couple.surface_of_a(push.on_a, push.normal), couple.to_world(push.normal).normalized(), true, 0};
}

// Whether a face of a hull has a ball above it all along the way, which costs less to know than where they meet.
bool stays_above_face(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                      const Placement& at, double limit) {
    if (moving.kind != ShapeKind::sphere || !still.hull || still.hull->faces.empty()) return false;  // of a triangle
    const auto to_still = [&](const Vec3& p) {
        return Vec3f(at.rotation.transpose() * (p - at.position).cast<float>());
    };
    const Vec3f start = to_still(from.position), end = to_still(from.position + limit * along);
    const float rounding = kHeightRounding * (start.norm() + end.norm());
    const float height = moving.size.x() + float(kContact) * still.hull->inner_radius + rounding;
    return lane_kernels().way_outside(still.hull->view().planes, start.data(), end.data()) > height;
}

}  // namespace

bool cast_at_convex(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                    const Placement& at, double limit, Hit& out) {
    if (stays_above_face(moving, from, along, still, at, limit)) return false;
    const Couple couple(still, at, moving, from);
    const Distance start = couple.distance(Vec3::Zero(), couple.hint());
    double separation = start.separation - couple.radii();
    if (!start.apart || separation <= 0) {
        out = inside(couple, start);
        return true;
    }
    const double contact = kContact * couple.size();
    const Vec3 way = couple.to_a(along);
    Vec3 normal = start.normal, on_core = start.on_a;
    double t = 0;
    for (int step = 0; step < kMaxCastSteps; ++step) {
        const double lift = std::max(kLift * couple.size() - separation, 0.0);
        const Distance cores = couple.distance(t * along + couple.to_world(lift * normal), normal);
        if (!cores.apart) break;  // rounding
        normal = cores.normal;
        on_core = cores.on_a;
        separation = couple.proven(t * along, normal) - couple.radii();
        const double approach = -normal.dot(way);
        if (!(approach > 0)) return false;
        if (separation <= contact) break;
        t += (separation - 0.5 * contact) / approach;
        separation = 0.5 * contact;
        if (!(t <= limit)) return false;
    }
    out = {t, couple.surface_of_a(on_core, normal), couple.to_world(normal).normalized(), false, 0};
    return true;
}

namespace {

bool cast_at_plane(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                   const Placement& at, double limit, Hit& out) {
    const Clearance clear = clearance(still, at, moving, from);
    if (clear.height <= 0) {
        out = {0, clear.lowest - clear.height * clear.normal, clear.normal, true, 0};
        return true;
    }
    const double approach = -clear.normal.dot(along);
    if (!(clear.height <= limit * approach)) return false;
    const double t = clear.height / approach;
    out = {t, clear.lowest + t * along, clear.normal, false, 0};
    return true;
}

using CastFunction = bool (*)(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                              const Placement& at, double limit, Hit& out);

// By the kind of the still shape.
constexpr std::array<CastFunction, kShapeKinds> kCasts = {cast_at_plane,  cast_at_convex, cast_at_convex,
                                                          cast_at_convex, cast_at_convex, cast_at_convex,
                                                          cast_at_convex, cast_at_convex, cast_at_surface};

}  // namespace

bool cast_shape(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still, const Placement& at,
                double limit, Hit& out) {
    return kCasts[size_t(still.kind)](moving, from, along, still, at, limit, out);
}

}  // namespace taut::collision
