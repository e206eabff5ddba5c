#include "movers/body_surface.h"

#include <cmath>

#include "base/math.h"

namespace taut {
namespace {

constexpr uint32_t kAround = 32, kArc = 16;  // corners around an axis, and along half a circle
constexpr double kArcPi = 3.14159265358979323846;

// Point of a profile that turns about y: radius and height [m], from the bottom up.
struct ProfilePoint {
    double r, y;
};

double sine(double x) { return x * sinc(x); }  // |x| <= pi/2

// A polygon of kAround corners has the area of its circle where it is larger by this.
double ring_factor() {
    const double half = kArcPi / kAround;
    return std::sqrt(half / (sine(half) * cosine(half)));
}

class Lathe {
public:
    explicit Lathe(Array<SurfaceTriangle>& out) : out_(out), profile_(out.get_allocator()) {}

    void add(double r, double y) { profile_.push_back({r, y}); }
    // Of a ball's surface from one angle over its equator to another [rad].
    void add_arc(double radius, double y, double from, double to) {
        for (uint32_t i = 0; i <= kArc; ++i) {
            const double angle = from + (to - from) * i / kArc;
            add(radius * std::max(0.0, cosine(angle)), y + radius * sine(angle));
        }
    }
    // The surface, with the volume [m^3] that the shape has: its rings have the area of circles, its arcs are widened
    // to make up for what their chords leave out.
    void turn(double volume) {
        double own = 0;
        for (size_t i = 1; i < profile_.size(); ++i) {
            const ProfilePoint &a = profile_[i - 1], &b = profile_[i];
            own += kArcPi / 3 * (b.y - a.y) * (a.r * a.r + a.r * b.r + b.r * b.r);
        }
        double grow = 1;  // the cube root of their ratio, by Newton's method from nearby
        for (int i = 0; i < 6; ++i) grow = (2 * grow + volume / own / (grow * grow)) / 3;
        for (ProfilePoint& p : profile_) p.r *= grow * ring_factor(), p.y *= grow;
        for (uint32_t k = 0; k < kAround; ++k)
            for (size_t i = 1; i < profile_.size(); ++i) {
                const Vec3 a = at(i - 1, k), b = at(i - 1, k + 1), c = at(i, k + 1), d = at(i, k);
                if (profile_[i - 1].r > 0) out_.push_back({{a, c, b}});
                if (profile_[i].r > 0) out_.push_back({{a, d, c}});
            }
        close(profile_.front(), false);
        close(profile_.back(), true);
    }

private:
    Vec3 at(size_t i, uint32_t k) const { return at(profile_[i], k); }
    // Quarter by quarter, as sine and cosine go no further.
    static Vec3 at(const ProfilePoint& p, uint32_t k) {
        const uint32_t quarter = k % kAround / (kAround / 4);
        const double angle = 2 * kArcPi * (k % (kAround / 4)) / kAround, c = cosine(angle), s = sine(angle);
        const double x[] = {c, -s, -c, s}, z[] = {s, c, -s, -c};
        return {p.r * x[quarter], p.y, p.r * z[quarter]};
    }
    void close(const ProfilePoint& p, bool top) {
        if (!(p.r > 0)) return;
        const Vec3 middle(0, p.y, 0);
        for (uint32_t k = 0; k < kAround; ++k)
            out_.push_back(top ? SurfaceTriangle{{middle, at(p, k + 1), at(p, k)}}
                               : SurfaceTriangle{{middle, at(p, k), at(p, k + 1)}});
    }

    Array<SurfaceTriangle>& out_;
    Array<ProfilePoint> profile_;
};

void add_box(const taut_vec3& half, Array<SurfaceTriangle>& out) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double way : {-1.0, 1.0}) {
            const Vec3 size = to_vec(half);
            Vec3 middle = Vec3::Zero(), u = Vec3::Zero(), v = Vec3::Zero();
            middle[axis] = way * size[axis];
            u[(axis + 1) % 3] = size[(axis + 1) % 3];
            v[(axis + 2) % 3] = way * size[(axis + 2) % 3];
            out.push_back({{middle - u - v, middle + u - v, middle + u + v}});
            out.push_back({{middle - u - v, middle + u + v, middle - u + v}});
        }
}

taut_result add_hull(taut_shape shape, Array<SurfaceTriangle>& out) {
    constexpr uint32_t kMost = 3 * (2 * TAUT_HULL_MAX_VERTICES - 4);
    taut_vec3 points[kMost];
    uint32_t count = 0;
    const taut_result result = taut_shape_get_triangles(shape, points, kMost, &count);
    for (uint32_t i = 0; result == TAUT_OK && i < count; i += 3)
        out.push_back({{to_vec(points[i]), to_vec(points[i + 1]), to_vec(points[i + 2])}});
    return result;
}

