#include "detect/carried.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut {
namespace {

// Beyond, a body rolls or tips: other points of it bear [rad].
constexpr double kTips = 0.05;

bool carries(const Nodes& nodes, uint32_t node) {
    return nodes.info[node].kind == NodeKind::kinematic && nodes.rest[node] != Rest::asleep;
}

bool any_carries(const Nodes& nodes) {
    for (const uint32_t node : nodes.active)
        if (carries(nodes, node)) return true;
    return false;
}

// Whether friction held a pair in the last substep: its force F and its torque T about the normal through the centre of
// pressure are within what its points give where they slide and spin, F_s = mu sum N_k and T_s = mu sum N_k r_k,
//   (F / F_s)^2 + (T / T_s)^2 < 1    (ellipsoidal limit surface: Howe and Cutkosky 1996).
// Single points say nothing: against each other they may all be at their bounds.
bool sticks(const Pair& pair) {
    constexpr float kWithin = 0.999f;  // of the bounds; forces are floats
    const Vec3f n = pair.manifold.normal;
    const Tangents tangents = tangents_of(pair);
    const Vec3f &t1 = tangents.t1, &t2 = tangents.t2;
    Vec3f force = Vec3f::Zero(), centre = Vec3f::Zero();
    float pressure = 0, torque = 0, arms = 0;
    const auto each = [&](auto visit) {
        for (int k = 0; k < pair.manifold.count; ++k) visit(pair.force[k], pair.manifold.points[k].position);
    };
    each([&](const ContactForce& at, const Vec3f& point) {
        pressure += at.normal;
        centre += at.normal * point;
    });
    if (!(pressure > 0)) return false;
    centre /= pressure;
    each([&](const ContactForce& given, const Vec3f& point) {
        const ContactForce at = to_rows(pair, given);
        const Vec3f push = at.tangent1 * t1 + at.tangent2 * t2, arm = point - centre;
        force += push;
        torque += n.dot(arm.cross(push));
        arms += at.normal * (arm - n.dot(arm) * n).norm();
    });
    const float slide = force.norm() / (pair.most_friction() * pressure);
    const float turn = arms > 0 ? torque / (pair.most_friction() * arms) : 0;
    return slide * slide + turn * turn < kWithin * kWithin;
}

Carried pose_of(const Nodes& nodes, const Pair& pair) {
    const NodeMotion &a = nodes.motion[pair.a], &b = nodes.motion[pair.b];
    const Quat back = a.q.conjugate();
    return {pair.key, pair.part, back * (b.x - a.x), back * b.q};
}

// The ways of a pair's points across the normal since its body b lay there: one of all and a turn about the normal.
struct Slip {
    Vec3 way = Vec3::Zero(), middle = Vec3::Zero();  // of their mean, from the origin of a's node [m]
    double turn = 0;                                 // [rad]

    Slip(const Nodes& nodes, const Pair& pair, const Carried& from) {
        const NodeMotion &a = nodes.motion[pair.a], &b = nodes.motion[pair.b];
        const Vec3 origin = nodes.origin(pair.a), n = pair.manifold.normal.cast<double>();
        const int count = pair.manifold.count;
        Vec3 point[4], each[4];
        for (int k = 0; k < count; ++k) {
            point[k] = pair.manifold.points[k].position.cast<double>();
            const Vec3 in_b = b.q.conjugate() * (origin + point[k] - b.x);
            const Vec3 moved = origin + point[k] - (a.x + a.q * (from.x + from.q * in_b));
            each[k] = moved - n.dot(moved) * n;
            way += each[k] / count;
            middle += point[k] / count;
        }
        double moment = 0, size = 0;
        for (int k = 0; k < count; ++k) {
            const Vec3 arm = point[k] - middle, across = arm - n.dot(arm) * n;
            moment += n.dot(across.cross(each[k] - way));
            size += across.squaredNorm();
        }
        if (size > 0) turn = moment / size;
    }
};

// How far its body tipped on its carrier [rad], at small angles.
double tipped(const Nodes& nodes, const Pair& pair, const Carried& from, const Carried& now) {
    const Vec3 turned = nodes.motion[pair.a].q * (2 * (now.q * from.q.conjugate()).vec());
    const Vec3 n = pair.manifold.normal.cast<double>();
    return (turned - n.dot(turned) * n).norm();
}

void drive_back(const Slip& slip, double time_step, Pair& pair) {
    const Vec3 spin = -slip.turn / time_step * pair.manifold.normal.cast<double>();
    pair.driven = true;
    pair.drive = (-slip.way / time_step - spin.cross(slip.middle)).cast<float>();
    pair.drive_spin = spin.cast<float>();
}

// Drives it back to where it lay; false where friction does not hold it there.
bool hold(const Nodes& nodes, float borne, double time_step, const Carried& from, const Carried& now, Pair& pair) {
    if (!sticks(pair) || !(tipped(nodes, pair, from, now) <= kTips)) return false;
    const Slip slip(nodes, pair, from);
    const double inv_mass = std::max(nodes.mass[pair.a].inv_mass, nodes.mass[pair.b].inv_mass);
    const double friction = static_cast<double>(pair.friction * pair.slide_factor * borne);
    if (!(slip.way.norm() <= friction * inv_mass * time_step * time_step)) return false;
    drive_back(slip, time_step, pair);
    return true;
}

}  // namespace

void hold_carried(const Nodes& nodes, Pairs& pairs, double time_step) {
    std::swap(pairs.carried, pairs.carried_before);
    pairs.carried.clear();
    if (!any_carries(nodes)) return;
    auto before = pairs.carried_before.begin();
    for (const ActivePair& active : pairs.active) {
        if (active.spans() || !(carries(nodes, active.a) || carries(nodes, active.b))) continue;
        Pair& pair = pairs.list[active.pair];
        if (pair.then > 0 || pair.driven || pair.manifold.count == 0) continue;
        const Carried now = pose_of(nodes, pair);
        const auto is_before = [&](const Carried& one) {
            return one.key < now.key || (one.key == now.key && one.part < now.part);
        };
        while (before != pairs.carried_before.end() && is_before(*before)) ++before;
        const bool known = before != pairs.carried_before.end() && before->key == now.key && before->part == now.part;
        const bool held = known && hold(nodes, active.borne, time_step, *before, now, pair);
        pairs.carried.push_back(held ? *before : now);
    }
}

}  // namespace taut
