// Edges and tree of the triangles of a soft body, which follow from these and are made anew where they change; and
// where its vertices are in the frame that contacts are being found for. detect/surface_tree.h.
#pragma once

#include "base/math.h"
#include "base/memory.h"
#include "state/nodes.h"

namespace taut {

struct SurfaceEdge {
    uint32_t vertex[2];
    uint32_t triangle[2];  // beside it; the second kNone at the rim
};

// Within which vertices go in the frame, from the mesh's origin [m]; lo > hi: nothing.
struct SurfaceBox {
    Vec3f lo, hi;

    static SurfaceBox none() { return {Vec3f::Constant(1e30f), Vec3f::Constant(-1e30f)}; }
    void add(const Vec3f& p) { lo = lo.cwiseMin(p), hi = hi.cwiseMax(p); }
    // By no more than so far apart along each axis.
    bool is_near(const SurfaceBox& other, float by) const {
        int meet = 1;
        for (int i = 0; i < 3; ++i)
            meet &= static_cast<int>(lo[i] <= other.hi[i] + by) & static_cast<int>(other.lo[i] <= hi[i] + by);
        return meet != 0;
    }
    // Along a way of all of it.
    SurfaceBox swept(const Vec3f& way) const { return {lo + way.cwiseMin(0.0f), hi + way.cwiseMax(0.0f)}; }
    void add(const SurfaceBox& box) { lo = lo.cwiseMin(box.lo), hi = hi.cwiseMax(box.hi); }
    SurfaceBox grown(float by) const { return {(lo.array() - by).matrix(), (hi.array() + by).matrix()}; }
    SurfaceBox moved(const Vec3f& by) const { return {lo + by, hi + by}; }
    bool meets(const SurfaceBox& other) const {
        int meet = 1;
        for (int i = 0; i < 3; ++i)
            meet &= static_cast<int>(lo[i] <= other.hi[i]) & static_cast<int>(other.lo[i] <= hi[i]);
        return meet != 0;
    }
};

// A triangle as it is, and how it moves.
struct SurfaceFace {
    SurfaceBox box;  // about it now
    Vec3f normal;    // unit, or 0
    Vec3f later;     // likewise, as the time is over
    Vec3f v;         // mean of its corners' velocities [m/s]
    float spread;    // by which one of them differs from that [m/s]
};

// In preorder: children of an inner one follow it, the second after all that is below the first.
struct SurfaceNode {
    SurfaceBox box;
    uint32_t begin, end;  // in SurfaceMesh::order
    uint32_t next;        // after all that is below it
    bool leaf;
    bool whole = false;                       // its triangles hang together by edges
    SurfaceBox normals = SurfaceBox::none();  // of its triangles, as they are and as the time is over
};

struct SurfaceMesh {
    explicit SurfaceMesh(Memory& memory)
        : edge(memory),
          edge_of(memory),
          owns(memory),
          ring_begin(memory),
          ring(memory),
          order(memory),
          node(memory),
          x(memory),
          v(memory),
          box(memory),
          face(memory) {}

    uint64_t version = 0;              // of the soft body that all of this was made from; 0: of none
    Array<SurfaceEdge> edge;           //
    Array<uint32_t> edge_of;           // [3] of each triangle: from corner k to the next
    Array<uint8_t> owns;               // of each triangle: bit k its edge k, bit 3 + k its corner k; each has one owner
    Array<uint32_t> ring_begin, ring;  // of each vertex: its edges
    Array<uint32_t> order;             // triangles, leaf by leaf
    Array<SurfaceNode> node;           // the tree; its root first
    // Of a frame.
    Vec3 origin = Vec3::Zero();   // [m]
    Array<Vec3f> x, v;            // of each vertex, from there [m], [m/s]
    Vec3f drift = Vec3f::Zero();  // mean of these velocities
    Array<SurfaceBox> box;        // about the way of each triangle, as seen from what moves as the mean does
    Array<SurfaceFace> face;      // of each triangle
    float radius = 0;             // half of its thickness, or more; 0: it touches nothing [m]
    float margin = 0;             // how far apart it gets contacts [m]
    uint32_t collider = kNone;    // of a vertex, for all
    bool awake = false;           // some vertex is solved, or moves as its host says
};

}  // namespace taut
