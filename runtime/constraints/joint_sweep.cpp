// Run-time choice of the joint sweep's build.
#include "constraints/joint_lanes.h"
#include "simd/width.h"

namespace taut {

const JointKernels& joint_kernels() {
    static const JointKernels* const kBuilds[] = {TAUT_BUILDS(kJointKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
