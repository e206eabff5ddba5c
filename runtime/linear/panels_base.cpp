// Panels, build for any processor.
#include "linear/panel_inverse.inl"

namespace taut {

const PanelKernels kPanelKernelsBase = {"base", factor, solve, inverse, add_rows};

}  // namespace taut
