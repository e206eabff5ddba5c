// Run-time choice of the build of the sweeps of grains.
#include "constraints/grain_lanes.h"
#include "simd/width.h"

namespace taut {

const GrainKernels& grain_kernels() {
    static const GrainKernels* const kBuilds[] = {&kGrainKernelsScalar, &kGrainKernelsSse2, &kGrainKernelsAvx2,
                                                  &kGrainKernelsAvx512};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
