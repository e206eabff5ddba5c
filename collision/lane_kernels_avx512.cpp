// Lane kernels, avx512 build.
#include "collision/lane_kernels.inl"

namespace taut::collision {

const LaneKernels kLaneKernelsAvx512 = LaneBuild<Avx512Lanes>::table("avx512");

}  // namespace taut::collision
