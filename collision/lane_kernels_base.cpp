// Lane kernels, base build.
#include "collision/lane_kernels.inl"

namespace taut::collision {

const LaneKernels kLaneKernelsBase = LaneBuild<BaseLanes>::table("base");

}  // namespace taut::collision
