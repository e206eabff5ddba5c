#include "check/quarantine.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace taut {

namespace {

// Of a node in its motion, and in what its load makes of that within h.
Divergence divergence_of(const Nodes& nodes, uint32_t node, double h) {
    const NodeMotion& m = nodes.motion[node];
    const NodeLoad& load = nodes.load_of(node);
    const Divergence now = divergence_of(m);
    if (now != Divergence::none || !load.any()) return now;
    const NodeMass& mass = nodes.mass[node];
    NodeMotion after = m;
    after.v += h * mass.inv_mass * load.force;
    after.w += h * (m.q * (mass.inv_inertia.matrix() * (m.q.conjugate() * load.torque)));
    nodes.locks_of(node).hold(after.v, after.w);
    return divergence_of(after);
}

constexpr uint32_t kGrain = 256;  // nodes that a thread takes at a time

struct Findings {
    bool loaded = false, bad = false;
};

Findings look_at(Team& team, const Nodes& nodes, const Array<uint32_t>& list, double h) {
    std::atomic<bool> loaded{false}, bad{false};
    team.for_ranges(static_cast<uint32_t>(list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            if (nodes.load_of(list[i]).any()) loaded.store(true, std::memory_order_relaxed);
            if (divergence_of(nodes, list[i], h) != Divergence::none) bad.store(true, std::memory_order_relaxed);
        }
    });
    return {loaded.load(std::memory_order_relaxed), bad.load(std::memory_order_relaxed)};
}

}  // namespace

bool quarantine(Team& team, Nodes& nodes, const Array<uint32_t>& list, Array<uint32_t>& frozen, double h) {
    const Findings found = look_at(team, nodes, list, h);
    if (!found.bad) return found.loaded;
    const auto first = static_cast<std::ptrdiff_t>(frozen.size());
    for (const uint32_t node : list) {
        if (divergence_of(nodes, node, h) == Divergence::none) continue;
        if (moves_by_forces(nodes.info[node].kind))
            frozen.push_back(node);
        else
            nodes.stay(node);  // frozen in this frame, and told
    }
    std::sort(frozen.begin() + first, frozen.end());
    for (auto node = frozen.begin() + first; node != frozen.end(); ++node)
        nodes.freeze(*node, divergence_of(nodes, *node, h));
    return found.loaded;
}

void drop_bad_impulses(Pairs& pairs, Joints& joints, Elements& elements) {
    const auto drop = [](ContactForce& p) {
        if (!(std::isfinite(p.normal) && std::isfinite(p.tangent1) && std::isfinite(p.tangent2))) p = {};
    };
    for (Pair& pair : pairs.list) {
        for (ContactForce& p : pair.force) drop(p);
        drop(pair.torque);
    }
    for (GrainContact& contact : pairs.grains.contact)
        if (!contact.force.allFinite()) contact.force.setZero();
    for (SurfaceContact& contact : pairs.surfaces.contact) drop(contact.force);
    for (Joint& joint : joints.record) {
        bool bad = false;
        for (double& force : joint.lambda) {
            bad = bad || !std::isfinite(force);
            if (!std::isfinite(force)) force = 0;
        }
        if (bad) std::fill(joint.memory, joint.memory + kMaxRows, AxisMemory{});
    }
    for (ElementSet& set : elements.set) {
        for (double& force : set.lambda)
            if (!std::isfinite(force)) force = 0;
        for (AxisMemory& memory : set.memory)
            if (!std::isfinite(memory.upper)) memory = {};
    }
}

}  // namespace taut
