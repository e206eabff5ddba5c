// The sweep of joints, a template over the lanes (simd/lanes.h). Included by one file for each build.
//
// Locked rows, as one block:  dp = -(S + c)^-1 (scale (J v - bias) + c p) - softness p,   S = J W J^T
// with scale and softness of rigid rows from the soft-contact model (system/soft_contact.h), 1 and 0 where they are
// elastic or the sweep is relaxed. Then each axis row:  mu += (target - s J v - c mu) / (k + c), within its bounds.
#pragma once

#include "constraints/joint_lanes.h"
#include "constraints/sweep_side.inl"

namespace taut {

template <class F>
struct JointSweep {
    using V = Vec3Lanes<F>;
    using Side = SweepSide<F>;

    // A group and the sides that it moves.
    struct Joints {
        const JointGroup& g;
        const LaneScalar* jacobian;
        Side side[kMaxNodes];

        Joints(const JointView& view, const JointGroup& group)
            : g(group), jacobian(view.jacobian + group.first_jacobian) {}
        void gather(const SweepMass* masses) {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].gather(g.node[n], masses);
        }
        void gather(const SweepVelocity* velocities, const SweepMass* masses) {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].gather(g.node[n], velocities, masses);
        }
        void scatter(SweepVelocity* velocities, const SweepMass* masses) const {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].scatter(g.node[n], velocities, masses);
        }
        V linear(uint32_t n, uint32_t r) const { return part(n, r, 0); }
        V angular(uint32_t n, uint32_t r) const { return part(n, r, 3); }
        F velocity(uint32_t r) const {  // J v
            F sum = F::all(0);
            for (uint32_t n = 0; n < g.nodes; ++n)
                sum = sum + (dot(linear(n, r), side[n].move()) + dot(angular(n, r), side[n].spin()));
            return sum;
        }
        void apply(const F* impulse) {  // of all rows
            for (uint32_t n = 0; n < g.nodes; ++n) {
                V p = impulse[0] * linear(n, 0), l = impulse[0] * angular(n, 0);
                for (uint32_t r = 1; r < g.rows; ++r) {
                    p = p + impulse[r] * linear(n, r);
                    l = l + impulse[r] * angular(n, r);
                }
                side[n].add_move(p);
                side[n].add_spin(l);
            }
        }
        void apply(uint32_t r, const F& impulse) {
            for (uint32_t n = 0; n < g.nodes; ++n) {
                side[n].add_move(impulse * linear(n, r));
                side[n].add_spin(impulse * angular(n, r));
            }
        }
        F coupling(uint32_t r, uint32_t c) const {  // J_r W J_c^T
            F sum = F::all(0);
            for (uint32_t n = 0; n < g.nodes; ++n)
                sum = sum + (side[n].inv_mass * dot(linear(n, r), linear(n, c)) +
                             dot(angular(n, r), side[n].turn(angular(n, c))));
            return sum;
        }

    private:
        V part(uint32_t n, uint32_t r, uint32_t first) const {
            const LaneScalar* j = jacobian + 6 * (n * g.rows + r) + first;
            return {F::load(j[0].value), F::load(j[1].value), F::load(j[2].value)};
        }
    };

    static F clamp(const F& x, const F& least, const F& most) {
        const F zero = F::all(0);
        return zero - F::max(zero - F::max(x, least), zero - most);
    }

    // S + c of the locked rows, an identity in the place of the others, as L D L^T. A row that what it moves or the
    // rows before it leave nothing to do is left out: its pivot is no more than rounding.
    static void factor(const JointView& view, const JointGroup& g, const F (&s)[21]) {
        const F zero = F::all(0), one = F::all(1), rounding = F::all(5e-6f);
        const LaneRow* row = view.row + g.first_row;
        LaneScalar* out = view.factor + g.first_factor;
        F l[21], d[kMaxRows];
        for (uint32_t r = 0; r < g.rows; ++r) {
            const F locked = F::load(row[r].locked);
            for (uint32_t c = 0; c < r; ++c) {
                F sum = locked * F::load(row[c].locked) * s[triangle(r, c)];
                for (uint32_t k = 0; k < c; ++k) sum = sum - l[triangle(r, k)] * (d[k] * l[triangle(c, k)]);
                l[triangle(r, c)] = sum * F::load(out[triangle(c, c)].value);
                l[triangle(r, c)].store(out[triangle(r, c)].value);
            }
            const F whole = locked * s[triangle(r, r)] + (one - locked);
            F pivot = whole;
            for (uint32_t c = 0; c < r; ++c) pivot = pivot - l[triangle(r, c)] * (d[c] * l[triangle(r, c)]);
            d[r] = F::if_greater(pivot, rounding * whole, pivot, zero);
            F::if_greater(d[r], zero, one / F::if_greater(d[r], zero, d[r], one), zero)
                .store(out[triangle(r, r)].value);
        }
    }

    static void prepare(JointView view, uint32_t begin, uint32_t end, const SweepMass* masses) {
        const F zero = F::all(0), tiny = F::all(1e-30f);
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(masses);
            F s[21], k[kMaxRows];
            for (uint32_t r = 0; r < g.rows; ++r)
                for (uint32_t c = 0; c <= r; ++c) s[triangle(r, c)] = joints.coupling(r, c);
            for (uint32_t r = 0; r < g.rows; ++r) k[r] = s[triangle(r, r)];
            if (g.first_compliance != kNoLanes)
                for (uint32_t e = 0; e < triangle(g.rows, 0); ++e)
                    s[e] = s[e] + F::load(view.compliance[g.first_compliance + e].value);
            factor(view, g, s);
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
                LaneAxis& axis = view.axis[a];
                const F used = F::load(axis.mass), whole = k[axis.row] + F::load(axis.compliance);
                F::if_greater(used * whole, tiny, used / F::max(whole, tiny), zero).store(axis.mass);
            }
        }
    }

    static void warm_start(JointView view, uint32_t begin, uint32_t end, SweepVelocity* velocities,
                           const SweepMass* masses) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(velocities, masses);
            F impulse[kMaxRows];
            for (uint32_t r = 0; r < g.rows; ++r) impulse[r] = F::load(view.row[g.first_row + r].impulse);
            joints.apply(impulse);
            joints.scatter(velocities, masses);
        }
    }

    // x <- -(S + c)^-1 x.
    static void solve_block(const JointView& view, const JointGroup& g, F (&x)[kMaxRows]) {
        const LaneScalar* l = view.factor + g.first_factor;
        for (uint32_t r = 1; r < g.rows; ++r)
            for (uint32_t c = 0; c < r; ++c) x[r] = x[r] - F::load(l[triangle(r, c)].value) * x[c];
        for (uint32_t r = 0; r < g.rows; ++r) x[r] = F::all(0) - F::load(l[triangle(r, r)].value) * x[r];
        for (uint32_t r = g.rows; r-- > 0;)
            for (uint32_t c = 0; c < r; ++c) x[c] = x[c] - F::load(l[triangle(r, c)].value) * x[r];
    }

    // stiffening: what of a rigid row's effective mass is left out; softness: of the impulse already there.
    static void locked_rows(const JointView& view, Joints& joints, const F& stiffening, const F& softness,
                            bool biased) {
        const JointGroup& g = joints.g;
        const F one = F::all(1);
        LaneRow* row = view.row + g.first_row;
        F x[kMaxRows], p[kMaxRows];
        for (uint32_t r = 0; r < g.rows; ++r) {
            const F rigid = F::load(row[r].rigid), wanted = F::load(row[r].bias);
            p[r] = F::load(row[r].impulse);
            const F bias = biased ? wanted : (one - rigid) * wanted;
            x[r] = (one - rigid * stiffening) * (F::load(row[r].locked) * joints.velocity(r) - bias);
        }
        if (g.first_compliance != kNoLanes) {
            const LaneScalar* c = view.compliance + g.first_compliance;
            for (uint32_t r = 0; r < g.rows; ++r)
                for (uint32_t k = 0; k < g.rows; ++k)
                    x[r] = x[r] + F::load(c[r > k ? triangle(r, k) : triangle(k, r)].value) * p[k];
        }
        solve_block(view, g, x);
        for (uint32_t r = 0; r < g.rows; ++r) {
            x[r] = x[r] - F::load(row[r].rigid) * softness * p[r];
            (p[r] + x[r]).store(row[r].impulse);
        }
        joints.apply(x);
    }

    static void axis_row(LaneAxis& axis, LaneRow& row, Joints& joints, bool biased) {
        const F sign = F::load(axis.sign), before = F::load(axis.impulse);
        const F target = F::load(biased ? axis.target : axis.relaxed_target);
        const F step =
            F::load(axis.mass) * (target - sign * joints.velocity(axis.row) - F::load(axis.compliance) * before);
        const F after = clamp(before + step, F::load(axis.least), F::load(axis.most));
        const F change = sign * (after - before);
        after.store(axis.impulse);
        (F::load(row.impulse) + change).store(row.impulse);
        joints.apply(axis.row, change);
    }

    static void sweep(const JointView& view, uint32_t begin, uint32_t end, SweepVelocity* velocities,
                      const SweepMass* masses, const F& stiffening, const F& softness, bool biased) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(velocities, masses);
            locked_rows(view, joints, stiffening, softness, biased);
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a)
                if (view.axis[a].used) axis_row(view.axis[a], view.row[g.first_row + view.axis[a].row], joints, biased);
            joints.scatter(velocities, masses);
        }
    }

    static void sweep_biased(JointView view, uint32_t begin, uint32_t end, SweepVelocity* velocities,
                             const SweepMass* masses, const SweepTerms& terms) {
        sweep(view, begin, end, velocities, masses, F::all(1 - terms.mass_scale), F::all(terms.impulse_scale), true);
    }

    static void sweep_relaxed(JointView view, uint32_t begin, uint32_t end, SweepVelocity* velocities,
                              const SweepMass* masses) {
        sweep(view, begin, end, velocities, masses, F::all(0), F::all(0), false);
    }

    static constexpr JointKernels table(const char* name) {
        return {name, prepare, warm_start, sweep_biased, sweep_relaxed};
    }
};

}  // namespace taut
