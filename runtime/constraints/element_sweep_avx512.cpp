// The fused sweeps of elements, avx512 build.
#include "constraints/element_sweep.inl"

namespace taut {

const ElementKernels kElementKernelsAvx512 = element_sweeps<Avx512Lanes>("avx512");

}  // namespace taut
