// The fused sweeps of elements, avx2 build.
#include "constraints/element_sweep.inl"

namespace taut {

const ElementKernels kElementKernelsAvx2 = element_sweeps<Avx2Lanes>("avx2");

}  // namespace taut
