#include "api/access.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "state/world_slot.h"

namespace taut {

// ---------------------------------------------------------------- check

Check& Check::pointer(const char* name, const void* value) {
    if (*this && !value) result_ = refuse(TAUT_NULL_POINTER, "%s: %s%s is null", call_, scope_, name);
    return *this;
}

Check& Check::struct_size(uint32_t value, size_t known, size_t alignment) {
    if (!*this) return *this;
    if (value > known) {
        result_ = refuse(TAUT_STRUCT_SIZE,
                         "%s: %sstruct_size is %u, this library (%d.%d.%d) knows up to %zu: call the _init function; "
                         "the program may be built with a newer header",
                         call_, scope_, value, TAUT_VERSION_MAJOR, TAUT_VERSION_MINOR, TAUT_VERSION_PATCH, known);
    } else if (value == 0 || value % alignment != 0) {
        result_ = refuse(TAUT_STRUCT_SIZE, "%s: %sstruct_size is %u, expected at most %zu; call the _init function",
                         call_, scope_, value, known);
    }
    return *this;
}

Check& Check::nested(uint32_t struct_size, size_t known) {
    if (*this && struct_size != known)
        result_ = refuse(TAUT_STRUCT_SIZE, "%s: %sstruct_size is %u, expected %zu; call the _init function", call_,
                         scope_, struct_size, known);
    return *this;
}

Check& Check::zero(const char* field, uint64_t value) {
    if (*this && value != 0) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s is %llu, expected 0", call_, scope_, field,
                         static_cast<unsigned long long>(value));
    }
    return *this;
}

Check& Check::boolean(const char* field, uint32_t value) { return count(field, value, 0, 1); }

Check& Check::count(const char* field, uint32_t value, uint32_t lo, uint32_t hi) {
    if (*this && !(value >= lo && value <= hi)) {
        result_ =
            refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s is %u, expected [%u, %u]", call_, scope_, field, value, lo, hi);
    }
    return *this;
}

template <class T>
Check& Check::in_range(const char* field, const char* part, T value, Range range) {
    const T lo = static_cast<T>(range.lo), hi = static_cast<T>(range.hi);
    const bool inside = (range.open_below ? value > lo : value >= lo) && value <= hi;
    if (*this && !inside) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s%s is %.9g, expected %c%.6g, %.6g]", call_, scope_, field,
                         part, static_cast<double>(value), range.open_below ? '(' : '[', range.lo, range.hi);
    }
    return *this;
}

Check& Check::number(const char* field, float value, Range range) { return in_range(field, "", value, range); }
Check& Check::number(const char* field, double value, Range range) { return in_range(field, "", value, range); }

Check& Check::zero_or(const char* field, float value, Range range) {
    if (*this && value != 0 && !(value >= static_cast<float>(range.lo) && value <= static_cast<float>(range.hi))) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s is %.9g, expected 0 or [%.6g, %.6g]", call_, scope_, field,
                         static_cast<double>(value), range.lo, range.hi);
    }
    return *this;
}

Check& Check::number_or(const char* field, float value, Range range, float other) {
    return value == other ? *this : in_range(field, "", value, range);
}

Check& Check::vector(const char* field, const taut_vec3& value, Range range) {
    return in_range(field, ".x", value.x, range)
        .in_range(field, ".y", value.y, range)
        .in_range(field, ".z", value.z, range);
}

Check& Check::vector(const char* field, const taut_pos& value, Range range) {
    return in_range(field, ".x", value.x, range)
        .in_range(field, ".y", value.y, range)
        .in_range(field, ".z", value.z, range);
}

Check& Check::length(const char* field, double squared, Range range) {
    if (*this && !(squared <= range.hi * range.hi)) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s has length %.9g, expected at most %.6g", call_, scope_, field,
                         std::sqrt(squared), range.hi);
    }
    return *this;
}

Check& Check::bounded(const char* field, const taut_vec3& value, Range range) {
    return vector(field, value, range).length(field, to_vec(value).squaredNorm(), range);
}

Check& Check::bounded(const char* field, const taut_pos& value, Range range) {
    return vector(field, value, range).length(field, to_vec(value).squaredNorm(), range);
}

Check& Check::zero(const char* field, float value, const char* why) {
    if (*this && value != 0) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s is %.9g, expected 0 %s", call_, scope_, field,
                         static_cast<double>(value), why);
    }
    return *this;
}

Check& Check::zero(const char* field, const taut_vec3& value, const char* why) {
    if (*this && !(value.x == 0 && value.y == 0 && value.z == 0)) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s is (%.9g, %.9g, %.9g), expected 0 %s", call_, scope_, field,
                         static_cast<double>(value.x), static_cast<double>(value.y), static_cast<double>(value.z), why);
    }
    return *this;
}

Check& Check::rotation(const char* field, const taut_quat& value) {
    constexpr Range component{-1 - kUnitTolerance, 1 + kUnitTolerance};
    in_range(field, ".x", value.x, component).in_range(field, ".y", value.y, component);
    in_range(field, ".z", value.z, component).in_range(field, ".w", value.w, component);
    const double size = Quat(value.w, value.x, value.y, value.z).norm();
    if (*this && !(std::abs(size - 1) <= kUnitTolerance)) {
        result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s has length %.9g, expected 1 within %g", call_, scope_, field,
                         size, kUnitTolerance);
    }
    return *this;
}

