// Run-time choice of the motion kernels' build.
#include "integrate/motion_kernels.h"

#include "simd/width.h"

namespace taut {

const MotionKernels& motion_kernels() {
    if constexpr (kHasAvx)
        if (kernel_width() >= Width::avx2) return kMotionKernelsAvx2;
    return kMotionKernelsBase;
}

}  // namespace taut
