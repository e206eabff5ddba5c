// Pairs of triangles in lanes: which of their features, corners with faces and edges with edges, may come within a
// reach of each other where one lies over or under the other, and which triangles may cut. Distances are exact but for
// rounding, for which reaches have room. What lies beside gets over it only by going there, or where the other turns:
// by no more than it moves over its height, so that of a reach below half of that it is no more than it moves again.
#pragma once

#include <cstdint>

#include "simd/width.h"

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

struct TrianglePairKernel {
    const char* name;
    void (*test)(TrianglePairs& pairs);
};

extern const TrianglePairKernel kTrianglePairsScalar, kTrianglePairsSse2, kTrianglePairsAvx2, kTrianglePairsAvx512;
// The widest that this machine runs.
const TrianglePairKernel& triangle_pair_kernel();

}  // namespace taut
