// The contact sweep, sse2 build.
#include "constraints/contact_sweep.inl"

namespace taut {

const ContactKernels kContactKernelsSse2 = ContactSweep<Sse2Lanes>::table("sse2");

}  // namespace taut
