// How much of a statistic runs: all of it in the tests labelled statistics (TAUT_STARTS=all in the environment), a part
// in the quick ones, few where sanitizers make each start some ten times as long (TAUT_STARTS=few).
#pragma once

#include <cstdlib>
#include <string_view>

inline bool asked_starts(std::string_view which) {
    const char* asked = std::getenv("TAUT_STARTS");
    return asked && asked == which;
}

inline bool few_starts() {
#ifdef TAUT_INSTRUMENTED
    return true;
#else
    return asked_starts("few");
#endif
}

// Random starts: a tenth in the quick tests, a hundredth of few.
template <class Count>
Count starts(Count all) {
    const Count part = asked_starts("all") ? 1 : few_starts() ? 100 : 10;
    return (all + part - 1) / part;
}

// Runs of a test that is through with them in a second: a tenth of few.
template <class Count>
Count runs(Count all) {
    return few_starts() ? (all + 9) / 10 : all;
}
