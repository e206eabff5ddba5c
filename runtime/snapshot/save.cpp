#include "snapshot/snapshot.h"

#include <cstring>

#include "snapshot/format.h"
#include "snapshot/visitor.h"

namespace taut {
namespace {

// whole: as Visitor::kWhole.
template <bool whole>
class Count : public Onlooker<Count<whole>> {
public:
    static constexpr bool kWhole = whole;

    void plain(const void*, size_t size) { bytes_ += size; }
    size_t bytes() const { return bytes_; }

private:
    size_t bytes_ = 0;
};

template <bool whole>
class Save : public Onlooker<Save<whole>> {
public:
    static constexpr bool kWhole = whole;

    explicit Save(std::byte* to) : to_(to) {}

    void plain(const void* field, size_t size) {
        if (size > 0) std::memcpy(to_, field, size);
        to_ += size;
    }

private:
    std::byte* to_;
};

// What it stands on, then the state.
template <class Visitor>
void tell(Visitor& visitor, const World& world) {
    for_used_shapes(world, [&](const UsedShape& shape) { visitor.one(shape); });
    const UsedShape end;
    visitor.one(end);
    describe(visitor, world);
}

}  // namespace

size_t note_size(const World& world) {
    Count<true> count;
    describe(count, world);
    return count.bytes();
}

void save_note(const World& world, std::byte* to) {
    Save<true> saving(to);
    describe(saving, world);
}

size_t snapshot_size(const World& world) {
    Count<false> count;
    tell(count, world);
    return sizeof(SnapshotHeader) + count.bytes();
}

void save(const World& world, std::span<std::byte> to) {
    Save<false> saving(to.data() + sizeof(SnapshotHeader));
    tell(saving, world);
    SnapshotHeader header = header_of(world, to.size());
    header.checksum = checksum(header, to.subspan(sizeof header));
    std::memcpy(to.data(), &header, sizeof header);
}

}  // namespace taut
