// The contact sweep, avx512 build.
#include "constraints/contact_sweep.inl"

namespace taut {

const ContactKernels kContactKernelsAvx512 = ContactSweep<Avx512Lanes>::table("avx512");

}  // namespace taut
