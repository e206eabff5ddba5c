// The motion kernels, build for every machine.
#include "integrate/motion_kernels.inl"

namespace taut {

const MotionKernels kMotionKernelsBase = kTable;

}  // namespace taut
