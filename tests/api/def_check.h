// Holds an entry point that takes a def against wrong sizes, null pointers and every float field out of range.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "support.h"

namespace taut_test {

struct Field {
    const char* name;  // as texts name it
    size_t offset;
    size_t size;  // 4: float, 8: double
    double lo, hi;
    // unchecked: other fields decide about the limits; or_infinite, or_minus_infinite: that is good as well
    enum Edges { closed, open_below, unchecked, or_infinite, or_minus_infinite } edges = closed;
};

#define FIELD(def, member, ...) \
    { #member, offsetof(def, member), sizeof(def::member), __VA_ARGS__ }
#define FIELD3(def, member, ...) \
    FIELD(def, member.x, __VA_ARGS__), FIELD(def, member.y, __VA_ARGS__), FIELD(def, member.z, __VA_ARGS__)

template <class Def>
inline Def with(const Def& def, const Field& field, double value) {
    Def out = def;
    unsigned char* at = reinterpret_cast<unsigned char*>(&out) + field.offset;
    if (field.size == sizeof(float)) {
        const float narrow = static_cast<float>(value);
        std::memcpy(at, &narrow, sizeof narrow);
    } else {
        std::memcpy(at, &value, sizeof value);
    }
    return out;
}

inline double above(const Field& field, double value) {
    const double inf = std::numeric_limits<double>::infinity();
    if (field.size == sizeof(double)) return std::nextafter(value, inf);
    return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}
inline double below(const Field& field, double value) { return -above(field, -value); }

// Holds one entry point against all that its def forbids, and the limits that it allows.
template <class Def, class Handle>
class DefCheck {
public:
    DefCheck(taut_world world, const char* name, taut_result (*add)(taut_world, const Def*, Handle*))
        : world_(world), name_(name), add_(add) {}

    void run(const Def& good, const std::vector<Field>& fields) {
        SCOPED_TRACE(name_);
        expect_refused(nullptr, TAUT_NULL_POINTER, "def");
        ASSERT_EQ(add_(world_, &good, nullptr), TAUT_NULL_POINTER);
        EXPECT_TRUE(contains(taut_last_error(), "out")) << taut_last_error();
        for (uint32_t size : {0u, good.struct_size - 1, good.struct_size + 1, UINT32_MAX}) {
            Def def = good;
            def.struct_size = size;
            expect_refused(&def, TAUT_STRUCT_SIZE, "struct_size");
        }
        for (const Field& field : fields) {
            for (double value : bad_values(field)) {
                const Def def = with(good, field, value);
                expect_refused(&def, TAUT_INVALID_ARGUMENT, field.name);
            }
            for (double value : {field.lo, field.hi}) {
                if (field.edges == Field::unchecked || (field.edges == Field::open_below && value == field.lo))
                    continue;
                const Def def = with(good, field, value);
                Handle out = {0};
                EXPECT_EQ(add_(world_, &def, &out), TAUT_OK) << field.name << ": " << taut_last_error();
                EXPECT_NE(out.bits, 0u);
            }
        }
        Handle out = {0};
        EXPECT_EQ(add_(world_, &good, &out), TAUT_OK) << taut_last_error();
    }

    // The def is wrong in a way that the text names by this word.
    void expect_refused(const Def* def, taut_result code, const char* word) {
        const Watch watch(world_);
        Handle out = {0x1234};
        EXPECT_EQ(add_(world_, def, &out), code) << word << ": " << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), std::string(name_) + ": ")) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(out.bits, 0x1234u);
        EXPECT_TRUE(watch.unchanged()) << word;
    }

private:
    static std::vector<double> bad_values(const Field& field) {
        const double inf = std::numeric_limits<double>::infinity(), most = std::numeric_limits<float>::max();
        std::vector<double> bad = {std::nan(""), most, -most};
        if (field.edges != Field::or_infinite) bad.push_back(inf);
        if (field.edges != Field::or_minus_infinite) bad.push_back(-inf);
        if (field.edges != Field::unchecked) {
            bad.push_back(field.edges == Field::open_below ? field.lo : below(field, field.lo));
            bad.push_back(above(field, field.hi));
        }
        return bad;
    }

    taut_world world_;
    const char* name_;
    taut_result (*add_)(taut_world, const Def*, Handle*);
};

}  // namespace taut_test
