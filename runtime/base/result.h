// The text of the last refused call, one a thread.
#pragma once

#include <taut/base.h>

#include "base/printf_like.h"

namespace taut {

// Sets the calling thread's text (printf format, cut at 511 bytes) and returns the code.
TAUT_PRINTF_LIKE(2, 3) taut_result refuse(taut_result code, const char* format, ...) noexcept;

// More at its end.
TAUT_PRINTF_LIKE(1, 2) void add_to_error(const char* format, ...) noexcept;

const char* last_error() noexcept;

// What the calling thread's call comes to, for its recording: the last code refused or told.
void tell_result(taut_result result) noexcept;
taut_result told_result() noexcept;

}  // namespace taut
