// The fused sweep of contacts between grains, base build.
#include "constraints/grain_sweep.inl"

namespace taut {

const GrainKernels kGrainKernelsBase = GrainSweep<BaseLanes>::table("base");

}  // namespace taut
