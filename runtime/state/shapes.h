// Shapes of a world, shared by its bodies.
#pragma once

#include <algorithm>

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

struct Shapes {
    explicit Shapes(Memory& memory) : ids(memory), record(memory) {}

    uint32_t add(collision::Shape shape) {
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
    void remove(uint32_t index) {
        record[index] = {};
        ids.destroy(index);
    }

    IdPool ids;
    Array<ShapeRecord> record;
};

}  // namespace taut
