// Which fused sweeps of elements there are; what they work on is in element_lanes.h.
#pragma once

#include <cstdint>

namespace taut {

struct ElementTerms;
struct ElementView;
struct SweepNode;
struct SweepPose;

using ElementSweep = void (*)(const ElementView&, uint32_t begin, uint32_t end, SweepNode*, const SweepPose*,
                              const ElementTerms&);

// The fused sweeps of types over lanes [begin, end) of groups. Four builds of one source give the same bits: scalar,
// SSE2, AVX2, AVX-512.
struct ElementKernels {
    const char* name;
    ElementSweep link, green_tri3, neo_hookean_tet4, dihedral, quadratic_bend;
};

extern const ElementKernels kElementKernelsScalar, kElementKernelsBase, kElementKernelsAvx2, kElementKernelsAvx512;
// The widest that this machine runs.
const ElementKernels& element_kernels();

}  // namespace taut
