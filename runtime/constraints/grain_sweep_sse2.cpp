// The fused sweep of contacts between grains, sse2 build.
#include "constraints/grain_sweep.inl"

namespace taut {

const GrainKernels kGrainKernelsSse2 = GrainSweep<Sse2Lanes>::table("sse2");

}  // namespace taut
