// Hints for loops that go through records in no order.
#pragma once

#include <cstddef>

namespace taut {

// Asks for the memory of an object that is read soon, where the compiler knows how.
template <class T>
inline void prefetch(const T& object) {
#if defined(__GNUC__)
    constexpr size_t kLine = 64;  // bytes
    const char* const from = reinterpret_cast<const char*>(&object);
    for (size_t i = 0; i < sizeof(T); i += kLine) __builtin_prefetch(from + i);
#else
    (void)object;
#endif
}

}  // namespace taut
