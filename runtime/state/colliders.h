// Colliders: the shapes that a node collides with, each at its place in the node's frame with a surface and a filter
// of its own; or a capsule that spans two particles and is stored with the first. Their slots are the broadphase's ids,
// and pairs are pairs of them.
#pragma once

#include <taut/body.h>

#include <algorithm>
#include <array>
#include <bit>

#include "base/id_pool.h"
#include "base/math.h"
#include "state/nodes.h"
#include "state/shared_values.h"

namespace taut {

// What a pair asks of a step: public bits of contact events, and two of its own.
constexpr uint8_t kAsksPreSolve = 16, kAsksOneWay = 32;
static_assert((TAUT_CONTACT_EVENTS_ALL & (kAsksPreSolve | kAsksOneWay)) == 0);

template <class Visitor, Like<taut_material> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [friction, restitution, friction_rule, restitution_rule, rolling_friction, spinning_friction] = of;
    TAUT_FIELDS(visitor, friction, restitution, friction_rule, restitution_rule, rolling_friction, spinning_friction);
}
template <class Visitor, Like<taut_filter> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [category, mask, group, reserved] = of;
    TAUT_FIELDS(visitor, category, mask, group);
}

struct Collider {
    uint32_t node = kNone;             // kNone: a dead slot
    uint32_t node_b = kNone;           // of a capsule between two particles, which it follows: its other end
    uint32_t shape = kNone;            // index into Shapes
    uint32_t next = kNone;             // of the same node, in the order in which they were added
    Vec3 position = Vec3::Zero();      // of the shape's origin in the frame of the body's origin [m]
    Quat rotation = Quat::Identity();  // body from shape
    uint64_t user_data = 0;
    uint8_t asks = 0;     // bits of contact events, kAsks
    bool sensor = false;  // detects, never collides
    bool senses_static = false;
    bool grain = false;  // its contacts with other grains are in Grains

    bool at_origin() const { return position == Vec3::Zero() && rotation.coeffs() == Quat::Identity().coeffs(); }
};
template <class Visitor, Like<Collider> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [node, node_b, shape, next, position, rotation, user_data, asks, sensor, senses_static, grain] = of;
    auto decides = static_cast<uint8_t>(asks & (kAsksPreSolve | kAsksOneWay));  // events change no motion
    TAUT_FIELDS(visitor, node, node_b, shape, next, position, rotation, decides, sensor, senses_static, grain);
    TAUT_ASIDE(visitor, asks);
    TAUT_ASIDE(visitor, user_data);
}

// What few colliders have of their own.
struct ColliderTraits {
    float density = 0;  // its share in the node's mass [kg/m^3]
    taut_material material{};
    taut_filter filter{};
    // Of its surface against the body, in the shape's frame: surface_velocity + surface_spin x p [m/s], [rad/s].
    Vec3f surface_velocity = Vec3f::Zero(), surface_spin = Vec3f::Zero();
    Vec3f one_way = Vec3f::Zero();  // unit, in the shape's frame: it is touched from this side only; 0: from all
    float static_friction = 0;      // coefficient while it sticks, if above that of the material
    float slide_factor = 0;         // of friction along slide_direction
    Vec3f slide_direction = Vec3f::Zero();  // unit, in the shape's frame; 0: none

    bool driven() const { return surface_velocity != Vec3f::Zero() || surface_spin != Vec3f::Zero(); }
    bool directed() const { return slide_direction != Vec3f::Zero(); }

    std::array<uint64_t, 23> words() const {
        const float numbers[] = {density,
                                 material.friction,
                                 material.restitution,
                                 material.rolling_friction,
                                 material.spinning_friction,
                                 surface_velocity.x(),
                                 surface_velocity.y(),
                                 surface_velocity.z(),
                                 surface_spin.x(),
                                 surface_spin.y(),
                                 surface_spin.z(),
                                 one_way.x(),
                                 one_way.y(),
                                 one_way.z(),
                                 static_friction,
                                 slide_factor,
                                 slide_direction.x(),
                                 slide_direction.y(),
                                 slide_direction.z()};
        std::array<uint64_t, 23> words{};
        std::transform(std::begin(numbers), std::end(numbers), words.begin(),
                       [](float x) { return std::bit_cast<uint32_t>(x); });
        words[19] =
            static_cast<uint64_t>(material.friction_rule) << 32 | static_cast<uint64_t>(material.restitution_rule);
        words[20] = filter.category;
        words[21] = filter.mask;
        words[22] = static_cast<uint32_t>(filter.group);
        return words;
    }
};
template <class Visitor, Like<ColliderTraits> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [density, material, filter, surface_velocity, surface_spin, one_way, static_friction, slide_factor,
           slide_direction] = of;
    TAUT_FIELDS(visitor, density, material, filter, surface_velocity, surface_spin, one_way);
    bool own_friction =
        static_friction != 0 || slide_factor != 0 || slide_direction != Vec3f::Zero();  // by laws of its own
    TAUT_ASIDE(visitor, own_friction);
    if (own_friction)
        TAUT_FIELDS(visitor, static_friction, slide_factor, slide_direction);
    else if constexpr (!std::is_const_v<Of>)
        static_friction = slide_factor = 0, slide_direction = Vec3f::Zero();
}

