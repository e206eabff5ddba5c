// The fused sweep of contacts of surfaces, a template over the lanes (simd/lanes.h). Included by one file for each
// build. Rows and terms are those of contact_sweep.inl, with w_i times the impulse for each node. Where no first node
// turns the mass is the same all ways, and what an impulse does along the normal changes nothing across it.
#pragma once

#include "constraints/contact_sweep.inl"
#include "constraints/surface_lanes.h"

namespace taut {

template <class F>
struct SurfaceSweep {
    using V = Vec3Lanes<F>;
    using Side = SweepSide<F>;
    using Contacts = ContactSweep<F>;
    using ShiftLanes = typename Contacts::ShiftLanes;
    using PointTerms = typename Contacts::PointTerms;
    using HitTerms = typename Contacts::HitTerms;

    static V load(const float (&p)[3][kLanes]) { return {F::load(p[0]), F::load(p[1]), F::load(p[2])}; }
    static F inverse(const F& k) {
        const F zero = F::all(0), tiny = F::all(1e-30f);
        return F::if_greater(k, tiny, F::all(1) / F::max(k, tiny), zero);
    }

    struct Frame {
        V n, t1, t2;
        explicit Frame(const SurfaceGroup& g)
            : n(SurfaceSweep::load(g.normal)), t1(SurfaceSweep::load(g.tangent)), t2(cross(n, t1)) {}
        V of(const F& p, const F& q1, const F& q2) const { return p * n + q1 * t1 + q2 * t2; }
    };

    // Velocities of the nodes of kLanes contacts.
    template <bool Turns>
    struct Ends {
        static constexpr uint32_t kFirst = Turns ? 1 : 0;  // of those that are particles
        const SurfaceGroup& g;
        Side first;
        V lever;
        F velocity[kSurfaceNodes][4];

        Ends(SurfaceView view, const SurfaceGroup& group, const SweepNode* nodes) : g(group) {
            if constexpr (Turns) {
                first.gather(g.node[0], nodes);
                lever = SurfaceSweep::load(view.turning[g.turning].lever);
            }
            for (uint32_t n = kFirst; n < kSurfaceNodes; ++n) {
                const float* row[kLanes];
                for (int i = 0; i < kLanes; ++i) row[i] = nodes[g.node[n][i]].velocity.v;
                F::transpose(row, velocity[n]);
            }
        }
        V apart() const {  // sum w_i v_i
            V sum{F::all(0), F::all(0), F::all(0)};
            if constexpr (Turns) sum = F::load(g.weight[0]) * first.at(lever);
            for (uint32_t n = kFirst; n < kSurfaceNodes; ++n)
                sum = sum + F::load(g.weight[n]) * V{velocity[n][0], velocity[n][1], velocity[n][2]};
            return sum;
        }
        void push(const V& p) {
            if constexpr (Turns) first.add(F::load(g.weight[0]) * p, lever);
            for (uint32_t n = kFirst; n < kSurfaceNodes; ++n) {
                const F share = F::load(g.weight[n]) * F::load(g.inv_mass[n]);
                velocity[n][0] = velocity[n][0] + share * p.x;
                velocity[n][1] = velocity[n][1] + share * p.y;
                velocity[n][2] = velocity[n][2] + share * p.z;
            }
        }
        // What no impulse moves is not written: groups on other threads read it.
        void scatter(SweepNode* nodes) const {
            if constexpr (Turns) first.scatter(g.node[0], nodes);
            for (uint32_t n = kFirst; n < kSurfaceNodes; ++n) {
                alignas(32) float nowhere[4];
                float* row[kLanes];
                for (int i = 0; i < kLanes; ++i) row[i] = nodes[g.node[n][i]].velocity.v;
                const unsigned still = ~F::greater(F::load(g.inv_mass[n]), F::all(0)) & kAllLanes;
                for (unsigned left = still; left != 0; left &= left - 1) row[__builtin_ctz(left)] = nowhere;
                F::transpose_back(velocity[n], row);
            }
        }
    };

    // ------------------------------------------------------------ masses

