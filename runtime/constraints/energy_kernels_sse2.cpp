// Energies of elements in lanes, sse2 build.
#include "constraints/energy_kernels.inl"

namespace taut {

const EnergyKernels kEnergyKernelsSse2 = energy_kernels_of<Sse2Doubles>("sse2");

}  // namespace taut