// Of a shape that turns about y; its def is asked for by get.
template <class Def, class Fill>
taut_result add_turned(taut_shape shape, void (*init)(Def*), taut_result (*get)(taut_shape, Def*),
                       Array<SurfaceTriangle>& out, Fill&& fill) {
    Def def;
    init(&def);
    taut_mass_properties mass;
    taut_result result = get(shape, &def);
    if (result == TAUT_OK) result = taut_shape_get_mass_properties(shape, 1, &mass);
    if (result != TAUT_OK) return result;
    Lathe lathe(out);
    fill(def, lathe);
    lathe.turn(static_cast<double>(mass.mass));
    return TAUT_OK;
}

}  // namespace

taut_result read_surface(taut_shape shape, Array<SurfaceTriangle>& out) {
    constexpr double kQuarter = kArcPi / 2;
    taut_shape_kind kind;
    if (const taut_result result = taut_shape_get_kind(shape, &kind); result != TAUT_OK) return result;
    switch (kind) {
        case TAUT_SHAPE_BOX: {
            taut_box_def def;
            taut_box_def_init(&def);
            const taut_result result = taut_shape_get_box(shape, &def);
            if (result == TAUT_OK) add_box(def.half_extents, out);
            return result;
        }
        case TAUT_SHAPE_HULL:
            return add_hull(shape, out);
        case TAUT_SHAPE_SPHERE:
            return add_turned(shape, taut_sphere_def_init, taut_shape_get_sphere, out,
                              [&](const taut_sphere_def& def, Lathe& lathe) {
                                  lathe.add_arc(double(def.radius), 0, -kQuarter, kQuarter);
                              });
        case TAUT_SHAPE_CAPSULE:
            return add_turned(shape, taut_capsule_def_init, taut_shape_get_capsule, out,
                              [&](const taut_capsule_def& def, Lathe& lathe) {
                                  const double r = double(def.radius), half = double(def.half_length);
                                  lathe.add_arc(r, -half, -kQuarter, 0);
                                  lathe.add_arc(r, half, 0, kQuarter);
                              });
        case TAUT_SHAPE_CYLINDER:
            return add_turned(shape, taut_cylinder_def_init, taut_shape_get_cylinder, out,
                              [&](const taut_cylinder_def& def, Lathe& lathe) {
                                  const double r = double(def.radius), half = double(def.half_length);
                                  lathe.add(r, -half);
                                  lathe.add(r, half);
                              });
        case TAUT_SHAPE_CONE:
            return add_turned(shape, taut_cone_def_init, taut_shape_get_cone, out,
                              [&](const taut_cone_def& def, Lathe& lathe) {
                                  const double r = double(def.radius), half = double(def.half_length);
                                  lathe.add(r, -half);
                                  lathe.add(0, half);
                              });
        case TAUT_SHAPE_TAPERED_CAPSULE:
            return add_turned(shape, taut_tapered_capsule_def_init, taut_shape_get_tapered_capsule, out,
                              [&](const taut_tapered_capsule_def& def, Lathe& lathe) {
                                  const double low = double(def.bottom_radius), high = double(def.top_radius);
                                  const double half = double(def.half_length);
                                  // Tangent cone: its normals lie at asin((low - high) / (2 half)) over the equator.
                                  const double sin = (low - high) / (2 * half);
                                  const double lean = angle_of(sin, std::sqrt(1 - sin * sin));
                                  lathe.add_arc(low, -half, -kQuarter, lean);
                                  lathe.add_arc(high, half, lean, kQuarter);
                              });
        default:
            return TAUT_OK;
    }
}

taut_result read_surface(taut_collider collider, const Vec3& body_position, const Quat& body_rotation,
                         Array<SurfaceTriangle>& out) {
    taut_collider_def def;
    taut_collider_def_init(&def);
    taut_result result = taut_collider_get_def(collider, &def);
    if (result != TAUT_OK || (def.flags & TAUT_COLLIDER_SENSOR)) return result;
    const size_t first = out.size();
    result = read_surface(def.shape, out);
    const Quat turn = body_rotation * to_quat(def.rotation);
    const Vec3 origin = body_position + body_rotation * to_vec(def.position);
    for (size_t i = first; i < out.size(); ++i)
        for (Vec3& corner : out[i].corner) corner = origin + turn * corner;
    return result;
}

}  // namespace taut
