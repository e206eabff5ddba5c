// A shape on its way: the distance d(t) to a convex shape is convex in the fraction t of the way, so that Newton's
// step t -= d / d' never passes the first contact, d' being the way's component along the normal (conservative
// advancement; van den Bergen 2004).
#include <array>

#include "collision/queries/couple.h"
#include "collision/queries/surface.h"

namespace taut::collision {
namespace {

// As near as so much of the smaller inner radius is contact.
constexpr double kContact = 1e-5;
// Newton's steps: a few as a rule, one halving of the distance each where the way grazes the surface.
constexpr int kMaxSteps = 64;

// Overlap at the start, told from the still shape a.
Hit inside(const Couple& couple, const Distance& cores) {
    Push push = {cores.normal, 0, cores.on_a};
    if (!cores.apart) push = couple.push();
    return {0, couple.surface_of_a(push.on_a, push.normal), couple.to_world(push.normal).normalized(), true, 0};
}

}  // namespace

bool cast_at_convex(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                    const Placement& at, double limit, Hit& out) {
    const Couple couple(still, at, moving, from);
    const double contact = kContact * couple.size();
    const Vec3 way = couple.to_a(along);
    Vec3 normal = couple.hint();
    Vec3 on_core = Vec3::Zero();
    double t = 0;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Distance cores = couple.distance(t * along, normal);
        const double distance = cores.separation - couple.radii();
        if (step == 0 && (!cores.apart || distance <= 0)) {
            out = inside(couple, cores);
            return true;
        }
        if (!cores.apart) break;  // rounding: the last step ended in contact
        normal = cores.normal;
        on_core = cores.on_a;
        const double approach = -normal.dot(way);
        if (!(approach > 0)) return false;
        if (distance <= contact) break;
        t += (distance - 0.5 * contact) / approach;  // to stay apart, as GJK's normal needs
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
