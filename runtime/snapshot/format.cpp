#include "snapshot/format.h"

#include <algorithm>
#include <cstring>

#include "base/hash.h"
#include "snapshot/visitor.h"

namespace taut {
namespace {

// Names and sizes of all fields, of lists those of an element.
class Layout : public Visitor<Layout> {
public:
    explicit Layout(Memory& memory) : memory_(memory) {}

    using Visitor::visit;

    template <class... Fields>
    void fields(const char* names, Fields&&... each) {
        for (const char* c = names; *c; ++c) hash_.add(static_cast<uint64_t>(*c));
        (one(each), ...);
    }
    void plain(const void*, size_t size) { hash_.add(uint64_t{size}); }
    template <class T>
    void visit(const Array<T>&) {
        element<T>();
    }
    template <class T>
    void visit(const SegmentedArray<T>&) {
        element<T>();
    }
    template <class T, class Each>
    void ordered(const SegmentedArray<T>&, Each&&) {
        element<T>();
    }
    void visit(const ConstraintType* const&) { hash_.add(uint64_t{constraint_types().size()}); }
    void visit(const ElementType* const&) { hash_.add(uint64_t{element_types().size()}); }
    template <class... Columns>
    void rows(const char* names, const IdPool&, const Columns&... columns) {
        fields(names);
        (column(columns), ...);
    }

    uint64_t value() const { return hash_.value(); }

private:
    template <class T>
    void element() {
        if constexpr (Nested<T>)
            as_const(T(memory_));
        else
            as_const(T{});
    }
    template <class T>
    void as_const(const T& made) {
        one(made);
    }
    template <class T>
    void column(const Array<T>&) {
        element<T>();
    }
    template <class T>
    void column(const SharedValues<T>&) {
        element<T>();
    }
    template <class List>
    void column(const OrNone<List>&) {
        element<typename List::value_type>();
    }

    Memory& memory_;
    Hash hash_;
};

uint64_t layout_of(const World& world) {
    Memory unused(world.def.hooks);  // empty lists take none
    Layout layout(unused);
    describe(layout, world);
    return layout.value();
}

}  // namespace

SnapshotHeader header_of(const World& world, size_t size) {
    static const uint64_t layout = layout_of(world);  // the same of all worlds
    return {{'t', 'a', 'u', 't', 's', 'n', 'a', 'p'}, kSnapshotVersion, world.id, layout, size, 0};
}

// In four runs beside each other: each waits for the word before.
uint64_t checksum(const SnapshotHeader& header, std::span<const std::byte> rest) {
    Hash run[4];
    const auto word_at = [&](size_t at) {
        uint64_t word = 0;
        std::memcpy(&word, rest.data() + at, std::min(sizeof word, rest.size() - at));
        return word;
    };
    size_t at = 0;
    for (; at + sizeof(uint64_t[4]) <= rest.size(); at += sizeof(uint64_t[4]))
        for (size_t k = 0; k < 4; ++k) run[k].add(word_at(at + k * sizeof(uint64_t)));
    for (; at < rest.size(); at += sizeof(uint64_t)) run[0].add(word_at(at));
    Hash all;
    uint64_t first;
    std::memcpy(&first, header.magic, sizeof first);
    for (const uint64_t word : {first, uint64_t{header.version} << 32 | header.world, header.layout, header.size})
        all.add(word);
    for (const Hash& each : run) all.add(each.value());
    return all.value();
}

}  // namespace taut
