// Run-time choice of the build of elements' fused sweeps.
#include "constraints/element_lanes.h"
#include "simd/width.h"

namespace taut {

const ElementKernels& element_kernels() {
    static const ElementKernels* const kBuilds[] = {TAUT_BUILDS(kElementKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
