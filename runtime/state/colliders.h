// Colliders: the shapes that a node collides with, each at its place in the node's frame with a surface and a filter
// of its own; or a capsule that spans two particles and is stored with the first. Their slots are the broadphase's ids,
// and pairs are pairs of them.
#pragma once

#include <taut/body.h>

#include "base/id_pool.h"
#include "base/math.h"
#include "state/nodes.h"

namespace taut {

struct Collider {
    uint32_t node = kNone;             // kNone: a dead slot
    uint32_t node_b = kNone;           // of a capsule between two particles, which it follows: its other end
    uint32_t shape = kNone;            // index into Shapes
    uint32_t next = kNone;             // of the same node, in the order in which they were added
    float density = 0;                 // its share in the node's mass [kg/m^3]
    Vec3 position = Vec3::Zero();      // of the shape's origin in the frame of the body's origin [m]
    Quat rotation = Quat::Identity();  // body from shape
    taut_material material{};
    bool driven = false;  // surface_velocity or surface_spin is not zero
    taut_filter filter{};
    uint64_t user_data = 0;
    // Of its surface against the body, in the shape's frame: surface_velocity + surface_spin x p [m/s], [rad/s].
    Vec3f surface_velocity = Vec3f::Zero(), surface_spin = Vec3f::Zero();

    bool at_origin() const { return position == Vec3::Zero() && rotation.coeffs() == Quat::Identity().coeffs(); }
};

struct Colliders {
    explicit Colliders(Memory& memory) : ids(memory), record(memory) {}

    // Throws std::bad_alloc before anything changes.
    void reserve_one() {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 16);
    }
    // reserve_one() went before.
    uint32_t add(const Collider& collider) {
        const uint32_t index = ids.create();
        if (index == record.size()) record.emplace_back();
        record[index] = collider;
        return index;
    }
    void remove(uint32_t index) {
        record[index] = {};
        ids.destroy(index);
    }

    IdPool ids;
    Array<Collider> record;
};

// Calls act(collider) for each collider of a node; act may not remove it.
template <class Act>
void for_colliders(const Nodes& nodes, const Colliders& colliders, uint32_t node, Act&& act) {
    for (uint32_t c = nodes.info[node].collider; c != kNone; c = colliders.record[c].next) act(c);
}

}  // namespace taut
