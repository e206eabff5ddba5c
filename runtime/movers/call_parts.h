// What the calls of characters and vehicles share: they ask and change the world by other calls of the interface.
#pragma once

#include <taut/query.h>

#include "api/access.h"

namespace taut {

// The host's filter, null for all, as this library knows it; it ignores at most so many, as the call adds its own.
bool take_filter(Check& check, const taut_query_filter* given, uint32_t most_bodies, uint32_t most_colliders,
                 taut_query_filter& filter);
// The text of a call within one becomes that of the call itself.
taut_result refuse_as(const Check& check, taut_result inner);

}  // namespace taut
