#include "detect/passage.h"

#include <algorithm>
#include <limits>

#include "detect/detect.h"

namespace taut {
namespace {

// Parts of the ball inside a shape.
constexpr double kLargest = 0.8;
constexpr double kCores[] = {kLargest, 0.4, 0.2};  // the largest that is free at the start is what may not pass
constexpr double kSkin = 0.02;                     // where none is, the middle stays so far off
constexpr double kSlack = 0.01;                    // less is not put back
constexpr double kTurn = 0.02;                     // a smaller turn moves no middle worth the name: sine of half of it

// Of a collider's shape as it was before the step, and as it is.
NodePose pose_before(const Nodes& nodes, const Collider& collider) {
    const NodePose& body = nodes.before[collider.node];
    if (collider.node_b != kNone) return pose_between(body.position, nodes.before[collider.node_b].position);
    if (collider.at_origin()) return body;
    return {body.position + body.rotation * collider.position, body.rotation * collider.rotation};
}
NodePose pose_now(const Nodes& nodes, const Collider& collider) {
    const NodeMotion& m = nodes.motion[collider.node];
    if (collider.node_b != kNone) return pose_between(m.x, nodes.motion[collider.node_b].x);
    if (collider.at_origin()) return {nodes.origin(collider.node), m.q};
    return {nodes.origin(collider.node) + m.q * collider.position, m.q * collider.rotation};
}
Vec3 as_seen_from(const NodePose& pose, const Vec3& point) {
    return pose.rotation.conjugate() * (point - pose.position);
}

// About the shape as it is.
collision::Box box_of(const Passage& passage) {
    if (passage.collider.node_b == kNone) return passage.record.box;
    return collision::bounds(passage.record.shape, {Vec3::Zero(), Mat3f::Identity()});
}

// Whether a ball that goes along may come by a box.
bool comes_by(const collision::Box& box, double radius, const Vec3& from, const Vec3& along) {
    double enter = 0, leave = 1;
    for (int i = 0; i < 3; ++i) {
        const double lo = static_cast<double>(box.lo[i]) - radius - from[i],
                     hi = static_cast<double>(box.hi[i]) + radius - from[i];
        if (along[i] == 0 && (lo > 0 || hi < 0)) return false;
        if (along[i] == 0) continue;
        enter = std::max(enter, std::min(lo / along[i], hi / along[i]));
        leave = std::min(leave, std::max(lo / along[i], hi / along[i]));
    }
    return enter <= leave;
}

// The part of the way of a core that is free of a shape at the origin, up to 1. inside: radius of the ball that the
// core is a part of [m].
double free_part(const collision::Shape& shape, double inside, const Vec3& from, const Vec3& along,
                 collision::Hit& hit) {
    const collision::Placement here = {Vec3::Zero(), Mat3f::Identity()};
    for (const double core : kCores) {
        collision::Shape ball;
        ball.size.x() = static_cast<float>(core * inside);
        if (!collision::cast_shape(ball, {from, Mat3f::Identity()}, along, shape, here, 1, hit)) return 1;
        if (!hit.inside) return hit.fraction;
    }
    if (!collision::cast_ray(shape, here, from, along, 1, hit) || hit.inside) return 1;
    return std::max(0.0, hit.fraction - kSkin * inside / -hit.normal.dot(along));
}

// Of a point of b, as a sees it.
class Ways {
public:
    Ways(const Nodes& nodes, const Couple& couple)
        : a_(couple.a),
          a_before_(pose_before(nodes, a_.collider)),
          a_now_(pose_now(nodes, a_.collider)),
          thickness_b_(collision::thickness(couple.b.record.shape)) {}

