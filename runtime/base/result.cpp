#include "base/result.h"

#include <cstdarg>
#include <cstdio>

namespace taut {
namespace {

thread_local char text[512] = "";

}  // namespace

taut_result refuse(taut_result code, const char* format, ...) noexcept {
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return code;
}

const char* last_error() noexcept { return text; }

}  // namespace taut
