// Who touches soft bodies, of which contact events tell as of one body each: by vertices, whose contacts are pairs, or
// by edges and triangles. A soft body goes by the collider of its first vertex that has one.
#pragma once

#include <span>

#include "world.h"

namespace taut {

inline uint32_t told(const World& world, uint32_t collider) {
    return told_collider(world.nodes, world.softs, world.colliders, collider);
}

inline bool is_of_soft(const World& world, const NearPair& near) {
    const auto of = [&](uint32_t collider) {
        return world.nodes.info[world.colliders.record[collider].node].soft != kNone;
    };
    return of(near.collider_a()) || of(near.collider_b());
}

// Two colliders with their bodies, the smaller slot first.
taut_contact_event event_of(const World& world, uint32_t a, uint32_t b);

// Takes the pairs of soft bodies out of Pairs::picked; they and the contacts of surfaces that touch and do not rest
// become SurfaceContacts::part, which was empty, in the order of their colliders.
void list_soft_parts(World& world);

// Of parts with one key.
SoftTouch begin_touch(const World& world, std::span<const TouchPart> parts);

// Goes through the parts beside a list of pairs, key by key. publisher.tell(parts, touch before) gives each touch.
class SoftTouches {
public:
    explicit SoftTouches(World& world) : world_(world), all_(world.pairs.surfaces) { all_.touch_now.clear(); }

    // Those before a key.
    template <class Publisher>
    void before(uint64_t key, Publisher&& publisher) {
        while (next_ < all_.part.size() && all_.part[next_].key < key) take(publisher);
    }
    // All that are left, and those that ended.
    template <class Publisher>
    void rest(Publisher&& publisher) {
        while (next_ < all_.part.size()) take(publisher);
        end();
    }

private:
    template <class Publisher>
    void take(Publisher&& publisher) {
        size_t end = next_ + 1;
        while (end < all_.part.size() && all_.part[end].key == all_.part[next_].key) ++end;
        const std::span<const TouchPart> parts(&all_.part[next_], end - next_);
        all_.touch_now.push_back(publisher.tell(parts, before_of(parts.front().key)));
        next_ = end;
    }
    // The same colliders in the last step; null: they did not touch.
    const SoftTouch* before_of(uint64_t key) const;
    // Tells who touches no more, but for those at rest, whom nobody looks at.
    void end();

    World& world_;
    SurfaceContacts& all_;
    size_t next_ = 0;
};

}  // namespace taut
