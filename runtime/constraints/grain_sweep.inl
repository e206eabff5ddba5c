// The fused sweep of contacts between grains, a template over the lanes (simd/lanes.h). Included by one file for each
// build. Rows and terms are those of contact_sweep.inl; friction is solved as one vector,
//   q = f - m (v - (v n) n),  |q| <= mu p_n,
// which is exact: what a point mass does along the normal changes nothing across it.
#pragma once

#include "constraints/grain_lanes.h"
#include "constraints/sweep_side.inl"

namespace taut {

template <class F>
struct GrainSweep {
    using V = Vec3Lanes<F>;

    // Velocities of kLanes particles.
    struct Ends {
        F of[4];

        void gather(const uint32_t (&node)[kLanes], const SweepNode* nodes) {
            const float* row[kLanes];
            for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
            F::transpose(row, of);
        }
        // What no impulse moves is not written: groups on other threads read it.
        void scatter(const uint32_t (&node)[kLanes], const F& inv_mass, SweepNode* nodes) const {
            alignas(32) float nowhere[4];
            float* row[kLanes];
            for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
            const unsigned still = ~F::greater(inv_mass, F::all(0)) & kAllLanes;
            for (unsigned left = still; left != 0; left &= left - 1) row[__builtin_ctz(left)] = nowhere;
            F::transpose_back(of, row);
        }
        V velocity() const { return {of[0], of[1], of[2]}; }
        void add(const F& scale, const V& push) {
            of[0] = of[0] + scale * push.x;
            of[1] = of[1] + scale * push.y;
            of[2] = of[2] + scale * push.z;
        }
    };

    static V load(const float (&p)[3][kLanes]) { return {F::load(p[0]), F::load(p[1]), F::load(p[2])}; }
    static void store(const V& v, float (&p)[3][kLanes]) {
        v.x.store(p[0]);
        v.y.store(p[1]);
        v.z.store(p[2]);
    }

    static void warm_start(const GrainGroup* groups, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            const GrainGroup& g = groups[i];
            const F p = F::load(g.impulse);
            if (!F::any(p)) continue;  // nor has friction any
            const F wa = F::load(g.inv_mass[0]), wb = F::load(g.inv_mass[1]);
            Ends a, b;
            a.gather(g.a, nodes);
            b.gather(g.b, nodes);
            const V push = p * load(g.normal) + load(g.slide);
            b.add(wb, push);
            a.add(F::all(0) - wa, push);
            a.scatter(g.a, wa, nodes);
            b.scatter(g.b, wb, nodes);
        }
    }

    struct Terms {  // of the normal row
        F bias, mass_scale, impulse_scale;
    };

    // terms(group) -> Terms.
    template <class Of>
    [[gnu::always_inline]] static void sweep(GrainGroup& g, SweepNode* nodes, const Of& terms) {
        const F zero = F::all(0), one = F::all(1), tiny = F::all(1e-30f);
        const F wa = F::load(g.inv_mass[0]), wb = F::load(g.inv_mass[1]), sum = wa + wb;
        const F mass = F::if_greater(sum, zero, one / F::max(sum, tiny), zero);
        const V n = load(g.normal), old_slide = load(g.slide);
        Ends a, b;
        a.gather(g.a, nodes);
        b.gather(g.b, nodes);
        const V v = b.velocity() - a.velocity();
        const F old = F::load(g.impulse), vn = dot(v, n);
        const Terms t = terms(g);
        const F p = F::max(old - t.mass_scale * mass * (vn + t.bias) - t.impulse_scale * old, zero);
        if (!F::any(p, old)) return;
        const V q = old_slide - mass * (v - vn * n);
        const F limit = F::load(g.friction) * p, squared = limit * limit, length2 = dot(q, q);
        const F scale = F::if_greater(length2, squared, limit / F::sqrt(F::max(length2, tiny)), one);
        const V slide = F::if_greater(limit, zero, scale, zero) * q;
        p.store(g.impulse);
        store(slide, g.slide);
        const V push = (p - old) * n + (slide - old_slide);
        b.add(wb, push);
        a.add(zero - wa, push);
        a.scatter(g.a, wa, nodes);
        b.scatter(g.b, wb, nodes);
    }

    static void measure_gap(GrainGroup& g, const SweepShift* shifts) {
        const float *row_a[kLanes], *row_b[kLanes];
        F of_a[4], of_b[4];
        for (int i = 0; i < kLanes; ++i) row_a[i] = shifts[g.a[i]].dx, row_b[i] = shifts[g.b[i]].dx;
        F::transpose(row_a, of_a);
        F::transpose(row_b, of_b);
        const V apart{of_b[0] - of_a[0], of_b[1] - of_a[1], of_b[2] - of_a[2]};
        (F::load(g.gap0) + dot(apart, load(g.normal))).store(g.gap);
    }

    static void sweep_biased(GrainGroup* groups, uint32_t begin, uint32_t end, SweepNode* nodes,
                             const SweepShift* shifts, const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h), rate = F::all(terms.bias_rate);
        const F least = F::all(-terms.push), soft_mass = F::all(terms.mass_scale);
        const F soft_impulse = F::all(terms.impulse_scale);
        for (uint32_t i = begin; i < end; ++i) {
            GrainGroup& g = groups[i];
            if (shifts) measure_gap(g, shifts);
            sweep(g, nodes, [&](const GrainGroup& of) {
                const F gap = F::load(of.gap), rigid = F::max(gap, F::load(of.hits));
                return Terms{F::if_greater(gap, zero, gap * inv_h, F::max(rate * gap, least)),
                             F::if_greater(rigid, zero, one, soft_mass),
                             F::if_greater(rigid, zero, zero, soft_impulse)};
            });
        }
    }

    static void sweep_relaxed(GrainGroup* groups, uint32_t begin, uint32_t end, SweepNode* nodes,
                              const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h);
        for (uint32_t i = begin; i < end; ++i)
            sweep(groups[i], nodes, [&](const GrainGroup& of) {
                const F gap = F::load(of.gap);
                return Terms{F::if_greater(gap, zero, gap * inv_h, zero), one, zero};
            });
    }

    static constexpr GrainKernels table(const char* name) { return {name, warm_start, sweep_biased, sweep_relaxed}; }
};

}  // namespace taut
