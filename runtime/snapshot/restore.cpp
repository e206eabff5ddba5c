// A restoration goes through the bytes twice. First it reads without keeping, sees that all is there and makes room in
// the world's lists for what will be in them: this may fail, and changes nothing. Then it reads once more, for good.
#include <cstring>
#include <optional>
#include <tuple>
#include <utility>

#include "base/result.h"
#include "publish/publish.h"
#include "snapshot/format.h"
#include "snapshot/snapshot.h"
#include "snapshot/undo.h"
#include "snapshot/visitor.h"

namespace taut {
namespace {

struct Damaged {};

// The bytes that are still to be read.
struct Source {
    const std::byte* at;
    const std::byte* end;

    size_t left() const { return static_cast<size_t>(end - at); }
    const std::byte* skip(size_t size) {
        if (size > left()) throw Damaged();
        return std::exchange(at, at + size);
    }
    void take(void* to, size_t size) {
        const std::byte* const from = skip(size);
        if (size > 0) std::memcpy(to, from, size);
    }
    // Each element takes a byte at least.
    uint32_t take_count() {
        uint32_t count;
        take(&count, sizeof count);
        if (count > left()) throw Damaged();
        return count;
    }
};

// Lists of what has lists itself, read in full beforehand, and where what follows them begins.
template <class T>
struct Staged {
    explicit Staged(Memory& memory) : list(memory) {}

    Array<T> list;
    const std::byte* end = nullptr;
};
using Staging = std::tuple<Staged<ElementSet>, Staged<Cable>, Staged<Soft>, Staged<Block>>;

template <class Self>
class Reader : public Visitor<Self> {
public:
    explicit Reader(Source& source) : source_(source) {}

    using Visitor<Self>::visit;

    void visit(const ConstraintType*& type) {
        const auto types = constraint_types();
        uint8_t index;
        this->self().plain(&index, sizeof index);
        type = index < types.size() ? types[index] : nullptr;
    }
    void visit(const ElementType*& type) {
        const auto types = element_types();
        uint8_t index;
        this->self().plain(&index, sizeof index);
        type = index < types.size() ? types[index] : nullptr;
    }

protected:
    Source& source_;
};

// whole: as Visitor::kWhole.
template <bool whole>
class Restore : public Reader<Restore<whole>> {
    using Base = Reader<Restore>;
    using Base::source_;

public:
    static constexpr bool kWhole = whole;

    Restore(Source& source, Staging& staging) : Base(source), staging_(staging) {}

    using Base::element_of;
    using Base::one;
    using Base::visit;

    void plain(void* field, size_t size) { source_.take(field, size); }
    void visit(IdPool& ids) {
        describe(*this, ids);
        ids.find_free();
    }
    template <class T>
    void visit(Array<T>& list) {
        if constexpr (Nested<T>) {
            take_staged(list);
        } else {
            list.clear();
            list.resize(source_.take_count());
            if constexpr (Base::template by_bytes<T>())
                source_.take(list.data(), list.size() * sizeof(T));
            else
                for (T& each : list) one(each);
        }
    }
    template <class T>
    void visit(SegmentedArray<T>& list) {
        list.resize(0);
        list.resize(source_.take_count());
        for (T& each : list) element_of(each);
    }
    template <class T, class Each>
    void ordered(SegmentedArray<T>& list, Each&&) {
        visit(list);
    }
    template <class... Columns>
    void rows(const char*, const IdPool& ids, Columns&... columns) {
        slots_ = ids.slots();
        (begin(columns), ...);
        uint32_t before = kNone;
        for (uint32_t slot = 0; slot < ids.slots(); ++slot) {
            if (!ids.live(slot)) continue;
            (element(columns, slot, before), ...);
            before = slot;
        }
    }

private:
    template <class T>
    void take_staged(Array<T>& list) {
        Staged<T>& staged = std::get<Staged<T>>(staging_);
        list.swap(staged.list);
        source_.at = staged.end;
    }

    template <class T>
    void begin(Array<T>& column) {
        if constexpr (Nested<T>) {
            take_staged(column);
        } else {
            column.clear();
            column.resize(slots_);
        }
    }
    template <class T>
    void begin(SharedValues<T>& column) {
        column.reset(slots_);
    }
    template <class List>
    void begin(OrNone<List>& column) {
        column.array.clear();
    }

