// Orders of many keys in linear time, for what is built once from millions of triangles.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "base/memory.h"

namespace taut::collision {

struct Keyed {
    uint32_t key, number;
};

// Bits that compare as the floats do; -0 below 0.
inline uint32_t ordered_bits(float x) {
    const uint32_t bits = std::bit_cast<uint32_t>(x);
    return bits >> 31 ? ~bits : bits | 1u << 31;
}

// By key, equal ones as they came (radix sort of 11, 11 and 10 bits; a digit that all share costs no pass). spare: as
// many, of any content.
inline void sort_by_key(std::span<Keyed> entries, std::span<Keyed> spare) {
    constexpr uint32_t kDigits[3] = {0, 11, 22}, kBuckets = 1u << 11;
    uint32_t first[3][kBuckets] = {};
    for (const Keyed& each : entries)
        for (int d = 0; d < 3; ++d) ++first[d][each.key >> kDigits[d] & (kBuckets - 1)];
    std::span<Keyed> from = entries, to = spare.first(entries.size());
    for (int d = 0; d < 3; ++d) {
        const auto digit = [&](const Keyed& each) { return each.key >> kDigits[d] & (kBuckets - 1); };
        if (entries.empty() || first[d][digit(from[0])] == entries.size()) continue;
        uint32_t sum = 0;
        for (uint32_t& bucket : first[d]) {
            const uint32_t count = bucket;
            bucket = sum;
            sum += count;
        }
        for (const Keyed& each : from) to[first[d][digit(each)]++] = each;
        std::swap(from, to);
    }
    if (from.data() != entries.data()) std::ranges::copy(from, entries.begin());
}

// Numbers, given in ascending order, by their value, the largest first, and of equal ones the smallest number first.
// value[number]: at least 0 and finite. By as many of their bits as fit into a key, over their range, and what these
// leave equal again, over its own.
inline void sort_by_value(std::span<Keyed> entries, std::span<Keyed> spare, std::span<const double> value) {
    constexpr size_t kFew = 32;
    const auto bits = [&](uint32_t number) { return std::bit_cast<uint64_t>(value[number]); };
    uint64_t least = UINT64_MAX, most = 0;
    for (const Keyed& each : entries) {
        const uint64_t b = bits(each.number);
        least = std::min(least, b), most = std::max(most, b);
    }
    if (entries.size() < 2 || least == most) return;
    const int shift = std::max(0, int(std::bit_width(most - least)) - 32);
    for (Keyed& each : entries) each.key = static_cast<uint32_t>((most - bits(each.number)) >> shift);
    sort_by_key(entries, spare);
    if (shift == 0) return;
    for (size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
        while (end < entries.size() && entries[end].key == entries[begin].key) ++end;
        const std::span<Keyed> equal = entries.subspan(begin, end - begin);
        if (equal.size() > kFew)
            sort_by_value(equal, spare, value);
        else if (equal.size() > 1)
            std::ranges::sort(equal, [&](const Keyed& a, const Keyed& b) {
                return bits(a.number) != bits(b.number) ? bits(a.number) > bits(b.number) : a.number < b.number;
            });
    }
}

// Things by the group that each belongs to, those of a group together and in their order: of groups [0, groups),
// begin[g] to begin[g + 1]. each(put) calls put(group, thing) for all, the same ones each time it is called.
template <class T, class Each>
void put_in_groups(uint32_t groups, Array<uint32_t>& begin, Array<T>& things, Each&& each) {
    begin.assign(size_t{groups} + 2, 0);
    each([&](uint32_t g, const T&) { ++begin[g + 2]; });
    for (size_t g = 2; g < begin.size(); ++g) begin[g] += begin[g - 1];
    things.resize(begin.back());
    each([&](uint32_t g, const T& thing) { things[begin[g + 1]++] = thing; });
    begin.pop_back();
}

}  // namespace taut::collision
