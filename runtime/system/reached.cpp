#include "system/reached.h"

namespace taut {
namespace {

void add(const Nodes& nodes, std::span<const uint32_t> ends, Array<uint32_t>& reached) {
    for (const uint32_t node : ends) {
        if (node == kNone || !stands_by(nodes, node)) continue;
        reserve_more(reached, 1);
        reached.push_back(node);
    }
}

}  // namespace

void list_reached(const Nodes& nodes, const Joints& joints, const Pairs& pairs, std::span<const uint32_t> held,
                  Array<uint32_t>& reached) {
    reached.clear();
    for (const ActivePair& pair : pairs.active) add(nodes, pair.nodes(), reached);
    for (const Joint& joint : joints.record)
        if (joint.works()) add(nodes, joint.nodes(), reached);
    for (const GrainContact& contact : pairs.grains.contact) add(nodes, std::array{contact.a, contact.b}, reached);
    add(nodes, held, reached);
    add_reached(nodes, pairs.surfaces, reached);
}

void add_reached(const Nodes& nodes, const SurfaceContacts& surfaces, Array<uint32_t>& reached) {
    for (const SurfaceContact& contact : surfaces.contact) add(nodes, contact.node, reached);
}

}  // namespace taut
