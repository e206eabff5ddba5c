// Energies of elements in lanes, avx2 build.
#include "constraints/energy_kernels.inl"

namespace taut {

const EnergyKernels kEnergyKernelsAvx2 = energy_kernels_of<Avx2Doubles>("avx2");

}  // namespace taut
