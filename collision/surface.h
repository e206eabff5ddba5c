// A surface of triangles behind Shape::surface: a mesh or a height field. A triangle looks to the side from which its
// corners run counter-clockwise. What the contacts need of the neighbourhood is found once, when the surface is built.
#pragma once

#include <array>
#include <span>

#include "collision/collide.h"

namespace taut::collision {

constexpr uint32_t kNoTriangle = UINT32_MAX;
using Corners = std::array<uint32_t, 3>;
using RingRoom = std::array<uint32_t, 8>;

class TriangleSink {
public:
    virtual void take(uint32_t triangle) = 0;

protected:
    ~TriangleSink() = default;
};

struct Surface {
    explicit Surface(Memory& memory) : facet_of(memory), seed_of(memory), sharp(memory) {}
    virtual ~Surface() = default;
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    virtual uint32_t slots() const = 0;                    // of triangle numbers, holes included
    virtual bool has(uint32_t triangle) const = 0;         // false: a hole
    virtual Corners corners(uint32_t triangle) const = 0;  // vertex numbers
    virtual Vec3f vertex(uint32_t vertex) const = 0;       // [m]
    // The triangle across the edge from corner `edge` to the next; kNoTriangle at a border.
    virtual uint32_t neighbour(uint32_t triangle, int edge) const = 0;
    // The vertices joined to this one by an edge; room is for surfaces that do not store them.
    virtual std::span<const uint32_t> ring(uint32_t vertex, RingRoom& room) const = 0;
    // Hands over the triangles whose boxes meet this one, in no particular order.
    virtual void find(const Box& box, TriangleSink& triangles) const = 0;

    SurfaceCounts counts;
    Box box;                 // of all triangles
    bool two_sided = false;  // else bodies behind a triangle do not meet it
    // Triangles of one plane that hang together are one facet, whose plane is that of its largest triangle, its seed;
    // see facets.h.
    Array<uint32_t> facet_of;  // by triangle
    Array<uint32_t> seed_of;   // by facet
    // Bit e: across edge e the surface falls away, or ends. Other edges touch nothing that a face does not.
    Array<uint8_t> sharp;  // by triangle
};

// Corner numbers of the edge: from, to, opposite.
constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }

// The corner of a triangle that is neither of two vertices.
inline uint32_t third_corner(const Corners& corners, uint32_t one, uint32_t other) {
    for (const uint32_t corner : corners) {
        if (corner != one && corner != other) return corner;
    }
    return corners[0];
}

}  // namespace taut::collision
