// TAUT_PRINTF_LIKE(format, first), before a function: calls are checked as those of printf. The numbers are those of
// its parameters, from 1; of members from 2. Formats are C's own, also on Windows, where g++ takes printf's for
// Microsoft's.
#pragma once

#if defined(__MINGW32__) && !defined(__clang__)
#define TAUT_PRINTF_LIKE(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#elif defined(__GNUC__)
#define TAUT_PRINTF_LIKE(format_at, first) __attribute__((format(printf, format_at, first)))
#else
#define TAUT_PRINTF_LIKE(format_at, first)
#endif
