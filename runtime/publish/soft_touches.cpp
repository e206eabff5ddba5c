#include "publish/soft_touches.h"

#include <algorithm>
#include <tuple>

#include "detect/surface_point.h"

namespace taut {
namespace {

std::pair<uint64_t, uint64_t> sides_of(const SoftTouch& touch) {
    return {touch.event.collider_a.bits, touch.event.collider_b.bits};
}

uint64_t key_of(const World& world, uint32_t one, uint32_t other) {
    return pair_key(told(world, one), told(world, other));
}

bool rests(const Nodes& nodes, uint32_t node) {
    return node == kNone || nodes.info[node].kind == NodeKind::fixed || nodes.rest[node] != Rest::awake;
}

// Whether a collider is there and nothing of it moves; of a soft body, no vertex.
bool rests(const World& world, taut_collider handle) {
    HandleBits bits{};
    if (!unpack_handle(handle.bits, bits) || !world.colliders.ids.live(bits.index, bits.generation)) return false;
    const Collider& collider = world.colliders.record[bits.index];
    const uint32_t soft = world.nodes.info[collider.node].soft;
    if (soft == kNone) return rests(world.nodes, collider.node) && rests(world.nodes, collider.node_b);
    return std::ranges::all_of(world.softs.record[soft].node, [&](uint32_t node) { return rests(world.nodes, node); });
}

uint32_t asks_of(const World& world, const TouchPart& part) {
    if (!part.surface) return world.pairs.active[part.index].asks;
    uint32_t asks = world.pairs.asks;
    for (const uint32_t collider : world.pairs.surfaces.contact[part.index].collider)
        asks |= world.colliders.record[collider].asks;
    return asks;
}

}  // namespace

taut_contact_event event_of(const World& world, uint32_t a, uint32_t b) {
    taut_contact_event event{};
    event.body_a = world.body_handle(world.colliders.record[a].node);
    event.body_b = world.body_handle(world.colliders.record[b].node);
    event.collider_a = world.collider_handle(a);
    event.collider_b = world.collider_handle(b);
    return event;
}

void list_soft_parts(World& world) {
    Pairs& pairs = world.pairs;
    Array<TouchPart>& parts = pairs.surfaces.part;
    std::erase_if(pairs.picked, [&](uint32_t i) {
        const NearPair& near = pairs.near[pairs.active[i].near];
        if (!is_of_soft(world, near)) return false;
        parts.push_back({key_of(world, near.collider_a(), near.collider_b()), false, i});
        return true;
    });
    const Array<SurfaceContact>& contacts = pairs.surfaces.contact;
    for (uint32_t i = 0; i < contacts.size(); ++i) {
        const SurfaceContact& contact = contacts[i];
        if (!contact.touches() || !is_awake(world.nodes, contact)) continue;
        const uint64_t key = key_of(world, contact.collider[0], contact.collider[1]);
        if (key >> 32 != static_cast<uint32_t>(key)) parts.push_back({key, true, i});  // else it touches itself
    }
    std::ranges::sort(parts, {}, [](const TouchPart& part) { return std::tuple(part.key, part.surface, part.index); });
}

SoftTouch begin_touch(const World& world, std::span<const TouchPart> parts) {
    const uint64_t key = parts.front().key;
    SoftTouch touch;
    touch.event = event_of(world, static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key));
    for (const TouchPart& part : parts)
        touch.asks |= static_cast<uint8_t>(asks_of(world, part) & TAUT_CONTACT_EVENTS_ALL);
    return touch;
}

const SoftTouch* SoftTouches::before_of(uint64_t key) const {
    const std::pair sides(world_.collider_handle(static_cast<uint32_t>(key >> 32)).bits,
                          world_.collider_handle(static_cast<uint32_t>(key)).bits);
    const auto at = std::ranges::lower_bound(all_.touch, sides, {}, sides_of);
    return at != all_.touch.end() && sides_of(*at) == sides ? &*at : nullptr;
}

void SoftTouches::end() {
    const size_t told = all_.touch_now.size();
    for (const SoftTouch& touch : all_.touch) {
        const auto now = all_.touch_now.begin() + static_cast<ptrdiff_t>(told);
        if (std::binary_search(all_.touch_now.begin(), now, touch,
                               [](const SoftTouch& a, const SoftTouch& b) { return sides_of(a) < sides_of(b); }))
            continue;
        if (rests(world_, touch.event.collider_a) && rests(world_, touch.event.collider_b)) {
            all_.touch_now.push_back(touch);
            all_.touch_now.back().hit = false;
        } else if (touch.asks & TAUT_CONTACT_EVENTS_BEGIN_END) {
            world_.contact_end.push_back(touch.event);
            world_.contact_end.back().step = world_.window.steps;
        }
    }
    if (all_.touch_now.size() > told) std::ranges::sort(all_.touch_now, {}, sides_of);
    all_.touch.swap(all_.touch_now);
}

}  // namespace taut
