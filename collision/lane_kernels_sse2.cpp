// Lane kernels, sse2 build.
#include "collision/lane_kernels.inl"

namespace taut::collision {

const LaneKernels kLaneKernelsSse2 = LaneBuild<Sse2Lanes>::table("sse2");

}  // namespace taut::collision
