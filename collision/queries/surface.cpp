#include "collision/queries/surface.h"

#include <array>
#include <cmath>

#include "collision/hull.h"
#include "collision/queries/couple.h"
#include "collision/surface.h"

namespace taut::collision {
namespace {

// A box in the frame of a surface as scaled [m].
struct Room {
    Vec3 lo, hi;

    Room grown(double by) const { return {lo.array() - by, hi.array() + by}; }
};

// A surface as its own frame sees it, scaled.
class Triangles {
public:
    Triangles(const Shape& shape, const Placement& at)
        : surface_(*shape.surface), scale_(shape.size.cast<double>()), rotation_(at.rotation.cast<double>()), at_(at) {}

    Vec3 to_own(const Vec3& vector) const { return rotation_.transpose() * vector; }
    Vec3 to_world(const Vec3& vector) const { return rotation_ * vector; }
    Vec3 place(const Vec3& point) const { return to_own(point - at_.position); }
    Mat3 turn(const Mat3f& rotation) const { return rotation_.transpose() * rotation.cast<double>(); }
    bool two_sided() const { return surface_.two_sided; }

    Room room() const {
        const Vec3 p = surface_.box.lo.cast<double>().cwiseProduct(scale_);
        const Vec3 q = surface_.box.hi.cast<double>().cwiseProduct(scale_);
        return {p.cwiseMin(q), p.cwiseMax(q)};
    }

    // The corners, counter-clockwise from the front.
    std::array<Vec3, 3> corners(uint32_t number) const {
        const Corners c = surface_.corners(number);
        std::array<Vec3, 3> out;
        for (size_t i = 0; i < 3; ++i) out[i] = surface_.vertex(c[i]).cast<double>().cwiseProduct(scale_);
        if (scale_.prod() < 0) std::swap(out[1], out[2]);
        return out;
    }

