// The list of schemes, in the order of taut_scheme: a new one is its file, a line here and a name in world.h.
#include "integrate/scheme.h"

namespace taut {

std::span<const SchemeType* const> scheme_types() {
    static const SchemeType* const list[] = {&kImplicitEuler, &kNewmark, &kBdf2};
    return list;
}

}  // namespace taut
