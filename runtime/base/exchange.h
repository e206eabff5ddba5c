// What leaves a sorted list and what comes into it, in place. An element moves once at most, in one run with those
// beside it: between two places up to which as many went as came, the others stay. Such stretches are settled one by
// one; where something comes first, from back to front, else from front to back.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/memory.h"
#include "base/segmented_array.h"

namespace taut {

// Moves what is from one index to another to where it begins at `to`; the two places may overlap.
template <class T>
void shift(SegmentedArray<T>& list, size_t from, size_t end, size_t to) {
    list.shift(from, end, to);
}
template <class T>
void shift(Array<T>& list, size_t from, size_t end, size_t to) {
    const auto at = [&](size_t index) { return list.begin() + static_cast<ptrdiff_t>(index); };
    if (to <= from)
        std::move(at(from), at(end), at(to));
    else
        std::move_backward(at(from), at(end), at(to + (end - from)));
}

// Keys that leave a list, which has them, and keys that come, which it has not; both sorted.
struct Changes {
    std::span<const uint64_t> gone, fresh;

    size_t count() const { return gone.size() + fresh.size(); }
    bool fresh_is_first() const { return !fresh.empty() && (gone.empty() || fresh.front() < gone.front()); }
    bool fresh_is_last() const { return !fresh.empty() && (gone.empty() || fresh.back() > gone.back()); }
};

// Of a list without equal keys: key_of(element) tells them, make(key) gives a new element.
template <class List, class KeyOf, class Make>
class Exchange {
public:
    Exchange(List& list, const Changes& changes, KeyOf key_of, Make make)
        : list_(list), size_(list.size()), left_(changes), key_of_(key_of), make_(make) {}

    // Throws std::bad_alloc, and does nothing, if the list has no room for what it grows by.
    void run() {
        const size_t size = size_ + left_.fresh.size() - left_.gone.size();
        if (size > size_) list_.resize(size);
        while (left_.count() > 0) {
            const Changes stretch = take_stretch();
            if (stretch.fresh_is_first())
                settle_from_back(stretch);
            else
                settle_from_front(stretch);
        }
        if (size < size_) list_.resize(size);
    }

private:
    // Up to where as many went as came, else all that is left.
    Changes take_stretch() {
        Changes rest = left_;
        do {
            auto& next = rest.fresh_is_first() ? rest.fresh : rest.gone;
            next = next.subspan(1);
        } while (left_.gone.size() - rest.gone.size() != left_.fresh.size() - rest.fresh.size() && rest.count() > 0);
        const Changes stretch = {left_.gone.first(left_.gone.size() - rest.gone.size()),
                                 left_.fresh.first(left_.fresh.size() - rest.fresh.size())};
        left_ = rest;
        return stretch;
    }

    // `to` is at most where elements are taken from.
    void settle_from_front(Changes stretch) {
        size_t from = done_, to = done_;
        while (stretch.count() > 0) {
            const bool comes = stretch.fresh_is_first();
            auto& next = comes ? stretch.fresh : stretch.gone;
            const uint64_t key = next.front();
            next = next.subspan(1);
            const size_t place = place_after(from, key);
            shift(list_, from, place, to);
            to += place - from;
            from = comes ? place : place + 1;
            if (comes) list_[to++] = make_(key);
        }
        if (to < from) shift(list_, from, size_, to);
        done_ = from;
    }

    // `to` is at least where elements are taken from.
    void settle_from_back(Changes stretch) {
        const bool is_even = stretch.gone.size() == stretch.fresh.size();
        size_t end = is_even ? place_after(done_, stretch.gone.back()) + 1 : size_;
        size_t to = end + stretch.fresh.size() - stretch.gone.size();
        done_ = end;
        while (stretch.count() > 0) {
            const bool comes = stretch.fresh_is_last();
            auto& next = comes ? stretch.fresh : stretch.gone;
            const uint64_t key = next.back();
            next = next.first(next.size() - 1);
            const size_t place = place_before(end, key), from = comes ? place : place + 1;
            to -= end - from;
            shift(list_, from, end, to);
            end = place;
            if (comes) list_[--to] = make_(key);
        }
    }

    bool is_less(size_t index, uint64_t key) const { return key_of_(list_[index]) < key; }
    // Of [begin, end), whose elements before some index are less than a key and no others, that index.
    size_t place_in(size_t begin, size_t end, uint64_t key) const {
        while (begin < end) {
            const size_t middle = begin + (end - begin) / 2;
            if (is_less(middle, key))
                begin = middle + 1;
            else
                end = middle;
        }
        return begin;
    }
    // Where the keys begin that are not less than this one; near `from`, as a rule.
    size_t place_after(size_t from, uint64_t key) const {
        size_t step = 1;
        for (; from + step <= size_ && is_less(from + step - 1, key); step *= 2) from += step;
        return place_in(from, std::min(from + step - 1, size_), key);
    }
    // The same; near `end`, as a rule.
    size_t place_before(size_t end, uint64_t key) const {
        size_t step = 1;
        for (; end >= step && !is_less(end - step, key); step *= 2) end -= step;
        return place_in(end >= step ? end - step + 1 : 0, end, key);
    }

    List& list_;
    size_t size_;  // as it was
    Changes left_;
    KeyOf key_of_;
    Make make_;
    size_t done_ = 0;  // elements from the front on that are settled
};

}  // namespace taut
