// The contact sweep, avx2 build.
#include "constraints/contact_sweep.inl"

namespace taut {

const ContactKernels kContactKernelsAvx2 = ContactSweep<Avx2Lanes>::table("avx2");

}  // namespace taut
