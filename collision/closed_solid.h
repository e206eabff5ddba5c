// What closed triangles enclose: whether a point is within, and how far it is from the surface.
#pragma once

#include <span>

#include "collision/box_tree.h"
#include "collision/polyhedron_mass.h"

namespace taut::collision {

// Triangles of vertices that are welded.
struct TriangleSoup {
    explicit TriangleSoup(Memory& memory) : vertex(memory), corner(memory) {}

    Array<Vec3> vertex;      // [m]
    Array<uint32_t> corner;  // three a triangle

    size_t triangles() const { return corner.size() / 3; }
    const Vec3& at(size_t triangle, size_t k) const { return vertex[corner[3 * triangle + k]]; }
};

struct WeldCounts {
    uint32_t without_area = 0;  // triangles left out, as two of their corners are one
    uint32_t open_edges = 0;    // of one side only, or of two that go round alike
};

// Vertices less than 5e-7 of the largest coordinate apart, by a grid of that cell, become one. close: open edges are
// joined to the middle of their rim, which closes any surface: each corner of a rim has as many edges in as out.
WeldCounts weld(std::span<const Vec3f> vertices, std::span<const uint32_t> indices, bool close, TriangleSoup& out,
                Memory& memory);

// The points whose winding number is not 0: it does not matter to which side the triangles look, nor whether they
// intersect.
class ClosedSolid {
public:
    ClosedSolid(const TriangleSoup& soup, Memory& memory);

    const ItemBox& box() const { return box_; }
    double signed_volume() const { return mass_.volume(); }  // [m^3], negative where the triangles look inward
    MassProperties mass_properties() const { return mass_.properties(mass_.volume() < 0 ? -1 : 1); }  // of density 1
    bool holds(const Vec3& point) const;
    double distance(const Vec3& point) const;  // to the surface [m], negative inside

private:
    int turns(uint32_t triangle, const Vec3& point) const;
    uint32_t bucket(int axis, double place) const;

    const TriangleSoup& soup_;
    ItemBox box_;
    PolyhedronMass mass_{Vec3::Zero()};
    BoxTree tree_;
    Array<ItemBox> boxes_;  // of the triangles
    // Triangles by the cells of the plane x = 0 that their shadows may meet.
    uint32_t side_;
    Array<uint32_t> first_, listed_;
};

}  // namespace taut::collision
