// Panels, avx2 build.
#include "linear/panels.inl"

namespace taut {

const PanelKernels kPanelKernelsAvx2 = {"avx2", factor, solve};

}  // namespace taut
