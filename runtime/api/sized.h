// Structs that programs of older headers hand over or receive. A struct grows at its end alone, so that an older one is
// the beginning of ours: of a shorter def the rest takes its defaults, of what is read the beginning is written. What
// lies inside of another struct does not grow.
#pragma once

#include <cstddef>
#include <cstring>

#include "api/access.h"

namespace taut {

// A def as this library knows it; init: the one that writes its defaults. def.struct_size becomes ours.
template <class Def>
bool take_def(Check& check, const Def* given, void (*init)(Def*), Def& def, const char* name = "def") {
    if (!check.pointer(name, given) || !check.struct_size(given->struct_size, sizeof(Def), alignof(Def))) return false;
    init(&def);
    std::memcpy(static_cast<void*>(&def), given, given->struct_size);
    def.struct_size = sizeof def;
    return true;
}

// To a host that said how long its struct is, in its struct_size; checked before.
template <class Def>
void give_def(const Def& def, Def* out) {
    const uint32_t size = out->struct_size;
    std::memcpy(static_cast<void*>(out), &def, size);
    out->struct_size = size;
}

// A host's array of records that are as long as its header says: what it does not know is left out, what we do not
// know is zero.
template <class Record>
class RecordOut {
public:
    class One {
    public:
        One(std::byte* at, size_t size) : at_(at), size_(size) {}
        One(const One&) = delete;
        void operator=(const Record& record) const {
            const size_t known = std::min(size_, sizeof record);
            std::memcpy(at_, &record, known);
            std::memset(at_ + known, 0, size_ - known);
            if constexpr (requires { record.struct_size; }) {
                const uint32_t size = static_cast<uint32_t>(size_);
                std::memcpy(at_ + offsetof(Record, struct_size), &size, sizeof size);
            }
        }

    private:
        std::byte* at_;
        size_t size_;
    };

    RecordOut(Record* first, size_t size) : first_(reinterpret_cast<std::byte*>(first)), size_(size) {}
    operator const void*() const { return first_; }
    One operator*() const { return {first_, size_}; }
    One operator[](size_t i) const { return {first_ + i * size_, size_}; }

    // As many as count, in an order; of those that less() compares no more is looked at than the host knows.
    template <class Less>
    void sort(size_t count, Less&& less) const;

private:
    Record read(size_t i) const {
        Record record{};
        std::memcpy(static_cast<void*>(&record), first_ + i * size_, std::min(size_, sizeof record));
        return record;
    }

    std::byte* first_;
    size_t size_;
};

// Heapsort: where records are not an array of ours.
template <class Record>
template <class Less>
void RecordOut<Record>::sort(size_t count, Less&& less) const {
    const auto swap = [&](size_t i, size_t k) {
        std::swap_ranges(first_ + i * size_, first_ + (i + 1) * size_, first_ + k * size_);
    };
    const auto sift = [&](size_t root, size_t end) {
        for (size_t child; (child = 2 * root + 1) < end; root = child) {
            if (child + 1 < end && less(read(child), read(child + 1))) ++child;
            if (!less(read(root), read(child))) return;
            swap(root, child);
        }
    };
    for (size_t i = count / 2; i-- > 0;) sift(i, count);
    for (size_t end = count; end-- > 1;) {
        swap(0, end);
        sift(0, end);
    }
}

// The defaults that fill(def) writes, as far as the host's def is long. A longer one keeps its size and is refused
// where it is used.
template <class Def, class Fill>
void give_defaults(Def* out, uint32_t size, Fill&& fill) {
    if (!out) return;
    Def own{};
    fill(own);
    *RecordOut<Def>(out, size) = own;
}

}  // namespace taut
