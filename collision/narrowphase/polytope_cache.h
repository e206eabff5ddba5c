// What a pair of polytopes remembers: an axis, whether they touched along it, and the pose at which all axes were
// tried.
#pragma once

#include <algorithm>
#include <bit>

#include "collision/narrowphase/polytope_axes.h"

namespace taut::collision {

// A touching pair keeps its axis until b moved this far in a's frame [m] since all axes were tried.
constexpr float kStill = 0.005f;

// Two columns of the rotation, 16 bits an entry: |dc0|^2 + |dc1|^2 bounds the squared angle of the turn.
struct Kept {
    Axis axis;
    bool touching = false;
    Vec3f centre = Vec3f::Zero();  // of b in a's frame
    int16_t columns[6] = {};
};

// Of a number from -1 to 1; from above zero on, where cutting off rounds down.
inline int16_t quantised(float x) { return int16_t(int(x * 32767.0f + 32768.5f) - 32768); }

// Word 0: kind, i, j, touching a byte each; of those that touch words 1 to 3 the centre, 4 to 6 the columns.
inline uint32_t word_of(Axis axis, bool touching) {
    return uint32_t(axis.kind) | uint32_t(axis.i) << 8 | uint32_t(axis.j) << 16 | uint32_t(touching) << 24;
}

inline Kept read_axis(uint32_t word) {
    Kept kept;
    kept.axis = {AxisKind(word & 3), uint8_t(word >> 8), uint8_t(word >> 16)};
    kept.touching = word >> 24 & 1;
    return kept;
}

inline Kept read(const PairCache& cache) {
    Kept kept = read_axis(cache.words[0]);
    if (!kept.touching) return kept;
    for (int i = 0; i < 3; ++i) {
        kept.centre[i] = std::bit_cast<float>(cache.words[1 + i]);
        kept.columns[2 * i] = int16_t(cache.words[4 + i] & 0xffff);
        kept.columns[2 * i + 1] = int16_t(cache.words[4 + i] >> 16);
    }
    return kept;
}

inline void write_apart(Axis axis, PairCache& cache) { cache.words[0] = word_of(axis, false); }

inline void write_touching(Axis axis, const PolytopePair& pair, PairCache& cache) {
    const Vec3f centre = pair.b_in_a * pair.b.centre;
    cache.words[0] = word_of(axis, true);
    for (int i = 0; i < 3; ++i) {
        const uint16_t lo = uint16_t(quantised(pair.b_in_a.rotation(i, 0)));
        const uint16_t hi = uint16_t(quantised(pair.b_in_a.rotation(i, 1)));
        cache.words[1 + i] = std::bit_cast<uint32_t>(centre[i]);
        cache.words[4 + i] = uint32_t(hi) << 16 | lo;
    }
}

inline bool still(const Kept& kept, const PolytopePair& pair) {
    const float limit = std::min(kStill, 0.02f * pair.size());
    // Written so that not-a-number is motion.
    if (!((pair.b_in_a * pair.b.centre - kept.centre).squaredNorm() <= limit * limit)) return false;
    float turned = 0;
    for (int i = 0; i < 6; ++i) {
        const float change = pair.b_in_a.rotation(i / 2, i % 2) - float(kept.columns[i]) * (1.0f / 32767.0f);
        turned += change * change;
    }
    const float radius = pair.b.outer_radius;
    return turned * radius * radius <= limit * limit;
}

}  // namespace taut::collision
