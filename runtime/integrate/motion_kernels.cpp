// Run-time choice of the motion kernels' build.
#include "integrate/motion_kernels.h"

#include "simd/width.h"

namespace taut {

const MotionKernels& motion_kernels() {
    return kernel_width() >= Width::avx2 ? kMotionKernelsAvx2 : kMotionKernelsBase;
}

}  // namespace taut
