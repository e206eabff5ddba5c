// The fused sweep of contacts between grains, avx2 build.
#include "constraints/grain_sweep.inl"

namespace taut {

const GrainKernels kGrainKernelsAvx2 = GrainSweep<Avx2Lanes>::table("avx2");

}  // namespace taut
