// Pairs of triangles in lanes: which of their boxes meet; which features come near; which of their features, corners
// with faces and edges with edges, may come within a reach of each other where one lies over or under the other, and
// which triangles may cut. Distances are exact but for rounding, for which reaches have room. What lies beside gets
// over it only by going there, or where the other turns: by no more than it moves over its height, so that of a reach
// below half of that it is no more than it moves again.
#pragma once

#include <cstdint>

#include "simd/width.h"
#include "state/surface_leaf.h"

namespace taut {

// Bits of what two triangles have near.
struct NearFeatures {
    static constexpr uint32_t corner(int k) { return 1u << k; }                   // of the first with the second's face
    static constexpr uint32_t other_corner(int k) { return 8u << k; }             // of the second with the first's face
    static constexpr uint32_t edges(int k, int n) { return 64u << (3 * k + n); }  // from corner k, n to the next
    static constexpr uint32_t cut = 1u << 15;  // each has corners on both sides of the other
    static constexpr int kTests = 16;
};

struct TrianglePairs {
    alignas(64) float corner[2][3][3][kLanes];  // of the two, of each three, x y z [m]
    alignas(64) float reach[kLanes];            // how near features count now [m]; below 0: none
    alignas(64) float moved[kLanes];            // by which one goes past the other in the time, at most [m]
    uint32_t near[kLanes];                      // out: NearFeatures
};

// A triangle as it goes by those of a leaf of another mesh, in whose frame it is.
struct PassingTriangle {
    SurfaceBoxEnds way;  // about its way, as seen from what moves as the other mesh does on average
    SurfaceBoxEnds box;  // about it now
    float v[3];          // mean of its corners' velocities [m/s]
    float spread;        // by which one of them differs from that [m/s]
    float reach;         // how near the two come to matter [m]
    float time;          // in which they do [s]
};

// Pairs of features, of four points in all: a vertex and a face, or two edges.
struct FeatureLanes {
    alignas(64) float x[4][3][kLanes], v[4][3][kLanes];  // [m], [m/s]
    float both, margin;              // the radii of the two together, and how far beyond these they get contacts [m]
    float of_size;                   // of the shortest of their edges: the radii count as no more together
    alignas(64) float time[kLanes];  // [s]
};
constexpr int kMostAdvances = 8;  // what is not there by then counts as there: the contact is one to come

struct TrianglePairKernel {
    const char* name;
    void (*test)(TrianglePairs& pairs);
    // Lanes whose boxes meet one.
    unsigned (*meets)(const SurfaceBoxLanes& lanes, const SurfaceBoxEnds& box);
    // Lanes whose triangles may come within its reach; moved: by how much one goes past the other, at most [m].
    unsigned (*passes)(const SurfaceLeaf& leaf, const PassingTriangle& by, float (&moved)[kLanes]);
    // Lanes whose features come within their reach in the time, as they move now, and do so within both features.
    unsigned (*meet_faces)(const FeatureLanes& of);
    unsigned (*meet_edges)(const FeatureLanes& of);
};

extern const TrianglePairKernel kTrianglePairsScalar, kTrianglePairsBase, kTrianglePairsAvx2, kTrianglePairsAvx512;
// The widest that this machine runs.
const TrianglePairKernel& triangle_pair_kernel();

}  // namespace taut
