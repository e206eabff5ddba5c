#include <algorithm>
#include <cmath>

#include "detect/detect.h"
#include "detect/impact.h"

namespace taut {
namespace {

// Parts of the ball inside a shape.
constexpr double kStride = 0.25;              // who moved less against each other is not looked after
constexpr double kCores[] = {0.8, 0.4, 0.2};  // the largest that is free at the start is what may not pass
constexpr double kSkin = 0.02;                // where none is, the middle stays so far off
constexpr double kSlack = 0.01;               // less is not put back
constexpr int kRounds = 3;                    // where a mechanism was put back, other parts of it may have passed
constexpr double kTurn = 0.02;                // a smaller turn moves no middle worth the name: sine of half of it

// ---------------------------------------------------------------- ways

// Of a collider's middle in this step, but for the turn of a slow one [m].
inline Vec3 way_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes) {
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

// A collider in a step: where it was and is.
struct Passage {
    Passage(const Nodes& nodes, const Collider& c, const collision::Shape& s)
        : collider(c), shape(s), before(placed_before(nodes, c)), now(placement_of(nodes, c)) {}

    static collision::Placement placed_before(const Nodes& nodes, const Collider& collider) {
        const NodePose& pose = nodes.before[collider.node];
        if (collider.node_b != kNone) return place_between(pose.position, nodes.before[collider.node_b].position);
        return {pose.position + pose.rotation * collider.position,
                (pose.rotation * collider.rotation).toRotationMatrix().cast<float>()};
    }
    Vec3 middle(const collision::Placement& at) const {
        return at.position + at.rotation.cast<double>() * collision::middle(shape);
    }
    Vec3 way() const { return middle(now) - middle(before); }

    const Collider& collider;
    const collision::Shape& shape;
    collision::Placement before, now;
};

// What is too much of two ways.
struct Excess {
    double share = 0;            // of each
    Vec3 normal = Vec3::Zero();  // of the surface met, at the present poses
    Vec3 way = Vec3::Zero();     // of the point that met it [m]

    double depth() const { return share * std::abs(normal.dot(way)); }
};

// The part of b's way along which its core is free of a, up to 1.
double free_part(const Passage& a, const Passage& b, const Vec3& from, const Vec3& along, collision::Hit& hit) {
    const double inside = collision::thickness(b.shape);
    for (const double core : kCores) {
        collision::Shape ball;
        ball.size.x() = static_cast<float>(core * inside);
        if (!collision::cast_shape(ball, {from, Mat3f::Identity()}, along, a.shape, a.before, 1, hit)) return 1;
        if (!hit.inside) return hit.fraction;
    }
    if (!collision::cast_ray(a.shape, a.before, from, along, 1, hit) || hit.inside) return 1;
    return std::max(0.0, hit.fraction - kSkin * inside / -hit.normal.dot(along));
}

// Of the way of a point of b as a sees it, which turns as well.
Excess excess_along(const Passage& a, const Passage& b, const Vec3& before, const Vec3& now) {
    const Mat3 then = a.before.rotation.cast<double>(), to_now = a.now.rotation.cast<double>() * then.transpose();
    const Vec3& from = before;
    const Vec3 to = a.before.position + to_now.transpose() * (now - a.now.position);
    const Vec3 along = to - from;
    const double slack = kSlack * collision::thickness(b.shape);
    if (along.norm() < slack) return {};
    collision::Hit hit;
    const double met = free_part(a, b, from, along, hit);
    if ((1 - met) * along.norm() < slack) return {};
    return {1 - met, to_now * hit.normal, now - before};
}

// Of b's middle; of a segment between two particles also of its ends: one that hits by its end is stopped there, and
// what keeps its length pushes it on.
Excess excess_of(const Nodes& nodes, const Passage& a, const Passage& b) {
    Excess most = excess_along(a, b, b.middle(b.before), b.middle(b.now));
    if (b.collider.node_b == kNone) return most;
    for (const uint32_t end : {b.collider.node, b.collider.node_b}) {
        const Excess of_end = excess_along(a, b, nodes.before[end].position, nodes.motion[end].x);
        if (of_end.depth() > most.depth()) most = of_end;
    }
    return most;
}

// ---------------------------------------------------------------- pairs

// By the host's function or a one-way direction: what goes through on purpose is not held back.
bool may_be_ignored(const Colliders& colliders, const NearPair& pair) {
    const unsigned asks = colliders.record[pair.collider_a()].asks | colliders.record[pair.collider_b()].asks;
    return (asks & (kAsksOneWay | kAsksPreSolve)) != 0;
}

// Marks what moved otherwise than its speed told before the step: further from there than a part of its thickness.
// Whether anything did.
bool find_astray(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    bool any = false;
    for (uint32_t c = 0; c < pairs.pace.size(); ++c) {
        const Collider& collider = colliders.record[c];
        Pace& pace = pairs.pace[c];
        if (collider.node == kNone || collider.node_b != kNone || !nodes.solved(collider.node)) continue;
        const double stride = kStride * pace.thickness;
        const Vec3 off = way_of(nodes, collider, shapes) - pairs.reach[c].ahead.cast<double>();
        pace.astray = off.squaredNorm() > stride * stride;
        any = any || pace.astray;
    }
    return any;
}

// The pairs of these and those that were fast, where they moved further against each other than a part of the
// thickness.
void find_fast(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, bool any_astray, Pairs& pairs) {
    const auto way = [&](uint32_t c) { return way_of(nodes, colliders.record[c], shapes); };
    pairs.fast.clear();
    for (const NearPair& near : pairs.near) {
        if (!near.fast && !any_astray) continue;
        const uint32_t a = near.collider_a(), b = near.collider_b();
        const Pace &one = pairs.pace[a], &other = pairs.pace[b];
        if (!(near.fast || one.astray || other.astray) || near.filtered) continue;
        if (std::isinf(one.thickness + other.thickness)) continue;  // not to be looked for
        const double thinner = one.thickness > 0 && other.thickness > 0 ? std::min(one.thickness, other.thickness)
                                                                        : std::max(one.thickness, other.thickness);
        const double stride = kStride * thinner;
        if ((way(a) - way(b)).squaredNorm() > stride * stride && !may_be_ignored(colliders, near))
            pairs.fast.push_back(near.key);
    }
}

// ---------------------------------------------------------------- mechanisms

// By node: the least of those that joints tie together.
void find_mechanisms(const Nodes& nodes, const Joints& joints, Array<uint32_t>& least) {
    least.resize(nodes.slots());
    for (uint32_t node = 0; node < nodes.slots(); ++node) least[node] = node;
    const auto root = [&](uint32_t node) {
        while (least[node] != node) node = least[node] = least[least[node]];
        return node;
    };
    for (const Joint& joint : joints.record) {
        uint32_t last = kNone;
        for (const uint32_t node : joint.nodes()) {
            if (node == kNone || !nodes.solved(node)) continue;
            const uint32_t one = root(node), other = last == kNone ? one : root(last);
            least[std::max(one, other)] = std::min(one, other);
            last = node;
        }
    }
    for (uint32_t node = 0; node < nodes.slots(); ++node) least[node] = root(node);
}

// What is put back as one: a body and what joints tie to it, so that they stay as they are against each other.
class Mechanism {
public:
    Mechanism(Nodes& nodes, const Joints& joints, const Array<uint32_t>& least, uint32_t node)
        : nodes_(nodes), least_(least), root_(least[node]), moves_(nodes.solved(node)) {
        for (const Joint& joint : joints.record) {
            const auto ends = joint.nodes();
            const auto own = std::count_if(ends.begin(), ends.end(), [&](uint32_t end) { return has(end); });
            jointed_ = jointed_ || own > 0;
            anchored_ = anchored_ || (own > 0 && static_cast<size_t>(own) < ends.size());
        }
    }

    bool has(uint32_t node) const { return node != kNone && nodes_.solved(node) && least_[node] == root_; }
    bool moves() const { return moves_; }

    // One body along its way, which is free; more of them only as far as they must.
    void go_back(const Vec3& way, const Vec3& normal) {
        if (anchored_) return stay();
        const Vec3 back = jointed_ ? Vec3(normal.dot(way) * normal) : way;
        for_each([&](uint32_t node) { nodes_.motion[node].x -= back; });
    }
    // Where they were before the step.
    void stay() {
        for_each([&](uint32_t node) {
            const NodePose& before = nodes_.before[node];
            nodes_.motion[node].q = before.rotation;
            nodes_.motion[node].x = before.position + before.rotation * nodes_.mass[node].centre;
        });
    }

private:
    template <class Act>
    void for_each(Act&& act) {
        for (uint32_t node = 0; moves_ && node < nodes_.slots(); ++node)
            if (has(node)) act(node);
    }

    Nodes& nodes_;
    const Array<uint32_t>& least_;
    uint32_t root_;
    bool moves_, jointed_ = false, anchored_ = false;
};

// Whether a pair had passed; in the last round it stays where it was.
bool part(const Colliders& colliders, const Shapes& shapes, const Joints& joints, uint64_t key, bool last, Pairs& pairs,
          Nodes& nodes) {
    const Collider &one = colliders.record[key >> 32], &other = colliders.record[static_cast<uint32_t>(key)];
    const collision::Shape &shape_one = shapes.record[one.shape].shape, &shape_other = shapes.record[other.shape].shape;
    const bool swapped = collision::spin_radius(shape_one, 0) < collision::spin_radius(shape_other, 0);
    const Passage a(nodes, swapped ? other : one, swapped ? shape_other : shape_one);
    const Passage b(nodes, swapped ? one : other, swapped ? shape_one : shape_other);
    const Excess excess = excess_of(nodes, a, b);
    if (!(excess.share > 0)) return false;
    if (pairs.mechanism.empty()) find_mechanisms(nodes, joints, pairs.mechanism);
    Mechanism of_a(nodes, joints, pairs.mechanism, a.collider.node);
    Mechanism of_b(nodes, joints, pairs.mechanism, b.collider.node);
    if (of_a.has(b.collider.node)) return false;
    if (last) {
        of_a.stay();
        of_b.stay();
    } else {
        of_a.go_back(excess.share * a.way(), excess.normal);
        of_b.go_back(excess.share * excess.way, excess.normal);
    }
    return true;
}

}  // namespace

void hold_back(const Colliders& colliders, const Shapes& shapes, const Joints& joints, Pairs& pairs, Nodes& nodes) {
    pairs.mechanism.clear();
    bool again = true;
    for (int round = 1; again && round <= kRounds; ++round) {
        again = false;
        find_fast(nodes, colliders, shapes, find_astray(nodes, colliders, shapes, pairs), pairs);
        for (const uint64_t key : pairs.fast)
            again = part(colliders, shapes, joints, key, round == kRounds, pairs, nodes) || again;
    }
}

}  // namespace taut
