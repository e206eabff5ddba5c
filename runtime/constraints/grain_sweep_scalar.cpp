// The fused sweep of contacts between grains, scalar build.
#include "constraints/grain_sweep.inl"

namespace taut {

const GrainKernels kGrainKernelsScalar = GrainSweep<ScalarLanes>::table("scalar");

}  // namespace taut
