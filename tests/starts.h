// How many random starts a statistic takes: a tenth of them where sanitizers make each some ten times as long.
#pragma once

constexpr int starts(int usually) {
#ifdef TAUT_INSTRUMENTED
    return (usually + 9) / 10;
#else
    return usually;
#endif
}
