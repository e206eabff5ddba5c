// The fused sweep of contacts of surfaces, sse2 build.
#include "constraints/surface_sweep.inl"

namespace taut {

const SurfaceKernels kSurfaceKernelsSse2 = SurfaceSweep<Sse2Lanes>::table("sse2");

}  // namespace taut
