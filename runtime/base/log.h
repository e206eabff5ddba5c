// Lines for the host's log hook.
#pragma once

#include <taut/base.h>

namespace taut {

// Formats as printf, cut at 255 bytes. Nothing happens without a hook, nor where it throws.
void log_line(const taut_hooks& hooks, taut_log_level level, const char* format, ...)
    __attribute__((format(printf, 3, 4)));

}  // namespace taut
