#include "base/result.h"

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace taut {
namespace {

thread_local char text[512] = "";
thread_local taut_result told = TAUT_OK;

}  // namespace

taut_result refuse(taut_result code, const char* format, ...) noexcept {
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    told = code;
    return code;
}

void add_to_error(const char* format, ...) noexcept {
    const size_t length = std::strlen(text);
    va_list values;
    va_start(values, format);
    std::vsnprintf(text + length, sizeof text - length, format, values);
    va_end(values);
}

const char* last_error() noexcept { return text; }

void tell_result(taut_result result) noexcept { told = result; }
taut_result told_result() noexcept { return told; }

}  // namespace taut
