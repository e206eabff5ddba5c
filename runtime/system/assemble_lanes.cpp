#include <algorithm>

#include "system/assemble.h"

namespace taut {
namespace {

float dot_inverse(const SweepMass& m, const Vec3f& a, const Vec3f& b) {  // a^T I^-1 b
    const float* i = m.inv_inertia;
    const Vec3f ib(i[0] * b.x() + i[3] * b.y() + i[4] * b.z(), i[3] * b.x() + i[1] * b.y() + i[5] * b.z(),
                   i[4] * b.x() + i[5] * b.y() + i[2] * b.z());
    return a.dot(ib);
}

struct PairFrame {  // what all points of a pair share
    uint32_t a, b;
    Vec3f n, t1, t2, com_a, com_b;  // centres of mass relative to the origin of a
    float inv_mass;
    const SweepMass *ma, *mb;
};

PairFrame frame_of(const System& system, const Nodes& nodes, const Pair& pair) {
    PairFrame f;
    f.a = pair.a() + 1;
    f.b = pair.b() + 1;
    f.n = pair.manifold.normal;
    f.t1 = tangent_of(f.n);
    f.t2 = f.n.cross(f.t1);
    const Vec3 origin = nodes.origin(pair.a());
    f.com_a = (nodes.motion[pair.a()].x - origin).cast<float>();
    f.com_b = (nodes.motion[pair.b()].x - origin).cast<float>();
    f.ma = &system.inverse_mass[f.a];
    f.mb = &system.inverse_mass[f.b];
    f.inv_mass = f.ma->inv_mass + f.mb->inv_mass;
    return f;
}

void clear_lane(LanePoint& p, int lane) {
    for (int i = 0; i < 3; ++i) p.ra[i][lane] = p.rb[i][lane] = p.friction_mass[i][lane] = p.impulse[i][lane] = 0;
    p.gap0[lane] = p.gap[lane] = p.normal_mass[lane] = p.isotropic_mass[lane] = 0;
    p.peak[lane] = p.approach[lane] = p.restitution[lane] = 0;
}

// Effective masses of one point: 1/k_n, the inverse of the tangential 2x2 block, 1/k_max.
void fill_lane(LanePoint& p, int lane, const PairFrame& f, const collision::ContactPoint& point, const Impulse& impulse,
               const System& system, float restitution) {
    const Vec3f ra = point.position - f.com_a, rb = point.position - f.com_b;
    auto effective = [&](const Vec3f& u, const Vec3f& v) {
        return f.inv_mass * u.dot(v) + dot_inverse(*f.ma, ra.cross(u), ra.cross(v)) +
               dot_inverse(*f.mb, rb.cross(u), rb.cross(v));
    };
    const float kn = effective(f.n, f.n), k11 = effective(f.t1, f.t1), k22 = effective(f.t2, f.t2), k12 = effective(f.t1, f.t2);
    const float half = 0.5f * (k11 + k22), diff = 0.5f * (k11 - k22);
    const float largest = half + std::sqrt(diff * diff + k12 * k12);
    const float det = k11 * k22 - k12 * k12;
    for (int i = 0; i < 3; ++i) {
        p.ra[i][lane] = ra[i];
        p.rb[i][lane] = rb[i];
    }
    p.gap0[lane] = p.gap[lane] = point.separation;
    p.normal_mass[lane] = kn > 0 ? 1 / kn : 0;
    p.isotropic_mass[lane] = largest > 0 ? 1 / largest : 0;
    const float inv_det = det > 0 ? 1 / det : 0;
    p.friction_mass[0][lane] = k22 * inv_det;
    p.friction_mass[1][lane] = k11 * inv_det;
    p.friction_mass[2][lane] = -k12 * inv_det;
    p.impulse[0][lane] = impulse.normal;
    p.impulse[1][lane] = impulse.tangent1;
    p.impulse[2][lane] = impulse.tangent2;
    p.peak[lane] = 0;
    const SweepVelocity &va = system.velocity[f.a], &vb = system.velocity[f.b];
    const Vec3f v = Vec3f::Map(vb.v) + Vec3f(Vec3f::Map(vb.w)).cross(rb) - Vec3f::Map(va.v) - Vec3f(Vec3f::Map(va.w)).cross(ra);
    p.approach[lane] = v.dot(f.n);
    p.restitution[lane] = restitution;
}

// One lane group of at most eight pairs of a colour.
void add_group(System& system, const Pairs& pairs, const Nodes& nodes, const uint32_t* items, uint32_t count) {
    ContactLanes& lanes = system.contacts;
    LaneGroup& g = lanes.group.emplace_back();
    g.first_point = static_cast<uint32_t>(lanes.point.size());
    g.points = 0;
    for (uint32_t i = 0; i < count; ++i) g.points = std::max(g.points, static_cast<uint32_t>(pairs.list[items[i]].manifold.count));
    lanes.point.resize(lanes.point.size() + g.points);
    for (int lane = 0; lane < kLanes; ++lane) {
        const bool used = static_cast<uint32_t>(lane) < count;
        g.a[lane] = g.b[lane] = 0;
        g.pair[lane] = used ? items[lane] : kNone;
        g.friction[lane] = 0;
        for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.tangent[i][lane] = 0;
        int filled = 0;
        if (used) {
            const Pair& pair = pairs.list[items[lane]];
            const PairFrame f = frame_of(system, nodes, pair);
            const auto &ma = nodes.info[pair.a()].material, &mb = nodes.info[pair.b()].material;
            g.a[lane] = f.a;
            g.b[lane] = f.b;
            g.friction[lane] = std::sqrt(ma.friction * mb.friction);
            for (int i = 0; i < 3; ++i) {
                g.normal[i][lane] = f.n[i];
                g.tangent[i][lane] = f.t1[i];
            }
            const float restitution = std::max(ma.restitution, mb.restitution);
            lanes.bounces = lanes.bounces || restitution > 0;
            for (; filled < pair.manifold.count; ++filled)
                fill_lane(lanes.point[g.first_point + filled], lane, f, pair.manifold.points[filled], pair.impulse[filled],
                          system, restitution);
        }
        for (uint32_t k = filled; k < g.points; ++k) clear_lane(lanes.point[g.first_point + k], lane);
    }
}

}  // namespace

void build_lanes(System& system, const Group& group, const Pairs& pairs, const Nodes& nodes) {
    ContactLanes& lanes = system.contacts;
    lanes.group.clear();
    lanes.point.clear();
    lanes.bounces = false;
    lanes.colour_begin.assign(1, 0);
    if (group.pair_colour_begin.empty()) return;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t begin = group.pair_colour_begin[c], end = group.pair_colour_begin[c + 1];
        const uint32_t width = c + 1 == kMaxColours ? 1 : kLanes;  // the overflow colour: one pair at a time
        // Pairs with as many points side by side: few empty places.
        uint32_t batch[kLanes], filled = 0;
        for (int points = 4; points >= 1; --points) {
            for (uint32_t i = begin; i < end; ++i) {
                if (pairs.list[group.pairs[i]].manifold.count != points) continue;
                batch[filled++] = group.pairs[i];
                if (filled < width) continue;
                add_group(system, pairs, nodes, batch, filled);
                filled = 0;
            }
        }
        if (filled > 0) add_group(system, pairs, nodes, batch, filled);
        lanes.colour_begin.push_back(static_cast<uint32_t>(lanes.group.size()));
    }
}

void store_lanes(const System& system, Pairs& pairs) {
    for (const LaneGroup& g : system.contacts.group) {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.pair[lane] == kNone) continue;
            Pair& pair = pairs.list[g.pair[lane]];
            for (int k = 0; k < pair.manifold.count; ++k) {
                const LanePoint& p = system.contacts.point[g.first_point + k];
                pair.impulse[k] = {p.impulse[0][lane], p.impulse[1][lane], p.impulse[2][lane]};
            }
        }
    }
}

}  // namespace taut
