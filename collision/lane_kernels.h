// What works on many boxes, faces or corners side by side. Built several times, with the same bits: scalar, for SSE2,
// AVX2 and AVX-512. All is plain numbers, so that no inline function is shared between builds.
#pragma once

#include <cstddef>
#include <cstdint>

#include "simd/width.h"

namespace taut::collision {

// Those that are not there meet nothing: their lo is above any hi.
struct alignas(64) BoxLanes {
    float lo[3][kLanes], hi[3][kLanes];  // [m]
};

// Numbers of many things side by side, a column for each number. What is beyond the last thing repeats it.
struct Columns {
    const float* first = nullptr;  // at a multiple of 64 bytes
    uint32_t length = 0;           // of a column: a multiple of kLanes
};
constexpr uint32_t column_length(size_t count) { return uint32_t((count + kLanes - 1) / kLanes * kLanes); }

// Which face of a polytope separates most from the corners of another. All vectors in the polytope's frame [m].
struct FaceSearch {
    Columns planes;  // x, y and z of the normal, offset
    uint32_t faces;
    Columns corners;                    // x, y and z in the other's frame
    float rotation[3][3], position[3];  // of the other, a row after the other
    float centre[3], radius;            // of a ball inside the other
    float least;                        // none, or any, where none separates by more
    float margin;                       // stops at the first beyond
};
struct FaceFound {
    uint32_t face = 0, corner = 0;  // that corner is nearest to the face
    float distance = -1e30f;        // negative is overlap [m]
};

struct LaneKernels {
    const char* build;
    // A bit for each box that has a point in common with the one from lo to hi, three numbers each.
    unsigned (*meeting)(const BoxLanes& boxes, const float* lo, const float* hi);
    // Of corners, along three numbers: the most, and which is the first that reaches as far.
    float (*highest)(const Columns& corners, const float* direction);
    uint32_t (*support)(const Columns& corners, const float* direction);
    // The most that a point lies over planes, and that all of a way does.
    float (*outside)(const Columns& planes, const float* point);
    float (*way_outside)(const Columns& planes, const float* from, const float* to);
    // How far each corner lies along three numbers, and a point over each plane; into as many as the columns hold.
    // Returns the most.
    float (*heights)(const Columns& corners, const float* direction, float* out);
    float (*heights_over)(const Columns& planes, const float* point, float* out);
    // How far corners reach along the rows of a rotation, the least and the most.
    void (*extent)(const Columns& corners, const float (*rotation)[3], float* least, float* most);
    FaceFound (*best_face)(const FaceSearch& search);
};

extern const LaneKernels kLaneKernelsScalar, kLaneKernelsBase, kLaneKernelsAvx2, kLaneKernelsAvx512;
extern const LaneKernels* const kLaneKernels[];  // by Width

// Of the build that kernels use now.
inline const LaneKernels& lane_kernels() { return *kLaneKernels[size_t(kernel_width())]; }

}  // namespace taut::collision
