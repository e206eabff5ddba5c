// Shapes of a world, shared by its bodies.
#pragma once

#include <algorithm>
#include <utility>

#include "base/id_pool.h"
#include "collision/collide.h"

namespace taut {

// How far apart two surfaces get contact points [m], their motion in a frame aside; tight boxes are grown by it before
// they enter the broadphase. Of small bodies it is a part of their size, lest in a heap each has contacts with all that
// lies around it, but no less than what gravity makes of a frame at 60 Hz.
constexpr float kContactMargin = 0.01f, kContactMarginOfSize = 0.1f, kLeastContactMargin = 0.003f;

struct ShapeRecord {
    collision::Shape shape;
    uint32_t users = 0;                                   // bodies that use it
    double reach = 0;                                     // of its core about its origin: collision::spin_radius() [m]
    float size = 0;                                       // the same of the shape itself, at most [m]
    float margin = kContactMargin;                        // how far apart it gets contact points, at most [m]
    collision::Box box = {Vec3f::Zero(), Vec3f::Zero()};  // about it, in its frame [m]
};
// Of shapes inside cables, which have neither hull nor surface.
template <class Visitor, Like<ShapeRecord> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [shape, users, reach, size, margin, box] = of;  // users: counted anew
    TAUT_FIELDS(visitor, shape, reach, size, margin, box);
}

// Those inside cables: state, as they come and go and change while a cable is reeled. They have slots of their own, so
// that where the host's shapes lie does not depend on them.
struct InnerShapes {
    explicit InnerShapes(Memory& memory) : ids(memory), record(memory) {}

    IdPool ids;
    Array<ShapeRecord> record;
};
template <class Visitor, Like<InnerShapes> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record] = of;
    TAUT_ASIDE(visitor, ids);
    TAUT_ROWS(visitor, ids, record);
}

struct Shapes {
    static constexpr uint32_t kInner = 1u << 23;  // first index of those inside cables

    explicit Shapes(Memory& memory) : ids(memory), record(memory), inner(memory) {}

    ShapeRecord& operator[](uint32_t index) { return index < kInner ? record[index] : inner.record[index - kInner]; }
    const ShapeRecord& operator[](uint32_t index) const { return const_cast<Shapes&>(*this)[index]; }
    bool live(uint32_t index, uint32_t generation) const {
        return index < kInner ? ids.live(index, generation) : inner.ids.live(index - kInner, generation);
    }
    uint32_t generation(uint32_t index) const {
        return index < kInner ? ids.generation(index) : inner.ids.generation(index - kInner);
    }
    uint32_t count() const { return ids.count() + inner.ids.count(); }

    uint32_t add(collision::Shape shape) { return add(std::move(shape), ids, record); }
    uint32_t add_inner(collision::Shape shape) { return kInner + add(std::move(shape), inner.ids, inner.record); }
    void remove(uint32_t index) {
        (*this)[index] = {};
        index < kInner ? ids.destroy(index) : inner.ids.destroy(index - kInner);
    }

    IdPool ids;
    Array<ShapeRecord> record;
    InnerShapes inner;

private:
    static uint32_t add(collision::Shape shape, IdPool& ids, Array<ShapeRecord>& record) {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 16);
        const uint32_t index = ids.create();
        if (index == record.size()) record.emplace_back();
        const double reach = collision::spin_radius(shape, 0);
        const float size = static_cast<float>(reach) + static_cast<float>(collision::ball_radius(shape));
        const collision::Box box = collision::bounds(shape, {Vec3::Zero(), Mat3f::Identity()});
        const float margin = std::clamp(kContactMarginOfSize * size, kLeastContactMargin, kContactMargin);
        record[index] = {std::move(shape), 0, reach, size, margin, box};
        return index;
    }
};
template <class Visitor, Like<Shapes> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record, inner] = of;  // the host's shapes: it keeps them, see snapshot.h
    TAUT_FIELDS(visitor, inner);
}

}  // namespace taut
