// Run-time choice of the contact sweep's build.
#include "constraints/contact_lanes.h"
#include "simd/width.h"

namespace taut {

const ContactKernels& contact_kernels() {
    static const ContactKernels* const kBuilds[] = {TAUT_BUILDS(kContactKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
