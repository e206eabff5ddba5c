#include "check/quarantine.h"

#include <cmath>

namespace taut {

void quarantine(Nodes& nodes, const Array<uint32_t>& list, Array<uint32_t>& frozen) {
    for (uint32_t node : list) {
        NodeMotion& m = nodes.motion[node];
        if (sane(m)) continue;
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
    for (Pair& pair : pairs.list)
        for (Impulse& p : pair.impulse)
            if (!(std::isfinite(p.normal) && std::isfinite(p.tangent1) && std::isfinite(p.tangent2))) p = {};
    for (Joint& joint : joints.record)
        for (double& force : joint.lambda)
            if (!std::isfinite(force)) force = 0;
}

}  // namespace taut
