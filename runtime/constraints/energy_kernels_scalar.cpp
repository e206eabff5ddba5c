// Energies of elements in lanes, scalar build.
#include "constraints/energy_kernels.inl"

namespace taut {

const EnergyKernels kEnergyKernelsScalar = energy_kernels_of<ScalarDoubles>("scalar");

}  // namespace taut
