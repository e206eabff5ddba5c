#include "state/pairs.h"

#include <algorithm>

#include "state/handle.h"

namespace taut {

void reserve_slots(Pairs& pairs, size_t more) {
    if (more > pairs.free.size()) pairs.list.reserve(pairs.list.size() + more - pairs.free.size());
    reserve_more(pairs.free, pairs.list.capacity() - pairs.free.size());
}

uint32_t take_slot(Pairs& pairs, const PairEnds& ends) {
    uint32_t slot = static_cast<uint32_t>(pairs.list.size());
    if (pairs.free.empty()) {
        pairs.list.emplace_back();
    } else {
        slot = pairs.free.back();
        pairs.free.pop_back();
        static const Pair fresh{};  // a constant: nothing of it is without a value
        pairs.list[slot] = fresh;
    }
    static_cast<PairEnds&>(pairs.list[slot]) = ends;
    return slot;
}

void forget_forces(Pair& pair) {
    std::fill(pair.force, pair.force + 4, ContactForce{});
    pair.torque = {};
    pair.spin_slip = -1;
}

void leave_block(Pair& pair) {
    if (!pair.in_block) return;
    pair.in_block = false;
    forget_forces(pair);
}

void give_slots(Pairs& pairs, NearPair& near) {
    for (uint32_t slot = near.pair; slot != kNone; slot = pairs.list[slot].next) {
        pairs.list[slot].manifold.count = 0;
        pairs.list[slot].touching = false;
        pairs.free.push_back(slot);
    }
    near.pair = kNone;
}

void trim(Pairs& pairs) noexcept {
    std::ranges::sort(pairs.free);
    for (; !pairs.free.empty() && pairs.free.back() + 1 == pairs.list.size(); pairs.free.pop_back())
        pairs.list.resize(pairs.list.size() - 1);
    std::ranges::reverse(pairs.free);
    pairs.near.trim();
    pairs.resting.trim();
    pairs.list.trim();
    trim(pairs.free);
    trim(pairs.active);
    trim(pairs.ended);
    trim(pairs.picked);
    trim(pairs.asked);
    trim(pairs.crowds);
}

namespace {

// Where the slot of a record is written down: at its near pair, at the record of the part before, or with the free
// ones.
uint32_t& link_to(Pairs& pairs, uint32_t slot) {
    const uint64_t key = pairs.list[slot].key;
    for (NearPairs* of : {&pairs.near, &pairs.resting}) {
        const auto near = std::ranges::lower_bound(*of, key, {}, &NearPair::key);
        if (near == of->end() || near->key != key) continue;
        for (uint32_t* link = &near->pair; *link != kNone; link = &pairs.list[*link].next)
            if (*link == slot) return *link;
    }
    return *std::ranges::find(pairs.free, slot);
}

void exchange_slots(Pairs& pairs, uint32_t one, uint32_t other) {
    uint32_t &to_one = link_to(pairs, one), &to_other = link_to(pairs, other);
    to_one = other;
    to_other = one;
    std::swap(pairs.list[one], pairs.list[other]);  // with a link from one to the other, if there is one
}

}  // namespace

void order_slots(Pairs& pairs) {
    constexpr uint32_t kLooks = 512, kMoves = 32;  // a frame
    constexpr uint32_t kAway = 16;                 // slots
    const auto count = static_cast<uint32_t>(pairs.active.size());
    for (uint32_t looks = 0, moves = 0; looks < std::min(kLooks, count) && moves < kMoves; ++looks) {
        const uint32_t to = pairs.next_ordered < count ? pairs.next_ordered : 0;
        pairs.next_ordered = to + 1;
        const uint32_t from = pairs.active[to].pair;
        if (std::max(from, to) - std::min(from, to) <= kAway) continue;
        exchange_slots(pairs, from, to);
        ++moves;
    }
}

void reserve_links(Pairs& pairs) { pairs.free.reserve(pairs.list.capacity()); }

void link_records(Pairs& pairs) {
    pairs.free.clear();
    pairs.active.clear();
    pairs.late.clear();
    pairs.joined_version = 0;
    pairs.next_ordered = 0;
    uint32_t slot = 0;
    const auto count = static_cast<uint32_t>(pairs.list.size());
    std::ranges::fill(pairs.met, uint8_t{0});
    for_near(pairs, [&](NearPair& near) {
        pairs.met[near.collider_a()] = pairs.met[near.collider_b()] = 1;
        for (uint32_t* link = &near.pair; slot < count && pairs.list[slot].key == near.key; ++slot) {
            *link = slot;
            link = &pairs.list[slot].next;
        }
    });
}

void report_end(Pairs& pairs, const Nodes& nodes, const Colliders& colliders, const NearPair& near) {
    if (!(near.asks & TAUT_CONTACT_EVENTS_BEGIN_END)) return;
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), pairs.world});
    };
    const PairEnds ends = near.ends(colliders);
    // Those of soft bodies are told with all else that touches the same; publish/soft_touches.h.
    if (nodes.info[ends.a].soft != kNone || nodes.info[ends.b].soft != kNone) return;
    pairs.ended.push_back({{bits(nodes.ids, ends.a)},
                           {bits(nodes.ids, ends.b)},
                           {bits(colliders.ids, ends.collider_a())},
                           {bits(colliders.ids, ends.collider_b())},
                           0,
                           0,
                           0,
                           0});
}

}  // namespace taut
