// What a surface's contacts need to know of its neighbourhoods: facets and sharp edges; bounds and read-back.
#include "collision/surface.h"

#include <algorithm>
#include <cmath>

namespace taut::collision {
namespace {

// A triangle belongs to a seed's facet if it looks within 2.5 degrees of it and has its corners within 1e-4 of the
// seed's longest edge from its plane, and within 0.5 mm.
constexpr double kSameDirection = 0.999;
constexpr double kRelativeFlat = 1e-4;
constexpr double kFlat = 5e-4;
// Edges that bend by less are flat: sine of the angle.
constexpr double kBend = 1e-3;

struct FacetPlane {
    Vec3 normal = Vec3::Zero();  // unit
    double offset = 0, area = 0, longest = 0;
};

FacetPlane plane_of(const Surface& surface, uint32_t triangle) {
    const Corners corners = surface.corners(triangle);
    const Vec3 a = surface.vertex(corners[0]).cast<double>();
    const Vec3 b = surface.vertex(corners[1]).cast<double>();
    const Vec3 c = surface.vertex(corners[2]).cast<double>();
    const Vec3 cross = (b - a).cross(c - a);
    FacetPlane plane;
    plane.area = 0.5 * cross.norm();
    plane.normal = cross / (2 * plane.area);
    plane.offset = plane.normal.dot(a);
    plane.longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    return plane;
}

bool continues(const Surface& surface, const FacetPlane& seed, uint32_t triangle) {
    const double flat = std::min(kFlat, kRelativeFlat * seed.longest);
    for (const uint32_t corner : surface.corners(triangle)) {
        const double height = seed.normal.dot(surface.vertex(corner).cast<double>()) - seed.offset;
        if (std::fabs(height) > flat) return false;
    }
    return plane_of(surface, triangle).normal.dot(seed.normal) > kSameDirection;
}

// From each seed, the largest triangle left, over all edges to what lies in its plane.
void grow_facets(Surface& surface) {
    const uint32_t slots = surface.slots();
    std::vector<uint32_t> order;
    std::vector<double> area(slots, 0);
    for (uint32_t t = 0; t < slots; ++t) {
        if (!surface.has(t)) continue;
        order.push_back(t);
        area[t] = plane_of(surface, t).area;
    }
    std::sort(order.begin(), order.end(),
              [&](uint32_t s, uint32_t t) { return area[s] != area[t] ? area[s] > area[t] : s < t; });
    surface.facet_of.assign(slots, kNoTriangle);
    std::vector<uint32_t> open;
    for (const uint32_t seed : order) {
        if (surface.facet_of[seed] != kNoTriangle) continue;
        const uint32_t facet = uint32_t(surface.seed_of.size());
        surface.seed_of.push_back(seed);
        const FacetPlane plane = plane_of(surface, seed);
        surface.facet_of[seed] = facet;
        open.assign(1, seed);
        while (!open.empty()) {
            const uint32_t triangle = open.back();
            open.pop_back();
            for (int edge = 0; edge < 3; ++edge) {
                const uint32_t other = surface.neighbour(triangle, edge);
                if (other == kNoTriangle || surface.facet_of[other] != kNoTriangle) continue;
                if (!continues(surface, plane, other)) continue;
                surface.facet_of[other] = facet;
                open.push_back(other);
            }
        }
    }
}

bool is_sharp(const Surface& surface, uint32_t triangle, int edge) {
    const uint32_t other = surface.neighbour(triangle, edge);
    if (other == kNoTriangle) return true;
    if (surface.facet_of[other] == surface.facet_of[triangle]) return false;
    const Corners corners = surface.corners(triangle);
    const uint32_t from = corners[size_t(edge)];
    const uint32_t opposite = third_corner(surface.corners(other), from, corners[size_t(next_corner(edge))]);
    const FacetPlane plane = plane_of(surface, triangle);
    const Vec3 normal = plane_of(surface, other).normal;
    const double height = plane.normal.dot(surface.vertex(opposite).cast<double>()) - plane.offset;
    const bool bends = plane.normal.cross(normal).norm() > kBend || plane.normal.dot(normal) < 0;
    return height < 0 && bends;
}

}  // namespace

void find_facets(Surface& surface) {
    grow_facets(surface);
    surface.counts.facets = uint32_t(surface.seed_of.size());
    surface.sharp.assign(surface.slots(), 0);
    surface.box = {Vec3f::Constant(1e30f), Vec3f::Constant(-1e30f)};
    for (uint32_t t = 0; t < surface.slots(); ++t) {
        if (!surface.has(t)) continue;
        ++surface.counts.triangles;
        for (int edge = 0; edge < 3; ++edge) surface.sharp[t] |= uint8_t(is_sharp(surface, t, edge) << edge);
        for (const uint32_t corner : surface.corners(t)) {
            surface.box.lo = surface.box.lo.cwiseMin(surface.vertex(corner));
            surface.box.hi = surface.box.hi.cwiseMax(surface.vertex(corner));
        }
    }
}

SurfaceCounts surface_counts(const Shape& shape) { return shape.surface->counts; }

void surface_triangles(const Shape& shape, std::vector<Vec3f>& points) {
    const Surface& surface = *shape.surface;
    const bool mirrored = shape.size.prod() < 0;
    points.clear();
    for (uint32_t t = 0; t < surface.slots(); ++t) {
        if (!surface.has(t)) continue;
        Corners corners = surface.corners(t);
        if (mirrored) std::swap(corners[1], corners[2]);
        for (const uint32_t corner : corners) points.push_back(surface.vertex(corner).cwiseProduct(shape.size));
    }
}

}  // namespace taut::collision
