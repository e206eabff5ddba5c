// Taking contacts that were found out of the step.
#pragma once

#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

// Goes through pairs.active in order and removes those for which is_dropped(item, first) says so; first: the record of
// part 0 of its pair. They are as if they had no points: a pair that touched and loses all ends.
template <class IsDropped>
void drop_contacts(const Nodes& nodes, const Colliders& colliders, Pairs& pairs, IsDropped&& is_dropped) {
    Array<ActivePair>& active = pairs.active;
    auto kept = active.begin();
    for (auto item = active.begin(); item != active.end();) {
        Pair& first = first_of(pairs, item->pair);
        const auto before = kept;
        // The parts of a pair.
        for (; item != active.end() && pairs.list[item->pair].key == first.key; ++item) {
            if (is_dropped(*item, first)) {
                Pair& pair = pairs.list[item->pair];
                pair.manifold.count = 0;
                if (pair.part != 0) pair.touching = false;
            } else {
                *kept++ = *item;
            }
        }
        if (kept != before || !first.touching) continue;
        report_end(pairs, nodes, colliders, first);
        first.touching = false;
    }
    active.erase(kept, active.end());
}

}  // namespace taut
