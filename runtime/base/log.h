// Lines for the host's log hook.
#pragma once

#include <taut/base.h>

#include "base/printf_like.h"

namespace taut {

// Formats as printf, cut at 255 bytes. Nothing happens without a hook, nor where it throws.
TAUT_PRINTF_LIKE(3, 4) void log_line(const taut_hooks& hooks, taut_log_level level, const char* format, ...);

}  // namespace taut
