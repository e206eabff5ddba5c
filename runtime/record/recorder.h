// Recordings of worlds: of each at most one at a time, in a table beside that of worlds.
#pragma once

#include <taut/record.h>

#include "world.h"

namespace taut {

// Writes the head. Throws std::bad_alloc. False, with the reason told: the host did not take it.
bool start_recording(const World& world, const taut_record_def& checked_def);
// Whether this thread is within a call that is being recorded, as the host's write is.
bool is_within_recording(uint32_t world) noexcept;
bool is_recorded(const World& world) noexcept;
// Writes the end. The world's pre_solve is the host's again.
void end_recording(World& world) noexcept;
// Of a world that is gone.
void end_recording(uint32_t world) noexcept;

// The host's filter, as a world asks it: through its recording, if there is one.
PreSolve recorded_pre_solve(const World& world, PreSolve host) noexcept;

// The def that a baked shape was made of, as an Encoder wrote it, behind its kind; not_kept where it was not kept or
// the handle is stale. Throws std::bad_alloc.
void append_baked_def(taut_baked baked, Array<std::byte>& out);

}  // namespace taut
