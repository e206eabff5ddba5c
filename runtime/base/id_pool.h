// Slots with generations: the index half of a handle. The smallest free slot is taken first, so that what is created
// stands in the order of creation whatever was destroyed before, in whatever order: steps go by slots. A slot whose
// generations are used up is retired, so that a stale handle can never come back to life.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "base/describe.h"
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
            ++live_;
            return static_cast<uint32_t>(generation_.size() - 1);
        }
        std::pop_heap(free_.begin(), free_.end(), std::greater<>());
        const uint32_t index = free_.back();
        free_.pop_back();
        ++live_;
        ++generation_[index];  // even: free, odd: live
        return index;
    }
    void destroy(uint32_t index) {
        --live_;
        ++generation_[index];
        if (generation_[index] >= kMaxGeneration - 1) return;
        free_.push_back(index);
        std::push_heap(free_.begin(), free_.end(), std::greater<>());
    }
    bool live(uint32_t index) const { return index < generation_.size() && (generation_[index] & 1); }
    bool live(uint32_t index, uint32_t generation) const { return live(index) && generation_[index] == generation; }
    uint32_t generation(uint32_t index) const { return generation_[index]; }
    uint32_t slots() const { return static_cast<uint32_t>(generation_.size()); }
    uint32_t count() const { return live_; }

    // Only generations are listed: which slots are free follows from them. Room for that, before; and after.
    template <class Visitor, Like<IdPool> Of>
    friend void describe(Visitor& visitor, Of& of) {
        TAUT_ASIDE(visitor, of.generation_);
    }
    void reserve_free() { free_.reserve(generation_.capacity()); }
    void find_free() {
        live_ = 0;
        free_.clear();
        for (uint32_t index = 0; index < slots(); ++index) {
            if (live(index))
                ++live_;
            else if (generation_[index] < kMaxGeneration - 1)
                free_.push_back(index);  // in ascending order they are a heap
        }
    }

private:
    static size_t grown(size_t size, size_t capacity) { return size < capacity ? capacity : with_slack(capacity) + 16; }

    uint32_t live_ = 0;
    Array<uint32_t> generation_;  // per slot; odd while live
    Array<uint32_t> free_;        // a heap, the smallest first; capacity kept at least the number of slots
};

}  // namespace taut
