// The fused sweep of contacts of surfaces, base build.
#include "constraints/surface_sweep.inl"

namespace taut {

const SurfaceKernels kSurfaceKernelsBase = SurfaceSweep<BaseLanes>::table("base");

}  // namespace taut
