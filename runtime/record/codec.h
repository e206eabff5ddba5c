// Arguments of calls as bytes and back, by the lists of layout.h and by parameters. Little-endian, without padding.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "base/memory.h"
#include "record/layout.h"
#include "state/handle.h"

namespace taut {

static_assert(std::endian::native == std::endian::little);

template <class T>
concept HandleOf = sizeof(T) == sizeof(uint64_t) && requires(const T& handle) {
    handle.bits;
};
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
// A struct that says its size first.
template <class T>
concept Def = requires(const T& def) {
    def.struct_size;
};

// In a recording handles have these bits in place of those of their world, so that it does not depend on which world of
// its process it is of. Those of other worlds become handles of none. Null stays null.
constexpr uint64_t kThisWorld = 0xffffff;
constexpr uint64_t to_recording(uint64_t bits, uint32_t own) {
    return (bits & kThisWorld) == own ? bits | kThisWorld : bits & ~kThisWorld;
}
constexpr uint64_t from_recording(uint64_t bits, uint32_t own) {
    return (bits & kThisWorld) == kThisWorld ? (bits & ~kThisWorld) | own : bits & ~kThisWorld;
}

// What is there of an array, or of what a pointer names.
enum class Content : uint8_t { null, here, unread };

// A limit up to which fields of a struct of an older header are there, set back where its visit ends.
class Sized {
public:
    Sized(const std::byte*& limit, const std::byte* now, bool whole) : limit_(limit), before_(limit), whole_(whole) {
        limit = now;
    }
    ~Sized() { limit_ = before_; }
    Sized(const Sized&) = delete;
    Sized& operator=(const Sized&) = delete;
    explicit operator bool() const { return whole_; }

private:
    const std::byte*& limit_;
    const std::byte* before_;
    bool whole_;
};

// Whether calls read a def of this size; see Check::struct_size.
template <Def T>
bool is_read(uint32_t struct_size) {
    return struct_size > 0 && struct_size <= sizeof(T) && struct_size % alignof(T) == 0;
}

// Where the fields of a def end that are there; it may lie in another, which ends sooner.
template <Def T>
const std::byte* end_of(const T& def, bool whole, const std::byte* limit) {
    const std::byte* end = reinterpret_cast<const std::byte*>(&def) + (whole ? def.struct_size : 0);
    return limit ? std::min(limit, end) : end;
}

class Encoder {
public:
    // baked: handles of those that the recording has, by number.
    Encoder(Array<std::byte>& out, uint32_t own_world, std::span<const uint64_t> baked)
        : out_(out), own_(own_world), baked_(baked) {}

    template <class... T>
    void operator()(const T&... fields) {
        (one(fields), ...);
    }
    template <class T>
    void one(const T& value) {
        if constexpr (std::is_array_v<T>) {
            for (const auto& each : value) one(each);
        } else if constexpr (!Plain<T> && !HandleOf<T>) {
            layout(*this, value);
        } else if (is_beyond(&value + 1)) {
            return;
        } else if constexpr (Plain<T>) {
            raw(&value, sizeof value);
        } else if constexpr (std::is_same_v<T, taut_baked>) {
            const auto at =
                taut_baked_is_valid(value) ? std::find(baked_.begin(), baked_.end(), value.bits) : baked_.end();
            number(static_cast<uint64_t>(at == baked_.end() ? -1 : at - baked_.begin()));
        } else {
            number(to_recording(value.bits, own_));
        }
    }
    template <Def T>
    Sized sized(const T& def) {
        if (is_beyond(&def.struct_size + 1)) return {limit_, limit_, false};
        const bool whole = is_read<T>(def.struct_size);
        raw(&def.struct_size, sizeof def.struct_size);
        raw(&whole, 1);
        return {limit_, end_of(def, whole, limit_), whole};
    }
    template <class T>
    void array(const T* const& first, uint64_t count, uint64_t most) {
        if (is_beyond(&first + 1) || !content(first, count <= most)) return;
        const Sized elsewhere(limit_, nullptr, true);
        if constexpr (Plain<T>) {
            raw(first, count * sizeof(T));
        } else {
            for (uint64_t i = 0; i < count; ++i) one(first[i]);
        }
    }
    // Defs that lie as far apart as the first of them says.
    template <Def T>
    void defs(const T* const& first, uint32_t count) {
        if (is_beyond(&first + 1) || !content(first, count > 0)) return;
        const Sized elsewhere(limit_, nullptr, true);
        const uint32_t stride = first->struct_size;
        raw(&stride, sizeof stride);
        if (!is_read<T>(stride)) return;
        const auto* at = reinterpret_cast<const std::byte*>(first);
        for (uint32_t i = 0; i < count; ++i, at += stride) one(*reinterpret_cast<const T*>(at));
    }
    // At most as many characters as a call looks at.
    void text(const char* const& value) {
        if (!content(value, true)) return;
        const auto length = static_cast<uint32_t>(strnlen(value, TAUT_BODY_NAME_SIZE));
        raw(&length, sizeof length);
        raw(value, length);
    }
    // Where a call writes: whether it can.
    template <class T>
    void out(T* const& where) {
        content(where, false);
    }
    template <class T>
    void function(T* const& value) {
        content(reinterpret_cast<const void*>(value), false);
    }

private:
    bool is_beyond(const void* end) const { return limit_ && static_cast<const std::byte*>(end) > limit_; }
    bool content(const void* first, bool is_here) {
        const Content content = !first ? Content::null : is_here ? Content::here : Content::unread;
        raw(&content, sizeof content);
        return content == Content::here;
    }
    // Of no struct, which the limit is of.
    void number(uint64_t value) { raw(&value, sizeof value); }
    void raw(const void* from, uint64_t size) {
        const auto* const bytes = static_cast<const std::byte*>(from);
        out_.insert(out_.end(), bytes, bytes + size);
    }

