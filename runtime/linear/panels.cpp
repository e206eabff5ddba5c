// Run-time choice of the panels' build.
#include "linear/panels.h"

namespace taut {

const PanelKernels& panel_kernels() {
    static const bool wide = __builtin_cpu_supports("avx2");
    return wide ? kPanelKernelsAvx2 : kPanelKernelsBase;
}

}  // namespace taut
