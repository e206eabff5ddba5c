#include "detect/passage.h"

#include <algorithm>

#include "detect/detect.h"

namespace taut {
namespace {

// Parts of the ball inside a shape.
constexpr double kCores[] = {0.8, 0.4, 0.2};  // the largest that is free at the start is what may not pass
constexpr double kSkin = 0.02;                // where none is, the middle stays so far off
constexpr double kSlack = 0.01;               // less is not put back
constexpr double kTurn = 0.02;                // a smaller turn moves no middle worth the name: sine of half of it

collision::Placement placed_before(const Nodes& nodes, const Collider& collider) {
    const NodePose& pose = nodes.before[collider.node];
    if (collider.node_b != kNone) return place_between(pose.position, nodes.before[collider.node_b].position);
    return {pose.position + pose.rotation * collider.position,
            (pose.rotation * collider.rotation).toRotationMatrix().cast<float>()};
}

// About the shape as it is.
collision::Box box_of(const Passage& passage) {
    if (passage.collider.node_b == kNone) return passage.record.box;
    return collision::bounds(passage.record.shape, {Vec3::Zero(), Mat3f::Identity()});
}

// Whether a ball that goes along may come by the box about a's shape.
bool comes_by(const Passage& a, double radius, const Vec3& from, const Vec3& along) {
    const Mat3 to_a = a.before.rotation.cast<double>().transpose();
    const Vec3 start = to_a * (from - a.before.position), way = to_a * along;
    const collision::Box box = box_of(a);
    double enter = 0, leave = 1;
    for (int i = 0; i < 3; ++i) {
        const double lo = static_cast<double>(box.lo[i]) - radius - start[i],
                     hi = static_cast<double>(box.hi[i]) + radius - start[i];
        if (way[i] == 0 && (lo > 0 || hi < 0)) return false;
        if (way[i] == 0) continue;
        enter = std::max(enter, std::min(lo / way[i], hi / way[i]));
        leave = std::min(leave, std::max(lo / way[i], hi / way[i]));
    }
    return enter <= leave;
}

// The part of b's way along which its core is free of a, up to 1.
double free_part(const Passage& a, const Passage& b, const Vec3& from, const Vec3& along, collision::Hit& hit) {
    const double inside = collision::thickness(b.record.shape);
    for (const double core : kCores) {
        collision::Shape ball;
        ball.size.x() = static_cast<float>(core * inside);
        if (!collision::cast_shape(ball, {from, Mat3f::Identity()}, along, a.record.shape, a.before, 1, hit)) return 1;
        if (!hit.inside) return hit.fraction;
    }
    if (!collision::cast_ray(a.record.shape, a.before, from, along, 1, hit) || hit.inside) return 1;
    return std::max(0.0, hit.fraction - kSkin * inside / -hit.normal.dot(along));
}

// Of a point of b, from before to now.
Excess excess_along(const Couple& couple, const Vec3& before, const Vec3& now) {
    const Passage &a = couple.a, &b = couple.b;
    const Mat3 then = a.before.rotation.cast<double>(), to_now = a.now.rotation.cast<double>() * then.transpose();
    const Vec3 to = a.before.position + to_now.transpose() * (now - a.now.position);
    const Vec3 along = to - before;
    const double slack = kSlack * collision::thickness(b.record.shape);
    if (along.norm() < slack || !comes_by(a, collision::thickness(b.record.shape), before, along)) return {};
    collision::Hit hit;
    const double met = free_part(a, b, before, along, hit);
    if ((1 - met) * along.norm() < slack) return {};
    return {1 - met, to_now * hit.normal, now - before};
}

// The least distance of a way from the origin.
double nearest_on(const Vec3& from, const Vec3& way) {
    const double squared = way.squaredNorm();
    const double at = squared > 0 ? std::clamp(-from.dot(way) / squared, 0.0, 1.0) : 0.0;
    return (from + at * way).norm();
}

double reach_of(const Collider& collider, const ShapeRecord& record) {
    return collider.node_b == kNone ? record.reach : collision::spin_radius(record.shape, 0);
}

// Of a collider's middle.
struct Way {
    Vec3 from, along;  // [m]
};
Way way_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    const NodePose& before = nodes.before[collider.node];
    const Vec3 middle = collision::middle(shapes.record[collider.shape].shape);
    Way way{before.position, nodes.origin(collider.node) - before.position};
    if (const Vec3 lever = collider.position + collider.rotation * middle; lever != Vec3::Zero()) {
        const Vec3 then = before.rotation * lever;
        way.from += then;
        way.along += nodes.motion[collider.node].q * lever - then;
    }
    return way;
}

// At least the chord of a node's turn, of radius 1: between unit quaternions p and q it is 2 sin(angle / 2), at most
// 2 |p - q|.
float chord_of(const Nodes& nodes, uint32_t node) {
    return static_cast<float>(2 * (nodes.motion[node].q.coeffs() - nodes.before[node].rotation.coeffs()).norm());
}

// Of a ball about the middle that holds the shape [m].
float reach_about_middle(const ShapeRecord& record) {
    return record.size + static_cast<float>(collision::middle(record.shape).norm());
}

Passage passage_of(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t collider) {
    const Collider& record = colliders.record[collider];
    const Way way = way_of(nodes, record, shapes);
    return {record,    shapes.record[record.shape],  way.from,
            way.along, placed_before(nodes, record), placement_of(nodes, record)};
}

}  // namespace

