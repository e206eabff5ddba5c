#include "check/minimised.h"

#include <algorithm>

namespace taut {
namespace {

bool may_touch(const World& world, uint32_t node) {
    bool any = false;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        const taut_filter& filter = world.colliders.traits[c].filter;
        any = any || (!world.colliders.record[c].sensor && (filter.mask != 0 || filter.group > 0));
    });
    return any;
}

}  // namespace

const char* why_not_minimised(const World& world) {
    if (!solvers()[world.def.solver]->energies) return nullptr;
    if (world.joints.ids.count() > 0) return "joints: TAUT_SOLVER_MINIMISATION takes none";
    for (uint32_t node = 0; node < world.nodes.slots(); ++node) {
        const NodeKind kind = world.nodes.info[node].kind;
        if (kind == NodeKind::dynamic) return "a rigid dynamic body: TAUT_SOLVER_MINIMISATION takes none";
        if (kind == NodeKind::particle && may_touch(world, node))
            return "a particle or vertex that may touch (filter.mask is not 0): TAUT_SOLVER_MINIMISATION has no "
                   "contacts";
    }
    for (const ElementSet& set : world.elements.set)
        if (set.type && set.size() > 0 && !(set.stiffness[0] > 0))
            return "a compliance of 0: TAUT_SOLVER_MINIMISATION takes what gives way";
    return nullptr;
}

}  // namespace taut
