#include "check/quarantine.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace taut {

namespace {

bool pushed_too_hard(const NodeMotion& m, const NodeMass& mass, const NodeLoad& load, double h) {
    NodeMotion after = m;
    after.v += h * mass.inv_mass * load.force;
    after.w += h * (m.q * (mass.inv_inertia.matrix() * (m.q.conjugate() * load.torque)));
    return !sane(after);
}

bool is_bad(const Nodes& nodes, uint32_t node, double h) {
    const NodeMotion& m = nodes.motion[node];
    const NodeLoad& load = nodes.load_of(node);
    return !sane(m) || (load.any() && pushed_too_hard(m, nodes.mass[node], load, h));
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
            if (is_bad(nodes, list[i], h)) bad.store(true, std::memory_order_relaxed);
        }
    });
    return {loaded.load(std::memory_order_relaxed), bad.load(std::memory_order_relaxed)};
}

}  // namespace

bool quarantine(Team& team, Nodes& nodes, const Array<uint32_t>& list, Array<uint32_t>& frozen, double h) {
    const Findings found = look_at(team, nodes, list, h);
    if (!found.bad) return found.loaded;
    const size_t first = frozen.size();
    for (uint32_t node : list)
        if (is_bad(nodes, node, h)) frozen.push_back(node);
    std::sort(frozen.begin() + static_cast<std::ptrdiff_t>(first), frozen.end());
    for (size_t i = first; i < frozen.size(); ++i) {
        const uint32_t node = frozen[i];
        NodeMotion& m = nodes.motion[node];
        nodes.mass.reserve_values(1);
        nodes.clear_load(node);
        const NodePose& last = nodes.before[node];
        m = {};
        m.q = last.rotation;
        m.x = last.position + last.rotation * nodes.mass[node].centre;
        nodes.info[node].kind = NodeKind::fixed;
        NodeMass none = nodes.mass[node];
        none.mass = none.inv_mass = 0;
        none.inertia = none.inv_inertia = {};
        nodes.mass.set(node, none);
    }
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
