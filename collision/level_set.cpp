// Level sets of shapes: from the nearest point of what a shape is grown from (a segment, a box, a profile turned about
// y, a hull) outside, from the shallowest face inside.
#include "collision/level_set.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "collision/distance_grid.h"
#include "collision/hull.h"
#include "collision/revolution.h"

namespace taut::collision {
namespace {

using Vec2 = Eigen::Vector2d;

// Of a point as far as `apart` from the nearest point of a feature with the unit direction along, or of a vertex:
// the distance grows equally all around, but not along an edge.
LevelSet from_nearest(const Vec3& apart, const Vec3& along) {
    LevelSet out;
    out.distance = apart.norm();
    out.gradient = apart / out.distance;
    out.curvature =
        (Mat3::Identity() - out.gradient * out.gradient.transpose() - along * along.transpose()) / out.distance;
    return out;
}

// About the segment from -half to +half along y.
LevelSet level_of_segment(double radius, double half, const Vec3& at) {
    const double y = std::clamp(at.y(), -half, half);
    const Vec3 apart = at - Vec3(0, y, 0);
    LevelSet out;
    if (apart.squaredNorm() > 0)
        out = from_nearest(apart, std::abs(at.y()) < half ? Vec3(Vec3::UnitY()) : Vec3(Vec3::Zero()));
    else
        out.gradient = Vec3::UnitX();
    out.distance -= radius;
    return out;
}

LevelSet level_of_box(const Vec3& half, const Vec3& at) {
    const Vec3 over = at.cwiseAbs() - half;
    Vec3 apart = Vec3::Zero(), sign;
    for (int k = 0; k < 3; ++k) {
        sign[k] = at[k] < 0 ? -1 : 1;
        if (over[k] > 0) apart[k] = sign[k] * over[k];
    }
    const int outside = static_cast<int>((over.array() > 0).count());
    if (outside > 1) {
        Vec3 along = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (outside == 2 && !(over[k] > 0)) along[k] = 1;
        return from_nearest(apart, along);
    }
    int axis;
    const double distance = over.maxCoeff(&axis);
    LevelSet out;
    out.distance = distance;
    out.gradient[axis] = sign[axis];
    return out;
}

// ---------------------------------------------------------------- about y

// The same in the half plane of the distance from the axis r and y.
struct PlaneLevel {
    double distance = 0;
    Vec2 gradient = Vec2::UnitX();
    Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
};

PlaneLevel from_nearest(const Vec2& apart) {
    PlaneLevel out;
    out.distance = apart.norm();
    if (!(out.distance > 0)) return out;
    out.gradient = apart / out.distance;
    out.curvature = (Eigen::Matrix2d::Identity() - out.gradient * out.gradient.transpose()) / out.distance;
    return out;
}

// A convex profile from the axis outward and up back to it.
PlaneLevel level_of_profile(std::span<const Vec2> corner, const Vec2& at) {
    PlaneLevel inside, nearest;
    inside.distance = -std::numeric_limits<double>::infinity();
    nearest.distance = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i + 1 < corner.size(); ++i) {
        const Vec2 edge = corner[i + 1] - corner[i], from = at - corner[i];
        const Vec2 normal = Vec2(edge.y(), -edge.x()).normalized();
        const double height = normal.dot(from), part = from.dot(edge) / edge.squaredNorm();
        if (height > inside.distance) inside = {height, normal, Eigen::Matrix2d::Zero()};
        if (!(height > 0)) continue;
        const PlaneLevel own = part < 0   ? from_nearest(from)
                               : part > 1 ? from_nearest(Vec2(at - corner[i + 1]))
                                          : PlaneLevel{height, normal, Eigen::Matrix2d::Zero()};
        if (own.distance < nearest.distance) nearest = own;
    }
    return inside.distance > 0 ? nearest : inside;
}

PlaneLevel level_of_tapered(const Shape& shape, const Vec2& at) {
    const TaperedSide side = tapered_side(shape);
    const double half = double(shape.size.y());
    const Vec2 normal(side.cosine, side.sine), along(-side.sine, side.cosine);
    const Vec2 bottom(0, -half), top(0, half);
    const double up = along.dot(at - bottom);
    PlaneLevel out;
    if (up < 0) {
        out = from_nearest(Vec2(at - bottom));
        out.distance -= double(shape.size.x());
    } else if (along.dot(at - top) > 0) {
        out = from_nearest(Vec2(at - top));
        out.distance -= double(shape.size.z());
    } else {
        out.distance = normal.dot(at - bottom) - double(shape.size.x());
        out.gradient = normal;
    }
    return out;
}

// phi(r(x), y) of level(r, y): d2phi/dx2 = sum phi_ab grad a grad b + phi_r/r around the axis.
template <class Level>
LevelSet turned(const Vec3& at, Level&& level) {
    const double r = hypotenuse(at.x(), at.z());
    const PlaneLevel of = level(Vec2(r, at.y()));
    const Vec3 out = r > 0 ? Vec3(at.x() / r, 0, at.z() / r) : Vec3(Vec3::UnitX());
    const Vec3 around(-out.z(), 0, out.x());
    Eigen::Matrix<double, 3, 2> axes;
    axes << out, Vec3::UnitY();
    LevelSet found{of.distance, axes * of.gradient, axes * of.curvature * axes.transpose()};
    if (r > 0) found.curvature += of.gradient.x() / r * around * around.transpose();
    return found;
}

LevelSet level_of_profile(std::span<const Vec2> corner, const Vec3& at) {
    return turned(at, [&](const Vec2& place) { return level_of_profile(corner, place); });
}

// ---------------------------------------------------------------- hulls

// Of a point over a face: its plane, or the nearest edge or corner.
LevelSet over_face(const Polytope& hull, const Face& face, const Vec3& normal, double height, const Vec3& at) {
    const std::span<const uint8_t> loop = hull.loop_of(face);
    LevelSet out{std::numeric_limits<double>::infinity(), normal, Mat3::Zero()};
    bool within = true;
    for (size_t i = 0; i < loop.size(); ++i) {
        const Vec3 from = hull.vertices[loop[i]].cast<double>();
        const Vec3 edge = hull.vertices[loop[i + 1 == loop.size() ? 0 : i + 1]].cast<double>() - from;
        const Vec3 apart = at - from;
        if (!(edge.cross(normal).dot(apart) > 0)) continue;
        within = false;
        const double part = apart.dot(edge) / edge.squaredNorm();
        const bool inner = part > 0 && part < 1;
        const LevelSet own = from_nearest(Vec3(apart - std::clamp(part, 0.0, 1.0) * edge),
                                          inner ? Vec3(edge.normalized()) : Vec3(Vec3::Zero()));
        if (own.distance < out.distance) out = own;
    }
    if (within) out.distance = height;
    return out;
}

LevelSet level_of_hull(const Polytope& hull, const Vec3& at) {
    LevelSet inside, nearest;
    inside.distance = -std::numeric_limits<double>::infinity();
    nearest.distance = std::numeric_limits<double>::infinity();
    for (const Face& face : hull.faces) {
        const Vec3 stored = face.normal.cast<double>();
        const double length = stored.norm(), height = (stored.dot(at) - double(face.offset)) / length;
        const Vec3 normal = stored / length;
        if (height > inside.distance) inside = {height, normal, Mat3::Zero()};
        if (!(height > 0)) continue;
        const LevelSet own = over_face(hull, face, normal, height, at);
        if (own.distance < nearest.distance) nearest = own;
    }
    return inside.distance > 0 ? nearest : inside;
}

LevelSet plane_level(const Shape& shape, const Vec3& at) {
    const Vec3 normal = shape.size.cast<double>().normalized();
    return {normal.dot(at), normal, Mat3::Zero()};
}
LevelSet box_level(const Shape& shape, const Vec3& at) { return level_of_box(shape.size.cast<double>(), at); }
LevelSet sphere_level(const Shape& shape, const Vec3& at) { return level_of_segment(double(shape.size.x()), 0, at); }
LevelSet capsule_level(const Shape& shape, const Vec3& at) {
    return level_of_segment(double(shape.size.x()), double(shape.size.y()), at);
}
LevelSet hull_level(const Shape& shape, const Vec3& at) { return level_of_hull(shape.hull->view(), at); }
LevelSet cylinder_level(const Shape& shape, const Vec3& at) {
    const double radius = double(shape.size.x()), half = double(shape.size.y());
    return level_of_profile(std::array{Vec2(0, -half), Vec2(radius, -half), Vec2(radius, half), Vec2(0, half)}, at);
}
LevelSet cone_level(const Shape& shape, const Vec3& at) {
    const double radius = double(shape.size.x()), half = double(shape.size.y());
    return level_of_profile(std::array{Vec2(0, -half), Vec2(radius, -half), Vec2(0, half)}, at);
}
LevelSet tapered_level(const Shape& shape, const Vec3& at) {
    return turned(at, [&](const Vec2& place) { return level_of_tapered(shape, place); });
}

LevelSet surface_level(const Shape& shape, const Vec3& at) { return shape.distance->at(at); }

using Level = LevelSet (*)(const Shape& shape, const Vec3& at);
constexpr std::array<Level, kShapeKinds> kLevels = {plane_level,   box_level,     sphere_level,
                                                    capsule_level, hull_level,    cylinder_level,
                                                    cone_level,    tapered_level, surface_level};

}  // namespace

LevelSet level_set(const Shape& shape, const Vec3& at) { return kLevels[size_t(shape.kind)](shape, at); }

}  // namespace taut::collision
