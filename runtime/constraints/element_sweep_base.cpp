// The fused sweeps of elements, base build.
#include "constraints/element_sweep.inl"

namespace taut {

const ElementKernels kElementKernelsBase = element_sweeps<BaseLanes>("base");

}  // namespace taut
