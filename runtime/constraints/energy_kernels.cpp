// Run-time choice of the build of energies in lanes.
#include "constraints/energy_kernels.h"

namespace taut {

const EnergyKernels& energy_kernels() {
    static const EnergyKernels* const kBuilds[] = {TAUT_BUILDS(kEnergyKernels)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
