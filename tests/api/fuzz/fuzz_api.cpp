// libFuzzer's entry: its bytes are the decisions of the random host.
#include <cstdio>
#include <cstdlib>

#include "../driver.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    taut_test::Driver driver(taut_test::source_of({data, size}), [](const char* call, const char* what) {
        std::fprintf(stderr, "%s: %s (last refusal: %s)\n", call, what, taut_last_error());
        std::abort();
    });
    while (driver.call()) {
    }
    return 0;
}
