// A list that grows without moving what it holds, in the world's memory: an array would copy all of it in the very
// frame that adds the most.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>

#include "base/memory.h"

namespace taut {

// Goes through what an index finds.
template <class List, class Element>
struct IndexIterator {
    using value_type = std::remove_const_t<Element>;
    using difference_type = std::ptrdiff_t;
    using reference = Element&;
    using pointer = Element*;
    using iterator_category = std::random_access_iterator_tag;

    List* of = nullptr;
    size_t index = 0;

    Element& operator*() const { return (*of)[index]; }
    Element* operator->() const { return &**this; }
    Element& operator[](difference_type n) const { return *(*this + n); }
    IndexIterator& operator+=(difference_type n) {
        index += static_cast<size_t>(n);
        return *this;
    }
    IndexIterator& operator-=(difference_type n) { return *this += -n; }
    IndexIterator& operator++() { return *this += 1; }
    IndexIterator& operator--() { return *this -= 1; }
    IndexIterator operator++(int) { return std::exchange(*this, *this + 1); }
    IndexIterator operator--(int) { return std::exchange(*this, *this - 1); }
    friend IndexIterator operator+(IndexIterator at, difference_type n) { return at += n; }
    friend IndexIterator operator+(difference_type n, IndexIterator at) { return at += n; }
    friend IndexIterator operator-(IndexIterator at, difference_type n) { return at -= n; }
    friend difference_type operator-(const IndexIterator& one, const IndexIterator& other) {
        return static_cast<difference_type>(one.index - other.index);
    }
    bool operator==(const IndexIterator&) const = default;
    auto operator<=>(const IndexIterator& other) const { return index <=> other.index; }
};

template <class T>
class SegmentedArray {
public:
    explicit SegmentedArray(Memory& memory) : allocator_(memory), segment_(memory) {}
    ~SegmentedArray() {
        for (size_t i = 0; i < segment_.size(); i += kTogether)
            allocator_.deallocate(segment_[i].first, kTogether * kSegment);
    }
    SegmentedArray(const SegmentedArray&) = delete;
    SegmentedArray& operator=(const SegmentedArray&) = delete;

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    size_t capacity() const { return segment_.size() * kSegment; }
    T& operator[](size_t index) { return segment_[index / kSegment].first[index % kSegment]; }
    const T& operator[](size_t index) const { return segment_[index / kSegment].first[index % kSegment]; }

    // Throws std::bad_alloc and stays as it is, but for room that it got.
    void reserve(size_t size) {
        while (capacity() < size) {
            reserve_more(segment_, kTogether);
            T* const piece = allocator_.allocate(kTogether * kSegment);
            for (size_t i = 0; i < kTogether; ++i) segment_.push_back({piece + i * kSegment});
        }
    }
    // Throws as reserve().
    T& emplace_back() {
        reserve(size_ + 1);
        return *std::construct_at(&(*this)[size_++]);
    }
    // New ones as T() is. Throws as reserve().
    void resize(size_t size) {
        reserve(size);
        for (; size_ < size; ++size_) std::construct_at(&(*this)[size_]);
        size_ = size;
    }
    // Moves what is from one index to another to where it begins at `to`; the two places may overlap.
    void shift(size_t from, size_t end, size_t to) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto move = [&](size_t source, size_t target, size_t count) {
            if (count > 0) std::memmove(&(*this)[target], &(*this)[source], count * sizeof(T));
        };
        if (to <= from) {
            for (size_t count = 0; from < end && to < from; from += count, to += count) {
                count = std::min({end - from, kSegment - from % kSegment, kSegment - to % kSegment});
                move(from, to, count);
            }
            return;
        }
        const auto before = [](size_t index) { return (index - 1) % kSegment + 1; };
        for (size_t to_end = to + (end - from), count = 0; end > from; end -= count, to_end -= count) {
            count = std::min({end - from, before(end), before(to_end)});
            move(end - count, to_end - count, count);
        }
    }
    // Gives back what it does not need, if it is too large.
    void trim() noexcept {
        if (!is_too_large<T>(size_, capacity())) return;
        const size_t needed = (with_slack(size_) + kSegment * kTogether - 1) / (kSegment * kTogether) * kTogether;
        for (size_t i = needed; i < segment_.size(); i += kTogether)
            allocator_.deallocate(segment_[i].first, kTogether * kSegment);
        segment_.resize(needed);
    }
    template <class Condition>
    void erase_if(Condition&& condition) {
        size_ = static_cast<size_t>(std::remove_if(begin(), end(), condition) - begin());
    }

    auto begin() { return IndexIterator<SegmentedArray, T>{this, 0}; }
    auto end() { return IndexIterator<SegmentedArray, T>{this, size_}; }
    auto begin() const { return IndexIterator<const SegmentedArray, const T>{this, 0}; }
    auto end() const { return IndexIterator<const SegmentedArray, const T>{this, size_}; }

private:
    static_assert(std::is_trivially_destructible_v<T>);
    // A power of two is found fast; so many at once come in a size of which Memory wastes little.
    static constexpr size_t kSegment = 16;
    static constexpr size_t kTogether = std::max<size_t>(32768 / (kSegment * sizeof(T)), 1);

    struct Segment {
        T* first;
    };

    HostAllocator<T> allocator_;
    Array<Segment> segment_;
    size_t size_ = 0;
};

}  // namespace taut
