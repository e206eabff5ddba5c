// Edges and tree of the triangles of a soft body, which follow from these and are made anew where they change; and
// where its vertices are in the frame that contacts are being found for. detect/surface_tree.h.
#pragma once

#include "base/math.h"
#include "base/memory.h"
#include "state/nodes.h"
#include "state/surface_leaf.h"

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

// In preorder: children of an inner one follow it, the second after all that is below the first.
struct SurfaceNode {
    SurfaceBox box;
    uint32_t begin, end;                      // in SurfaceMesh::order
    uint32_t next;                            // after all that is below it
    uint32_t leaf = kNone;                    // its number among leaves; kNone: it is none
    bool whole = false;                       // its triangles hang together by edges
    bool renewed = false;                     // contacts of some triangle below are found anew
    SurfaceBox normals = SurfaceBox::none();  // of its triangles, as they are and as the time is over
};

inline void set_lane(SurfaceBoxLanes& lanes, int lane, const SurfaceBox& box) {
    for (int i = 0; i < 3; ++i) lanes.lo[i][lane] = box.lo[i], lanes.hi[i][lane] = box.hi[i];
}
inline SurfaceBoxEnds ends_of(const SurfaceBox& box) {
    return {{box.lo.x(), box.lo.y(), box.lo.z()}, {box.hi.x(), box.hi.y(), box.hi.z()}};
}
inline SurfaceBox box_of_lane(const SurfaceBoxLanes& lanes, int lane) {
    return {{lanes.lo[0][lane], lanes.lo[1][lane], lanes.lo[2][lane]},
            {lanes.hi[0][lane], lanes.hi[1][lane], lanes.hi[2][lane]}};
}

struct SurfaceMesh {
    explicit SurfaceMesh(Memory& memory)
        : edge(memory),
          edge_of(memory),
          owns(memory),
          ring_begin(memory),
          ring(memory),
          order(memory),
          node(memory),
          beside_begin(memory),
          beside(memory),
          place_of(memory),
          owner(memory),
          x(memory),
          v(memory),
          way(memory),
          strayed(memory),
          leaf(memory),
          normal(memory) {}

    uint64_t version = 0;              // of the soft body that all of this was made from; 0: of none
    Array<SurfaceEdge> edge;           //
    Array<uint32_t> edge_of;           // [3] of each triangle: from corner k to the next
    Array<uint8_t> owns;               // of each triangle: bit k its edge k, bit 3 + k its corner k; each has one owner
    Array<uint32_t> ring_begin, ring;  // of each vertex: its edges
    Array<uint32_t> order;             // triangles, leaf by leaf
    Array<SurfaceNode> node;           // the tree; its root first
    Array<uint32_t> beside_begin, beside;  // of each leaf: those after it that have a vertex of it, ascending
    Array<uint32_t> place_of, owner;       // of each triangle: leaf times kLanes plus lane; of each vertex its owner
    // Of a frame.
    Vec3 origin = Vec3::Zero();  // [m]
    Array<Vec3f> x;              // of each vertex, from there [m]
    Array<Vec3f> v, way;         // of each vertex: the way that contacts are found for, way + t v from the time of x on
    Array<uint8_t> strayed;      // of each vertex: its way is a new one
    Vec3f drift = Vec3f::Zero();  // mean of these velocities
    Array<SurfaceLeaf> leaf;      // of each leaf
    Array<Vec3f> normal;          // of each triangle, unit, or 0
    float radius = 0;             // half of its thickness, or more; 0: it touches nothing [m]
    float margin = 0;             // how far apart it gets contacts [m]
    uint32_t collider = kNone;    // of a vertex, for all
    float left = 0;               // least of its triangles' [s]
    bool awake = false;           // some vertex is solved, or moves as its host says

    // Whether contacts of a triangle are found anew.
    bool renews(uint32_t triangle) const {
        return leaf[place_of[triangle] / kLanes].renewed >> place_of[triangle] % kLanes & 1;
    }
};

}  // namespace taut
