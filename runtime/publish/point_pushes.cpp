// What vertices pushed obstacles by, as contacts of surfaces, for those who ask for contacts, events and sleep.
#include <algorithm>
#include <tuple>

#include "detect/surface_finder.h"
#include "publish/contact_watch.h"

namespace taut {
namespace {

SurfaceContact contact_of(const PointPush& push, const Softs& softs, const Nodes& nodes) {
    const uint32_t soft = nodes.info[push.node].soft;
    SurfaceContact out;
    out.a = uint64_t{soft} << 32 | push.node;
    out.collider[0] = collider_of(nodes, softs.record[soft]);
    if (push.collider != kNone) {
        out.b = feature_of_shape(push.collider, 0);
        out.collider[1] = push.collider;
        out.node[0] = push.other[0], out.weight[0] = -1;
        out.node[1] = push.node, out.weight[1] = 1;
        out.lever = push.lever.cast<float>();
    } else {
        const uint32_t other = nodes.info[push.other[0]].soft;
        out.b = uint64_t{other} << 32 | push.other[0];
        out.collider[1] = collider_of(nodes, softs.record[other]);
        out.node[0] = push.node, out.weight[0] = 1;
        for (int k = 0; k < 3; ++k) {
            if (push.weight[k] == 0) continue;
            out.node[k + 1] = push.other[k];
            out.weight[k + 1] = -push.weight[k];
        }
    }
    out.approach = static_cast<float>(push.approach);
    return out;
}

}  // namespace

void tell_pushes(double substep, const Softs& softs, const Nodes& nodes, Obstacles& obstacles,
                 SurfaceContacts& surfaces) {
    const auto name = [](const PointPush& push) { return std::tuple(push.node, push.collider, push.other[0]); };
    std::ranges::stable_sort(obstacles.push, {}, name);
    for (size_t i = 0; i < obstacles.push.size(); ++i) {
        const PointPush& push = obstacles.push[i];
        if (i == 0 || name(obstacles.push[i - 1]) != name(push))
            surfaces.contact.push_back(contact_of(push, softs, nodes));
        SurfaceContact& contact = surfaces.contact.back();
        const Vec3f n = push.normal.cast<float>(), t1 = tangent_of(n), t2 = n.cross(t1);
        const Vec3f rubbed = push.rubbed.cast<float>();
        const auto impulse = static_cast<float>(push.impulse), rate = static_cast<float>(1 / substep);
        contact.normal = n;
        contact.gap = static_cast<float>(push.gap);
        contact.pushed += impulse;
        contact.push += impulse * n;
        contact.rubbed += rubbed;
        contact.force = {rate * impulse, rate * rubbed.dot(t1), rate * rubbed.dot(t2)};
    }
    std::ranges::sort(surfaces.contact, {}, [](const SurfaceContact& each) { return std::pair(each.a, each.b); });
}

}  // namespace taut