    // act(number) for each triangle whose box meets the room.
    template <class Act>
    void find(const Room& where, Act&& act) const {
        struct Call final : TriangleSink {
            explicit Call(Act& a) : act(a) {}
            void take(uint32_t number) override { act(number); }
            Act& act;
        };
        const Vec3 p = where.lo.cwiseQuotient(scale_), q = where.hi.cwiseQuotient(scale_);
        constexpr float kCoordinateRounding = 1e-6f;  // of coordinates, so that the box holds what the room does
        Box box = {p.cwiseMin(q).cast<float>(), p.cwiseMax(q).cast<float>()};
        box.lo -= kCoordinateRounding * box.lo.cwiseAbs();
        box.hi += kCoordinateRounding * box.hi.cwiseAbs();
        Call call(act);
        surface_.find(box, call);
    }

private:
    const Surface& surface_;
    Vec3 scale_;
    Mat3 rotation_;
    const Placement& at_;
};

// ---------------------------------------------------------------- ways

// A way through a surface is searched in so many pieces, of which the first with a hit is the last.
constexpr int kPieces = 16;

// act(number, limit) may lower the limit. from, along: in the surface's frame; reach: of what moves, about from.
template <class Act>
void along_way(const Triangles& triangles, const Vec3& from, const Vec3& along, const Room& reach, double limit,
               Act&& act) {
    const Room all = triangles.room();
    double enter = 0, exit = limit;
    for (int i = 0; i < 3; ++i) {
        const double lo = all.lo[i] - reach.hi[i] - from[i], hi = all.hi[i] - reach.lo[i] - from[i];
        if (std::fabs(along[i]) < 1e-12) {
            if (lo > 1e-6 || hi < -1e-6) return;
            continue;
        }
        const double one = lo / along[i], other = hi / along[i];
        enter = std::max(enter, std::min(one, other) - 1e-6);
        exit = std::min(exit, std::max(one, other) + 1e-6);
    }
    const double step = (exit - enter) / kPieces;
    for (int piece = 0; piece < kPieces && step >= 0; ++piece) {
        const double begin = enter + piece * step;
        if (begin > limit) return;
        const Vec3 p = from + begin * along, q = from + (begin + step) * along;
        triangles.find({p.cwiseMin(q) + reach.lo, p.cwiseMax(q) + reach.hi},
                       [&](uint32_t number) { act(number, limit); });
    }
}

// Whether a hit comes before the best: sooner, or as soon on a triangle of smaller number.
bool improves(bool any, double fraction, uint32_t number, const Hit& best) {
    return !any || fraction < best.fraction || (fraction == best.fraction && number < best.feature);
}

// Where a line from o along d crosses a triangle's plane, in parts of d; a nan or infinity where it does not inside
// the triangle. Edges count by the signs of d . (p x q) for their ends p and q seen from o, which two triangles at an
// edge compute alike: no line slips between them.
double crossing(const std::array<Vec3, 3>& corner, const Vec3& o, const Vec3& d, const Vec3& normal) {
    const Vec3 a = corner[0] - o, b = corner[1] - o, c = corner[2] - o;
    const double u = d.dot(c.cross(b)), v = d.dot(a.cross(c)), w = d.dot(b.cross(a));
    const bool outside = (u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0);
    return outside ? std::nan("") : normal.dot(a) / normal.dot(d);
}

// ---------------------------------------------------------------- triangles as shapes

// A triangle as a hull without faces about its middle, whose inner radius is that of the shape it is held against.
class TriangleShape {
public:
    TriangleShape(const Triangles& triangles, const Placement& at, uint32_t number, float inner) {
        const Vec3 middle = lay_out(triangles.corners(number), inner);
        at_ = {at.position + triangles.to_world(middle), at.rotation};
    }
    // Corners from an origin, along world axes.
    TriangleShape(const std::array<Vec3, 3>& corner, const Vec3& origin, float inner) {
        const Vec3 middle = lay_out(corner, inner);
        at_ = {origin + middle, Mat3f::Identity()};
    }
    TriangleShape(const TriangleShape&) = delete;
    TriangleShape& operator=(const TriangleShape&) = delete;
    const Shape& shape() const { return shape_; }
    const Placement& at() const { return at_; }
    // Of the triangle with the surface that moves so.
    Motion along(const Motion& of_surface) const {
        Motion motion = of_surface;
        motion.at = at_;
        motion.reach = spin_radius(shape_, (at_.position - motion.centre).norm());
        return motion;
    }
    // Its normal that points away from a place: unit, world axes; any where the triangle has no area.
    Vec3 facing(const Vec3& place) const {
        const Vec3 across = (corner_[1] - corner_[0]).cross(corner_[2] - corner_[0]).cast<double>();
        const double length = across.norm();
        const Vec3 normal = length > 0 ? Vec3(at_.rotation.cast<double>() * (across / length)) : Vec3(Vec3::UnitY());
        return normal.dot(place - at_.position) > 0 ? Vec3(-normal) : normal;
    }

private:
    Vec3 lay_out(const std::array<Vec3, 3>& corner, float inner) {
        const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
        for (size_t i = 0; i < 3; ++i) corner_[i] = (corner[i] - middle).cast<float>();
        hull_.vertices = corner_;
        hull_.corners = fill_columns(3, 3, lanes_, [&](size_t vertex, int i) { return corner_[vertex][i]; });
        hull_.inner_radius = inner;
        shape_.kind = ShapeKind::hull;
        shape_.hull = std::shared_ptr<const Hull>(std::shared_ptr<const Hull>(), &hull_);  // not owned
        return middle;
    }

    std::array<Vec3f, 3> corner_;
    FloatLanes lanes_[3];
    Hull hull_;
    Shape shape_;
    Placement at_;
};

// Whether the cores of two convex shapes are no further apart than their radii and so much more.
bool are_near(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, double by) {
    const Couple couple(a, at_a, b, at_b);
    const Distance cores = couple.distance(Vec3::Zero(), couple.hint());
    return !cores.apart || cores.separation <= couple.radii() + by;
}

Room room_of(const Triangles& triangles, const Shape& a, const Placement& at_a, const Placement& at_b) {
    const Box box = bounds(a, {Vec3::Zero(), at_b.rotation.transpose() * at_a.rotation});
    const Vec3 place = triangles.place(at_a.position);
    return {place + box.lo.cast<double>(), place + box.hi.cast<double>()};
}

// What a covers of the frame of b until a time: between where it is then and now each point stays within A t^2 / 8 of
// the chord of its way, A the most that it is accelerated by as seen from b, which turns:
//   A = |w_a|^2 r_a + 2 |w_b| |z'| + |w_b|^2 |z|,  z from the centre of b
Room way_through(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double time) {
    const Placement at_b = motion_b.after(time);
    const Room now = room_of(Triangles(b, motion_b.at), a, motion_a.at, motion_b.at),
               then = room_of(Triangles(b, at_b), a, motion_a.after(time), at_b);
    const double spin_a = motion_a.spin.norm(), spin_b = motion_b.spin.norm();
    const double reach = motion_a.reach + core_radius(a);
    const double speed = (motion_a.velocity - motion_b.velocity).norm() + spin_a * reach;
    const double furthest = (motion_a.centre - motion_b.centre).norm() + time * speed + reach;
    const double most = spin_a * spin_a * reach + 2 * spin_b * speed + spin_b * spin_b * furthest;
    return Room{now.lo.cwiseMin(then.lo), now.hi.cwiseMax(then.hi)}.grown(most * time * time / 8);
}

// Planes of a surface's triangles that keep a shape apart from them all along its way, by impact.cpp's bound:
//   s(t) >= min(s(0), s(T)) - |w_a|^2 r_a T^2 / 8
// for surfaces that do not turn.
class PlaneTest {
public:
    PlaneTest(const Shape& a, const Motion& motion_a, const Triangles& triangles, const Motion& motion_b, double time)
        : shape_(a),
          motion_(motion_a),
          triangles_(triangles),
          turns_(motion_b.spin != Vec3::Zero()),
          velocity_(triangles.to_own(motion_b.velocity)),
          now_(triangles, motion_a.at) {
        set_time(time);
    }
    // Until when.
    void set_time(double time) {
        then_ = Pose(triangles_, motion_.after(time));
        way_ = time * velocity_;
        bend_ = motion_.spin.squaredNorm() * motion_.reach * time * time / 8;
    }

