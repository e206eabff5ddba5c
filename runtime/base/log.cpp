#include "base/log.h"

#include <cstdarg>
#include <cstdio>

namespace taut {

void log_line(const taut_hooks& hooks, taut_log_level level, const char* format, ...) {
    if (!hooks.log) return;
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    try {
        hooks.log(level, text, hooks.log_user_data);
    } catch (...) {  // what is told changes nothing
    }
}

}  // namespace taut
