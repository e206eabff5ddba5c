// Run-time choice of the panels' build.
#include "linear/panels.h"
#include "simd/width.h"

namespace taut {

const PanelKernels& panel_kernels() {
    if constexpr (kHasAvx)
        if (kernel_width() >= Width::avx2) return kPanelKernelsAvx2;
    return kPanelKernelsBase;
}

}  // namespace taut
