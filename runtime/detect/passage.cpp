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

// Whether a ball that goes along may come by the box about a's shape, as it was before the step.
bool comes_by(const Passage& a, const collision::Placement& before, double radius, const Vec3& from,
              const Vec3& along) {
    const Mat3 to_a = before.rotation.cast<double>().transpose();
    const Vec3 start = to_a * (from - before.position), way = to_a * along;
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
double free_part(const Passage& a, const collision::Placement& a_before, const Passage& b, const Vec3& from,
                 const Vec3& along, collision::Hit& hit) {
    const double inside = collision::thickness(b.record.shape);
    for (const double core : kCores) {
        collision::Shape ball;
        ball.size.x() = static_cast<float>(core * inside);
        if (!collision::cast_shape(ball, {from, Mat3f::Identity()}, along, a.record.shape, a_before, 1, hit)) return 1;
        if (!hit.inside) return hit.fraction;
    }
    if (!collision::cast_ray(a.record.shape, a_before, from, along, 1, hit) || hit.inside) return 1;
    return std::max(0.0, hit.fraction - kSkin * inside / -hit.normal.dot(along));
}

// Of a point of b, as a sees it.
class Ways {
public:
    Ways(const Nodes& nodes, const Couple& couple)
        : a_(couple.a),
          b_(couple.b),
          a_before_(placed_before(nodes, couple.a.collider)),
          a_now_(placement_of(nodes, couple.a.collider)),
          thickness_b_(collision::thickness(couple.b.record.shape)) {}

    Excess excess_along(const Vec3& before, const Vec3& now) const {
        const Mat3 then = a_before_.rotation.cast<double>(), to_now = a_now_.rotation.cast<double>() * then.transpose();
        const Vec3 to = a_before_.position + to_now.transpose() * (now - a_now_.position);
        const Vec3 along = to - before;
        const double slack = kSlack * thickness_b_;
        if (along.norm() < slack || !comes_by(a_, a_before_, kLargest * thickness_b_, before, along)) return {};
        collision::Hit hit;
        const double met = free_part(a_, a_before_, b_, before, along, hit);
        if ((1 - met) * along.norm() < slack) return {};
        return {1 - met, to_now * hit.normal, now - before};
    }

private:
    const Passage &a_, &b_;
    collision::Placement a_before_, a_now_;
    double thickness_b_;
};

// Whether a way comes within a distance of the origin: at its start, at its end or, where it comes by in between, with
// |from|^2 - (from . way)^2 / |way|^2 <= distance^2.
bool comes_within(const Vec3& from, const Vec3& way, double distance) {
    const double start = from.squaredNorm(), squared = way.squaredNorm(), nearer = -from.dot(way);
    const double reach = distance * distance;
    if (nearer <= 0) return start <= reach;
    if (nearer >= squared) return (from + way).squaredNorm() <= reach;
    return (start - reach) * squared <= nearer * nearer;
}

double reach_of(const Collider& collider, const ShapeRecord& record) {
    return collider.node_b == kNone ? record.reach : collision::spin_radius(record.shape, 0);
}

// At least the chord of a node's turn, of radius 1: between unit quaternions p and q it is 2 sin(angle / 2), at most
// 2 |p - q|.
float chord_of(const Nodes& nodes, uint32_t node) {
    return static_cast<float>(2 * (nodes.motion[node].q.coeffs() - nodes.before[node].rotation.coeffs()).norm());
}

Passage passage_of(const Colliders& colliders, const Shapes& shapes, const Array<Course>& courses, uint32_t collider) {
    const Collider& record = colliders.record[collider];
    return {record, shapes.record[record.shape], courses[collider]};
}

}  // namespace

Course course_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes, const Pace& pace) {
    const ShapeRecord& record = shapes.record[collider.shape];
    const NodePose& before = nodes.before[collider.node];
    const Vec3 middle = collision::middle(record.shape);
    Course course{before.position,
                  nodes.origin(collider.node) - before.position,
                  static_cast<float>(pace.thickness),
                  static_cast<float>(reach_of(collider, record)),
                  pace.round + static_cast<float>(middle.norm()),
                  std::numeric_limits<float>::infinity()};
    if (collider.node_b == kNone) course.chord = chord_of(nodes, collider.node);
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
    const Course &a = one.reach < other.reach ? other : one, &b = one.reach < other.reach ? one : other;
    const Vec3 from = b.from - a.from, along = b.along - a.along;
    const double reach = static_cast<double>(a.reach + a.round) + kLargest * static_cast<double>(b.thickness);
    return comes_within(from, along, reach + static_cast<double>(a.chord) * (from + along).norm());
}

Excess excess_of(const Nodes& nodes, const Couple& couple) {
    const Ways ways(nodes, couple);
    const Passage& b = couple.b;
    if (!b.spans()) return ways.excess_along(b.course.from, b.course.from + b.course.along);
    Excess most =
        ways.excess_along(placed_before(nodes, b.collider).position, placement_of(nodes, b.collider).position);
    for (const uint32_t end : {b.collider.node, b.collider.node_b}) {
        const Excess of_end = ways.excess_along(nodes.before[end].position, nodes.motion[end].x);
        if (of_end.depth() > most.depth()) most = of_end;
    }
    return most;
}

Vec3 way_of(const Nodes& nodes, const Passage& passage) {
    if (!passage.spans()) return passage.course.along;
    return placement_of(nodes, passage.collider).position - placed_before(nodes, passage.collider).position;
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

collision::Box bounds_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    return collision::bounds(shapes.record[collider.shape].shape, placement_of(nodes, collider));
}

collision::Box box_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
    const collision::Box then = collision::bounds(shapes.record[collider.shape].shape, placed_before(nodes, collider)),
                         now = bounds_of(nodes, collider, shapes);
    return {then.lo.cwiseMin(now.lo), then.hi.cwiseMax(now.hi)};
}

Couple::Couple(const Passage& one, const Passage& other)
    : a(one.course.reach < other.course.reach ? other : one), b(one.course.reach < other.course.reach ? one : other) {}

Couple::Couple(const Colliders& colliders, const Shapes& shapes, const Array<Course>& courses, const NearPair& near)
    : Couple(passage_of(colliders, shapes, courses, near.collider_a()),
             passage_of(colliders, shapes, courses, near.collider_b())) {}

}  // namespace taut
