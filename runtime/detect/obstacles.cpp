#include "detect/obstacles.h"

#include "detect/surfaces.h"

namespace taut {
namespace {

bool is_obstacle(const Nodes& nodes, const Collider& collider) {
    if (collider.node == kNone || collider.sensor || collider.node_b != kNone) return false;
    const NodeKind kind = nodes.info[collider.node].kind;
    return (kind == NodeKind::fixed || kind == NodeKind::kinematic) && nodes.info[collider.node].soft == kNone;
}

// Box of a shape's box, turned.
void find_box(const collision::Box& box, Obstacle& out) {
    const Vec3 half = 0.5 * (box.hi - box.lo).cast<double>(), middle = 0.5 * (box.hi + box.lo).cast<double>();
    const Vec3 reach = out.rotation.cwiseAbs() * half, at = out.position + out.rotation * middle;
    out.lo = at - reach;
    out.hi = at + reach;
}

}  // namespace

void find_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
                    Obstacles& out) {
    out.list.clear();
    out.met.clear();
    out.first.assign(softs.record.size(), 0);
    out.count.assign(softs.record.size(), 0);
    out.radius.assign(softs.record.size(), 0);
    out.push.clear();
    for (uint32_t c = 0; c < colliders.record.size(); ++c)
        if (is_obstacle(nodes, colliders.record[c]))
            out.list.push_back({&shapes[colliders.record[c].shape].shape, c, colliders.record[c].node});
    for (uint32_t s = 0; s < softs.record.size(); ++s) {
        const uint32_t own = softs.record[s].node.empty() ? kNone : collider_of(nodes, softs.record[s]);
        out.first[s] = static_cast<uint32_t>(out.met.size());
        if (own == kNone) continue;
        out.radius[s] = collision::ball_radius(shapes[colliders.record[own].shape].shape);
        const ColliderTraits& traits = colliders.traits[own];
        for (uint32_t i = 0; i < out.list.size(); ++i) {
            const ColliderTraits& other = colliders.traits[out.list[i].collider];
            if (!filters_agree(traits.filter, other.filter)) continue;
            const auto friction = static_cast<double>(friction_of(traits.material, other.material));
            out.met.push_back({i, friction});
        }
        out.count[s] = static_cast<uint32_t>(out.met.size()) - out.first[s];
    }
}

void place_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, double elapsed,
                     Obstacles& obstacles) {
    for (Obstacle& each : obstacles.list) {
        const Collider& collider = colliders.record[each.collider];
        const NodeMotion& motion = nodes.motion[each.node];
        const Mat3 turn = (rotation_from_vector(elapsed * motion.w) * motion.q).normalized().toRotationMatrix();
        each.v = motion.v;
        each.w = motion.w;
        each.centre = motion.x + elapsed * motion.v;
        each.rotation = turn * collider.rotation.toRotationMatrix();
        each.position = each.centre + turn * (collider.position - nodes.mass[each.node].centre);
        const ColliderTraits& traits = colliders.traits[each.collider];
        each.surface_v = each.rotation * traits.surface_velocity.cast<double>();
        each.surface_w = each.rotation * traits.surface_spin.cast<double>();
        find_box(shapes[collider.shape].box, each);
    }
}

}  // namespace taut