    // By more than least [m].
    bool keep_apart(uint32_t number, double least) const {
        if (turns_) return false;
        const std::array<Vec3, 3> corner = triangles_.corners(number);
        Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double length = normal.norm();
        if (!(length > 0)) return false;
        normal /= normal.dot(now_.place - corner[0]) > 0 ? length : -length;
        return above(now_, normal, corner[0]) - bend_ > least && above(then_, normal, corner[0] + way_) - bend_ > least;
    }

private:
    struct Pose {  // as the surface lies now
        Vec3 place = Vec3::Zero();
        Mat3 rotation = Mat3::Identity();

        Pose() = default;
        Pose(const Triangles& triangles, const Placement& at)
            : place(triangles.place(at.position)), rotation(triangles.turn(at.rotation)) {}
    };
    double above(const Pose& pose, const Vec3& normal, const Vec3& corner) const {
        const Vec3 down = pose.rotation.transpose() * -normal;
        return normal.dot(pose.place - corner) - down.dot(furthest_point(shape_, down));
    }

    const Shape& shape_;
    const Motion& motion_;
    const Triangles& triangles_;
    bool turns_;
    Vec3 velocity_;  // of the surface [m/s]
    Pose now_, then_;
    Vec3 way_ = Vec3::Zero();  // of the surface [m]
    double bend_ = 0;          // [m]
};

}  // namespace

bool cast_ray_at_surface(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit,
                         Hit& out) {
    const Triangles triangles(shape, at);
    const Vec3 o = triangles.place(from), d = triangles.to_own(along);
    bool any = false;
    along_way(triangles, o, d, {Vec3::Zero(), Vec3::Zero()}, limit, [&](uint32_t number, double& end) {
        const std::array<Vec3, 3> corner = triangles.corners(number);
        const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double towards = normal.dot(d);
        if (towards == 0 || (towards > 0 && !triangles.two_sided())) return;
        const double t = crossing(corner, o, d, normal);
        if (!(t >= 0 && t <= end) || !improves(any, t, number, out)) return;
        any = true;
        end = t;
        const Vec3 outward = triangles.to_world(towards < 0 ? normal : Vec3(-normal)).normalized();
        out = {t, from + t * along, outward, false, number};
    });
    return any;
}

bool cast_at_surface(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                     const Placement& at, double limit, Hit& out) {
    const Triangles triangles(still, at);
    const Vec3 o = triangles.place(from.position), d = triangles.to_own(along);
    const Room own = room_of(triangles, moving, from, at);
    bool any = false;
    along_way(triangles, o, d, {own.lo - o, own.hi - o}, limit, [&](uint32_t number, double& end) {
        const std::array<Vec3, 3> corner = triangles.corners(number);
        const double towards = (corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(d);
        if (towards >= 0 && !triangles.two_sided()) return;
        const TriangleShape triangle(triangles, at, number, inner_radius(moving));
        Hit hit;
        if (!cast_at_convex(moving, from, along, triangle.shape(), triangle.at(), end, hit)) return;
        if (!improves(any, hit.fraction, number, out)) return;
        any = true;
        end = hit.fraction;
        out = hit;
        out.feature = number;
    });
    return any;
}

double surface_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                       double limit, uint32_t& number) {
    const Triangles triangles(b, motion_b.at);
    PlaneTest planes(a, motion_a, triangles, motion_b, limit);
    double first = limit;
    triangles.find(way_through(a, motion_a, b, motion_b, limit).grown(reach), [&](uint32_t next) {
        if (first == 0 || planes.keep_apart(next, reach)) return;
        const TriangleShape triangle(triangles, motion_b.at, next, inner_radius(a));
        const double met = convex_meeting(a, motion_a, triangle.shape(), triangle.along(motion_b), reach, first);
        if (met >= first) return;
        number = next;
        first = met;
        planes.set_time(first);
    });
    return first;
}

bool surface_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b,
                         uint32_t number, double met, double depth, double until) {
    const Motion from_a = motion_a.from(met), from_b = motion_b.from(met);
    const Triangles triangles(b, from_b.at);
    const PlaneTest planes(a, from_a, triangles, from_b, until - met);
    const auto passes = [&](uint32_t next) {
        if (planes.keep_apart(next, -depth)) return false;
        const TriangleShape triangle(triangles, from_b.at, next, inner_radius(a));
        return triangle_passes_deep(a, from_a, triangle.shape(), triangle.along(from_b),
                                    triangle.facing(from_a.at.position), depth, until - met);
    };
    bool deep = passes(number);
    if (deep) return true;
    triangles.find(way_through(a, from_a, b, from_b, until - met),
                   [&](uint32_t next) { deep = deep || (next != number && passes(next)); });
    return deep;
}

