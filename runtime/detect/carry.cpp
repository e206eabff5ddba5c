#include "detect/carry.h"

#include <algorithm>

namespace taut {
namespace {

// Points further apart than this are not the same point of two frames [m].
constexpr float kSamePoint = 0.02f;

// Impulses of the old points onto the new ones: by feature, else by place; friction turned into the new tangents.
void carry_impulses(const collision::Manifold& old, const Impulse* from, const collision::Manifold& now, Impulse* to) {
    const Vec3f t1 = tangent_of(now.normal), t2 = now.normal.cross(t1);
    const Vec3f o1 = tangent_of(old.normal), o2 = old.normal.cross(o1);
    bool used[4] = {}, found[4] = {};
    auto take = [&](int i, int k) {
        const Vec3f friction = from[k].tangent1 * o1 + from[k].tangent2 * o2;
        to[i] = {from[k].normal, friction.dot(t1), friction.dot(t2), from[k].slip};
        used[k] = found[i] = true;
    };
    for (int i = 0; i < now.count; ++i)
        for (int k = 0; k < old.count && !found[i]; ++k)
            if (!used[k] && old.points[k].feature == now.points[i].feature) take(i, k);
    for (int i = 0; i < now.count; ++i) {
        if (found[i]) continue;
        to[i] = {};
        float nearest = kSamePoint * kSamePoint;
        int best = -1;
        for (int k = 0; k < old.count; ++k) {
            const float d = (old.points[k].position - now.points[i].position).squaredNorm();
            if (!used[k] && d < nearest) nearest = d, best = k;
        }
        if (best >= 0) take(i, best);
    }
}

// Friction torques carried over, turned into the frame of the new manifold.
void carry_turning(const collision::Manifold& old, Impulse turning, float spin_slip, Pair& pair) {
    const Vec3f n = pair.manifold.normal, t1 = tangent_of(n), o1 = tangent_of(old.normal);
    const Vec3f sum = turning.normal * old.normal + turning.tangent1 * o1 + turning.tangent2 * old.normal.cross(o1);
    pair.turning = {sum.dot(n), sum.dot(t1), sum.dot(n.cross(t1)), turning.slip};
    pair.spin_slip = spin_slip;
}

}  // namespace

void carry(const collision::Manifold& old, const Pair& before, Pair& pair) {
    if (old.count == 0) {
        std::fill(pair.impulse, pair.impulse + 4, Impulse{});
        pair.turning = {};
        pair.spin_slip = -1;
        return;
    }
    Impulse carried[4];
    std::copy(before.impulse, before.impulse + 4, carried);
    carry_impulses(old, carried, pair.manifold, pair.impulse);
    if (pair.turns()) carry_turning(old, before.turning, before.spin_slip, pair);
}

void carry_on(const Vec3f& old_normal, Pair& pair) {
    if (same_tangents(old_normal, pair.manifold.normal)) return;
    collision::Manifold old = pair.manifold;
    old.normal = old_normal;
    carry(old, pair, pair);
}

}  // namespace taut
