// Why islands have rows that are solved directly, for reports.
#include "partition/partition.h"

namespace taut {

void Partition::find_reasons(const Joints& joints, const Elements& elements, Array<uint8_t>& out) const {
    out.assign(island_.size(), 0);
    for (const Block& block : blocks) {
        uint32_t root = block.nodes[0];
        while (parent_[root] != root) root = parent_[root];
        const Component& component = component_[root];
        const uint32_t island = island_of_[block.nodes[0]];
        const auto reason = [](JointSolve solve) { return solve == JointSolve::direct ? kByJoint : kByLoad; };
        for (const uint32_t j : block.joints) out[island] |= reason(joints.record[j].solve);
        for (const auto* list : {&block.elements, &block.elastic})
            for (const ElementRef& e : *list) out[island] |= reason(elements.set[e.set].solve);
        if (block.pairs.empty()) continue;
        if (island_[island].tower) out[island] |= kByTower;
        if (component.hit || block.memory.hit_left > 0) out[island] |= kByHit;
        if (component.loaded && !component.hit && block.memory.hit_left == 0) out[island] |= kByLoad;
    }
    for (const Press& press : presses_)
        if (pair_in_block_[press.pair]) out[island_of_[press.light]] |= kByPress;
    for (size_t i = 0; i < island_.size(); ++i)
        if (island_[i].squeezed) out[i] |= kSqueezed;
}

}  // namespace taut
