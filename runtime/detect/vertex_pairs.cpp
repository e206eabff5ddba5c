#include "detect/vertex_pairs.h"

#include <algorithm>
#include <limits>

namespace taut {
namespace {

bool is_round(const collision::Shape& shape) {
    return shape.kind == collision::ShapeKind::sphere || shape.kind == collision::ShapeKind::capsule;
}

// Of a node: vertices got theirs one after another, but for those that came later by tearing.
uint32_t vertex_of(const Soft& soft, uint32_t node) {
    const uint32_t index = node - soft.node.front();
    if (index < soft.vertices() && soft.node[index] == node) return index;
    return static_cast<uint32_t>(std::ranges::find(soft.node, node) - soft.node.begin());
}

// How far a shape reaches along a direction, from its origin [m].
float reach_of(collision::Shape shape, const Mat3f& rotation, const Vec3f& direction) {
    if (is_round(shape)) shape.size.x() = 0;  // of its axis
    const Mat3f from = turn_between(direction.cast<double>(), Vec3::UnitY()).toRotationMatrix().cast<float>();
    return collision::bounds(shape, {Vec3::Zero(), from * rotation}).hi.y();
}

}  // namespace

VertexPair::VertexPair(const Nodes& nodes, const Softs& softs, const ActivePair& pair) {
    for (const uint32_t node : {pair.a, pair.b}) {
        if (!is_surface_vertex(nodes, softs, node)) continue;
        const uint32_t soft = nodes.info[node].soft;
        if (softs.mesh.size() <= soft || softs.mesh[soft].version != softs.record[soft].mesh_version) continue;
        second_ = node == pair.b;
        feature_ = {SurfaceFeature::Of::vertex, &softs.record[soft], &softs.mesh[soft],
                    vertex_of(softs.record[soft], node)};
        return;
    }
}

Turned turn_normal(const SurfaceFeature& feature, const collision::Shape& shape, const collision::Placement& at,
                   const Vec3& x, const Vec3f& direction, float margin) {
    const Vec3f normal = feature.in_cone(direction);
    const bool turns = normal != direction && shape.kind != collision::ShapeKind::plane && !collision::has_parts(shape);
    if (!turns) return {direction, -std::numeric_limits<float>::infinity()};
    const float round = is_round(shape) ? shape.size.x() : 0;
    const float clear = normal.dot((at.position - x).cast<float>()) - reach_of(shape, at.rotation, -normal) - round -
                        feature.mesh->radius;
    if (!(clear > -depth_within(feature.mesh->radius + round, margin)))
        return {direction, -std::numeric_limits<float>::infinity()};
    return {normal, clear};
}

void turn_into_cone(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
                    Pairs& pairs, const ActivePair& active) {
    const VertexPair of(nodes, softs, active);
    Pair& pair = pairs.list[active.pair];
    if (!of.mesh() || pair.manifold.count == 0) return;
    const uint32_t collider = of.is_second() ? pair.collider_a() : pair.collider_b();
    const collision::Shape& shape = shapes[colliders.record[collider].shape].shape;
    const Vec3& x = nodes.motion[of.is_second() ? active.b : active.a].x;
    const Vec3f out = of.is_second() ? Vec3f(-pair.manifold.normal) : pair.manifold.normal;
    const Turned turned = turn_normal(held_feature(nodes, of.feature()), shape, pairs.placement[collider], x, out,
                                      pairs.travel[collider].margin);
    if (turned.normal == out) return;
    pair.manifold.normal = of.is_second() ? Vec3f(-turned.normal) : turned.normal;
    // What was found ahead of time came back along the direction from then.
    float& separation = pair.manifold.points[0].separation;
    separation = std::max(separation, turned.clear);
}

}  // namespace taut
