#include "detect/reuse.h"

namespace taut {
namespace {

constexpr float kSlide = 5e-5f;        // s at most [m], and
constexpr float kSlideOfSize = 1e-3f;  // in parts of r
// Bodies that will move further than this against each other meet what is beyond the contact margin [m].
constexpr float kUnderWay = 1e-3f;
constexpr double kRounding = 1e-4;  // of distances that the narrowphase tells [m]

// b's shape as seen from a's.
struct View {
    const Stance &a, &b;
    const Mat3f& world_from_a;
    Vec3f apart;  // from a's origin to b's, world axes [m]

    View(const Pairs& pairs, const PairEnds& pair)
        : a(pairs.stance[pair.collider_a()]),
          b(pairs.stance[pair.collider_b()]),
          world_from_a(pairs.placement[pair.collider_a()].rotation),
          apart((pairs.placement[pair.collider_b()].position - pairs.placement[pair.collider_a()].position)
                    .cast<float>()) {}

    Vec3f origin() const { return world_from_a.transpose() * apart; }
    Quatf turn() const { return a.turn.conjugate() * b.turn; }
    float size() const { return std::min(a.size, b.size); }
    // Whether points of the two near p, from a's origin in world axes, move by little against each other in a time [s].
    bool is_calm(const Vec3f& p, double time) const {
        const Vec3f spin = b.spin - a.spin;
        const Vec3f speed = b.velocity - a.velocity + b.spin.cross(p - apart) - a.spin.cross(p);
        const float limit = kUnderWay / static_cast<float>(time);
        return speed.squaredNorm() <= limit * limit && spin.squaredNorm() * size() * size() <= limit * limit;
    }
};

// How b's points move against a, see above.
struct Shift {
    Vec3f moved, pivot;
    Vec3f axis;  // times sin(angle / 2)
    float cosine;

    Shift(const FoundManifold& from, const View& to) : moved(to.origin() - from.origin), pivot(from.origin) {
        const Quatf turned = to.turn() * from.turn.conjugate();
        axis = turned.vec();
        cosine = turned.w();
    }
    Vec3f of(const Vec3f& p) const {
        const Vec3f across = 2 * axis.cross(p - pivot);
        return moved + cosine * across + axis.cross(across);
    }
    float angle_squared() const { return 4 * axis.squaredNorm(); }
};

// Whether only a is round: the normal, which lies in a's frame as long as a manifold is kept, is b's then, and does not
// turn as a rolls.
bool normal_is_of_b(const Pair& pair) {
    return (pair.round_a > 0 || pair.rolls_a) && !(pair.round_b > 0 || pair.rolls_b);
}

}  // namespace

bool keep_manifold(const Pairs& pairs, double time, Pair& pair) {
    if (normal_is_of_b(pair)) return false;
    const View view(pairs, pair);
    if (!view.is_calm(pair.manifold.points[0].position - view.a.from_node, time)) return false;
    FoundManifold& found = pair.found;
    const Mat3f a_from_world = view.world_from_a.transpose();
    found.turn = view.turn();
    found.origin = view.origin();
    found.normal = a_from_world * pair.manifold.normal;
    for (int k = 0; k < pair.manifold.count; ++k) {
        found.position[k] = a_from_world * (pair.manifold.points[k].position - view.a.from_node);
        found.separation[k] = pair.manifold.points[k].separation;
    }
    return true;
}

bool reuse_manifold(const Pairs& pairs, double time, Pair& pair) {
    collision::Manifold& manifold = pair.manifold;
    const FoundManifold& found = pair.found;
    if (manifold.count == 0) return false;
    const View view(pairs, pair);
    const Shift shift(found, view);
    const float size = view.size(), slide = std::min(kSlide, kSlideOfSize * size);
    // Written so that not-a-number is motion.
    if (!(shift.angle_squared() * size * size <= slide * slide)) return false;
    float change[4];
    for (int k = 0; k < manifold.count; ++k) {
        const Vec3f moved = shift.of(found.position[k]);
        if (!(moved.squaredNorm() <= slide * slide)) return false;
        change[k] = found.normal.dot(moved);
    }
    if (!view.is_calm(view.world_from_a * found.position[0], time)) return false;
    manifold.normal = view.world_from_a * found.normal;
    for (int k = 0; k < manifold.count; ++k) {
        manifold.points[k].position = view.a.from_node + view.world_from_a * found.position[k];
        manifold.points[k].separation = found.separation[k] + change[k];
    }
    return true;
}

void note_clear(const Pairs& pairs, float gap, NearPair& near) {
    near.clear = pairs.travel[near.collider_a()].way + pairs.travel[near.collider_b()].way + static_cast<double>(gap) -
                 kRounding;
}

}  // namespace taut
