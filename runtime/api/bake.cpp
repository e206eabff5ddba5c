// Shapes built ahead of their worlds: each with memory and a count of holders of its own, in a table of handles.
#include <atomic>
#include <mutex>

#include "api/shape_build.h"
#include "api/shape_def.h"
#include "record/codec.h"
#include "record/format.h"
#include "record/recorder.h"

using namespace taut;

namespace {

struct Baked {
    explicit Baked(const taut_hooks& hooks) : memory(hooks), def(memory) {}

    Memory memory;  // first: the shape is in it
    collision::Shape shape;
    Array<std::byte> def;              // as recordings hold it, behind its kind; empty: not kept
    std::atomic<uint32_t> holders{1};  // its handle, and the shapes of worlds
};

void free_baked(Baked* baked, const taut_hooks& hooks) { Memory(hooks).release(baked, sizeof(Baked), alignof(Baked)); }

void let_go(Baked* baked) {
    if (baked->holders.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    const taut_hooks hooks = baked->memory.hooks();
    baked->~Baked();
    free_baked(baked, hooks);
}

// Of one shape of a world: what is baked outlives it.
struct BakedHolder {
    Baked* baked;
    void operator()(const void*) const {
        if (baked) let_go(baked);
    }
};

std::atomic<bool> keeps_defs{false};

constexpr BakedDef kind_of(const taut_hull_def&) { return BakedDef::hull; }
constexpr BakedDef kind_of(const taut_mesh_def&) { return BakedDef::mesh; }
constexpr BakedDef kind_of(const taut_height_field_def&) { return BakedDef::height_field; }

template <class T>
std::shared_ptr<const T> share(const std::shared_ptr<const T>& data, Baked* baked, Memory& memory) {
    if (!data) return nullptr;
    baked->holders.fetch_add(1, std::memory_order_relaxed);
    return {data.get(), BakedHolder{baked}, HostAllocator<char>(memory)};
}

// ---------------------------------------------------------------- the table

struct BakedSlot {
    Baked* baked;
    uint64_t bits;  // of its handle: a serial number above those of the slot
    uint32_t next;  // free slot, 0: none
};

constexpr int kSlotBits = 16;
constexpr uint32_t kBakedSlots = 1u << kSlotBits;  // the first stays empty

std::mutex baked_lock;  // of all that follows
BakedSlot baked_slots[kBakedSlots];
uint32_t baked_used = 1, baked_free = 0;
uint64_t baked_serial = 0;

// 0: the table is full.
uint64_t list_baked(Baked* baked) {
    const std::lock_guard guard(baked_lock);
    if (baked_free == 0 && baked_used == kBakedSlots) return 0;
    const uint32_t at = baked_free ? baked_free : baked_used++;
    BakedSlot& slot = baked_slots[at];
    if (baked_free) baked_free = slot.next;
    slot = {baked, ++baked_serial << kSlotBits | at, 0};
    return slot.bits;
}

// Null where the handle names nothing; else act(slot), locked.
template <class Act>
bool with_baked(taut_baked handle, Act&& act) {
    const std::lock_guard guard(baked_lock);
    BakedSlot& slot = baked_slots[handle.bits & (kBakedSlots - 1)];
    if (!slot.baked || slot.bits != handle.bits) return false;
    act(slot);
    return true;
}

taut_result refuse_baked(const char* call, taut_baked handle) { return refuse_stale(call, "baked", handle.bits); }

// A holder of what the handle names, or null.
Baked* hold_baked(taut_baked handle) {
    Baked* held = nullptr;
    with_baked(handle, [&](const BakedSlot& slot) {
        held = slot.baked;
        held->holders.fetch_add(1, std::memory_order_relaxed);
    });
    return held;
}

template <class Def>
taut_result bake(const char* call, const Def* given, const taut_allocator* allocator, taut_baked* out) {
    Check check(call);
    Def def;
    if (!check.pointer("out", out) || !take_def(check, given, init_def, def) || !check_build(check, def))
        return check.result();
    taut_hooks hooks{};
    if (allocator) {
        hooks.allocate = allocator->allocate;
        hooks.free = allocator->free;
        hooks.memory_user_data = allocator->user_data;
        check.require(!hooks.allocate == !hooks.free,
                      "allocate and free: one of them is null, expected both or neither");
        if (!check) return check.result();
    }
    return contain(call, [&] {
        void* const room = Memory(hooks).allocate(sizeof(Baked), alignof(Baked));
        Baked* const baked = new (room) Baked(hooks);
        const std::unique_ptr<Baked, BakedHolder> holder(baked, BakedHolder{baked});
        baked->shape = build_shape(check, def, baked->memory);
        if (!check) return check.result();
        if (keeps_defs.load(std::memory_order_relaxed)) {
            Encoder encoder(baked->def, 0, {});
            encoder(kind_of(def), def);
        }
        baked->holders.fetch_add(1, std::memory_order_relaxed);
        const uint64_t bits = list_baked(baked);
        if (bits == 0) {
            let_go(baked);
            return refuse(TAUT_LIMIT, "%s: %u baked shapes are there", call, kBakedSlots - 1);
        }
        *out = {bits};
        return TAUT_OK;
    });
}

}  // namespace

taut_result taut_bake_hull(const taut_hull_def* def, const taut_allocator* allocator, taut_baked* out) {
    return bake(__func__, def, allocator, out);
}
taut_result taut_bake_mesh(const taut_mesh_def* def, const taut_allocator* allocator, taut_baked* out) {
    return bake(__func__, def, allocator, out);
}
taut_result taut_bake_height_field(const taut_height_field_def* def, const taut_allocator* allocator, taut_baked* out) {
    return bake(__func__, def, allocator, out);
}

taut_result taut_bake_keep_defs(uint32_t keep) {
    Check check(__func__);
    if (check.boolean("keep", keep)) keeps_defs.store(keep != 0, std::memory_order_relaxed);
    return check.result();
}

void taut::append_baked_def(taut_baked handle, Array<std::byte>& out) {
    Baked* const baked = hold_baked(handle);
    const std::unique_ptr<Baked, BakedHolder> holder(baked, BakedHolder{baked});
    const BakedDef none = BakedDef::not_kept;
    const auto* const first = reinterpret_cast<const std::byte*>(&none);
    if (baked && !baked->def.empty())
        out.insert(out.end(), baked->def.begin(), baked->def.end());
    else
        out.insert(out.end(), first, first + sizeof none);
}

taut_result taut_world_add_baked(taut_world world, taut_baked handle, taut_shape* out) {
    TAUT_RECORD(taut_world_add_baked, world, handle, out);
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), world, Use::write, [&](World& target) {
        Baked* const baked = hold_baked(handle);
        if (!baked) return refuse_baked(check.call(), handle);
        const std::unique_ptr<Baked, BakedHolder> holder(baked, BakedHolder{baked});
        collision::Shape shape;
        shape.kind = baked->shape.kind;
        shape.size = baked->shape.size;
        shape.hull = share(baked->shape.hull, baked, target.memory);
        shape.surface = share(baked->shape.surface, baked, target.memory);
        return insert_shape(check, target, std::move(shape), out);
    });
}

taut_result taut_baked_release(taut_baked handle) {
    Baked* baked = nullptr;
    const bool found = with_baked(handle, [&](BakedSlot& slot) {
        baked = slot.baked;
        const uint32_t at = static_cast<uint32_t>(&slot - baked_slots);
        slot = {nullptr, 0, baked_free};
        baked_free = at;
    });
    if (!found) return refuse_baked(__func__, handle);
    return contain(__func__, [&] {
        let_go(baked);
        return TAUT_OK;
    });
}

int32_t taut_baked_is_valid(taut_baked handle) {
    return with_baked(handle, [](const BakedSlot&) {}) ? 1 : 0;
}

taut_result taut_baked_get_bytes(taut_baked handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    const bool found = with_baked(handle, [&](const BakedSlot& slot) {
        *out = slot.baked->memory.bytes() + Memory::whole(sizeof(Baked), alignof(Baked));
    });
    return found ? TAUT_OK : refuse_baked(check.call(), handle);
}
