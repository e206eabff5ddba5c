#include "detect/impact.h"

#include "state/levers.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace taut {
namespace {

constexpr double kReach = 0.25 * static_cast<double>(kContactMargin);  // as near as this have met [m], and
constexpr double kReachOfThickness = 0.25;                             // so much of the thicker one at most
static_assert(kReach < static_cast<double>(kLeastContactMargin));
constexpr double kDepth = 0.25;  // of the thinner one: what stays above grazes, and is left to the next frame
// What lies within so many radii of a ball inside a shape, about the centre that it turns about, is as good as thick:
// it grazes what it turns past, by as little as this in a frame [rad]. Cubes, stones and bricks of 2:1:1 lie within,
// rods do not.
constexpr double kThick = 2.5, kMostThick = 1;
constexpr double kLeastThick = 0.02;  // below, nothing gets far either way [rad]

// World from body, as placed.
Mat3 rotation_of(const Collider& collider, const collision::Placement& at) {
    return at.rotation.cast<double>() * collider.rotation.conjugate().toRotationMatrix();
}

// From where its collider is placed now.
collision::Motion motion_of(const Nodes& nodes, const Collider& collider, const ShapeRecord& record,
                            const collision::Placement& at) {
    const Movement m = movement_of(nodes, collider.node, collider.node_b);
    if (collider.node_b != kNone) return {at, m.x, m.v, m.w, collision::spin_radius(record.shape, 0)};
    const Vec3 lever = nodes.mass[collider.node].centre - collider.position;
    if (lever == Vec3::Zero()) return {at, at.position, m.v, m.w, record.reach};
    return {at, at.position + rotation_of(collider, at) * lever, m.v, m.w, record.reach + lever.norm()};
}

const ShapeRecord& record_of(const Shapes& shapes, const Collider& collider) { return shapes[collider.shape]; }

// From the origin of a collider's node to the centre that it turns about.
Vec3 arm_of(const Nodes& nodes, const Collider& collider, const collision::Motion& motion) {
    if (collider.node_b != kNone) return motion.centre - nodes.motion[collider.node].x;
    const Vec3& centre = nodes.mass[collider.node].centre;
    return centre == Vec3::Zero() ? centre : Vec3(rotation_of(collider, motion.at) * centre);
}

bool looked_for(const Nodes& nodes, uint32_t node) {
    return node == kNone || nodes.info[node].continuous || nodes.info[node].kind == NodeKind::fixed;
}

// How far what is not thick gets as a shape turns by an angle [rad], [m].
double turning_way(const Nodes& nodes, const Collider& collider, const ShapeRecord& record, double angle) {
    if (angle == 0) return 0;
    const collision::Shape& shape = record.shape;
    if (collider.node_b != kNone) return angle * collision::spin_radius(shape, 0);
    const Vec3 lever = collider.position - nodes.mass[collider.node].centre;
    const double core = lever.norm() + record.reach;
    if (angle < kLeastThick || angle > kMostThick) return angle * core;
    const Vec3 middle = lever + collider.rotation * collision::middle(shape);
    const double ball = std::max(0.0, collision::thickness(shape) - middle.norm());
    return angle * std::clamp(core + collision::ball_radius(shape) - kThick * ball, 0.0, core);
}

}  // namespace

Pace pace_of(const Nodes& nodes, const Collider& collider, const ShapeRecord& record, double time) {
    const collision::Shape& shape = record.shape;
    const auto round = static_cast<float>(collision::ball_radius(shape));
    const bool rolls = collision::rolls(shape);
    if (!looked_for(nodes, collider.node) || !looked_for(nodes, collider.node_b))
        return {std::numeric_limits<double>::infinity(), 0, round, rolls};
    const double angle = time * spin_of(nodes, collider.node, collider.node_b).norm();
    return {collision::thickness(shape), turning_way(nodes, collider, record, angle), round, rolls};
}

