// The fused sweeps of elements, sse2 build.
#include "constraints/element_sweep.inl"

namespace taut {

const ElementKernels kElementKernelsSse2 = element_sweeps<Sse2Lanes>("sse2");

}  // namespace taut