    template <class T>
    void element(Array<T>& column, uint32_t slot, uint32_t) {
        if constexpr (!Nested<T>) element_of(column[slot]);
    }
    template <class T>
    void element(SharedValues<T>& column, uint32_t slot, uint32_t before) {
        bool same;
        plain(&same, sizeof same);
        T value = before == kNone ? T{} : column[before];
        if (!same) element_of(value);
        column.set(slot, value);
    }
    template <class List>
    void element(OrNone<List>& column, uint32_t slot, uint32_t) {
        bool any;
        plain(&any, sizeof any);
        if (!any) return;
        typename List::value_type value{};
        element_of(value);
        if (column.array.empty()) column.array.resize(slots_);
        column.array[slot] = value;
    }

    Staging& staging_;
    uint32_t slots_ = 0;  // of the rows that are read
};

template <bool whole>
class MakeRoom : public Reader<MakeRoom<whole>> {
    using Base = Reader<MakeRoom>;
    using Base::source_;

public:
    static constexpr bool kWhole = whole;

    MakeRoom(Source& source, Staging& staging) : Base(source), staging_(staging), restore_(source, staging) {}

    using Base::visit;

    void plain(const void*, size_t size) { source_.skip(size); }
    void visit(IdPool& ids) {
        Source generations = source_;
        describe(*this, ids);
        ids.reserve_free();
        slots_[pools_++] = {&ids, generations.take_count(), generations.at};
    }
    template <class T>
    void visit(Array<T>& list) {
        const uint32_t count = source_.take_count();
        if constexpr (Nested<T>) {
            stage<T>(count, [](uint32_t) { return true; });
        } else {
            list.reserve(count);
            try_out<T>(count);
        }
    }
    template <class T>
    void visit(SegmentedArray<T>& list) {
        const uint32_t count = source_.take_count();
        list.reserve(count);
        try_out<T>(count);
    }
    template <class T, class Each>
    void ordered(SegmentedArray<T>& list, Each&&) {
        visit(list);
    }
    template <class... Columns>
    void rows(const char*, const IdPool& ids, Columns&... columns) {
        const Slots& slots = slots_of(ids);
        (reserve(columns, slots), ...);
        bool first = true;
        for (uint32_t slot = 0; slot < slots.count; ++slot) {
            if (!slots.live(slot)) continue;
            (element(columns, first, slots), ...);
            first = false;
        }
    }

    uint32_t slots(const IdPool& ids) const { return slots_of(ids).count; }

private:
    // Those of a pool as they will be.
    struct Slots {
        const IdPool* of = nullptr;
        uint32_t count = 0;
        const std::byte* generations = nullptr;

        bool live(uint32_t slot) const {
            uint32_t generation;
            std::memcpy(&generation, generations + slot * sizeof generation, sizeof generation);
            return generation & 1;
        }
    };

    const Slots& slots_of(const IdPool& ids) const { return *std::ranges::find(slots_, &ids, &Slots::of); }
    template <class T>
    void try_out(uint32_t count = 1) {
        if constexpr (Base::template by_bytes<T>()) {
            source_.skip(count * sizeof(T));
        } else {
            for (uint32_t i = 0; i < count; ++i) {
                T value{};
                restore_.one(value);
            }
        }
    }
    template <class T, class Lives>
    void stage(uint32_t count, Lives&& lives) {
        Staged<T>& staged = std::get<Staged<T>>(staging_);
        staged.list.reserve(count);
        for (uint32_t i = 0; i < count; ++i) {
            T& made = staged.list.emplace_back(*staged.list.get_allocator().memory);
            if (lives(i)) restore_.one(made);
        }
        staged.end = source_.at;
    }

    template <class T>
    void reserve(Array<T>& column, const Slots& slots) {
        if constexpr (Nested<T>)
            stage<T>(slots.count, [&](uint32_t slot) { return slots.live(slot); });
        else
            column.reserve(slots.count);
    }
    template <class T>
    void reserve(SharedValues<T>& column, const Slots& slots) {
        column.reserve(slots.count);
    }
    template <class List>
    void reserve(OrNone<List>&, const Slots&) {}