    Array<std::byte>& out_;
    uint32_t own_;
    std::span<const uint64_t> baked_;
    const std::byte* limit_ = nullptr;
};

// Room for what pointers among a call's arguments name.
class Arena {
public:
    explicit Arena(Memory& memory) : pieces_(memory), memory_(memory) {}
    // Zeroed. Throws std::bad_alloc.
    void* take(uint64_t size) {
        pieces_.emplace_back(std::max<uint64_t>(size, 1), std::byte{}, HostAllocator<std::byte>(memory_));
        return pieces_.back().data();
    }
    void clear() { pieces_.clear(); }

private:
    Array<Array<std::byte>> pieces_;
    Memory& memory_;
};

// Reads what an Encoder wrote, or anything else: whatever the bytes are, values come out that a call may be given, or
// it is bad. It takes no more memory than some times the bytes there are.
class Decoder {
public:
    static constexpr uint32_t kMostOut = 4096;  // bytes, of a struct that a call writes

    // host: what functions of the host are given as theirs, and pre_solve the one that answers for it.
    Decoder(std::span<const std::byte> bytes, uint32_t own_world, std::span<const taut_baked> baked, Arena& arena,
            taut_pre_solve_fn pre_solve, void* host)
        : bytes_(bytes), own_(own_world), baked_(baked), arena_(arena), pre_solve_(pre_solve), host_(host) {}

    bool is_bad() const { return bad_; }
    bool is_done() const { return !bad_ && bytes_.empty(); }