// As a sees it b's middle ends elsewhere by the chord of a's turn.
bool may_pass(const Nodes& nodes, const Collider& a, double thickness_a, const Collider& b, double thickness_b,
              const Shapes& shapes) {
    if (a.node_b != kNone || b.node_b != kNone) return true;  // their ends go ways of their own
    const Way of_a = way_of(nodes, a, shapes), of_b = way_of(nodes, b, shapes);
    const Vec3 from = of_b.from - of_a.from, along = of_b.along - of_a.along;
    const double apart = (from + along).norm(), nearest = nearest_on(from, along);
    const auto meets = [&](const Collider& one, double thickness_of_other) {
        const auto reach = static_cast<double>(reach_about_middle(shapes.record[one.shape]));
        return nearest <= reach + thickness_of_other + static_cast<double>(chord_of(nodes, one.node)) * apart;
    };
    return meets(a, thickness_b) || meets(b, thickness_a);
}

Excess excess_of(const Nodes& nodes, const Couple& couple) {
    const Passage& b = couple.b;
    if (b.collider.node_b == kNone) return excess_along(couple, b.from, b.from + b.along);
    Excess most = excess_along(couple, b.before.position, b.now.position);
    for (const uint32_t end : {b.collider.node, b.collider.node_b}) {
        const Excess of_end = excess_along(couple, nodes.before[end].position, nodes.motion[end].x);
        if (of_end.depth() > most.depth()) most = of_end;
    }
    return most;
}

Vec3 way_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    const NodePose& before = nodes.before[collider.node];
    const NodeMotion& now = nodes.motion[collider.node];
    const Vec3& centre = nodes.mass[collider.node].centre;
    Vec3 way = now.x - before.position;
    if (centre != Vec3::Zero()) way -= before.rotation * centre;
    if ((now.q.coeffs() - before.rotation.coeffs()).squaredNorm() < kTurn * kTurn) return way;
    const Vec3 middle = collision::middle(shapes.record[collider.shape].shape);
    const Vec3 lever = collider.position + collider.rotation * middle - centre;
    return way + now.q * lever - before.rotation * lever;
}

Couple::Couple(const Passage& one, const Passage& other, double reach_of_one, double reach_of_other)
    : a(reach_of_one < reach_of_other ? other : one), b(reach_of_one < reach_of_other ? one : other) {}

Couple::Couple(const Passage& one, const Passage& other)
    : Couple(one, other, reach_of(one.collider, one.record), reach_of(other.collider, other.record)) {}

Couple::Couple(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const NearPair& near)
    : Couple(passage_of(nodes, colliders, shapes, near.collider_a()),
             passage_of(nodes, colliders, shapes, near.collider_b())) {}

}  // namespace taut
