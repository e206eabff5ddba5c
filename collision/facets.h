// Facets and sharp edges of a surface, found when it is built. A facet grows from a seed, the largest triangle left,
// over all edges to what lies in the seed's plane. Most triangles of rough ground are a facet each, which is seen by
// looking at their edges in order; only those that something grows from are gone through by size.
#pragma once

#include <cmath>

#include "collision/sorting.h"
#include "collision/surface.h"

namespace taut::collision {

// A triangle belongs to a seed's facet if it looks within 2.5 degrees of it and has its corners within 1e-4 of the
// seed's longest edge from its plane, and within 0.5 mm.
constexpr double kSameDirection = 0.999;
constexpr double kRelativeFlat = 1e-4;
constexpr double kFlat = 5e-4;
// Edges that bend by less are flat: sine of the angle.
constexpr double kEdgeBend = 1e-3;

struct FacetPlane {
    Vec3 normal;                // unit
    double offset, area, flat;  // [m], [m^2], and how far off a corner may be [m]

    double height(const Vec3f& p) const { return normal.dot(p.cast<double>()) - offset; }
};

inline FacetPlane plane_through(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 cross = (b - a).cross(c - a);
    const double area = 0.5 * cross.norm();
    const Vec3 normal = cross / (2 * area);
    const double longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    return {normal, normal.dot(a), area, std::min(kFlat, kRelativeFlat * longest)};
}

// Of: a kind of surface that is final, so that its answers cost no call.
template <class Of>
class Facets {
public:
    Facets(Of& surface, Memory& memory)
        : surface_(surface),
          flags_(surface.sharp),
          area_(memory),
          order_(memory),
          spare_(memory),
          open_(memory),
          number_(memory) {
        flags_.assign(surface.slots(), kHole);
        area_.assign(surface.slots(), 0);
    }

    // First each triangle that is there, then the edges between two, from both sides, and those at borders. opposite:
    // the corner of the other triangle that is not on the edge.
    void add(uint32_t triangle, const FacetPlane& plane) {
        flags_[triangle] = 0;
        area_[triangle] = plane.area;
        ++surface_.counts.triangles;
    }
    void look_across(uint32_t triangle, int edge, const FacetPlane& plane, const FacetPlane& other,
                     const Vec3f& opposite) {
        const double height = plane.height(opposite), cosine = plane.normal.dot(other.normal);
        if (std::fabs(height) <= plane.flat && cosine > kSameDirection) flags_[triangle] |= kSpreads;
        if (height < 0 && (cosine < 0 || plane.normal.cross(other.normal).norm() > kEdgeBend)) end(triangle, edge);
    }
    void end(uint32_t triangle, int edge) { flags_[triangle] = uint8_t(flags_[triangle] | 1 << edge); }

    // Then fills facet_of, seed_of and sharp.
    void find() {
        surface_.facet_of.assign(flags_.size(), kNoTriangle);
        grow();
        flatten();
        number();
    }

private:
    // Beside the bits of sharp edges.
    static constexpr uint8_t kSharp = 7, kSpreads = 8, kShared = 16, kHole = 32;

    FacetPlane plane(uint32_t triangle) const {
        const Corners c = surface_.corners(triangle);
        return plane_through(at(c[0]), at(c[1]), at(c[2]));
    }
    Vec3 at(uint32_t vertex) const { return surface_.vertex(vertex).template cast<double>(); }
    bool before(uint32_t one, uint32_t other) const {
        return area_[one] != area_[other] ? area_[one] > area_[other] : one < other;
    }
    template <class Wanted>
    void sort_by_area(Wanted&& wanted) {
        order_.clear();
        for (uint32_t t = 0; t < flags_.size(); ++t)
            if (wanted(t)) order_.push_back({0, t});
        spare_.resize(order_.size());
        sort_by_value(order_, spare_, area_);
    }
    void grow();
    void grow_from(uint32_t seed);
    void flatten();
    void number();

    Of& surface_;
    Array<uint8_t>& flags_;
    Array<double> area_;  // by triangle [m^2]
    Array<Keyed> order_;
    UnsetArray<Keyed> spare_;
    Array<uint32_t> open_;
    UnsetArray<uint32_t> number_;  // of a seed's facet
};

// Fills facet_of with seeds: what spreads to no neighbour is one, unless a larger one has taken it in.
template <class Of>
void Facets<Of>::grow() {
    sort_by_area([&](uint32_t t) { return (flags_[t] & kSpreads) != 0; });
    for (const Keyed& each : order_)
        if (surface_.facet_of[each.number] == kNoTriangle) grow_from(each.number);
    for (uint32_t t = 0; t < flags_.size(); ++t)
        if (surface_.facet_of[t] == kNoTriangle && !(flags_[t] & kHole)) surface_.facet_of[t] = t;
}

template <class Of>
void Facets<Of>::grow_from(uint32_t seed) {
    const FacetPlane of_seed = plane(seed);
    surface_.facet_of[seed] = seed;
    open_.assign(1, seed);
    while (!open_.empty()) {
        const uint32_t triangle = open_.back();
        open_.pop_back();
        for (int edge = 0; edge < 3; ++edge) {
            const uint32_t other = surface_.neighbour(triangle, edge);
            if (other == kNoTriangle || surface_.facet_of[other] != kNoTriangle || before(other, seed)) continue;
            const Corners own = surface_.corners(triangle), corners = surface_.corners(other);
            const uint32_t opposite = third_corner(corners, own[size_t(edge)], own[size_t(next_corner(edge))]);
            if (std::fabs(of_seed.height(surface_.vertex(opposite))) > of_seed.flat) continue;
            if (!(plane(other).normal.dot(of_seed.normal) > kSameDirection)) continue;
            surface_.facet_of[other] = seed;
            flags_[seed] |= kShared;
            flags_[other] |= kShared;
            open_.push_back(other);
        }
    }
}

// Edges within a facet are not sharp.
template <class Of>
void Facets<Of>::flatten() {
    for (uint32_t t = 0; t < flags_.size(); ++t) {
        for (int edge = 0; (flags_[t] & kShared) && edge < 3; ++edge) {
            if (!(flags_[t] >> edge & 1)) continue;
            const uint32_t other = surface_.neighbour(t, edge);
            if (other != kNoTriangle && surface_.facet_of[other] == surface_.facet_of[t])
                flags_[t] = uint8_t(flags_[t] & ~(1 << edge));
        }
    }
}

// By their seeds' size.
template <class Of>
void Facets<Of>::number() {
    sort_by_area([&](uint32_t t) { return surface_.facet_of[t] == t; });
    surface_.seed_of.reserve(order_.size());
    number_.resize(flags_.size());
    for (const Keyed& each : order_) {
        number_[each.number] = uint32_t(surface_.seed_of.size());
        surface_.seed_of.push_back(each.number);
    }
    for (uint32_t t = 0; t < flags_.size(); ++t) {
        flags_[t] &= kSharp;
        if (surface_.facet_of[t] != kNoTriangle) surface_.facet_of[t] = number_[surface_.facet_of[t]];
    }
    surface_.counts.facets = uint32_t(surface_.seed_of.size());
}

}  // namespace taut::collision
