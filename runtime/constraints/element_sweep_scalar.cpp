// The fused sweeps of elements, scalar build.
#include "constraints/element_sweep.inl"

namespace taut {

const ElementKernels kElementKernelsScalar = element_sweeps<ScalarLanes>("scalar");

}  // namespace taut
