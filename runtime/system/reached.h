// What constraints end on though the step does not go through it: fixed nodes and such that sleep.
#pragma once

#include <span>

#include "state/joints.h"
#include "state/pairs.h"

namespace taut {

// Whether a node has a seat only where something of the step ends on it.
inline bool stands_by(const Nodes& nodes, uint32_t node) {
    return nodes.rest[node] == Rest::asleep || nodes.info[node].kind == NodeKind::fixed;
}

// Ends of what touches, of joints, and those of elements, which are `held`; some of them more than once.
void list_reached(const Nodes& nodes, const Joints& joints, const Pairs& pairs, std::span<const uint32_t> held,
                  Array<uint32_t>& reached);

// Of contacts of surfaces, which come and go within a step.
void add_reached(const Nodes& nodes, const SurfaceContacts& surfaces, Array<uint32_t>& reached);

}  // namespace taut
