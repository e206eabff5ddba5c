#include "detect/carry.h"

#include <algorithm>
#include <bit>

namespace taut {
namespace {

// Points further apart than this are not the same point of two frames [m].
constexpr float kSamePoint = 0.02f;

// What points gave that are gone: together, as a force with its moment.
struct Lost {
    float normal = 0;                // [N]
    Vec3f moment = Vec3f::Zero();    // sum of normal force times position [N m]
    Vec3f friction = Vec3f::Zero();  // [N]

    void add(const Vec3f& position, const ContactForce& force, const Vec3f& t1, const Vec3f& t2) {
        normal += force.normal;
        moment += force.normal * position;
        friction += force.tangent1 * t1 + force.tangent2 * t2;
    }
};

// Onto the points that are there now. Without it a body whose contact goes over to other points falls for a substep:
// heaps in which points come and go never rest. Of all shares d_i that leave the pair's force and moment as they were,
//   sum d_i = F,  sum d_i (x_i, y_i) = M,
// the least ones, d = F / n + b x + c y with x, y from the mean of the points; of M as much as no d below 0 bears.
void hand_over(const Lost& lost, const collision::Manifold& now, const Vec3f& t1, const Vec3f& t2, ContactForce* to) {
    const float even = lost.normal / static_cast<float>(now.count);
    Vec3f mean = Vec3f::Zero();
    for (int i = 0; i < now.count; ++i) mean += now.points[i].position / static_cast<float>(now.count);
    float x[4], y[4], xx = 0, yy = 0, xy = 0;
    for (int i = 0; i < now.count; ++i) {
        const Vec3f r = now.points[i].position - mean;
        x[i] = r.dot(t1), y[i] = r.dot(t2);
        xx += x[i] * x[i], yy += y[i] * y[i], xy += x[i] * y[i];
    }
    const Vec3f moment = lost.moment - lost.normal * mean;
    const float mx = moment.dot(t1), my = moment.dot(t2);
    const float least = 1e-3f * (xx + yy) + 1e-8f;  // points in a line bear nothing across it, in one place nothing
    xx += least, yy += least;
    const float det = xx * yy - xy * xy, b = (yy * mx - xy * my) / det, c = (xx * my - xy * mx) / det;
    float tilt[4], sum = 0, borne = 1;
    for (int i = 0; i < now.count; ++i) sum += tilt[i] = b * x[i] + c * y[i];
    for (int i = 0; i < now.count; ++i) {
        tilt[i] -= sum / static_cast<float>(now.count);  // of points in one place the mean is as far off as they are
        if (even + borne * tilt[i] < 0) borne = even / -tilt[i];
    }
    for (int i = 0; i < now.count; ++i) {
        const float share = even + borne * tilt[i];
        to[i].normal += share;
        to[i].tangent1 += share / lost.normal * lost.friction.dot(t1);
        to[i].tangent2 += share / lost.normal * lost.friction.dot(t2);
    }
}

// Forces of the old points onto the new ones: by feature, else by place, what is left over, if all is asked for, to
// all; friction turned into the new tangents.
void carry_forces(const collision::Manifold& old, const ContactForce* from, bool all, const collision::Manifold& now,
                  ContactForce* to) {
    const Vec3f t1 = tangent_of(now.normal), t2 = now.normal.cross(t1);
    const Vec3f o1 = tangent_of(old.normal), o2 = old.normal.cross(o1);
    unsigned left = (1u << old.count) - 1, missing = 0;  // bits of old points, and of new ones
    const auto take = [&](int i, int k) {
        const Vec3f friction = from[k].tangent1 * o1 + from[k].tangent2 * o2;
        to[i] = {from[k].normal, friction.dot(t1), friction.dot(t2), from[k].slip};
        left &= ~(1u << k);
    };
    for (int i = 0; i < now.count; ++i) {
        unsigned same = 0;
        for (int k = 0; k < old.count; ++k) same |= unsigned(old.points[k].feature == now.points[i].feature) << k;
        if (same &= left; same != 0)
            take(i, std::countr_zero(same));
        else
            missing |= 1u << i;
    }
    for (; missing != 0; missing &= missing - 1) {
        const int i = std::countr_zero(missing);
        to[i] = {};
        float nearest = kSamePoint * kSamePoint;
        int best = -1;
        for (unsigned rest = left; rest != 0; rest &= rest - 1) {
            const int k = std::countr_zero(rest);
            const float d = (old.points[k].position - now.points[i].position).squaredNorm();
            if (d < nearest) nearest = d, best = k;
        }
        if (best >= 0) take(i, best);
    }
    if (!all) return;
    Lost lost;
    for (int k = 0; k < old.count; ++k)
        if ((left >> k & 1) && from[k].normal > 0) lost.add(old.points[k].position, from[k], o1, o2);
    if (lost.normal > 0) hand_over(lost, now, t1, t2, to);
}

// Friction torques carried over, turned into the frame of the new manifold.
void carry_torque(const collision::Manifold& old, ContactForce torque, float spin_slip, Pair& pair) {
    const Vec3f n = pair.manifold.normal, t1 = tangent_of(n), o1 = tangent_of(old.normal);
    const Vec3f sum = torque.normal * old.normal + torque.tangent1 * o1 + torque.tangent2 * old.normal.cross(o1);
    pair.torque = {sum.dot(n), sum.dot(t1), sum.dot(n.cross(t1)), torque.slip};
    pair.spin_slip = spin_slip;
}

// Whether points have something to carry: without a push there is no friction; those in blocks may know their slip.
bool bore(const collision::Manifold& old, const Pair& before) {
    return std::any_of(before.force, before.force + old.count,
                       [](const ContactForce& force) { return force.normal > 0 || force.slip >= 0; });
}

}  // namespace

void carry(const collision::Manifold& old, const Pair& before, Pair& pair) {
    if (old.count == 0) return forget_forces(pair);
    pair.in_block = before.in_block;
    pair.loaded = before.loaded;
    if (bore(old, before)) {
        ContactForce carried[4];
        std::copy(before.force, before.force + 4, carried);
        // Flat faces keep most of their points, and the rest are not worth the time.
        const bool is_round = pair.patch > 0;
        carry_forces(old, carried, is_round, pair.manifold, pair.force);
    } else {
        std::fill(pair.force, pair.force + 4, ContactForce{});
    }
    if (pair.twists()) carry_torque(old, before.torque, before.spin_slip, pair);
}

void carry_on(const Vec3f& old_normal, Pair& pair) {
    if (same_tangents(old_normal, pair.manifold.normal)) return;
    collision::Manifold old = pair.manifold;
    old.normal = old_normal;
    carry(old, pair, pair);
}

}  // namespace taut
