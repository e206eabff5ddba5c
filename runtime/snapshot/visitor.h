// What visitors of the state have in common (base/describe.h): which kinds of fields there are, and how those that only
// look go through them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "base/memory.h"
#include "base/segmented_array.h"
#include "constraints/element.h"
#include "state/nodes.h"
#include "state/shared_values.h"

namespace taut {

// Numbers, enumerations, and Eigen's vectors, rotations and matrices: their bytes are all there is to them.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || requires {
    typename T::Scalar;
};

// Lists inside, which take the world's memory.
template <class T>
concept Nested = !Plain<T> && std::is_constructible_v<T, Memory&>;

// Elements of lists that have none inside: within one process their bytes are all there is to them as well.
template <class T>
concept Flat = !Nested<T> && std::is_trivially_destructible_v<T>;

template <class Self>
class Visitor {
public:
    // Whether flat elements are taken as their bytes, which is many times as fast as by their lists of fields.
    static constexpr bool kWhole = false;
    template <class T>
    static constexpr bool by_bytes() {
        return Plain<T> || (Self::kWhole && Flat<T>);
    }

    template <class... Fields>
    void fields(const char*, Fields&&... each) {
        (self().one(each), ...);
    }
    template <class... Fields>
    void aside(const char* names, Fields&&... each) {
        self().fields(names, each...);
    }

    template <class List>
    void rare(const char* name, List& list) {
        self().fields(name, list);
    }

    template <class T>
    void one(T& field) {
        using Field = std::remove_const_t<T>;
        if constexpr (Plain<Field>)
            self().plain(&field, sizeof field);
        else if constexpr (std::is_array_v<Field>)
            for (auto& each : field) self().one(each);
        else
            self().visit(field);
    }
    template <class T, size_t kCount>
    void visit(std::array<T, kCount>& field) {
        for (T& each : field) self().one(each);
    }
    template <class T, size_t kCount>
    void visit(const std::array<T, kCount>& field) {
        for (const T& each : field) self().one(each);
    }
    template <class Byte>
    void visit(Bytes<Byte> field) {
        self().plain(field.first, field.count);
    }
    template <class T>
    void visit(T& field) {
        describe(self(), field);
    }
    // An element of a list or column, with what else describes it.
    template <class T, class... With>
    void element_of(T& element, With... with) {
        if constexpr (by_bytes<std::remove_const_t<T>>())
            self().plain(&element, sizeof element);
        else if constexpr (sizeof...(with) > 0)
            describe(self(), element, with...);
        else
            self().one(element);
    }

protected:
    Self& self() { return static_cast<Self&>(*this); }
};

// One that only looks.
template <class Self>
class Onlooker : public Visitor<Self> {
public:
    using Visitor<Self>::visit;

    template <class T>
    void visit(const Array<T>& list) {
        const auto count = static_cast<uint32_t>(list.size());
        this->self().plain(&count, sizeof count);
        if constexpr (Visitor<Self>::template by_bytes<T>())
            this->self().plain(list.data(), count * sizeof(T));
        else
            for (const T& each : list) this->self().one(each);
    }
    template <class T>
    void visit(const SegmentedArray<T>& list) {
        const auto count = static_cast<uint32_t>(list.size());
        this->self().plain(&count, sizeof count);
        for (const T& each : list) this->element_of(each);
    }
    // Elements in the order in which each(act) names them, with what else describes them.
    template <class T, class Each>
    void ordered(const SegmentedArray<T>&, Each&& each) {
        uint32_t count = 0;
        each([&](const T&, auto...) { ++count; });
        this->self().plain(&count, sizeof count);
        each([&](const T& element, auto... with) { this->element_of(element, with...); });
    }
    void visit(const ConstraintType* const& type) {
        const auto types = constraint_types();
        const auto index = static_cast<uint8_t>(std::ranges::find(types, type) - types.begin());
        this->self().plain(&index, sizeof index);
    }
    void visit(const ElementType* const& type) {
        const auto types = element_types();
        const auto index = static_cast<uint8_t>(std::ranges::find(types, type) - types.begin());
        this->self().plain(&index, sizeof index);
    }

    template <class... Columns>
    void rows(const char*, const IdPool& ids, const Columns&... columns) {
        uint32_t before = kNone;
        for (uint32_t slot = 0; slot < ids.slots(); ++slot) {
            if (!ids.live(slot)) continue;
            this->self().begin_row(slot);
            (element(columns, slot, before), ...);
            before = slot;
        }
    }
    void begin_row(uint32_t) {}

private:
    template <class T>
    void element(const Array<T>& column, uint32_t slot, uint32_t) {
        this->element_of(column[slot]);
    }
    // Most are as the one before.
    template <class T>
    void element(const SharedValues<T>& column, uint32_t slot, uint32_t before) {
        const bool same = before != kNone && column.same(slot, before);
        this->self().plain(&same, sizeof same);
        if (!same) this->element_of(column[slot]);
    }
    template <class List>
    void element(const OrNone<List>& column, uint32_t slot, uint32_t) {
        const bool any = slot < column.array.size() && column.array[slot].any();
        this->self().plain(&any, sizeof any);
        if (any) this->element_of(column.array[slot]);
    }
};

}  // namespace taut