// All of a collider that is to be.
struct ColliderPlan : Collider {
    ColliderTraits traits;
};

// Sets some of the bits that a collider asks for.
inline void ask_for(Collider& collider, uint32_t which, uint32_t bits) {
    collider.asks = static_cast<uint8_t>((collider.asks & ~which) | bits);
}

struct Colliders {
    explicit Colliders(Memory& memory)
        : ids(memory), record(memory), traits(memory), sensors(memory), grains(memory), active(memory) {}

    // Throws std::bad_alloc before anything changes.
    void reserve_one() {
        ids.reserve_one();
        reserve_more(record, 1);
        traits.reserve(record.capacity());
        active.reserve(record.capacity());
        reserve_sensor();
        if (grains.capacity() == grains.size()) grains.reserve(2 * grains.size() + 16);
    }
    void reserve_sensor() {
        if (sensors.capacity() == sensors.size()) sensors.reserve(2 * sensors.size() + 16);
    }
    // reserve_one() went before.
    uint32_t add(const ColliderPlan& collider) {
        const uint32_t index = ids.create();
        if (index == record.size()) {
            record.emplace_back();
            traits.add();
        }
        record[index] = collider;
        traits.set(index, collider.traits);
        list_sensor(index, collider.sensor);
        list(grains, index, collider.grain);
        listed_ = 0;
        return index;
    }
    void remove(uint32_t index) {
        list_sensor(index, false);
        list(grains, index, false);
        record[index] = {};
        traits.set(index, {});
        ids.destroy(index);
        listed_ = 0;
    }

    // Brings `active` up to date, after Nodes::active.
    void list_active(const Nodes& nodes);

    // Into the lists of sensors and grains, or out of them; for the former reserve_lists() went before.
    void reserve_lists(size_t more) {
        reserve_more(sensors, more);
        reserve_more(grains, more);
    }
    void list_own(uint32_t index, bool listed) {
        list(sensors, index, listed && record[index].sensor);
        list(grains, index, listed && record[index].grain);
        listed_ = 0;
    }

    // Brings the list of sensors up to date; reserve_sensor() went before.
    void list_sensor(uint32_t index, bool sensor) { list(sensors, index, sensor); }

    // For a change of asks: pairs ask again.
    Collider& change(uint32_t index) {
        ++version;
        return record[index];
    }

    // The same for what act() changes of the traits. Throws std::bad_alloc before anything changes.
    template <class Act>
    void change_traits(uint32_t index, Act&& act) {
        traits.reserve_values(1);
        ColliderTraits own = traits[index];
        act(own);
        traits.set(index, own);
        ++version;
    }
    ColliderPlan plan(uint32_t index) const { return {record[index], traits[index]}; }

    IdPool ids;
    Array<Collider> record;
    SharedValues<ColliderTraits> traits;
    Array<uint32_t> sensors;  // slots, sorted
    Array<uint32_t> grains;   // likewise
    Array<uint32_t> active;   // slots of those of active nodes, ascending; list_active()
    uint64_t version = 0;     // counts changes
    uint32_t chained = 0;     // how many come after another of their node

private:
    uint64_t listed_ = 0;  // Nodes::lists that `active` is of; 0: of none

    template <class Visitor, Like<Colliders> Of>
    friend void describe(Visitor& visitor, Of& of);

    // In a sorted list, or not.
    static void list(Array<uint32_t>& slots, uint32_t index, bool listed) {
        const auto at = std::lower_bound(slots.begin(), slots.end(), index);
        const bool is = at != slots.end() && *at == index;
        if (listed && !is) slots.insert(at, index);
        if (!listed && is) slots.erase(at);
    }
};
template <class Visitor, Like<Colliders> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record, traits, sensors, grains, active, version, chained, listed] = of;  // some follow
    TAUT_ASIDE(visitor, ids, version);
    TAUT_ROWS(visitor, ids, record, traits);
    TAUT_FIELDS(visitor, sensors, grains);
}

inline bool filters_agree(const taut_filter& a, const taut_filter& b) {
    if (a.group != 0 && a.group == b.group) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

// Calls act(collider) for each collider of a node; act may not remove it.
template <class Act>
void for_colliders(const Nodes& nodes, const Colliders& colliders, uint32_t node, Act&& act) {
    for (uint32_t c = nodes.info[node].collider; c != kNone; c = colliders.record[c].next) act(c);
}

inline void Colliders::list_active(const Nodes& nodes) {
    if (listed_ == nodes.lists) return;
    active.clear();
    for (const uint32_t node : nodes.active)
        for_colliders(nodes, *this, node, [&](uint32_t c) { active.push_back(c); });
    if (!std::ranges::is_sorted(active)) std::ranges::sort(active);
    listed_ = nodes.lists;
}

}  // namespace taut
