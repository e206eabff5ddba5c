#include "collision/outline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/hull.h"
#include "collision/surface.h"

namespace taut::collision {
namespace {

constexpr int kSides = 24;         // of a circle; of a half circle from pole to pole half as many
constexpr float kPlaneHalf = 10;   // [m]
constexpr float kPlaneNormal = 1;  // [m]
constexpr float kTurn = 6.28318530717959f;

// ---------------------------------------------------------------- what turns about y

struct Ring {
    float radius, height;  // [m]
    bool bends;            // the outline has a circle here
};

struct Profile {
    std::array<Ring, kSides + 4> ring;  // upwards
    int count = 0;

    void add(float radius, float height, bool bends = false) { ring[size_t(count++)] = {radius, height, bends}; }
    // Part of a circle about (0, middle), between two latitudes [rad], which bends at one of its points.
    void add_arc(float radius, float middle, float from, float to, float bend) {
        const int steps = int(std::ceil(kSides * (to - from) / kTurn));
        for (int i = 0; i <= steps; ++i) {
            const float latitude = std::lerp(from, to, float(i) / float(steps));
            const bool pole = std::abs(latitude) == kTurn / 4;
            const SineCosine turn = sine_cosine(double(latitude));
            add(pole ? 0 : radius * float(turn.cosine), middle + radius * float(turn.sine), latitude == bend);
        }
    }
};

// Two balls and what is between them: the flank touches both at the latitude a, sin a = (r_low - r_high) / length. A
// ball within the other has no part in it.
Profile capsule_profile(float low, float high, float half) {
    const double sine = std::clamp((double(low) - double(high)) / (2 * double(half)), -1.0, 1.0);
    const float latitude = float(angle_of(sine, std::sqrt((1 - sine) * (1 + sine))));
    Profile out;
    if (latitude > -kTurn / 4) out.add_arc(low, -half, -kTurn / 4, latitude, latitude);
    if (latitude < kTurn / 4) out.add_arc(high, half, latitude, kTurn / 4, latitude);
    return out;
}

Profile profile_of(const Shape& shape) {
    const Vec3f& s = shape.size;
    Profile out;
    switch (shape.kind) {
        case ShapeKind::sphere:
            out.add_arc(s.x(), 0, -kTurn / 4, kTurn / 4, 0);
            break;
        case ShapeKind::capsule:
            return capsule_profile(s.x(), s.x(), s.y());
        case ShapeKind::tapered_capsule:
            return capsule_profile(s.x(), s.z(), s.y());
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            out.add(0, -s.y());
            out.add(s.x(), -s.y(), true);
            if (shape.kind == ShapeKind::cylinder) out.add(s.x(), s.y(), true);
            out.add(0, s.y());
            break;
        default:
            break;
    }
    return out;
}

Vec3f at(const Ring& ring, int side) {
    const SineCosine turn = sine_cosine(double(kTurn) * (side % kSides) / kSides);
    return {ring.radius * float(turn.cosine), ring.height, ring.radius * float(turn.sine)};
}

void outline_of(const Profile& profile, LineSink& lines) {
    for (int i = 0; i < profile.count; ++i) {
        const Ring& ring = profile.ring[size_t(i)];
        for (int side = 0; ring.bends && side < kSides; ++side) lines.take(at(ring, side), at(ring, side + 1));
        for (int side = 0; i > 0 && side < kSides; side += kSides / 4)
            lines.take(at(profile.ring[size_t(i - 1)], side), at(ring, side));
    }
}

void take_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, PointSink& points) {
    for (const Vec3f& corner : {a, b, c}) points.take(corner);
}

void triangles_of(const Profile& profile, PointSink& points) {
    for (int i = 1; i < profile.count; ++i) {
        const Ring &low = profile.ring[size_t(i - 1)], &high = profile.ring[size_t(i)];
        for (int side = 0; side < kSides; ++side) {
            if (low.radius > 0) take_triangle(at(low, side), at(high, side), at(low, side + 1), points);
            if (high.radius > 0) take_triangle(at(high, side), at(high, side + 1), at(low, side + 1), points);
        }
    }
}

// ---------------------------------------------------------------- what is flat

void outline_of(const Polytope& polytope, LineSink& lines) {
    for (const Edge& edge : polytope.edges) lines.take(polytope.vertices[edge.from], polytope.vertices[edge.to]);
}

void triangles_of(const Polytope& polytope, PointSink& points) {
    for (const Face& face : polytope.faces) {
        const std::span<const uint8_t> loop = polytope.loop_of(face);
        for (size_t i = 2; i < loop.size(); ++i)
            take_triangle(polytope.vertices[loop[0]], polytope.vertices[loop[i - 1]], polytope.vertices[loop[i]],
                          points);
    }
}

std::array<Vec3f, 4> square(const Vec3f& normal) {
    const Vec3f u = kPlaneHalf * normal.unitOrthogonal(), v = normal.cross(u);
    return {Vec3f(-u - v), Vec3f(u - v), Vec3f(u + v), Vec3f(v - u)};
}

// ---------------------------------------------------------------- surfaces

// Triangles of a surface near a box.
class Near {
public:
    Near(const Shape& shape, const Box& near) : surface_(*shape.surface), scale_(shape.size) {
        const Vec3f a = near.lo.cwiseQuotient(scale_), b = near.hi.cwiseQuotient(scale_);
        box_ = {a.cwiseMin(b), a.cwiseMax(b)};
    }

