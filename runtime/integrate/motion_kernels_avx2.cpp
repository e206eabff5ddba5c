// The motion kernels, avx2 build.
#include "integrate/motion_kernels.inl"

namespace taut {

const MotionKernels kMotionKernelsAvx2 = kTable;

}  // namespace taut
