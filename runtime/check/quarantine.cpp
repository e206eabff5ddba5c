#include "check/quarantine.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace taut {

namespace {

bool pushed_too_hard(const NodeMotion& m, const NodeMass& mass, const NodeLoad& load, double h) {
    if (load.force == Vec3::Zero() && load.torque == Vec3::Zero()) return false;
    NodeMotion after = m;
    after.v += h * mass.inv_mass * load.force;
    after.w += h * (m.q * (mass.inv_inertia.matrix() * (m.q.conjugate() * load.torque)));
    return !sane(after);
}

bool is_bad(const Nodes& nodes, uint32_t node, double h) {
    const NodeMotion& m = nodes.motion[node];
    return !sane(m) || pushed_too_hard(m, nodes.mass[node], nodes.load[node], h);
}

constexpr uint32_t kGrain = 256;  // nodes that a thread takes at a time

bool any_bad(Team& team, const Nodes& nodes, const Array<uint32_t>& list, double h) {
    std::atomic<bool> any{false};
    team.for_ranges(static_cast<uint32_t>(list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            if (is_bad(nodes, list[i], h)) any.store(true, std::memory_order_relaxed);
    });
    return any.load(std::memory_order_relaxed);
}

}  // namespace

void quarantine(Team& team, Nodes& nodes, const Array<uint32_t>& list, Array<uint32_t>& frozen, double h) {
    if (!any_bad(team, nodes, list, h)) return;
    for (uint32_t node : list) {
        if (!is_bad(nodes, node, h)) continue;
        NodeMotion& m = nodes.motion[node];
        nodes.load[node] = {};
        const NodePose& last = nodes.before[node];
        m = {};
        m.q = last.rotation;
        m.x = last.position + last.rotation * nodes.mass[node].centre;
        nodes.info[node].kind = NodeKind::fixed;
        nodes.mass[node].mass = nodes.mass[node].inv_mass = 0;
        nodes.mass[node].inertia = nodes.mass[node].inv_inertia = {};
        frozen.push_back(node);
    }
}

void drop_bad_impulses(Pairs& pairs, Joints& joints) {
    const auto drop = [](Impulse& p) {
        if (!(std::isfinite(p.normal) && std::isfinite(p.tangent1) && std::isfinite(p.tangent2))) p = {};
    };
    for (Pair& pair : pairs.list) {
        for (Impulse& p : pair.impulse) drop(p);
        drop(pair.turning);
    }
    for (Joint& joint : joints.record) {
        bool bad = false;
        for (double& force : joint.lambda) {
            bad = bad || !std::isfinite(force);
            if (!std::isfinite(force)) force = 0;
        }
        if (bad) std::fill(joint.memory, joint.memory + kMaxRows, AxisMemory{});
    }
}

}  // namespace taut
