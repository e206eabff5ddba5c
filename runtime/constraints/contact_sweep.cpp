// Run-time choice of the contact sweep's build.
#include "constraints/contact_lanes.h"

namespace taut {

const ContactKernels& contact_kernels() {
    static const bool wide = __builtin_cpu_supports("avx2");
    return wide ? kContactKernelsAvx2 : kContactKernelsSse2;
}

}  // namespace taut
