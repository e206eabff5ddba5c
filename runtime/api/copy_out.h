// Arrays that a host reads: pointer, capacity, count.
#pragma once

#include "base/result.h"

namespace taut {

// Out: a pointer or RecordOut.
template <class Out, class Get>
taut_result copy_out(uint32_t needed, const Out& out, uint32_t capacity, uint32_t* count, const char* call,
                     const char* name, Get get) {
    *count = needed;
    if (capacity < needed) return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, %u needed", call, capacity, needed);
    if (!out) return refuse(TAUT_NULL_POINTER, "%s: %s is null", call, name);
    for (uint32_t i = 0; i < needed; ++i) out[i] = get(i);
    return TAUT_OK;
}

}  // namespace taut
