// How many random starts a statistic takes: all of them in the tests labelled full (TAUT_STARTS=all in the
// environment), a tenth in the quick ones, a hundredth where sanitizers make each some ten times as long.
#pragma once

#include <cstdlib>
#include <string_view>

template <class Count>
Count starts(Count all) {
    const char* asked = std::getenv("TAUT_STARTS");
#ifdef TAUT_INSTRUMENTED
    constexpr Count kPart = 100;
#else
    constexpr Count kPart = 10;
#endif
    return asked && std::string_view(asked) == "all" ? all : (all + kPart - 1) / kPart;
}

// How many runs a test takes that is through with them in a second: a tenth of them with sanitizers.
template <class Count>
constexpr Count runs(Count all) {
#ifdef TAUT_INSTRUMENTED
    return (all + 9) / 10;
#else
    return all;
#endif
}
