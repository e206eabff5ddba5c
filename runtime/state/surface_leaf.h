// Triangles of a leaf of a surface's tree, in lanes; seen by kernels, so without Eigen.
#pragma once

#include <cstdint>

#include "simd/width.h"

namespace taut {

// Boxes [m]; lo > hi: nothing.
struct SurfaceBoxLanes {
    alignas(64) float lo[3][kLanes], hi[3][kLanes];
};

struct SurfaceLeaf {
    SurfaceBoxLanes way;               // about its way, as seen from what moves as the mesh does on average
    SurfaceBoxLanes box;               // about it now
    alignas(64) float v[3][kLanes];    // mean of its corners' velocities [m/s]
    alignas(64) float spread[kLanes];  // by which one of them differs from that [m/s]
    alignas(64) float left[kLanes];    // for how long contacts were found [s]
    float lasted[kLanes];              // since [s]
    uint32_t triangle[kLanes];
    uint32_t renewed;    // a bit for each: contacts are found anew
    uint32_t count;      // of lanes that have one; the first
    uint32_t node;       // its own
    uint32_t past_flat;  // after what is below the highest flat node that it is below; flat ones meet nothing below
};

// Of one triangle.
struct SurfaceBoxEnds {
    float lo[3], hi[3];
};

}  // namespace taut