    template <class T>
    void element(Array<T>&, bool, const Slots&) {
        if constexpr (!Nested<T>) try_out<T>();
    }
    template <class T>
    void element(SharedValues<T>& column, bool first, const Slots&) {
        if (first) values_ = 0;
        bool same;
        source_.take(&same, sizeof same);
        if (same) return;
        try_out<T>();
        column.reserve_as_new(++values_);
    }
    template <class List>
    void element(OrNone<List>& column, bool, const Slots& slots) {
        bool any;
        source_.take(&any, sizeof any);
        if (!any) return;
        try_out<typename List::value_type>();
        column.array.reserve(slots.count);
    }

    Staging& staging_;
    Restore<whole> restore_;
    std::array<Slots, 12> slots_{};
    size_t pools_ = 0;
    size_t values_ = 0;  // of the shared ones that are read
};

// What follows from the state: room for it, and, once the state is there, it.
void reserve_derived(World& world, uint32_t nodes, uint32_t colliders) {
    world.system.make_room(nodes, 0);
    world.pairs.make_room(colliders);
    reserve_more(world.pairs.grains.gone, colliders);
    reserve_more(world.pairs.surfaces.gone, colliders);
    world.broadphase.reserve_tree();
    world.partition.reserve_nodes(nodes);
    reserve_links(world.pairs);
}
void derive(World& world) {
    const auto lives = [&](uint32_t collider) { return world.colliders.ids.live(collider); };
    for (Array<ShapeRecord>* shapes : {&world.shapes.record, &world.shapes.inner.record})
        for (ShapeRecord& shape : *shapes) shape.users = 0;
    world.colliders.chained = 0;
    for (uint32_t collider = 0; collider < world.colliders.record.size(); ++collider) {
        if (!lives(collider)) continue;
        const Collider& record = world.colliders.record[collider];
        ++world.shapes[record.shape].users;
        world.colliders.chained += record.next != kNone;
    }
    world.broadphase.rebuild(
        [&](uint32_t c) { return lives(c) && world.nodes.enabled(world.colliders.record[c].node); });
    link_records(world.pairs);
    world.partition.forget_frame(world.nodes.slots());
    world.nodes.load.clear();
    world.nodes.forget_active();
    world.nodes.movable = 0;
    for (const NodeInfo& info : world.nodes.info)
        world.nodes.movable += info.kind != NodeKind::dead && info.kind != NodeKind::fixed;
    for (SurfaceMesh& mesh : world.softs.mesh) mesh.version = 0;  // of other triangles, maybe
}

// What steps told the host.
auto told(World& w) {
    return std::tie(w.contact_begin, w.contact_persist, w.contact_end, w.contact_points, w.hits, w.moved, w.quarantined,
                    w.broken, w.detached, w.torn, w.yielded, w.fell_asleep, w.woke, w.sensors.enter, w.sensors.leave,
                    w.frozen);
}
template <class... Lists>
std::tuple<Lists...> made_like(const std::tuple<Lists&...>&, Memory& memory) {
    return {Lists(memory)...};
}
using Told = decltype(made_like(told(std::declval<World&>()), std::declval<Memory&>()));

template <class Act, size_t... kIndex>
void for_each_two(auto& one, auto& other, Act&& act, std::index_sequence<kIndex...>) {
    (act(std::get<kIndex>(one), std::get<kIndex>(other)), ...);
}
// act(list of the world, noted list)
template <class Act>
void for_told(World& world, Told& noted, Act&& act) {
    auto lists = told(world);
    for_each_two(lists, noted, act, std::make_index_sequence<std::tuple_size_v<Told>>());
}

// TAUT_OK: it is a snapshot of this world, and undamaged.
taut_result check(const char* call, const World& world, std::span<const std::byte> from) {
    const SnapshotHeader own = header_of(world, from.size());
    SnapshotHeader header;
    if (from.size() < sizeof header)
        return refuse(TAUT_INVALID_ARGUMENT, "%s: bytes is %zu, less than of any snapshot", call, from.size());
    std::memcpy(&header, from.data(), sizeof header);
    if (std::memcmp(header.magic, own.magic, sizeof header.magic) != 0)
        return refuse(TAUT_INVALID_ARGUMENT, "%s: buffer holds no snapshot", call);
    if (header.version != own.version || header.layout != own.layout)
        return refuse(TAUT_UNSUPPORTED, "%s: the snapshot is of another version of the library", call);
    if (header.size != own.size)
        return refuse(TAUT_INVALID_ARGUMENT, "%s: bytes is %zu, expected %llu", call, from.size(),
                      static_cast<unsigned long long>(header.size));
    if (header.checksum != checksum(header, from.subspan(sizeof header)))
        return refuse(TAUT_INVALID_ARGUMENT, "%s: the snapshot is damaged: its checksum differs", call);
    if (header.world != own.world) return refuse(TAUT_FOREIGN_HANDLE, "%s: the snapshot is of another world", call);
    return TAUT_OK;
}

// Whether the shapes are there that it stands on.
taut_result check_shapes(const char* call, const World& world, Source& source) {
    for (;;) {
        UsedShape shape;
        source.take(&shape, sizeof shape);
        if (shape.slot == kNone) return TAUT_OK;
        if (!world.shapes.ids.live(shape.slot, shape.generation))
            return refuse(TAUT_STALE_HANDLE, "%s: shape %#llx, which bodies had when it was saved, is gone", call,
                          static_cast<unsigned long long>(pack_handle({shape.slot, shape.generation, world.id})));
    }
}

}  // namespace

taut_result restore(const char* call, World& world, std::span<const std::byte> from) {
    if (const taut_result whole = check(call, world, from); whole != TAUT_OK) return whole;
    const Memory::Keeping keeping(world.memory);  // what is staged takes the same again and again
    try {
        Source source{from.data() + sizeof(SnapshotHeader), from.data() + from.size()};
        if (const taut_result there = check_shapes(call, world, source); there != TAUT_OK) return there;
        Source again = source;
        Staging staging{world.memory, world.memory, world.memory, world.memory};
        MakeRoom<false> room(source, staging);
        describe(room, world);
        if (source.left() > 0) throw Damaged();
        reserve_derived(world, room.slots(world.nodes.ids), room.slots(world.colliders.ids));
        Restore<false> reading(again, staging);
        describe(reading, world);
        derive(world);
        world.frozen.clear();
        forget_events(world);
    } catch (const Damaged&) {
        return refuse(TAUT_INVALID_ARGUMENT, "%s: the snapshot is damaged", call);
    }
    return TAUT_OK;
}

struct Undo::Note {
    Note(World& world, Memory& memory)
        : bytes(memory), staging{memory, memory, memory, memory}, lists(made_like(told(world), memory)) {}