    // held: lanes with a locked axis; least: of a k that is not nothing there.
    template <class Put>
    static void prepare_tangents(SurfaceTurning& t, const F& k11, const F& k22, const F& k12, const F& held,
                                 const F& least, const Put& put) {
        const F half = F::all(0.5f), mean = half * (k11 + k22), diff = half * (k11 - k22);
        const F inv_det = inverse(k11 * k22 - k12 * k12), largest = mean + F::sqrt(diff * diff + k12 * k12);
        F mass[3] = {k22 * inv_det, k11 * inv_det, F::all(0) - k12 * inv_det}, isotropic = inverse(largest);
        if (F::greater(held, F::all(0)) != 0) invert_held(held, {k11, k22, k12}, largest, least, mass, isotropic);
        for (int i = 0; i < 3; ++i) put(mass[i], t.friction_mass[i]);
        put(isotropic, t.isotropic_mass);
    }

    // Least k of lanes where each side that moves has nodes that are held, 0 elsewhere. What is free of a side, by a
    // share w of its weights, would move by 1 / w times what the contact asks for, a million times so at a pinned
    // corner; with k at least sum w_i^2 / m_i over w it moves by no more than that.
    template <bool Turns>
    static F least_by_held(const SurfaceGroup& g, const V& lever) {
        const F zero = F::all(0), one = F::all(1);
        F least = zero, whole = zero;  // whole: 1 where a side has nothing that is held
        for (const F& sign : {one, F::all(-1)}) {
            F free = zero, held = zero, k = zero;
            for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
                const F weight = F::max(sign * F::load(g.weight[n]), zero), inv_mass = F::load(g.inv_mass[n]);
                F moves = inv_mass;
                if constexpr (Turns)
                    if (n == 0) moves = moves + dot(lever, lever);
                free = free + F::if_greater(moves, zero, weight, zero);
                held = held + F::if_greater(moves, zero, zero, weight);
                k = k + weight * weight * inv_mass;
            }
            whole = F::if_greater(free, zero, F::if_greater(held, zero, whole, one), whole);
            least = F::max(least, k * inverse(free));
        }
        return F::if_greater(whole, zero, zero, least);
    }

