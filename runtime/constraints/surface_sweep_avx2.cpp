// The fused sweep of contacts of surfaces, avx2 build.
#include "constraints/surface_sweep.inl"

namespace taut {

const SurfaceKernels kSurfaceKernelsAvx2 = SurfaceSweep<Avx2Lanes>::table("avx2");

}  // namespace taut
