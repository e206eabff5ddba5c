// The program's own memory.
#pragma once

#include <cstddef>

namespace bench {

// Takes so much memory from the system, writes to each page and keeps it for what asks next: as a program does that has
// a frame to keep, for the kernel gives a page when it is first written to, and takes from .2 to 12 us for it.
void warm_heap(size_t bytes);

}  // namespace bench
