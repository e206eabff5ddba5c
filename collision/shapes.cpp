// What a shape weighs and how far it reaches, one function a kind.
#include <array>
#include <bit>
#include <cmath>

#include "collision/collide.h"
#include "collision/hull.h"
#include "collision/polyhedron_mass.h"
#include "collision/revolution.h"
#include "collision/surface.h"

namespace taut::collision {
namespace {

constexpr double kPi = 3.14159265358979323846;

// ---------------------------------------------------------------- mass

MassProperties no_mass(const Shape&, double) { return {}; }

// m/3 (b^2 + c^2) for half extents b, c.
MassProperties box_mass(const Shape& shape, double density) {
    const Vec3 h = shape.size.cast<double>();
    MassProperties out;
    out.mass = density * 8 * h.x() * h.y() * h.z();
    const Vec3 s = h.cwiseAbs2() * (out.mass / 3);
    out.inertia = {s.y() + s.z(), s.z() + s.x(), s.x() + s.y(), 0, 0, 0};
    return out;
}

MassProperties sphere_mass(const Shape& shape, double density) {
    const double r = shape.size.x();
    MassProperties out;
    out.mass = density * 4.0 / 3.0 * kPi * r * r * r;
    const double i = 0.4 * out.mass * r * r;
    out.inertia = {i, i, i, 0, 0, 0};
    return out;
}

// A cylinder of length 2 h and two half balls, whose centres lie 3 r / 8 beyond the ends; axis y.
MassProperties capsule_mass(const Shape& shape, double density) {
    const double r = shape.size.x();
    const double h = shape.size.y();
    const double cylinder = density * kPi * r * r * 2 * h;
    const double ball = density * 4.0 / 3.0 * kPi * r * r * r;
    const double along = cylinder * r * r / 2 + ball * 0.4 * r * r;
    // (2/5 - 9/64) r^2 + (h + 3/8 r)^2 = 2/5 r^2 + h^2 + 3/4 h r
    const double across = cylinder * (h * h / 3 + r * r / 4) + ball * (0.4 * r * r + h * h + 0.75 * h * r);
    MassProperties out;
    out.mass = cylinder + ball;
    out.inertia = {across, along, across, 0, 0, 0};
    return out;
}

MassProperties cylinder_mass(const Shape& shape, double density) {
    const double r = shape.size.x();
    const double h = shape.size.y();
    const Slice whole = conical_slice(-h, h, r, r);
    return mass_of_revolution({&whole, 1}, density);
}

MassProperties cone_mass(const Shape& shape, double density) {
    const double h = shape.size.y();
    const Slice whole = conical_slice(-h, h, shape.size.x(), 0);
    return mass_of_revolution({&whole, 1}, density);
}

// Two caps of balls and the frustum between the circles where its side touches them.
MassProperties tapered_capsule_mass(const Shape& shape, double density) {
    const double low = shape.size.x();
    const double h = shape.size.y();
    const double high = shape.size.z();
    const TaperedSide side = tapered_side(shape);
    const std::array<Slice, 3> slices = {ball_slice(-h - low, side.from, -h, low),
                                         conical_slice(side.from, side.to, side.from_radius, side.to_radius),
                                         ball_slice(side.to, h + high, h, high)};
    return mass_of_revolution(slices, density);
}

MassProperties hull_mass(const Shape& shape, double density) {
    const Hull& hull = *shape.hull;
    PolyhedronMass mass(hull.centre.cast<double>());
    for (const Face& face : hull.faces) {
        const auto loop = hull.loop_of(face);
        const auto at = [&](size_t i) { return Vec3(hull.vertices[loop[i]].cast<double>()); };
        for (size_t i = 2; i < loop.size(); ++i) mass.add(at(0), at(i - 1), at(i));
    }
    return mass.properties(density);
}

// ---------------------------------------------------------------- bounds

// The largest float that is not above x. The bits of neighbours in size differ by one; which way x was rounded, and so
// whether it is the neighbour, no branch could foretell.
float not_above(double x) {
    const float nearest = float(x);
    const int32_t bits = std::bit_cast<int32_t>(nearest), below = bits < 0 ? 1 : -1;  // -0, of what is less than 0, too
    return std::bit_cast<float>(bits + below * int32_t(double(nearest) > x));
}

// Single precision box of a box in double, rounded outwards.
Box rounded(const Vec3& centre, const Vec3& lo, const Vec3& hi) {
    Box box;
    for (int i = 0; i < 3; ++i) {
        box.lo[i] = not_above(centre[i] + lo[i]);
        box.hi[i] = -not_above(-(centre[i] + hi[i]));
    }
    return box;
}

Box plane_bounds(const Shape&, const Placement&) { return {Vec3f::Constant(-1e9f), Vec3f::Constant(1e9f)}; }

Box box_bounds(const Shape& shape, const Placement& at) {
    const Vec3 reach = at.rotation.cwiseAbs().cast<double>() * shape.size.cast<double>();
    return rounded(at.position, -reach, reach);
}

Box sphere_bounds(const Shape& shape, const Placement& at) {
    const Vec3 reach = Vec3::Constant(shape.size.x());
    return rounded(at.position, -reach, reach);
}

Box capsule_bounds(const Shape& shape, const Placement& at) {
    const Vec3 reach =
        at.rotation.col(1).cwiseAbs().cast<double>() * double(shape.size.y()) + Vec3::Constant(shape.size.x());
    return rounded(at.position, -reach, reach);
}

// Reach of a circle of radius 1 across the body's y axis, along each axis of the world: sqrt(1 - y_i^2).
Vec3 disc_reach(const Placement& at) {
    const Mat3 r = at.rotation.cast<double>();
    return (r.col(0).cwiseAbs2() + r.col(2).cwiseAbs2()).cwiseSqrt();
}

Box cylinder_bounds(const Shape& shape, const Placement& at) {
    const Vec3 reach =
        at.rotation.col(1).cwiseAbs().cast<double>() * double(shape.size.y()) + disc_reach(at) * double(shape.size.x());
    return rounded(at.position, -reach, reach);
}

Box cone_bounds(const Shape& shape, const Placement& at) {
    const Vec3 apex = at.rotation.col(1).cast<double>() * double(shape.size.y());
    const Vec3 rim = disc_reach(at) * double(shape.size.x());
    return rounded(at.position, apex.cwiseMin(-apex - rim), apex.cwiseMax(rim - apex));
}

Box tapered_capsule_bounds(const Shape& shape, const Placement& at) {
    const Vec3 end = at.rotation.col(1).cast<double>() * double(shape.size.y());
    const Vec3 low = Vec3::Constant(shape.size.x());
    const Vec3 high = Vec3::Constant(shape.size.z());
    return rounded(at.position, (end - high).cwiseMin(-end - low), (end + high).cwiseMax(low - end));
}

Box hull_bounds(const Shape& shape, const Placement& at) {
    const Mat3f by_row = at.rotation.transpose();  // of a matrix that is stored by column
    float rows[3][3];
    std::copy_n(by_row.data(), 9, rows[0]);
    Vec3f lo, hi;
    lane_kernels().extent(shape.hull->view().corners, rows, lo.data(), hi.data());
    return rounded(at.position, lo.cast<double>(), hi.cast<double>());
}

// The box of the turned and scaled local box.
Box surface_bounds(const Shape& shape, const Placement& at) {
    const Box& own = shape.surface->box;
    const Vec3 p = own.lo.cwiseProduct(shape.size).cast<double>(), q = own.hi.cwiseProduct(shape.size).cast<double>();
    const Mat3 rotation = at.rotation.cast<double>();
    const Vec3 middle = rotation * (0.5 * (p + q));
    const Vec3 reach = rotation.cwiseAbs() * (0.5 * (q - p).cwiseAbs());
    return rounded(at.position, middle - reach, middle + reach);
}

struct KindFunctions {
    MassProperties (*mass)(const Shape&, double density);
    Box (*bounds)(const Shape&, const Placement&);
};

constexpr std::array<KindFunctions, kShapeKinds> kKinds = {{
    {no_mass, plane_bounds},
    {box_mass, box_bounds},
    {sphere_mass, sphere_bounds},
    {capsule_mass, capsule_bounds},
    {hull_mass, hull_bounds},
    {cylinder_mass, cylinder_bounds},
    {cone_mass, cone_bounds},
    {tapered_capsule_mass, tapered_capsule_bounds},
    {no_mass, surface_bounds},
}};

}  // namespace

MassProperties mass_properties(const Shape& shape, double density) {
    return kKinds[size_t(shape.kind)].mass(shape, density);
}

Box bounds(const Shape& shape, const Placement& placement) {
    return kKinds[size_t(shape.kind)].bounds(shape, placement);
}

}  // namespace taut::collision
