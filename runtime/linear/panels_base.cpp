// Panels, build for any processor.
#include "linear/panels.inl"

namespace taut {

const PanelKernels kPanelKernelsBase = {"base", factor, solve};

}  // namespace taut
