// Energies of elements in lanes, base build.
#include "constraints/energy_kernels.inl"

namespace taut {

const EnergyKernels kEnergyKernelsBase = energy_kernels_of<BaseDoubles>("base");

}  // namespace taut
