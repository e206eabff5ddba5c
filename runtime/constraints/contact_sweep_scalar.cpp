// The contact sweep, scalar build.
#include "constraints/contact_sweep.inl"

namespace taut {

const ContactKernels kContactKernelsScalar = ContactSweep<ScalarLanes>::table("scalar");

}  // namespace taut
