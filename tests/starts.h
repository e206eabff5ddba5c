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
