// Hints for loops that go through records in no order.
#pragma once

#include <cstddef>

namespace taut {

// Asks for the memory of an object that is read soon, or of its first bytes, where the compiler knows how.
template <class T>
inline void prefetch(const T& object, size_t bytes = sizeof(T)) {
#if defined(__GNUC__)
    constexpr size_t kLine = 64;  // bytes
    const char* const from = reinterpret_cast<const char*>(&object);
    for (size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(from + i);
#else
    (void)object;
    (void)bytes;
#endif
}

}  // namespace taut
