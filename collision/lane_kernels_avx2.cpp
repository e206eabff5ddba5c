// Lane kernels, avx2 build.
#include "collision/lane_kernels.inl"

namespace taut::collision {

const LaneKernels kLaneKernelsAvx2 = LaneBuild<Avx2Lanes>::table("avx2");

}  // namespace taut::collision
