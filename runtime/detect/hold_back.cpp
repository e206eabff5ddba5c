#include <algorithm>

#include "detect/detect.h"
#include "detect/impact.h"

namespace taut {
namespace {

constexpr double kCore = 0.5;  // of the ball inside a shape

// A collider from the frame's start to its end, its turning left out.
struct Passage {
    Passage(const Nodes& nodes, const Collider& collider, const collision::Shape& s)
        : shape(s), node(collider.node), at(placed(nodes, collider)) {
        along = way_of(nodes, node);
        if (collider.node_b != kNone) along = 0.5 * (along + way_of(nodes, collider.node_b));
    }

    static Vec3 way_of(const Nodes& nodes, uint32_t of) {
        const NodePose& before = nodes.before[of];
        return nodes.motion[of].x - before.position - before.rotation * nodes.mass[of].centre;
    }

    static collision::Placement placed(const Nodes& nodes, const Collider& collider) {
        const NodePose& before = nodes.before[collider.node];
        if (collider.node_b != kNone) return place_between(before.position, nodes.before[collider.node_b].position);
        return {before.position + before.rotation * collider.position,
                (before.rotation * collider.rotation).toRotationMatrix().cast<float>()};
    }

    const collision::Shape& shape;
    uint32_t node;
    collision::Placement at;  // at the start
    Vec3 along;               // [m]
};

// How far b's way against a goes on after its core met a [m].
Vec3 excess(const Passage& a, const Passage& b) {
    const Vec3 along = b.along - a.along;
    const double radius = kCore * collision::thickness(b.shape);
    if (along.norm() <= radius) return Vec3::Zero();
    collision::Shape core;
    core.kind = collision::ShapeKind::sphere;
    core.size.x() = static_cast<float>(radius);
    const Vec3 from = b.at.position + b.at.rotation.cast<double>() * collision::middle(b.shape);
    collision::Hit hit;
    if (!collision::cast_shape(core, {from, Mat3f::Identity()}, along, a.shape, a.at, 1, hit) || hit.inside)
        return Vec3::Zero();
    return (1 - hit.fraction) * along;
}

// Of inverse mass, where nothing holds the node [1/kg]: no joint, no sleep, no quarantine.
double ease(const Nodes& nodes, const Joints& joints, uint32_t node) {
    if (!nodes.solved(node)) return 0;
    const bool held = std::any_of(joints.record.begin(), joints.record.end(),
                                  [&](const Joint& joint) { return joint.type && ends_on(joint, node); });
    return held ? 0 : nodes.mass[node].inv_mass;
}

}  // namespace

void hold_back(const Colliders& colliders, const Shapes& shapes, const Joints& joints, const Pairs& pairs,
               Nodes& nodes) {
    for (uint64_t key : pairs.fast) {
        const Collider &one = colliders.record[key >> 32], &other = colliders.record[static_cast<uint32_t>(key)];
        const collision::Shape &shape_one = shapes.record[one.shape].shape,
                               &shape_other = shapes.record[other.shape].shape;
        const bool swapped = collision::spin_radius(shape_one, 0) < collision::spin_radius(shape_other, 0);
        const Passage a(nodes, swapped ? other : one, swapped ? shape_other : shape_one);
        const Passage b(nodes, swapped ? one : other, swapped ? shape_one : shape_other);
        const Vec3 too_far = excess(a, b);
        if (too_far == Vec3::Zero()) continue;
        const double ease_a = ease(nodes, joints, a.node), ease_b = ease(nodes, joints, b.node);
        if (!(ease_a + ease_b > 0)) continue;
        nodes.motion[a.node].x += ease_a / (ease_a + ease_b) * too_far;
        nodes.motion[b.node].x -= ease_b / (ease_a + ease_b) * too_far;
    }
}

}  // namespace taut
