// Run-time choice of the joint sweep's build.
#include "constraints/joint_lanes.h"
#include "simd/width.h"

namespace taut {

const JointKernels& joint_kernels() {
    static const JointKernels* const kBuilds[] = {&kJointKernelsScalar, &kJointKernelsSse2, &kJointKernelsAvx2,
                                                  &kJointKernelsAvx512};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
