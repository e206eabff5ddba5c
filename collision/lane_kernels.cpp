#include "collision/lane_kernels.h"

namespace taut::collision {

const LaneKernels* const kLaneKernels[] = {TAUT_BUILDS(kLaneKernels)};

}  // namespace taut::collision
