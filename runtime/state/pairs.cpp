#include "state/pairs.h"

#include "state/handle.h"

namespace taut {

void reserve_slots(Pairs& pairs, size_t more) {
    if (more > pairs.free.size()) reserve_more(pairs.list, more - pairs.free.size());
    pairs.free.reserve(pairs.list.capacity());
}

uint32_t take_slot(Pairs& pairs, const PairEnds& ends) {
    uint32_t slot = static_cast<uint32_t>(pairs.list.size());
    if (pairs.free.empty()) {
        pairs.list.emplace_back();
    } else {
        slot = pairs.free.back();
        pairs.free.pop_back();
        pairs.list[slot] = Pair();
    }
    static_cast<PairEnds&>(pairs.list[slot]) = ends;
    return slot;
}

void give_slots(Pairs& pairs, NearPair& near) {
    for_parts(pairs, near, [&](Pair& pair) {
        pair.manifold.count = 0;
        pair.touching = false;
        pairs.free.push_back(static_cast<uint32_t>(&pair - pairs.list.data()));
    });
    near.pair = kNone;
}

void report_end(Pairs& pairs, const Nodes& nodes, const Colliders& colliders, const NearPair& near) {
    if (!(near.asks & TAUT_CONTACT_EVENTS_BEGIN_END)) return;
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), pairs.world});
    };
    const PairEnds ends = near.ends(colliders);
    pairs.ended.push_back({{bits(nodes.ids, ends.a)},
                           {bits(nodes.ids, ends.b)},
                           {bits(colliders.ids, ends.collider_a())},
                           {bits(colliders.ids, ends.collider_b())},
                           0,
                           0});
}

}  // namespace taut
