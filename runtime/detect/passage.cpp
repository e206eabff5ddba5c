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

}  // namespace

Excess excess_of(const Nodes& nodes, const Couple& couple) {
    const Passage& b = couple.b;
    Excess most = excess_along(couple, b.middle(b.before), b.middle(b.now));
    if (b.collider.node_b == kNone) return most;
    for (const uint32_t end : {b.collider.node, b.collider.node_b}) {
        const Excess of_end = excess_along(couple, nodes.before[end].position, nodes.motion[end].x);
        if (of_end.depth() > most.depth()) most = of_end;
    }
    return most;
}

Vec3 way_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
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

Passage::Passage(const Nodes& nodes, const Collider& c, const ShapeRecord& r)
    : collider(c), record(r), before(placed_before(nodes, c)), now(placement_of(nodes, c)) {}

double Couple::reach_of(const Collider& collider, const Shapes& shapes) {
    const ShapeRecord& record = shapes.record[collider.shape];
    return collider.node_b == kNone ? record.reach : collision::spin_radius(record.shape, 0);
}

}  // namespace taut
