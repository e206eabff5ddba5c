// Slots with generations: the index half of a handle. Slots are reused last-freed first; a slot whose
// generations are used up is retired, so that a stale handle can never come back to life.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace taut {

class IdPool {
public:
    static constexpr uint32_t kMaxGeneration = 0xffff;

    explicit IdPool(Memory& memory) : generation_(memory), free_(memory) {}

    // Makes room so that the next create() cannot throw.
    void reserve_one() {
        if (free_.empty()) {
            generation_.reserve(grown(generation_.size(), generation_.capacity()));
            free_.reserve(generation_.capacity());
        }
    }
    uint32_t create() {
        if (free_.empty()) {
            generation_.push_back(1);
            return static_cast<uint32_t>(generation_.size() - 1);
        }
        const uint32_t index = free_.back();
        free_.pop_back();
        ++generation_[index];  // even: free, odd: live
        return index;
    }
    void destroy(uint32_t index) {
        ++generation_[index];
        if (generation_[index] < kMaxGeneration - 1) free_.push_back(index);
    }
    bool live(uint32_t index) const { return index < generation_.size() && (generation_[index] & 1); }
    bool live(uint32_t index, uint32_t generation) const { return live(index) && generation_[index] == generation; }
    uint32_t generation(uint32_t index) const { return generation_[index]; }
    uint32_t slots() const { return static_cast<uint32_t>(generation_.size()); }
    uint32_t count() const {
        uint32_t n = 0;
        for (uint32_t g : generation_) n += g & 1;
        return n;
    }

private:
    static size_t grown(size_t size, size_t capacity) { return size < capacity ? capacity : 2 * capacity + 16; }

    Array<uint32_t> generation_;  // per slot; odd while live
    Array<uint32_t> free_;        // capacity kept at least the number of slots
};

}  // namespace taut