    template <class Act>
    void each(Act&& act) const {
        struct Sink final : TriangleSink {
            explicit Sink(Act& given) : visit(given) {}
            void take(uint32_t triangle) override { visit(triangle); }
            Act& visit;
        } sink(act);
        surface_.find(box_, sink);
    }
    Vec3f corner(uint32_t triangle, int i) const {
        return surface_.vertex(surface_.corners(triangle)[size_t(i)]).cwiseProduct(scale_);
    }
    // Mirrored by the scale: the other way round.
    bool is_mirrored() const { return scale_.prod() < 0; }
    // An edge is drawn once: by the triangle of the smaller number, or by the one that is near.
    bool draws(uint32_t triangle, int edge) const {
        const uint32_t other = surface_.neighbour(triangle, edge);
        if (other == kNoTriangle) return true;
        if (surface_.facet_of[triangle] == surface_.facet_of[other]) return false;
        return triangle < other || !is_near(other);
    }

private:
    bool is_near(uint32_t triangle) const {
        const Corners corners = surface_.corners(triangle);
        const Vec3f a = surface_.vertex(corners[0]), b = surface_.vertex(corners[1]), c = surface_.vertex(corners[2]);
        return (a.cwiseMin(b).cwiseMin(c).array() <= box_.hi.array()).all() &&
               (a.cwiseMax(b).cwiseMax(c).array() >= box_.lo.array()).all();
    }

    const Surface& surface_;
    Vec3f scale_;
    Box box_;
};

}  // namespace

void outline(const Shape& shape, const Box& near, LineSink& lines) {
    switch (shape.kind) {
        case ShapeKind::plane: {
            const std::array<Vec3f, 4> corners = square(shape.size);
            for (size_t i = 0; i < 4; ++i) lines.take(corners[i], corners[(i + 1) % 4]);
            lines.take(Vec3f::Zero(), kPlaneNormal * shape.size);
            break;
        }
        case ShapeKind::box:
            outline_of(BoxPolytope(shape.size).view(), lines);
            break;
        case ShapeKind::hull:
            outline_of(*shape.hull, lines);
            break;
        case ShapeKind::surface: {
            const Near those(shape, near);
            those.each([&](uint32_t triangle) {
                for (int edge = 0; edge < 3; ++edge)
                    if (those.draws(triangle, edge))
                        lines.take(those.corner(triangle, edge), those.corner(triangle, next_corner(edge)));
            });
            break;
        }
        default:
            outline_of(profile_of(shape), lines);
    }
}

void triangles_of(const Shape& shape, const Box& near, PointSink& points) {
    switch (shape.kind) {
        case ShapeKind::plane: {
            const std::array<Vec3f, 4> corners = square(shape.size);
            take_triangle(corners[0], corners[1], corners[2], points);
            take_triangle(corners[0], corners[2], corners[3], points);
            break;
        }
        case ShapeKind::box:
            triangles_of(BoxPolytope(shape.size).view(), points);
            break;
        case ShapeKind::hull:
            triangles_of(*shape.hull, points);
            break;
        case ShapeKind::surface: {
            const Near those(shape, near);
            const int second = those.is_mirrored() ? 2 : 1;
            those.each([&](uint32_t triangle) {
                take_triangle(those.corner(triangle, 0), those.corner(triangle, second),
                              those.corner(triangle, 3 - second), points);
            });
            break;
        }
        default:
            triangles_of(profile_of(shape), points);
    }
}

}  // namespace taut::collision