bool surface_overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Triangles triangles(b, at_b);
    bool found = false;
    triangles.find(room_of(triangles, a, at_a, at_b), [&](uint32_t number) {
        if (found) return;
        const TriangleShape triangle(triangles, at_b, number, inner_radius(a));
        found = convex_overlap(a, at_a, triangle.shape(), triangle.at());
    });
    return found;
}

bool near_triangle(const Shape& a, const Placement& at_a, const Vec3 (&corner)[3], double radius) {
    const std::array<Vec3, 3> corners = {corner[0], corner[1], corner[2]};
    if (a.kind == ShapeKind::plane) {
        const Vec3 normal = (at_a.rotation.cast<double>() * a.size.cast<double>()).normalized();
        return std::min({normal.dot(corners[0]), normal.dot(corners[1]), normal.dot(corners[2])}) <= radius;
    }
    if (is_convex(a)) {
        const TriangleShape triangle(corners, at_a.position, inner_radius(a));
        return are_near(a, at_a, triangle.shape(), triangle.at(), radius);
    }
    const double size = (corners[1] - corners[0]).norm() + (corners[2] - corners[0]).norm();
    const auto inner = static_cast<float>(std::max(radius, 1e-3 * size));  // a scale alone: nothing is inset
    const TriangleShape triangle(corners, at_a.position, inner);
    const Triangles triangles(a, at_a);
    bool found = false;
    triangles.find(room_of(triangles, triangle.shape(), triangle.at(), at_a).grown(radius), [&](uint32_t number) {
        if (found) return;
        const TriangleShape own(triangles, at_a, number, inner);
        found = are_near(triangle.shape(), triangle.at(), own.shape(), own.at(), radius);
    });
    return found;
}

// In rooms that double until the nearest triangle lies within, or all do.
Gap surface_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Triangles triangles(b, at_b);
    const Room own = room_of(triangles, a, at_a, at_b), all = triangles.room();
    const double furthest =
        ((all.hi - own.lo).cwiseAbs()).cwiseMax((own.hi - all.lo).cwiseAbs()).maxCoeff();  // on one axis
    Gap least;
    uint32_t nearest = kNoTriangle;
    for (double reach = (own.hi - own.lo).maxCoeff();; reach *= 2) {
        triangles.find(own.grown(reach), [&](uint32_t number) {
            const TriangleShape triangle(triangles, at_b, number, inner_radius(a));
            const Gap gap = convex_gap(a, at_a, triangle.shape(), triangle.at());
            const bool tie = gap.distance == least.distance && number > nearest;
            if (nearest != kNoTriangle && (gap.distance > least.distance || tie)) return;
            least = gap;
            nearest = number;
        });
        if (reach > furthest || (nearest != kNoTriangle && least.distance <= reach)) return least;
    }
}

}  // namespace taut::collision
