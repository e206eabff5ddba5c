// Lane kernels, scalar build.
#include "collision/lane_kernels.inl"

namespace taut::collision {

const LaneKernels kLaneKernelsScalar = LaneBuild<ScalarLanes>::table("scalar");

}  // namespace taut::collision