    // before(new mass) comes ahead, put(value, array) writes a value of all lanes. What was hit already keeps the
    // approach speed that it had.
    template <bool Turns, class Before, class Put>
    static void prepare_group(SurfaceView view, SurfaceGroup& g, const SweepNode* nodes, const Before& before,
                              const Put& put) {
        const Ends<Turns> ends(view, g, nodes);
        const Frame f(g);
        F linear = F::all(0);
        for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
            const F weight = F::load(g.weight[n]);
            linear = linear + weight * weight * F::load(g.inv_mass[n]);
        }
        const F least_k = least_by_held<Turns>(g, ends.lever);
        F k = linear;
        if constexpr (Turns) {
            SurfaceTurning& t = view.turning[g.turning];
            const F weight = F::load(g.weight[0]), square = weight * weight;
            const V a0 = cross(ends.lever, f.n), a1 = cross(ends.lever, f.t1), a2 = cross(ends.lever, f.t2);
            const V w0 = ends.first.turn(a0), w1 = ends.first.turn(a1), w2 = ends.first.turn(a2);
            const F zero = F::all(0), held = ends.first.held(), least = F::all(kLeastFree) * linear;
            k = linear + square * dot(a0, w0);
            F k11 = linear + square * dot(a1, w1), k22 = linear + square * dot(a2, w2), k12 = square * dot(a2, w1);
            F c1 = square * dot(a1, w0), c2 = square * dot(a2, w0);
            if (F::greater(held, zero) != 0) {
                // What the locked node does not move of these.
                const auto lost = [&](const V& p, const V& q) {
                    return square * (ends.first.inv_mass * dot(p, q) - ends.first.moved(p, q));
                };
                const auto lose = [&](F& of, const V& p, const V& q) {
                    of = F::if_greater(held, zero, of - lost(p, q), of);
                };
                lose(k, f.n, f.n);
                lose(k11, f.t1, f.t1);
                lose(k22, f.t2, f.t2);
                lose(k12, f.t1, f.t2);
                lose(c1, f.t1, f.n);
                lose(c2, f.t2, f.n);
                k = F::if_greater(held, zero, F::if_greater(k, least, k, zero), k);
            }
            k11 = F::max(k11, least_k), k22 = F::max(k22, least_k);
            prepare_tangents(t, k11, k22, k12, held, least, put);
            put(c1, t.coupling[0]);
            put(c2, t.coupling[1]);
        }
        const F mass = inverse(F::max(k, least_k));
        before(mass);
        put(mass, g.normal_mass);
        put(F::if_greater(F::load(g.peak), F::all(0), F::load(g.approach), dot(ends.apart(), f.n)), g.approach);
    }

    static void prepare(SurfaceView view, uint32_t begin, uint32_t end, const SweepNode* nodes) {
        const auto before = [](const F&) {};
        const auto put = [](const F& value, float* to) { value.store(to); };
        for (uint32_t i = begin; i < end; ++i) {
            SurfaceGroup& g = view.group[i];
            if (g.turning != kNoLanes)
                prepare_group<true>(view, g, nodes, before, put);
            else
                prepare_group<false>(view, g, nodes, before, put);
        }
    }

    // As of contacts, an impulse that fitted other masses is not carried on: ContactSweep::kOtherMass.
    static void turn(SurfaceView view, uint32_t group, const float (&turned)[kLanes], const SweepShift* shifts,
                     const SweepNode* nodes) {
        SurfaceGroup& g = view.group[group];
        SurfaceTurning& t = view.turning[g.turning];
        const F zero = F::all(0), chosen = F::load(turned), part = F::all(Contacts::kOtherMass);
        const auto put = [&](const F& value, float* to) { F::if_greater(chosen, zero, value, F::load(to)).store(to); };
        const V lever = load(t.lever), change = ShiftLanes(g.node[0], shifts).turning(lever - load(t.skin));
        put(F::load(g.gap0) + F::load(g.weight[0]) * dot(change, load(g.normal)), g.gap0);
        put(lever.x + change.x, t.lever[0]);
        put(lever.y + change.y, t.lever[1]);
        put(lever.z + change.z, t.lever[2]);
        const auto drop_impulse = [&](const F& mass) {
            const F was = F::load(g.normal_mass), differs = F::max(mass - was, was - mass);
            for (float(&impulse)[kLanes] : g.impulse) {
                const F kept = F::load(impulse);
                put(F::if_greater(differs, part * was, zero, kept), impulse);
            }
        };
        prepare_group<true>(view, g, nodes, drop_impulse, put);
    }

    // ------------------------------------------------------------ sweeps

    static void warm_start(SurfaceView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            const SurfaceGroup& g = view.group[i];
            const F p = F::load(g.impulse[0]), q1 = F::load(g.impulse[1]), q2 = F::load(g.impulse[2]);
            if (!F::any(p, q1, q2)) continue;
            if (g.turning != kNoLanes)
                give<true>(view, g, Frame(g).of(p, q1, q2), nodes);
            else
                give<false>(view, g, Frame(g).of(p, q1, q2), nodes);
        }
    }
    template <bool Turns>
    static void give(SurfaceView view, const SurfaceGroup& g, const V& push, SweepNode* nodes) {
        Ends<Turns> ends(view, g, nodes);
        ends.push(push);
        ends.scatter(nodes);
    }

    // Changes an impulse across the normal by one step against its speed, and keeps it within a circle.
    static void disc(F& p1, F& p2, const F& v1, const F& v2, const F& mass, const F& limit) {
        const F zero = F::all(0), one = F::all(1), tiny = F::all(1e-30f);
        const F q1 = p1 - mass * v1, q2 = p2 - mass * v2, length2 = q1 * q1 + q2 * q2, squared = limit * limit;
        const F inside = F::if_greater(length2, squared, limit / F::sqrt(F::max(length2, tiny)), one);
        const F scale = F::if_greater(limit, zero, inside, zero);
        p1 = scale * q1;
        p2 = scale * q2;
    }

    template <bool Turns, class Terms>
    static void sweep_one(SurfaceView view, SurfaceGroup& g, SweepNode* nodes, const Terms& terms) {
        Ends<Turns> ends(view, g, nodes);
        const Frame f(g);
        const V v = ends.apart();
        const F old = F::load(g.impulse[0]), old1 = F::load(g.impulse[1]), old2 = F::load(g.impulse[2]);
        const F mass = F::load(g.normal_mass), asked = Contacts::normal_row(mass, old, dot(v, f.n), terms);
        const F first = F::max(asked, F::all(0));
        if (!F::any(first, old, old1, old2)) return;
        F next = first, q1 = old1, q2 = old2;
        const F v1 = dot(v, f.t1) - F::load(g.drive[0]), v2 = dot(v, f.t2) - F::load(g.drive[1]);
        const F limit = F::load(g.friction) * first;
        if constexpr (Turns) {
            const SurfaceTurning& t = view.turning[g.turning];
            const F c1 = F::load(t.coupling[0]), c2 = F::load(t.coupling[1]), normal = first - old;
            Contacts::circle(q1, q2, v1 + c1 * normal, v2 + c2 * normal, t.friction_mass, t.isotropic_mass, limit);
            next = Contacts::after_friction(mass, asked, c1 * (q1 - old1) + c2 * (q2 - old2), terms);
        } else {
            disc(q1, q2, v1, v2, mass, limit);
        }
        next.store(g.impulse[0]);
        q1.store(g.impulse[1]);
        q2.store(g.impulse[2]);
        F::max(next, F::load(g.peak)).store(g.peak);
        ends.push(f.of(next - old, q1 - old1, q2 - old2));
        ends.scatter(nodes);
    }
    template <class Terms>
    static void sweep_group(SurfaceView view, SurfaceGroup& g, SweepNode* nodes, const Terms& terms) {
        if (g.turning != kNoLanes)
            sweep_one<true>(view, g, nodes, terms);
        else
            sweep_one<false>(view, g, nodes, terms);
    }

    static void measure_gap(SurfaceView view, SurfaceGroup& g, const SweepShift* shifts) {
        V moved{F::all(0), F::all(0), F::all(0)};
        for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
            const float* row[kLanes];
            F dx[4];
            for (int i = 0; i < kLanes; ++i) row[i] = shifts[g.node[n][i]].dx;
            F::transpose(row, dx);
            moved = moved + F::load(g.weight[n]) * V{dx[0], dx[1], dx[2]};
        }
        if (g.turning != kNoLanes) {
            const SurfaceTurning& t = view.turning[g.turning];
            const V core = load(t.lever) - load(t.skin);
            moved = moved + F::load(g.weight[0]) * ShiftLanes(g.node[0], shifts).turning(core);
        }
        (F::load(g.gap0) + dot(moved, load(g.normal))).store(g.gap);
    }

    static void sweep_biased(SurfaceView view, uint32_t begin, uint32_t end, SweepNode* nodes, const SweepShift* shifts,
                             const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h), rate = F::all(terms.bias_rate);
        const F least = F::all(-terms.push), slow = F::all(-terms.hit);
        const F soft_mass = F::all(terms.mass_scale), soft_impulse = F::all(terms.impulse_scale);
        for (uint32_t i = begin; i < end; ++i) {
            SurfaceGroup& g = view.group[i];
            if (shifts) measure_gap(view, g, shifts);
            const F gap = F::load(g.gap), hit = slow - F::load(g.approach), rigid = F::max(gap, hit);
            const HitTerms of{
                {F::if_greater(gap, zero, gap * inv_h, F::max(rate * gap, least)),
                 F::if_greater(rigid, zero, one, soft_mass), F::if_greater(rigid, zero, zero, soft_impulse)},
                F::if_greater(hit, zero, one, zero)};
            sweep_group(view, g, nodes, of);
        }
    }

    static void sweep_relaxed(SurfaceView view, uint32_t begin, uint32_t end, SweepNode* nodes,
                              const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h);
        for (uint32_t i = begin; i < end; ++i) {
            SurfaceGroup& g = view.group[i];
            const F gap = F::load(g.gap);
            sweep_group(view, g, nodes, PointTerms{F::if_greater(gap, zero, gap * inv_h, zero), one, zero});
        }
    }

    static constexpr SurfaceKernels table(const char* name) {
        return {name, prepare, turn, warm_start, sweep_biased, sweep_relaxed};
    }
};

}  // namespace taut
