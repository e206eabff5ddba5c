// Run-time choice of the build of the sweeps of grains.
#include "constraints/grain_lanes.h"
#include "simd/width.h"

namespace taut {

const GrainKernels& grain_kernels() {
    static const GrainKernels* const kBuilds[] = {TAUT_BUILDS(kGrainKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