    Excess excess_along(const Vec3& before, const Vec3& now) const {
        const Vec3 from = as_seen_from(a_before_, before), along = as_seen_from(a_now_, now) - from;
        const double slack = kSlack * thickness_b_;
        if (along.norm() < slack || !comes_by(box_of(a_), kLargest * thickness_b_, from, along)) return {};
        collision::Hit hit;
        const double met = free_part(a_.record.shape, thickness_b_, from, along, hit);
        if ((1 - met) * along.norm() < slack) return {};
        return {1 - met, a_now_.rotation * hit.normal, now - before, a_now_.rotation * along};
    }

private:
    const Passage& a_;
    NodePose a_before_, a_now_;
    double thickness_b_;
};

// Whether a way comes within a distance of the origin.
bool comes_within(const Vec3& from, const Vec3& way, double distance) {
    const double squared = way.squaredNorm();
    const double nearest = squared > 0 ? std::clamp(-from.dot(way) / squared, 0.0, 1.0) : 0.0;
    return (from + nearest * way).squaredNorm() <= distance * distance;
}

// Of the middle between two nodes.
Vec3 way_between(const Nodes& nodes, const Collider& collider) {
    const uint32_t a = collider.node, b = collider.node_b;
    return 0.5 * (nodes.motion[a].x - nodes.before[a].position + nodes.motion[b].x - nodes.before[b].position);
}

double reach_of(const Collider& collider, const ShapeRecord& record) {
    return collider.node_b == kNone ? record.reach : collision::spin_radius(record.shape, 0);
}

// At least the chord of a node's turn, of radius 1: between unit quaternions p and q it is 2 sin(angle / 2), at most
// 2 |p - q|.
float chord_of(const Nodes& nodes, uint32_t node) {
    return static_cast<float>(2 * (nodes.motion[node].q.coeffs() - nodes.before[node].rotation.coeffs()).norm());
}

// Of a ball about the middle that holds the collider [m]: the core of what is round alone may be a point.
float radius_of(const Course& course) { return course.reach + course.round; }
bool reaches_less_far(const Course& one, const Course& other) { return radius_of(one) < radius_of(other); }

Passage passage_of(const Colliders& colliders, const Shapes& shapes, const Array<Course>& courses, uint32_t collider) {
    const Collider& record = colliders.record[collider];
    return {record, shapes[record.shape], courses[collider]};
}

}  // namespace

Course course_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes, const Pace& pace) {
    const ShapeRecord& record = shapes[collider.shape];
    const NodePose& before = nodes.before[collider.node];
    const Vec3 middle = collision::middle(record.shape);
    Course course{before.position,
                  nodes.origin(collider.node) - before.position,
                  static_cast<float>(pace.thickness),
                  static_cast<float>(reach_of(collider, record)),
                  pace.round + static_cast<float>(middle.norm()),
                  std::numeric_limits<float>::infinity()};
    if (collider.node_b != kNone) {
        course.from = 0.5 * (before.position + nodes.before[collider.node_b].position);
        course.along = way_between(nodes, collider);
        return course;
    }
    course.chord = chord_of(nodes, collider.node);
    if (const Vec3 lever = collider.position + collider.rotation * middle; lever != Vec3::Zero()) {
        const Vec3 then = before.rotation * lever;
        course.from += then;
        course.along += nodes.motion[collider.node].q * lever - then;
    }
    return course;
}

// As the one sees it the other's middle ends elsewhere by the chord of the one's turn.
bool may_pass(const Course& one, const Course& other) {
    if (std::isinf(one.chord) || std::isinf(other.chord)) return true;  // their ends go ways of their own
    const bool less = reaches_less_far(one, other);
    const Course &a = less ? other : one, &b = less ? one : other;
    const Vec3 from = b.from - a.from, along = b.along - a.along;
    const double reach = static_cast<double>(radius_of(a)) + kLargest * static_cast<double>(b.thickness);
    return comes_within(from, along, reach + static_cast<double>(a.chord) * (from + along).norm());
}

Excess excess_of(const Nodes& nodes, const Couple& couple) {
    const Ways ways(nodes, couple);
    const Passage& b = couple.b;
    Excess most = ways.excess_along(b.course.from, b.course.from + b.course.along);
    if (!b.spans()) return most;
    for (const uint32_t end : {b.collider.node, b.collider.node_b}) {
        const Excess of_end = ways.excess_along(nodes.before[end].position, nodes.motion[end].x);
        if (of_end.depth() > most.depth()) most = of_end;
    }
    return most;
}

Vec3 way_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    if (collider.node_b != kNone) return way_between(nodes, collider);
    const NodePose& before = nodes.before[collider.node];
    const NodeMotion& now = nodes.motion[collider.node];
    const Vec3& centre = nodes.mass[collider.node].centre;
    Vec3 way = now.x - before.position;
    if (centre != Vec3::Zero()) way -= before.rotation * centre;
    if ((now.q.coeffs() - before.rotation.coeffs()).squaredNorm() < kTurn * kTurn) return way;
    const Vec3 middle = collision::middle(shapes[collider.shape].shape);
    const Vec3 lever = collider.position + collider.rotation * middle - centre;
    return way + now.q * lever - before.rotation * lever;
}

collision::Box bounds_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    return collision::bounds(shapes[collider.shape].shape, placement_of(nodes, collider));
}

collision::Box box_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    const collision::Placement before = placement_of(pose_before(nodes, collider));
    const collision::Box then = collision::bounds(shapes[collider.shape].shape, before),
                         now = bounds_of(nodes, collider, shapes);
    return {then.lo.cwiseMin(now.lo), then.hi.cwiseMax(now.hi)};
}

Couple::Couple(const Passage& one, const Passage& other)
    : a(reaches_less_far(one.course, other.course) ? other : one),
      b(reaches_less_far(one.course, other.course) ? one : other) {}

Couple::Couple(const Colliders& colliders, const Shapes& shapes, const Array<Course>& courses, const AskedPair& pair)
    : Couple(passage_of(colliders, shapes, courses, pair.a), passage_of(colliders, shapes, courses, pair.b)) {}

}  // namespace taut
