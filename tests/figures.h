// What the bounds of a test measured: of each expression that EXPECT_LE and its like compare, the value nearest its
// bound. A program appends them to the file that TAUT_FIGURES names, if any; tests/run figures makes figures.md of
// that. Included in front of every test's source (CMakeLists.txt), so that a test need not know it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace figures {

// Keeps value where it is nearer its bound than any before in this test under this name; above is the bound's side.
void keep(const char* what, double value, double bound, bool above);

template <typename T>
constexpr bool kNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

template <typename A, typename B>
void keep_number(const char* what, const A& value, const B& bound, bool above) {
    if constexpr (kNumber<A> && kNumber<B>) keep(what, static_cast<double>(value), static_cast<double>(bound), above);
}

// As the macros of GoogleTest ask for it: both as written and as they are.
#define TAUT_KEPT_COMPARISON(name, relation, above)                                                                  \
    template <typename A, typename B>                                                                                \
    testing::AssertionResult name(const char* a, const char* b, const A& value, const B& bound) {                    \
        keep_number(a, value, bound, above);                                                                         \
        if (value relation bound) return testing::AssertionSuccess();                                                \
        return testing::AssertionFailure() << a << " is " << testing::PrintToString(value) << ", not " #relation " " \
                                           << testing::PrintToString(bound) << ", which " << b << " is";             \
    }
TAUT_KEPT_COMPARISON(less, <, true)
TAUT_KEPT_COMPARISON(at_most, <=, true)
TAUT_KEPT_COMPARISON(more, >, false)
TAUT_KEPT_COMPARISON(at_least, >=, false)
#undef TAUT_KEPT_COMPARISON

inline testing::AssertionResult near(const char* a, const char* b, const char* error, double value, double other,
                                     double most) {
    const double apart = std::abs(value - other);
    keep((std::string(a) + " - " + b).c_str(), apart, most, true);
    if (apart <= most) return testing::AssertionSuccess();
    return testing::AssertionFailure() << a << " is " << testing::PrintToString(value) << " and " << b << " "
                                       << testing::PrintToString(other) << ": " << apart << " apart, not within "
                                       << most << ", which " << error << " is";
}

}  // namespace figures

#undef EXPECT_LT
#undef EXPECT_LE
#undef EXPECT_GT
#undef EXPECT_GE
#undef EXPECT_NEAR
#undef ASSERT_LT
#undef ASSERT_LE
#undef ASSERT_GT
#undef ASSERT_GE
#undef ASSERT_NEAR
#define EXPECT_LT(value, bound) EXPECT_PRED_FORMAT2(figures::less, value, bound)
#define EXPECT_LE(value, bound) EXPECT_PRED_FORMAT2(figures::at_most, value, bound)
#define EXPECT_GT(value, bound) EXPECT_PRED_FORMAT2(figures::more, value, bound)
#define EXPECT_GE(value, bound) EXPECT_PRED_FORMAT2(figures::at_least, value, bound)
#define EXPECT_NEAR(value, other, most) EXPECT_PRED_FORMAT3(figures::near, value, other, most)
#define ASSERT_LT(value, bound) ASSERT_PRED_FORMAT2(figures::less, value, bound)
#define ASSERT_LE(value, bound) ASSERT_PRED_FORMAT2(figures::at_most, value, bound)
#define ASSERT_GT(value, bound) ASSERT_PRED_FORMAT2(figures::more, value, bound)
#define ASSERT_GE(value, bound) ASSERT_PRED_FORMAT2(figures::at_least, value, bound)
#define ASSERT_NEAR(value, other, most) ASSERT_PRED_FORMAT3(figures::near, value, other, most)
