// Run-time choice of the panels' build.
#include "linear/panels.h"
#include "simd/width.h"

namespace taut {

const PanelKernels& panel_kernels() { return kernel_width() >= Width::avx2 ? kPanelKernelsAvx2 : kPanelKernelsBase; }

}  // namespace taut
