#include "collision/narrowphase/convex.h"

#include <array>
#include <cmath>

#include "collision/revolution.h"

namespace taut::collision {
namespace {

// A line on a surface is a contact's length if it is within 10 degrees (sine) of flat to the direction.
constexpr float kFlat = 0.17f;

// Unit vector across y nearest to d; any where d is along y.
Vec3 radial(const Vec3& d) {
    const double length = std::sqrt(d.x() * d.x() + d.z() * d.z());
    return length > 1e-12 ? Vec3(d.x() / length, 0, d.z() / length) : Vec3(1, 0, 0);
}
Vec3f radial(const Vec3f& d) { return radial(Vec3(d.cast<double>())).cast<float>(); }

// ---------------------------------------------------------------- reach

Vec3 box_furthest(const Shape& shape, const Vec3& d) {
    return Vec3(std::copysign(shape.size.x(), d.x()), std::copysign(shape.size.y(), d.y()),
                std::copysign(shape.size.z(), d.z()));
}

Vec3 sphere_furthest(const Shape& shape, const Vec3& d) { return d * double(shape.size.x()); }

Vec3 capsule_furthest(const Shape& shape, const Vec3& d) {
    return d * double(shape.size.x()) + Vec3(0, std::copysign(shape.size.y(), d.y()), 0);
}

Vec3 hull_furthest(const Shape& shape, const Vec3& d) {
    const Vec3f direction = d.cast<float>();
    return shape.hull->vertices[size_t(support(shape.hull->view(), direction))].cast<double>();
}

Vec3 cylinder_furthest(const Shape& shape, const Vec3& d) {
    return radial(d) * double(shape.size.x()) + Vec3(0, std::copysign(shape.size.y(), d.y()), 0);
}

Vec3 cone_furthest(const Shape& shape, const Vec3& d) {
    const Vec3 apex(0, shape.size.y(), 0);
    const Vec3 rim = radial(d) * double(shape.size.x()) - apex;
    return d.dot(apex) > d.dot(rim) ? apex : rim;
}

Vec3 tapered_capsule_furthest(const Shape& shape, const Vec3& d) {
    const double low = shape.size.x();
    const double half = shape.size.y();
    const double high = shape.size.z();
    return half * d.y() + high > low - half * d.y() ? Vec3(d * high + Vec3(0, half, 0))
                                                    : Vec3(d * low - Vec3(0, half, 0));
}

// ---------------------------------------------------------------- insets

Vec3 no_inset(const Shape&, const Vec3& p, double) { return p; }

Vec3 box_inset(const Shape&, const Vec3& p, double m) {
    return p - Vec3(std::copysign(m, p.x()), std::copysign(m, p.y()), std::copysign(m, p.z()));
}

Vec3 cylinder_inset(const Shape& shape, const Vec3& p, double m) {
    const double across = 1 - m / double(shape.size.x());
    return Vec3(p.x() * across, p.y() - std::copysign(m, p.y()), p.z() * across);
}

// Smaller about the centre of the ball inside.
Vec3 towards(const Vec3& centre, double inner, const Vec3& p, double m) { return p + (centre - p) * (m / inner); }

Vec3 cone_inset(const Shape& shape, const Vec3& p, double m) {
    const double inner = double(inner_radius(shape));
    return towards(Vec3(0, inner - double(shape.size.y()), 0), inner, p, m);
}

Vec3 hull_inset(const Shape& shape, const Vec3& p, double m) {
    return towards(shape.hull->centre.cast<double>(), double(shape.hull->inner_radius), p, m);
}

// ---------------------------------------------------------------- sizes

double no_radius(const Shape&) { return 0; }
double whole_radius(const Shape& shape) { return shape.size.x(); }
double lesser_radius(const Shape& shape) { return std::min(shape.size.x(), shape.size.z()); }

float box_inner(const Shape& shape) { return shape.size.minCoeff(); }
float round_inner(const Shape& shape) { return shape.size.x(); }
float hull_inner(const Shape& shape) { return shape.hull->inner_radius; }
float cylinder_inner(const Shape& shape) { return std::min(shape.size.x(), shape.size.y()); }
float tapered_capsule_inner(const Shape& shape) { return std::min(shape.size.x(), shape.size.z()); }
// Of the circle in the triangle of the cone's section: area over half of the circumference.
float cone_inner(const Shape& shape) {
    const float r = shape.size.x();
    const float height = 2 * shape.size.y();
    return r * height / (r + std::sqrt(r * r + height * height));
}

Segment point_line(const Shape& shape) {
    return {shape.hull ? shape.hull->centre : Vec3f(Vec3f::Zero()), Vec3f::Zero()};
}
Segment long_line(const Shape& shape) {
    const float half = shape.size.y();
    return {Vec3f(0, -half, 0), Vec3f(0, 2 * half, 0)};
}

// ---------------------------------------------------------------- faces

FlatFace polytope_face(const Solid& solid, int number) {
    const Polytope& polytope = *solid.polytope();
    const Face& face = polytope.faces[size_t(number)];
    return {face.normal,      face.u, face.v, face.offset, 0, polytope.sides_of(face), polytope.loop_of(face),
            polytope.vertices};
}

// 0 below, 1 above; a cone has the lower one only.
FlatFace cap(const Solid& solid, int number) {
    const bool top = number == 1;
    FlatFace face;
    face.normal = top ? Vec3f(Vec3f::UnitY()) : Vec3f(-Vec3f::UnitY());
    face.u = top ? Vec3f::UnitZ() : Vec3f::UnitX();
    face.v = top ? Vec3f::UnitX() : Vec3f::UnitZ();
    face.offset = solid.shape().size.y();
    face.radius = solid.shape().size.x();
    return face;
}

FlatFace no_face(const Solid&, int) { return {}; }

// ---------------------------------------------------------------- features

Feature polytope_feature(const Solid& solid, const Vec3f& d) { return {face_against(*solid.polytope(), -d), {}}; }

Feature sphere_feature(const Solid& solid, const Vec3f& d) { return {-1, {d * solid.shape().size.x(), Vec3f::Zero()}}; }

// The lowest points of two balls on the axis.
Feature line_of_balls(float half, float low, float high, const Vec3f& d) {
    const Vec3f from = d * low - Vec3f(0, half, 0);
    const Vec3f to = d * high + Vec3f(0, half, 0);
    return {-1, {from, to - from}};
}
Feature capsule_feature(const Solid& solid, const Vec3f& d) {
    const Vec3f& size = solid.shape().size;
    return line_of_balls(size.y(), size.x(), size.x(), d);
}
Feature tapered_capsule_feature(const Solid& solid, const Vec3f& d) {
    const Vec3f& size = solid.shape().size;
    return line_of_balls(size.y(), size.x(), size.z(), d);
}

Feature cylinder_feature(const Solid& solid, const Vec3f& d) {
    const Vec3f& size = solid.shape().size;
    if (d.y() * d.y() > 0.5f * d.squaredNorm()) return {d.y() > 0 ? 1 : 0, {}};
    return {-1, {radial(d) * size.x() - Vec3f(0, size.y(), 0), Vec3f(0, 2 * size.y(), 0)}};
}

// The base, or the line from the rim to the apex, whichever's normal is nearer to d; the side's normal is (2 h, r) in
// (radius, y).
Feature cone_feature(const Solid& solid, const Vec3f& d) {
    const float r = solid.shape().size.x();
    const float height = 2 * solid.shape().size.y();
    const Vec3f out = radial(d);
    const float along_side = (height * d.dot(out) + r * d.y()) / std::sqrt(r * r + height * height);
    if (-d.y() > along_side) return {0, {}};
    const Vec3f apex(0, 0.5f * height, 0);
    const Vec3f rim = out * r - apex;
    return {-1, {rim, apex - rim}};
}

Segment feature_line(const Solid& solid, const Vec3f& d) {
    const Feature feature = solid.feature_along(d);
    return feature.face < 0 ? feature.line : Segment{Vec3f::Zero(), Vec3f::Zero()};
}

// Of the edges at the vertex furthest along d, the flattest to d.
Segment polytope_line(const Solid& solid, const Vec3f& d) {
    const Polytope& polytope = *solid.polytope();
    const int vertex = support(polytope, d);
    Segment line = {polytope.vertices[size_t(vertex)], Vec3f::Zero()};
    float least = kFlat;
    for (const Edge& edge : polytope.edges) {
        if (edge.from != vertex && edge.to != vertex) continue;
        const Vec3f along = polytope.direction(edge);
        const float slope = std::fabs(along.dot(d)) / along.norm();
        if (slope >= least) continue;
        least = slope;
        line = {polytope.vertices[edge.from], along};
    }
    return line;
}

struct ConvexKind {
    Vec3 (*furthest)(const Shape&, const Vec3& d);
    Vec3 (*inset)(const Shape&, const Vec3& p, double m);
    double (*core_radius)(const Shape&);
    float (*inner_radius)(const Shape&);
    Segment (*centre_line)(const Shape&);
    int faces;  // -1: as many as the polytope has
    FlatFace (*face)(const Solid&, int number);
    Feature (*feature)(const Solid&, const Vec3f& d);
    Segment (*line)(const Solid&, const Vec3f& d);
};

// A plane is not among them: it has no reach.
constexpr std::array<ConvexKind, kShapeKinds> kKinds = {{
    {},
    {box_furthest, box_inset, no_radius, box_inner, point_line, -1, polytope_face, polytope_feature, polytope_line},
    {sphere_furthest, no_inset, whole_radius, round_inner, point_line, 0, no_face, sphere_feature, feature_line},
    {capsule_furthest, no_inset, whole_radius, round_inner, long_line, 0, no_face, capsule_feature, feature_line},
    {hull_furthest, hull_inset, no_radius, hull_inner, point_line, -1, polytope_face, polytope_feature, polytope_line},
    {cylinder_furthest, cylinder_inset, no_radius, cylinder_inner, long_line, 2, cap, cylinder_feature, feature_line},
    {cone_furthest, cone_inset, no_radius, cone_inner, long_line, 1, cap, cone_feature, feature_line},
    {tapered_capsule_furthest, no_inset, lesser_radius, tapered_capsule_inner, long_line, 0, no_face,
     tapered_capsule_feature, feature_line},
}};

const ConvexKind& kind_of(const Shape& shape) { return kKinds[size_t(shape.kind)]; }

}  // namespace

Vec3 furthest_point(const Shape& shape, const Vec3& d) { return kind_of(shape).furthest(shape, d); }
Vec3 inset(const Shape& shape, const Vec3& p, double m) { return kind_of(shape).inset(shape, p, m); }
double core_radius(const Shape& shape) { return kind_of(shape).core_radius(shape); }
float inner_radius(const Shape& shape) { return kind_of(shape).inner_radius(shape); }
Segment centre_line(const Shape& shape) { return kind_of(shape).centre_line(shape); }

Solid::Solid(const Shape& shape) : shape_(shape) {
    if (kind_of(shape).faces < 0) polytope_.emplace(shape);
}

int Solid::faces() const { return polytope_ ? int(polytope()->faces.size()) : kind_of(shape_).faces; }
FlatFace Solid::face(int number) const { return kind_of(shape_).face(*this, number); }
Feature Solid::feature_along(const Vec3f& d) const { return kind_of(shape_).feature(*this, d); }

int Solid::face_along(const Vec3f& d) const {
    int best = -1;
    float most = -2;
    for (int i = 0; i < faces(); ++i) {
        const float dot = polytope_ ? polytope()->faces[size_t(i)].normal.dot(d) : face(i).normal.dot(d);
        if (dot > most) {
            most = dot;
            best = i;
        }
    }
    return best;
}

Segment Solid::line_along(const Vec3f& d) const {
    const Segment line = kind_of(shape_).line(*this, d);
    const float length = line.step.norm();
    return std::fabs(line.step.dot(d)) < kFlat * length ? line : Segment{line.from, Vec3f::Zero()};
}

}  // namespace taut::collision
