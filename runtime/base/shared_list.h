// A list that the threads of a loop add to at once, in no order: what is made of it may depend on none.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>

#include "base/memory.h"

namespace taut {

template <class T>
class SharedList {
public:
    explicit SharedList(Memory& memory) : room_(memory) {}

    void clear() { count_ = 0; }
    // Whether there was no room for all that was added since: all is to be added again, and finds room.
    bool lacked_room() {
        if (count_ <= room_.size()) return false;
        const size_t wanted = count_;
        room_.clear();
        reserve_more(room_, wanted);
        room_.resize(room_.capacity());
        return true;
    }
    // By any thread.
    void add(std::span<const T> some) {
        const size_t at = std::atomic_ref(count_).fetch_add(some.size(), std::memory_order_relaxed);
        if (at + some.size() <= room_.size()) std::ranges::copy(some, room_.begin() + static_cast<ptrdiff_t>(at));
    }
    std::span<const T> all() const { return {room_.data(), count_}; }

private:
    UnsetArray<T> room_;
    size_t count_ = 0;
};

// What a thread adds to one, some at a time.
template <class T>
class SharedListPart {
public:
    explicit SharedListPart(SharedList<T>& list) : list_(list) {}
    ~SharedListPart() { list_.add({some_, count_}); }
    SharedListPart(const SharedListPart&) = delete;
    SharedListPart& operator=(const SharedListPart&) = delete;

    void add(const T& one) {
        some_[count_] = one;
        if (++count_ < kSome) return;
        list_.add({some_, count_});
        count_ = 0;
    }

private:
    static constexpr size_t kSome = 32;

    SharedList<T>& list_;
    T some_[kSome];
    size_t count_ = 0;
};

}  // namespace taut