    UnsetArray<std::byte> bytes;  // the state
    Staging staging;              // of it
    Told lists;
    uint32_t steps = 0, dropped_steps = 0, dropped_contacts = 0;  // EventWindow
    bool read = false;
    taut_profile profile{};
};

void Undo::note(World& world) {
    noted_ = false;
    if (memory_.calls() == calls_) {
        forget();
    } else {
        if (!note_) note_ = new (memory_.allocate(sizeof(Note), alignof(Note))) Note(world, memory_);
        Note& note = *note_;
        note.bytes.clear();
        note.bytes.resize(note_size(world));
        save_note(world, note.bytes.data());
        Source source{note.bytes.data(), note.bytes.data() + note.bytes.size()};
        std::apply([](auto&... staged) { (staged.list.clear(), ...); }, note.staging);
        MakeRoom<true> room(source, note.staging);
        describe(room, world);
        reserve_derived(world, room.slots(world.nodes.ids), room.slots(world.colliders.ids));
        for_told(world, note.lists, [](const auto& list, auto& noted) { noted = list; });
        note.steps = world.window.steps;
        note.dropped_steps = world.window.dropped_steps;
        note.dropped_contacts = world.window.dropped_contacts;
        note.read = world.window.read;
        note.profile = world.profile;
        noted_ = true;
    }
    calls_ = memory_.calls();
}

void Undo::restore(World& world) noexcept {
    if (!noted_) return;
    const Memory::Keeping keeping(memory_);
    Note& note = *note_;
    try {
        Source source{note.bytes.data(), note.bytes.data() + note.bytes.size()};
        Restore<true> reading(source, note.staging);
        describe(reading, world);
        derive(world);
    } catch (...) {  // note() made the room
    }
    for_told(world, note.lists, [](auto& list, auto& noted) { list.swap(noted); });
    world.window.steps = note.steps;
    world.window.dropped_steps = note.dropped_steps;
    world.window.dropped_contacts = note.dropped_contacts;
    world.window.read = note.read;
    world.profile = note.profile;
    forget();
}

void Undo::forget() noexcept {
    if (!note_) return;
    note_->~Note();
    memory_.release(note_, sizeof(Note), alignof(Note));
    note_ = nullptr;
    noted_ = false;
}

}  // namespace taut
