#include "state/pairs.h"

#include "state/handle.h"

namespace taut {

void report_end(Pairs& pairs, const Nodes& nodes, const Colliders& colliders, const Pair& pair) {
    if (!(pair.asks & TAUT_CONTACT_EVENTS_BEGIN_END)) return;
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), pairs.world});
    };
    pairs.ended.push_back({{bits(nodes.ids, pair.a)},
                           {bits(nodes.ids, pair.b)},
                           {bits(colliders.ids, pair.collider_a())},
                           {bits(colliders.ids, pair.collider_b())},
                           0,
                           0});
}

}  // namespace taut
