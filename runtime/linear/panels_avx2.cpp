// Panels, avx2 build.
#include "linear/panel_inverse.inl"

namespace taut {

const PanelKernels kPanelKernelsAvx2 = {"avx2", factor, solve, inverse, add_rows};

}  // namespace taut
