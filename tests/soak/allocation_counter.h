// Counts every call that takes memory from the C runtime, operator new included, in the whole process.
#pragma once

#include <cstdint>

namespace soak {

bool counts_allocations();  // false where a sanitizer or another C library owns malloc
uint64_t allocations();     // so far

}  // namespace soak
