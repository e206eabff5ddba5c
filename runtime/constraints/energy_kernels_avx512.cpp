// Energies of elements in lanes, avx512 build.
#include "constraints/energy_kernels.inl"

namespace taut {

const EnergyKernels kEnergyKernelsAvx512 = energy_kernels_of<Avx512Doubles>("avx512");

}  // namespace taut
