// The fused sweep of contacts between grains, avx512 build.
#include "constraints/grain_sweep.inl"

namespace taut {

const GrainKernels kGrainKernelsAvx512 = GrainSweep<Avx512Lanes>::table("avx512");

}  // namespace taut
