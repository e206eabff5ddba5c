// Apart, the normal is GJK's. Where the cores overlap, s(n), the separation along n, has many maxima. From the best
// of some likely directions b is moved out along n until it is clear by a little, and GJK's normal there is the next n:
// if q is clear of a convex set by d along n, and its nearest point lies along n', then s(n') >= s(n).
#include "collision/narrowphase/least_push.h"

#include <cmath>

namespace taut::collision {
namespace {

// Shapes that overlap no deeper than so much of their inner radii are apart when made smaller by as much, and GJK's
// normal of those is the start.
constexpr double kShrink = 0.4;
// Cores this far apart, in parts of the smaller shape's inner radius, have a direction of their own.
constexpr double kClear = 1e-3;
// GJK's gap for a start and for the answer, whose normal is good to 4.5e-5 rad.
constexpr double kCoarse = 1e-3, kFine = 1e-9;
// How far out b is moved, in the same parts: far enough for a direction, near enough to see the nearest face.
constexpr double kLift = 0.25;
constexpr int kMaxRounds = 6;
constexpr int kMaxStarts = 4;
constexpr double kSame = 0.9999;                        // of a start that was climbed from already
constexpr double kAlike = 0.9;                          // cosine between starts that climb to the same place
constexpr double kCoarseGain = 1e-2, kFineGain = 1e-4;  // a round that gains less, in the same parts, was the last

struct Start {
    Vec3 normal = Vec3::Zero();
    double separation = -1e300;
};

// The best few directions tried, the best first, no two of them alike.
class Starts {
public:
    explicit Starts(const Difference& difference) : difference_(difference) {}

    void add(const Vec3& n) { keep({n, difference_.separation(n)}); }
    // A direction of any length, and maybe none.
    void add_loose(const Vec3& direction) {
        const double squared = direction.squaredNorm();
        if (squared > 1e-12) add(direction / std::sqrt(squared));
    }
    int count() const { return count_; }
    const Start& operator[](int i) const { return kept_[i]; }
    double worst() const { return count_ == kMaxStarts ? kept_[kMaxStarts - 1].separation : -1e300; }

private:
    void keep(Start start) {
        for (int i = 0; i < count_; ++i) {
            if (start.separation > kept_[i].separation) std::swap(start, kept_[i]);
            if (start.normal.dot(kept_[i].normal) > kAlike) return;
        }
        if (count_ < kMaxStarts) kept_[count_++] = start;
    }

    const Difference& difference_;
    int count_ = 0;
    Start kept_[kMaxStarts];
};

// No face separates by more than its distance from the ball inside the other shape.
void add_faces(const Solid& solid, const Solid& other, const Pose& other_in_solid, const Mat3& to_a, double sign,
               Starts& starts) {
    const Vec3f centre = other_in_solid * centre_line(other.shape()).at(0.5f);
    const double inner = double(inner_radius(other.shape()));
    const double slack = core_radius(solid.shape()) + core_radius(other.shape());
    for (int i = 0; i < solid.faces(); ++i) {
        const FlatFace face = solid.face(i);
        const double at_most = double(face.normal.dot(centre) - face.offset) - inner + slack;
        if (at_most > starts.worst()) starts.add(sign * (to_a * face.normal.cast<double>()));
    }
}

// From line of centres to line of centres, and across both.
void add_lines(const Solid& a, const Solid& b, const Pose& b_in_a, Starts& starts) {
    const Segment line = centre_line(a.shape());
    const Segment own = centre_line(b.shape());
    const Segment other = {b_in_a * own.from, b_in_a.rotation * own.step};
    const SegmentPair nearest = nearest_points(line, other);
    starts.add_loose((other.at(nearest.t) - line.at(nearest.s)).cast<double>());
    starts.add_loose((other.at(0.5f) - line.at(0.5f)).cast<double>());
    const Vec3 across = line.step.cross(other.step).cast<double>();
    starts.add_loose(across);
    starts.add_loose(-across);
}

// For shapes deep in each other: the corners of a cube and the middles of its sides.
void add_net(Starts& starts) {
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) starts.add_loose(Vec3(x, y, z));
        }
    }
}

// Upwards on s from a start; where the cores are well apart the first round finds the top.
Push climb(const Difference& difference, const Start& start, double size, double gap, double gain) {
    Push push = {start.normal, start.separation, Vec3::Zero()};
    for (int round = 0; round < kMaxRounds; ++round) {
        const double lift = std::max(kLift * size - push.separation, 0.0);
        const Distance distance = gjk(difference, push.normal * lift, push.normal, gap);
        if (!distance.apart) break;  // rounding
        push.on_a = distance.on_a;
        const double separation = difference.separation(distance.normal);
        const bool last = lift == 0 || separation < push.separation + gain * size;
        if (separation >= push.separation) {
            push.normal = distance.normal;
            push.separation = separation;
        }
        if (last) break;
    }
    return push;
}

// The better of best and of what the starts lead to.
void climb_others(const Difference& difference, double size, const Starts& starts, Push& best) {
    Start better = {best.normal, best.separation};
    for (int i = 0; i < starts.count(); ++i) {
        if (starts[i].normal.dot(best.normal) > kSame) continue;
        const Push push = climb(difference, starts[i], size, kCoarse, kCoarseGain);
        if (push.separation > better.separation) better = {push.normal, push.separation};
    }
    if (better.separation > best.separation) best = climb(difference, better, size, kFine, kFineGain);
}

// From all likely directions, for shapes that overlap deeply or for the first time.
void search(const Solid& a, const Solid& b, const Pair& pair, const Difference& difference, double size, Starts& starts,
            Push& best) {
    const Pose a_in_b = {pair.b_in_a.rotation.transpose(), pair.b_in_a.rotation.transpose() * -pair.b_in_a.position};
    add_faces(a, b, pair.b_in_a, Mat3::Identity(), 1, starts);
    add_faces(b, a, a_in_b, pair.b_in_a.rotation.cast<double>(), -1, starts);
    add_lines(a, b, pair.b_in_a, starts);
    add_net(starts);
    climb_others(difference, size, starts, best);
}

}  // namespace

Push least_push(const Solid& a, const Solid& b, const Pair& pair, const Vec3& hint, double enough) {
    const Difference difference(pair);
    const double radii = difference.radii();
    const double size = double(std::min(inner_radius(pair.a), inner_radius(pair.b)));
    const bool hinted = hint.squaredNorm() > 0;
    Starts starts(difference);
    if (hinted) starts.add(hint);
    if (hinted && starts[0].separation > enough + radii) return {hint, starts[0].separation - radii, Vec3::Zero()};

    const Difference shrunk(pair, kShrink);
    const Distance inner = gjk(shrunk, Vec3::Zero(), hinted ? hint : Vec3(Vec3::UnitY()), kCoarse);
    starts.add(inner.normal);
    Push best = climb(difference, starts[0], size, kFine, kFineGain);
    const bool shallow = inner.apart && inner.separation > kClear * size;
    // Apart there is one top; a shallow overlap stays near last frame's, or goes where the smaller shapes point.
    if (best.separation < 0 && shallow && hinted) climb_others(difference, size, starts, best);
    if (best.separation < 0 && !(shallow && hinted)) search(a, b, pair, difference, size, starts, best);
    best.separation -= radii;
    return best;
}

}  // namespace taut::collision
