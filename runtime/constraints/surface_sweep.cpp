// Run-time choice of the build of the sweeps of contacts of surfaces.
#include "constraints/surface_lanes.h"
#include "simd/width.h"

namespace taut {

const SurfaceKernels& surface_kernels() {
    static const SurfaceKernels* const kBuilds[] = {TAUT_BUILDS(kSurfaceKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