Check& Check::pose(const char* position, const char* rotation_field, const taut_pose& value) {
    return bounded(position, value.position, kPosition)
        .rotation(rotation_field, value.rotation)
        .zero("reserved[0]", value.reserved[0])
        .zero("reserved[1]", value.reserved[1]);
}

Check& Check::require(bool condition, const char* text, taut_result code) {
    if (*this && !condition) result_ = refuse(code, "%s: %s%s", call_, scope_, text);
    return *this;
}

Check& Check::refuse_with(const char* text, const char* reason) {
    if (*this) result_ = refuse(TAUT_INVALID_ARGUMENT, "%s: %s%s: %s", call_, scope_, text, reason);
    return *this;
}

// ---------------------------------------------------------------- the table of worlds

namespace {

constinit std::array<WorldSlot, kWorldSlots> slots;
// Where the search for a free slot begins: one after the last taken, so that all slots are used up evenly.
constinit std::atomic<uint32_t> next_slot{1};

// Takes a free slot; 0 if there is none.
uint32_t take_slot() {
    const uint32_t first = next_slot.load(std::memory_order_relaxed);
    for (uint32_t i = 0; i < kWorldSlots - 1; ++i) {
        const uint32_t slot = 1 + (first - 1 + i) % (kWorldSlots - 1);
        if (!slots[slot].take()) continue;
        next_slot.store(1 + slot % (kWorldSlots - 1), std::memory_order_relaxed);
        return slot;
    }
    return 0;
}

}  // namespace

Hold::Hold(uint32_t world, Use use) noexcept : slot_(world_slot_of(world)), use_(use) {
    WorldSlot& slot = slots[slot_];
    const WorldSlot::Lock lock = slot.lock(world, use != Use::read);
    if (lock == WorldSlot::Lock::held) {
        world_ = slot.world;
        if (use == Use::write) slot.changed = true;
    } else {
        refusal_ = lock == WorldSlot::Lock::busy ? TAUT_LOCKED : TAUT_STALE_HANDLE;
    }
}

Hold::~Hold() {
    if (world_) slots[slot_].unlock(use_ != Use::read);
}

uint32_t create_world(const taut_world_def& checked_def) {
    const uint32_t index = take_slot();
    if (index == 0) return 0;
    WorldSlot& slot = slots[index];
    const uint32_t id = make_world_id(index, slot.generation());
    Memory memory(checked_def.hooks);  // for the world's own bytes; its contents count theirs
    void* room = nullptr;
    try {
        room = memory.allocate(sizeof(World), alignof(World));
        slot.world = new (room) World(checked_def, id);
        slot.changed = false;
    } catch (...) {
        memory.release(room, sizeof(World), alignof(World));
        slot.give_back();
        throw;
    }
    slot.begin_life();
    return id;
}

void destroy_world(Hold& hold) {
    WorldSlot& slot = slots[hold.slot_];
    slot.end_life();
    const taut_hooks hooks = hold.world_->def.hooks;
    hold.world_->~World();
    Memory(hooks).release(hold.world_, sizeof(World), alignof(World));
    slot.world = nullptr;
    hold.world_ = nullptr;
    slot.release();
}

bool world_lives(uint32_t world) noexcept { return slots[world_slot_of(world)].lives(world); }

bool is_as_created(const World& world) noexcept { return !slots[world_slot_of(world.id)].changed; }

// ---------------------------------------------------------------- find

taut_result refuse_hold(const char* call, const char* what, taut_result refusal) {
    if (refusal == TAUT_LOCKED) {
        return refuse(TAUT_LOCKED, "%s: the world is inside a step, or another thread is using it", call);
    }
    return refuse(TAUT_STALE_HANDLE, "%s: %s is null, or its world is gone", call, what);
}

taut_result refuse_stale(const char* call, const char* what, uint64_t bits) {
    if (bits == 0) return refuse(TAUT_STALE_HANDLE, "%s: %s is null", call, what);
    return refuse(TAUT_STALE_HANDLE, "%s: %s is %#llx, which names nothing that lives", call, what,
                  static_cast<unsigned long long>(bits));
}

namespace {

template <class Handle>
taut_result find(const char* call, const char* field, const World& world, Handle handle, uint32_t& index) {
    HandleBits bits;
    if (!unpack_handle(handle.bits, bits)) return refuse_stale(call, field, handle.bits);
    if (bits.world != world.id && world_lives(bits.world)) {
        return refuse(TAUT_FOREIGN_HANDLE, "%s: %s is %#llx, a %s of another world", call, field,
                      static_cast<unsigned long long>(handle.bits), name_of(handle));
    }
    if (bits.world != world.id || !names(world, handle, bits)) return refuse_stale(call, field, handle.bits);
    index = bits.index;
    return TAUT_OK;
}

}  // namespace

void tell_name(const World& world, uint32_t node) {
    if (const char* const name = world.nodes.name_of(node)) add_to_error(" (body '%s')", name);
}

taut_result find_body(const char* call, const char* field, const World& world, taut_body handle, uint32_t& node) {
    return find(call, field, world, handle, node);
}

taut_result find_shape(const char* call, const char* field, const World& world, taut_shape handle, uint32_t& shape) {
    return find(call, field, world, handle, shape);
}

taut_result find_collider(const char* call, const char* field, const World& world, taut_collider handle,
                          uint32_t& collider) {
    return find(call, field, world, handle, collider);
}

}  // namespace taut
