#include "collision/lane_kernels.h"

namespace taut::collision {

const LaneKernels* const kLaneKernels[] = {&kLaneKernelsScalar, &kLaneKernelsSse2, &kLaneKernelsAvx2,
                                           &kLaneKernelsAvx512};

}  // namespace taut::collision
