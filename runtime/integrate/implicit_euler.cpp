// Implicit Euler.  t = s = h,  u* = v~ = v_n + h a.
#include "integrate/scheme.h"

namespace taut {

const SchemeType kImplicitEuler{"implicit_euler", [](const SchemeSettings&) { return Scheme{}; }, nullptr};

}  // namespace taut