    template <class... T>
    void operator()(T&... fields) {
        (one(fields), ...);
    }
    template <class T>
    void one(T& value) {
        if constexpr (std::is_array_v<T>) {
            for (auto& each : value) one(each);
        } else if constexpr (!Plain<T> && !HandleOf<T>) {
            layout(*this, value);
        } else if (is_beyond(&value + 1)) {
            return;
        } else if constexpr (std::is_enum_v<T> && sizeof(T) == sizeof(uint32_t)) {
            uint32_t bits = 0;  // of which an enumeration of the interface has values up to this
            raw(&bits, sizeof bits);
            bits = std::min(bits, uint32_t{0x7fffffff});
            std::memcpy(static_cast<void*>(&value), &bits, sizeof bits);
        } else if constexpr (Plain<T>) {
            raw(&value, sizeof value);
        } else if constexpr (std::is_same_v<T, taut_baked>) {
            uint64_t number = 0;
            raw(&number, sizeof number);
            value = number < baked_.size() ? baked_[number] : taut_baked{0};
        } else {
            one(value.bits);
            value.bits = from_recording(value.bits, own_);
        }
    }
    template <Def T>
    Sized sized(T& def) {
        if (is_beyond(&def.struct_size + 1)) return {limit_, limit_, false};
        uint8_t whole = 0;
        raw(&def.struct_size, sizeof def.struct_size);
        raw(&whole, 1);
        if (whole > 1 || (whole && !is_read<T>(def.struct_size))) bad_ = true;
        return {limit_, end_of(def, whole && !bad_, limit_), whole && !bad_};
    }
    template <class T>
    void array(const T*& first, uint64_t count, uint64_t most) {
        if (is_beyond(&first + 1) || !content(first, count <= most)) return;
        const Sized elsewhere(limit_, nullptr, true);
        T* const room = room_for<T>(count);
        if (!room) return;
        if constexpr (Plain<T>) {
            raw(room, count * sizeof(T));
        } else {
            for (uint64_t i = 0; i < count && !bad_; ++i) one(room[i]);
        }
        first = bad_ ? nullptr : room;
    }
    template <Def T>
    void defs(const T*& first, uint32_t count) {
        if (is_beyond(&first + 1) || !content(first, count > 0)) return;
        const Sized elsewhere(limit_, nullptr, true);
        uint32_t stride = 0;
        raw(&stride, sizeof stride);
        const bool read = is_read<T>(stride);
        T* const room = room_for<T>(read ? count : 1);
        if (!room) return;
        room->struct_size = stride;
        first = room;
        auto* at = reinterpret_cast<std::byte*>(room);
        for (uint32_t i = 0; read && i < count && !bad_; ++i, at += stride) {
            T def{};
            one(def);
            std::memcpy(at, &def, stride);
        }
        if (bad_) first = nullptr;
    }
    void text(const char*& value) {
        if (!content(value, true)) return;
        uint32_t length = 0;
        raw(&length, sizeof length);
        if (length > TAUT_BODY_NAME_SIZE) bad_ = true;
        if (bad_) return;
        auto* const room = static_cast<char*>(arena_.take(length + 1));
        raw(room, length);
        value = room;
    }
    // What nobody knows is the host's own.
    template <class T>
    void out(T*& where) {
        const bool is_there = has_content();
        if constexpr (std::is_void_v<T>) {
            where = host_;
        } else {
            static_assert(sizeof(T) <= kMostOut);
            where = is_there ? static_cast<T*>(arena_.take(kMostOut)) : nullptr;
        }
    }
    template <class T>
    void function(T*& value) {
        static_assert(std::is_same_v<T*, taut_pre_solve_fn>, "the player has no answers of this function");
        value = has_content() ? pre_solve_ : nullptr;
    }

private:
    bool is_beyond(const void* end) const { return limit_ && static_cast<const std::byte*>(end) > limit_; }
    bool has_content() {
        uint8_t content = 0;
        raw(&content, 1);
        return content != 0;
    }
    // is_here: whether a call reads it, if it is not null.
    template <class T>
    bool content(const T*& first, bool is_here) {
        uint8_t content = 0;
        raw(&content, 1);
        first = nullptr;
        if (content == 0) return false;
        if (Content(content) != (is_here ? Content::here : Content::unread)) bad_ = true;
        if (bad_) return false;
        if (!is_here) first = static_cast<const T*>(arena_.take(sizeof(T)));
        return is_here;
    }
    // Bytes that an element takes at least.
    template <class T>
    static constexpr uint64_t least_bytes() {
        return Plain<T> || HandleOf<T> ? sizeof(T) : sizeof(uint32_t);
    }
    template <class T>
    T* room_for(uint64_t count) {
        if (count > bytes_.size() / least_bytes<T>() + 1) bad_ = true;
        return bad_ ? nullptr : static_cast<T*>(arena_.take(count * sizeof(T)));
    }
    void raw(void* to, uint64_t size) {
        if (bad_ || size > bytes_.size()) {
            bad_ = true;
            std::memset(to, 0, size);
            return;
        }
        if (size == 0) return;
        std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }

    std::span<const std::byte> bytes_;
    uint32_t own_;
    std::span<const taut_baked> baked_;
    Arena& arena_;
    taut_pre_solve_fn pre_solve_;
    void* host_;
    const std::byte* limit_ = nullptr;
    bool bad_ = false;
};

// A parameter of a call, as Encoder or Decoder take it.
template <class V, class Parameter>
void visit_parameter(V& visit, Parameter& value) {
    using P = std::remove_const_t<Parameter>;
    using Of = std::remove_pointer_t<P>;
    if constexpr (!std::is_pointer_v<P>) {
        visit.one(value);
    } else if constexpr (std::is_function_v<Of>) {
        visit.function(value);
    } else if constexpr (std::is_same_v<Of, const char>) {
        visit.text(value);
    } else if constexpr (std::is_void_v<Of> || !std::is_const_v<Of>) {
        visit.out(value);
    } else {
        static_assert(std::is_class_v<Of> && !HandleOf<Of>, "the length of an array is not known here");
        visit.array(value, 1, 1);
    }
}

// What a call gives: handles; act(handle) for those parameters that point to one.
template <class Act, class Parameter>
void for_given(Act&& act, const Parameter& value) {
    if constexpr (std::is_pointer_v<Parameter>) {
        using Of = std::remove_pointer_t<Parameter>;
        if constexpr (std::is_class_v<Of> && !std::is_const_v<Of>)
            if constexpr (HandleOf<Of>)
                if (value) act(*value);
    }
}

}  // namespace taut
