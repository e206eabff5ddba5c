#include <algorithm>
#include <cmath>

#include "detect/detect.h"
#include "detect/impact.h"

namespace taut {
namespace {

// Parts of the ball inside a shape.
constexpr double kStride = 0.25;                  // what moved less is not looked after
constexpr double kCores[] = {0.6, 0.3, 0.15};  // the largest that is free at the start is what may not pass
constexpr double kSkin = 0.02;                    // where none is, the middle stays so far off
constexpr double kSlack = 0.01;                   // less is not put back
constexpr int kRounds = 3;                        // who was moved may now pass something else

// A collider in a frame: where it was and is.
struct Passage {
    Passage(const Nodes& nodes, const Collider& collider, const collision::Shape& s)
        : shape(s), node(collider.node), before(placed_before(nodes, collider)), now(placement_of(nodes, collider)) {}

    static collision::Placement placed_before(const Nodes& nodes, const Collider& collider) {
        const NodePose& pose = nodes.before[collider.node];
        if (collider.node_b != kNone) return place_between(pose.position, nodes.before[collider.node_b].position);
        return {pose.position + pose.rotation * collider.position,
                (pose.rotation * collider.rotation).toRotationMatrix().cast<float>()};
    }
    Vec3 middle(const collision::Placement& at) const {
        return at.position + at.rotation.cast<double>() * collision::middle(shape);
    }

    const collision::Shape& shape;
    uint32_t node;
    collision::Placement before, now;
};

// What of a way is too much.
struct Excess {
    Vec3 way = Vec3::Zero(), normal = Vec3::Zero();  // [m]; of the surface met
    explicit operator bool() const { return way != Vec3::Zero(); }
};

// The part of b's way that is left when its core meets a; 1 if it does not.
double meeting(const Passage& a, const Passage& b, const Vec3& from, const Vec3& along, collision::Hit& hit) {
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

// How far b's way, as a sees it on its own, goes on after its core met a; at the present poses.
Excess excess_of(const Passage& a, const Passage& b) {
    const Mat3 then = a.before.rotation.cast<double>(), to_now = a.now.rotation.cast<double>() * then.transpose();
    const Vec3 from = b.middle(b.before);
    const Vec3 to = a.before.position + to_now.transpose() * (b.middle(b.now) - a.now.position);
    const Vec3 along = to - from;
    if (along.norm() < kSlack * collision::thickness(b.shape)) return {};
    collision::Hit hit;
    const double met = meeting(a, b, from, along, hit);
    if ((1 - met) * along.norm() < kSlack * collision::thickness(b.shape)) return {};
    return {(1 - met) * (to_now * along), to_now * hit.normal};
}

// By node: the least of those that joints tie together.
void find_mechanisms(const Nodes& nodes, const Joints& joints, Array<uint32_t>& least) {
    least.resize(nodes.slots());
    for (uint32_t node = 0; node < nodes.slots(); ++node) least[node] = node;
    const auto root = [&](uint32_t node) {
        while (least[node] != node) node = least[node] = least[least[node]];
        return node;
    };
    for (const Joint& joint : joints.record) {
        uint32_t first = kNone;
        for (const uint32_t node : joint.nodes()) {
            if (node == kNone || !nodes.solved(node)) continue;
            const uint32_t one = root(node), other = first == kNone ? one : root(first);
            least[std::max(one, other)] = std::min(one, other);
            first = node;
        }
    }
    for (uint32_t node = 0; node < nodes.slots(); ++node) least[node] = root(node);
}

// What moves as one where a body is put back: it and what joints tie to it, whose errors are not to change.
class Mechanism {
public:
    Mechanism(Nodes& nodes, const Joints& joints, const Array<uint32_t>& least, uint32_t node)
        : nodes_(nodes), least_(least), root_(least[node]) {
        if (!nodes.solved(node)) return;
        double mass = 0;
        for_each([&](uint32_t one) { mass += nodes.mass[one].mass; });
        inv_mass_ = 1 / mass;
        for (const Joint& joint : joints.record) {
            const auto ends = joint.nodes();
            if (std::any_of(ends.begin(), ends.end(), [&](uint32_t end) { return has(end); })) {
                jointed_ = true;
                anchored_ = anchored_ || !std::all_of(ends.begin(), ends.end(), [&](uint32_t end) { return has(end); });
            }
        }
    }

    bool has(uint32_t node) const { return node != kNone && nodes_.solved(node) && least_[node] == root_; }
    bool jointed() const { return jointed_; }
    bool moves() const { return inv_mass_ > 0; }
    double ease() const { return anchored_ ? 0 : inv_mass_; }  // [1/kg]

    void shift(const Vec3& by) {
        for_each([&](uint32_t node) { nodes_.motion[node].x += by; });
    }
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
        for (uint32_t node = 0; node < nodes_.slots(); ++node)
            if (has(node)) act(node);
    }

    Nodes& nodes_;
    const Array<uint32_t>& least_;
    uint32_t root_;
    double inv_mass_ = 0;
    bool jointed_ = false, anchored_ = false;
};

// By the host's function or a one-way direction: what goes through on purpose is not held back.
bool may_be_ignored(const Colliders& colliders, const NearPair& pair) {
    const unsigned asks = colliders.record[pair.collider_a()].asks | colliders.record[pair.collider_b()].asks;
    return (asks & (kAsksOneWay | kAsksPreSolve)) != 0;
}

// No less than the way of a collider's middle in this step [m].
double way_of(const Nodes& nodes, const Collider& collider, const collision::Shape& shape) {
    const NodePose& before = nodes.before[collider.node];
    const NodeMotion& now = nodes.motion[collider.node];
    const Vec3& centre = nodes.mass[collider.node].centre;
    const double moved = (now.x - before.position - before.rotation * centre).norm();
    const Vec3 lever = collider.position + collider.rotation * collision::middle(shape) - centre;
    return moved + 2 * (now.q * before.rotation.conjugate()).vec().norm() * lever.norm();
}

// Marks what moved further than a part of its thickness; whether anything did.
bool find_strides(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    bool any = false;
    for (uint32_t c = 0; c < pairs.pace.size(); ++c) {
        const Collider& collider = colliders.record[c];
        Pace& pace = pairs.pace[c];
        pace.strides = false;
        if (collider.node == kNone || collider.node_b != kNone || !nodes.solved(collider.node)) continue;
        if (!(pace.thickness > 0 && std::isfinite(pace.thickness))) continue;
        pace.strides = way_of(nodes, collider, shapes.record[collider.shape].shape) > kStride * pace.thickness;
        any = any || pace.strides;
    }
    return any;
}

void find_fast(const Colliders& colliders, Pairs& pairs) {
    pairs.fast.clear();
    for (const NearPair& near : pairs.near) {
        const Pace &a = pairs.pace[near.collider_a()], &b = pairs.pace[near.collider_b()];
        if ((a.strides || b.strides) && !near.filtered && !may_be_ignored(colliders, near))
            pairs.fast.push_back(near.key);
    }
}

// The work of one step.
class Holder {
public:
    Holder(const Colliders& colliders, const Shapes& shapes, const Joints& joints, Pairs& pairs, Nodes& nodes)
        : colliders_(colliders), shapes_(shapes), joints_(joints), pairs_(pairs), nodes_(nodes) {}

