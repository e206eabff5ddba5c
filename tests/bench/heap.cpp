#include "heap.h"

#include <limits>
#include <memory>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace bench {

void warm_heap(size_t bytes) {
    constexpr size_t kPiece = size_t{16} << 20, kPage = 4096;  // [bytes]
#if defined(__GLIBC__)
    // Large pieces come from the heap too, and what is freed there stays.
    mallopt(M_MMAP_THRESHOLD, 2 * static_cast<int>(kPiece));
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
    std::vector<std::unique_ptr<char[]>> pieces;
    for (size_t taken = 0; taken < bytes; taken += kPiece) {
        pieces.emplace_back(new char[kPiece]);
        for (size_t i = 0; i < kPiece; i += kPage) static_cast<volatile char*>(pieces.back().get())[i] = 1;
    }
}

}  // namespace bench