bool is_fast(const Nodes& nodes, const Pairs& pairs, const PairEnds& pair, double time) {
    const Pace &a = pairs.pace[pair.collider_a()], &b = pairs.pace[pair.collider_b()];
    const double linear = time * (movement_of(nodes, pair.a, pair.a2).v - movement_of(nodes, pair.b, pair.b2).v).norm();
    return linear + a.turning + b.turning > a.thickness + b.thickness;
}

bool stay_apart(const Nodes& nodes, const Pairs& pairs, const PairEnds& pair, double time) {
    if (pair.a2 != kNone || pair.b2 != kNone) return false;
    double touch = kReach;
    Vec3 velocity[2];
    const uint32_t node[] = {pair.a, pair.b}, collider[] = {pair.collider_a(), pair.collider_b()};
    for (int i = 0; i < 2; ++i) {
        if (nodes.info[node[i]].kind == NodeKind::kinematic) return false;  // may be placed ahead of its centre
        // A point on a lever l leaves the tangent of its way by no more than |w|^2 l t^2 / 2.
        const NodeMotion& m = nodes.motion[node[i]];
        const Vec3 lever = pairs.placement[collider[i]].position - m.x;
        const double angle = kAhead * time * m.w.norm();
        velocity[i] = m.v + m.w.cross(lever);
        touch += 0.5 * angle * angle * lever.norm() + static_cast<double>(pairs.stance[collider[i]].size);
    }
    const Vec3 apart = pairs.placement[collider[1]].position - pairs.placement[collider[0]].position,
               way = velocity[1] - velocity[0];
    const double squared = way.squaredNorm();
    const double nearest = squared > 0 ? std::clamp(-apart.dot(way) / squared, 0.0, kAhead * time) : 0.0;
    return (apart + nearest * way).squaredNorm() > touch * touch;
}

Encounter::Encounter(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
                     const PairEnds& pair)
    : Encounter(nodes, shapes, colliders.record[pair.collider_a()], pairs.placement[pair.collider_a()],
                colliders.record[pair.collider_b()], pairs.placement[pair.collider_b()]) {}

Encounter::Encounter(const Nodes& nodes, const Shapes& shapes, const Collider& a, const collision::Placement& at_a,
                     const Collider& b, const collision::Placement& at_b)
    : a_(record_of(shapes, a).shape),
      b_(record_of(shapes, b).shape),
      motion_a_(motion_of(nodes, a, record_of(shapes, a), at_a)),
      motion_b_(motion_of(nodes, b, record_of(shapes, b), at_b)),
      arm_a_(arm_of(nodes, a, motion_a_)) {}

double Encounter::meeting(double time) const {
    const double one = collision::thickness(a_), other = collision::thickness(b_);
    const double thinner = one > 0 && other > 0 ? std::min(one, other) : std::max(one, other);
    const double reach = std::min(kReach, kReachOfThickness * std::max(one, other));
    return collision::find_impact(a_, motion_a_, b_, motion_b_, reach, kDepth * thinner, kAhead * time);
}

void Encounter::bring_to_present(Pair& pair) const {
    const Movement a = {motion_a_.centre, motion_a_.velocity, motion_a_.spin},
                   b = {motion_b_.centre, motion_b_.velocity, motion_b_.spin};
    const auto axle = [](const collision::Shape& shape, const collision::Motion& motion) {
        if (!collision::rolls(shape)) return Axle{};
        return Axle{motion.at.rotation.col(1).cast<double>(), motion.at.position - motion.centre};
    };
    const Axles axles = {axle(a_, motion_a_), axle(b_, motion_b_)};
    for (int k = 0; k < pair.manifold.count; ++k) {
        float& separation = pair.manifold.points[k].separation;
        const Levers levers = levers_of(pair, k, static_cast<double>(separation), arm_a_, axles, a, b);
        separation -= static_cast<float>(growth_of(pair, levers, axles, a, b));
    }
}

}  // namespace taut
