// Taking contacts that were found out of the step.
#pragma once

#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

// Goes through pairs.active in order and removes those for which is_dropped(item, near) says so; near: the pair that
// it is of, or a part of. They are as if they had no points: a pair that touched and loses all ends.
template <class IsDropped>
void drop_contacts(const Nodes& nodes, const Colliders& colliders, Pairs& pairs, IsDropped&& is_dropped) {
    Array<ActivePair>& active = pairs.active;
    auto kept = active.begin();
    for (auto item = active.begin(); item != active.end();) {
        const uint32_t index = item->near;
        NearPair& near = pairs.near[index];
        const auto before = kept;
        // The parts of a pair.
        for (; item != active.end() && item->near == index; ++item) {
            if (is_dropped(*item, near)) {
                Pair& pair = pairs.list[item->pair];
                pair.manifold.count = 0;
                pair.touching = false;
            } else {
                *kept++ = *item;
            }
        }
        if (kept != before || !near.touching) continue;
        report_end(pairs, nodes, colliders, near);
        near.touching = false;
    }
    active.erase(kept, active.end());
}

}  // namespace taut
