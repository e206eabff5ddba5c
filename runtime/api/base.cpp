#include <taut/base.h>

#include <cstddef>

#include "base/result.h"

const char* taut_result_name(taut_result result) {
    static constexpr const char* names[] = {
        "TAUT_OK",          "TAUT_INVALID_ARGUMENT", "TAUT_NULL_POINTER", "TAUT_STALE_HANDLE",  "TAUT_FOREIGN_HANDLE",
        "TAUT_STRUCT_SIZE", "TAUT_LOCKED",           "TAUT_TOO_SMALL",    "TAUT_OUT_OF_MEMORY", "TAUT_IN_USE",
        "TAUT_LIMIT",       "TAUT_UNSUPPORTED",
    };
    static_assert(sizeof names / sizeof *names == TAUT_UNSUPPORTED + 1);
    const size_t index = static_cast<size_t>(result);
    return index < sizeof names / sizeof *names ? names[index] : "unknown";
}

const char* taut_last_error(void) { return taut::last_error(); }

uint32_t taut_version(void) { return TAUT_VERSION_MAJOR * 10000 + TAUT_VERSION_MINOR * 100 + TAUT_VERSION_PATCH; }