    // Whether a pair had passed. In the last round they stay where they were before the step.
    bool part(uint64_t key, bool last) {
        const Collider &one = collider(key >> 32), &other = collider(static_cast<uint32_t>(key));
        const bool swapped = collision::spin_radius(shape(one), 0) < collision::spin_radius(shape(other), 0);
        const Collider &thick = swapped ? other : one, &thin = swapped ? one : other;
        const Excess excess = excess_of(Passage(nodes_, thick, shape(thick)), Passage(nodes_, thin, shape(thin)));
        if (!excess) return false;
        if (!found_) find_mechanisms(nodes_, joints_, pairs_.mechanism);
        found_ = true;
        Mechanism a(nodes_, joints_, pairs_.mechanism, thick.node), b(nodes_, joints_, pairs_.mechanism, thin.node);
        if ((!a.moves() && !b.moves()) || a.has(thin.node)) return false;
        const double ease = a.ease() + b.ease();
        if (last || !(ease > 0)) {
            a.stay();
            b.stay();
            return true;
        }
        const bool jointed = a.jointed() || b.jointed();
        const Vec3 back = jointed ? Vec3(excess.normal.dot(excess.way) * excess.normal) : excess.way;
        a.shift(a.ease() / ease * back);
        b.shift(-b.ease() / ease * back);
        return true;
    }

private:
    const Collider& collider(uint64_t index) const { return colliders_.record[index]; }
    const collision::Shape& shape(const Collider& of) const { return shapes_.record[of.shape].shape; }

    const Colliders& colliders_;
    const Shapes& shapes_;
    const Joints& joints_;
    Pairs& pairs_;
    Nodes& nodes_;
    bool found_ = false;  // the mechanisms
};

}  // namespace

void hold_back(const Colliders& colliders, const Shapes& shapes, const Joints& joints, Pairs& pairs, Nodes& nodes) {
    if (!find_strides(nodes, colliders, shapes, pairs)) return;
    find_fast(colliders, pairs);
    Holder holder(colliders, shapes, joints, pairs, nodes);
    bool again = true;
    for (int round = 1; again && round <= kRounds; ++round) {
        again = false;
        for (const uint64_t key : pairs.fast) again = holder.part(key, round == kRounds) || again;
    }
}

}  // namespace taut
