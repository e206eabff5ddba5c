// The contact sweep, base build.
#include "constraints/contact_sweep.inl"

namespace taut {

const ContactKernels kContactKernelsBase = ContactSweep<BaseLanes>::table("base");

}  // namespace taut
