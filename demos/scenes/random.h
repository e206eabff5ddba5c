// Random numbers that are the same on every machine for the same seed (SplitMix64; Steele, Lea, Flood 2014).
#pragma once

#include <taut/math.h>

#include <cmath>
#include <cstdint>

namespace scenes {

class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}

    uint64_t bits() {
        uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
    double around_zero() { return 2 * uniform() - 1; }                        // [-1, 1)

    taut_vec3 in_cube(double half) {
        double x = half * around_zero(), y = half * around_zero(), z = half * around_zero();
        return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
    taut_vec3 direction() {
        for (;;) {
            taut_vec3 v = in_cube(1);
            float square = v.x * v.x + v.y * v.y + v.z * v.z;
            if (square > 1 || square < 0.01f) continue;
            float s = 1 / std::sqrt(square);
            return {v.x * s, v.y * s, v.z * s};
        }
    }

private:
    uint64_t state_;
};

// Sine and cosine to 2^-40, the same on every machine: of angles near a multiple of a quarter turn those of C libraries
// have other bits.
inline double sine(double angle) { return std::round(std::sin(angle) * 0x1p40) * 0x1p-40; }
inline double cosine(double angle) { return std::round(std::cos(angle) * 0x1p40) * 0x1p-40; }

// Rotation by an angle [rad] about a unit axis.
inline taut_quat turn(taut_vec3 axis, double angle) {
    const auto s = static_cast<float>(sine(0.5 * angle));
    return {axis.x * s, axis.y * s, axis.z * s, static_cast<float>(cosine(0.5 * angle))};
}

}  // namespace scenes
