// By slot, values that many slots have in common, as equal bodies their mass: each different one is held once, bit by
// bit, with the number of its users. T has words(): an array of all that makes it what it is, as 64-bit words.
#pragma once

#include <utility>

#include "base/hash.h"
#include "base/memory.h"

namespace taut {

template <class T>
class SharedValues {
public:
    explicit SharedValues(Memory& memory) : which_(memory), held_(memory), first_(memory) {}

    const T& operator[](uint32_t slot) const { return held_[which_[slot]].value; }

    // Room for slots, so that add() cannot throw.
    void reserve(size_t slots) {
        reserve_values(1);
        which_.reserve(slots);
    }
    // Room for more values, so that set() cannot throw.
    void reserve_values(size_t more) {
        reserve_more(held_, more + 1);
        while (held_.size() + more + 1 > first_.size()) rehash();
        if (held_.empty()) take({});  // the default one stays the first
    }

    // One more slot, with the default value.
    void add() {
        which_.push_back(0);
        ++held_[0].users;
    }
    void set(uint32_t slot, const T& value) {
        const uint32_t before = std::exchange(which_[slot], take(value));
        drop(before);
    }

    // Room for so many different values in all, so that after reset() none of them throws in set().
    void reserve_as_new(size_t values) {
        if (values + 2 > held_.size()) reserve_values(values + 2 - held_.size());
    }
    bool same(uint32_t slot, uint32_t other) const { return which_[slot] == which_[other]; }
    // As many slots, all with the default value; takes no memory where reserve() made room.
    void reset(size_t slots) {
        held_.clear();
        free_ = kEnd;
        first_.assign(first_.size(), kEnd);
        take({});
        which_.assign(slots, 0);
        held_[0].users += static_cast<uint32_t>(slots);
    }

private:
    struct Held {
        T value;
        uint32_t users = 0;    // 0: free
        uint32_t next = kEnd;  // of those with its hash, or of the free ones
    };
    static constexpr uint32_t kEnd = UINT32_MAX;

    uint32_t& chain_of(const T& value) {
        Hash hash;
        for (const uint64_t word : value.words()) hash.add(word);
        return first_[hash.value() >> 32 & (first_.size() - 1)];
    }
    void link(uint32_t at) {
        uint32_t& first = chain_of(held_[at].value);
        held_[at].next = std::exchange(first, at);
    }
    void rehash() {
        Array<uint32_t> wider(std::max<size_t>(16, 2 * first_.size()), kEnd, first_.get_allocator());
        first_.swap(wider);
        for (uint32_t at = 0; at < held_.size(); ++at)
            if (held_[at].users > 0) link(at);
    }

    uint32_t take(const T& value) {
        for (uint32_t at = chain_of(value); at != kEnd; at = held_[at].next) {
            if (held_[at].value.words() != value.words()) continue;
            ++held_[at].users;
            return at;
        }
        uint32_t at = free_;
        if (at == kEnd) {
            at = static_cast<uint32_t>(held_.size());
            held_.emplace_back();
        } else {
            free_ = held_[at].next;
        }
        held_[at].value = value;
        held_[at].users = 1;
        link(at);
        return at;
    }
    void drop(uint32_t at) {
        if (--held_[at].users > 0) return;
        uint32_t* link = &chain_of(held_[at].value);
        while (*link != at) link = &held_[*link].next;
        *link = held_[at].next;
        held_[at].next = std::exchange(free_, at);
    }

    Array<uint32_t> which_;  // by slot, in held_
    Array<Held> held_;
    uint32_t free_ = kEnd;   // the first of held_ that nobody uses
    Array<uint32_t> first_;  // by hash, in held_: the first of a chain; as many as
                             // a power of two
};

}  // namespace taut
