// The fused sweep of contacts of surfaces, avx512 build.
#include "constraints/surface_sweep.inl"

namespace taut {

const SurfaceKernels kSurfaceKernelsAvx512 = SurfaceSweep<Avx512Lanes>::table("avx512");

}  // namespace taut
