// Worlds that play recordings: of each at most one, in a table beside that of worlds.
#pragma once

#include <taut/record.h>

#include "api/access.h"

namespace taut {

// Throws std::bad_alloc.
taut_result open_replay(const char* call, const taut_replay_def& checked_def, taut_world& out);
taut_result next_of_replay(const char* call, taut_world world, taut_replay_state& out);
// Of a world that is gone.
void close_replay(uint32_t world) noexcept;

}  // namespace taut
