// A list that grows without moving what it holds, in the world's memory: an array would copy all of it in the very
// frame that adds the most.
#pragma once

#include <algorithm>
#include <memory>
#include <type_traits>

#include "base/memory.h"

namespace taut {

// Goes through what an index finds.
template <class List, class Element>
struct IndexIterator {
    List* of;
    size_t index;

    Element& operator*() const { return (*of)[index]; }
    IndexIterator& operator++() {
        ++index;
        return *this;
    }
    bool operator==(const IndexIterator&) const = default;
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
