// The fused sweep of contacts of surfaces, scalar build.
#include "constraints/surface_sweep.inl"

namespace taut {

const SurfaceKernels kSurfaceKernelsScalar = SurfaceSweep<ScalarLanes>::table("scalar");

}  // namespace taut
