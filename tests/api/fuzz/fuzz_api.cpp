// libFuzzer's entry: its bytes are the decisions of the random host.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "../driver.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    size_t at = 0;
    taut_test::Driver driver(
        [&](void* out, size_t wanted) {
            if (size - at < wanted) return false;
            std::memcpy(out, data + at, wanted);
            at += wanted;
            return true;
        },
        [](const char* call, const char* what) {
            std::fprintf(stderr, "%s: %s (last refusal: %s)\n", call, what, taut_last_error());
            std::abort();
        });
    while (driver.call()) {
    }
    return 0;
}
