// FNV-1a over 64-bit words with a final mix: the state hash. Bits, not values: +0 and -0 differ.
#pragma once

#include <bit>
#include <cstdint>

#include "base/math.h"

namespace taut {

class Hash {
public:
    void add(uint64_t word) {
        value_ = (value_ ^ word) * 0x100000001b3ull;
        value_ ^= value_ >> 29;
    }
    void add(double x) { add(std::bit_cast<uint64_t>(x)); }
    void add(float x) { add(static_cast<uint64_t>(std::bit_cast<uint32_t>(x))); }
    void add(const Vec3& v) {
        for (int i = 0; i < 3; ++i) add(v[i]);
    }
    void add(const Quat& q) {
        for (int i = 0; i < 4; ++i) add(q.coeffs()[i]);
    }
    uint64_t value() const { return value_; }

private:
    uint64_t value_ = 0xcbf29ce484222325ull;
};

}  // namespace taut
