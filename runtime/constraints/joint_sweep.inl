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
        void gather_masses(const SweepNode* nodes) {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].gather_masses(g.node[n], nodes);
        }
        void gather(const SweepNode* nodes) {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].gather(g.node[n], nodes);
        }
        void scatter(SweepNode* nodes) const {
            for (uint32_t n = 0; n < g.nodes; ++n) side[n].scatter(g.node[n], nodes);
        }
        V linear(uint32_t n, uint32_t r) const { return part(n, r, 0); }
        V angular(uint32_t n, uint32_t r) const { return part(n, r, 3); }
        F velocity(uint32_t r) const {  // J v
            if (r >= g.first_turn) return dot(angular(1, r), side[1].spin() - side[0].spin());
            F sum = F::all(0);
            for (uint32_t n = 0; n < g.nodes; ++n)
                sum = sum + (dot(linear(n, r), side[n].move()) + dot(angular(n, r), side[n].spin()));
            return sum;
        }
        void apply(const F* impulse, uint32_t rows) {  // of the first rows
            const uint32_t moving = rows < g.first_turn ? rows : g.first_turn;
            for (uint32_t n = 0; n < g.nodes; ++n) {
                V p = impulse[0] * linear(n, 0), l = impulse[0] * angular(n, 0);
                for (uint32_t r = 1; r < moving; ++r) {
                    p = p + impulse[r] * linear(n, r);
                    l = l + impulse[r] * angular(n, r);
                }
                for (uint32_t r = moving; r < rows; ++r) l = l + impulse[r] * angular(n, r);
                side[n].add_move(p);
                side[n].add_spin(l);
            }
        }
        void apply(uint32_t r, const F& impulse) {
            for (uint32_t n = 0; n < g.nodes; ++n) {
                if (r < g.first_turn) side[n].add_move(impulse * linear(n, r));
                side[n].add_spin(impulse * angular(n, r));
            }
        }
        // S = J W J^T, of which rows that turn need only the diagonal unless they are held.
        void couplings(F (&s)[21]) const {
            for (uint32_t n = 0; n < g.nodes; ++n) {
                for (uint32_t c = 0; c < g.rows; ++c) {
                    const V turned = side[n].turn(angular(n, c));
                    const uint32_t end = c < g.held ? g.held : c + 1;
                    for (uint32_t r = c; r < end; ++r) {
                        F both = dot(angular(n, r), turned);
                        if (r < g.first_turn) both = both + side[n].inv_mass * dot(linear(n, r), linear(n, c));
                        s[triangle(r, c)] = n == 0 ? both : s[triangle(r, c)] + both;
                    }
                }
            }
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
        for (uint32_t r = 0; r < g.held; ++r) {
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

    // C with what of its drift has come, and the biases.
    static void set_biases(const JointView& view, const JointGroup& g, const F& frame_left) {
        for (uint32_t r = g.first_row; r < g.first_row + g.rows; ++r) {
            LaneCoordinate& at = view.coordinate[r];
            const F come = F::load(at.damped_drift) - frame_left * F::load(at.drift);
            const F c = F::load(at.value) + come;
            c.store(at.value);
            (F::all(0) - F::load(at.rate) * c).store(view.row[r].bias);
        }
    }

    static void set_axis(LaneAxis& axis, const LaneAxisLaw& law, const LaneCoordinate& at, const F& k) {
        const F zero = F::all(0), tiny = F::all(1e-30f), sign = F::load(axis.sign), base = F::load(law.base);
        const F turn = F::load(law.turn), half = F::all(0.5f) * turn, c = F::load(at.value);
        const F off = c - F::load(law.near);
        const F turns = F::if_greater(off, half, turn, zero) - F::if_greater(zero - off, half, turn, zero);
        const F gap = sign * (c - turns - F::load(law.at)), open = F::load(law.open), push = F::load(law.push);
        const F target = base - F::if_greater(gap, zero, open, F::load(law.closed)) * gap;
        F::if_greater(target, push, push, target).store(axis.target);
        (base - F::if_greater(gap, zero, open, F::load(law.relaxed)) * gap).store(axis.relaxed_target);

        const F compliance = F::max(F::load(law.compliance), F::load(law.softness) * k);
        compliance.store(axis.compliance);
        const F filled = F::load(law.filled), whole = k + compliance;
        const F far = F::if_greater(F::load(axis.impulse), zero, filled, zero);
        const F used = F::if_greater(gap, F::load(law.reach), far, filled);
        F::if_greater(used * whole, tiny, used / F::max(whole, tiny), zero).store(axis.mass);
        axis.used = 0;
        for (float mass : axis.mass) axis.used |= mass > 0 ? 1u : 0u;
    }

    // Friction is a torque: lambda is less where the coordinate turns faster than its bodies do, |g| > 1. What is
    // carried on from the last substep is cut down to that, or it would be a torque of any size.
    static void bound_friction(LaneAxis& axis, LaneRow& row, const LaneAxisLaw& law, const V& g) {
        const F most = F::load(law.friction) / F::max(F::sqrt(dot(g, g)), F::all(1e-30f)), least = F::all(0) - most;
        most.store(axis.most);
        least.store(axis.least);
        const F carried = F::load(axis.impulse), kept = clamp(carried, least, most);
        kept.store(axis.impulse);
        (F::load(row.impulse) + F::load(axis.sign) * (kept - carried)).store(row.impulse);
    }

    static void prepare(JointView view, uint32_t begin, uint32_t end, const SweepNode* nodes, float frame_left) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather_masses(nodes);
            F s[21];
            joints.couplings(s);
            for (uint32_t r = 0; r < g.rows; ++r) s[triangle(r, r)].store(view.row[g.first_row + r].own);
            if (g.first_compliance != kNoLanes)
                for (uint32_t e = 0; e < triangle(g.held, 0); ++e)
                    s[e] = s[e] + F::load(view.compliance[g.first_compliance + e].value);
            factor(view, g, s);
            set_biases(view, g, F::all(frame_left));
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
                const uint32_t row = view.axis[a].row;
                set_axis(view.axis[a], view.law[a], view.coordinate[g.first_row + row],
                         F::load(view.row[g.first_row + row].own));
                if (view.axis[a].part == kRubbing && row >= g.first_turn)  // one that turns
                    bound_friction(view.axis[a], view.row[g.first_row + row], view.law[a], joints.angular(1, row));
            }
        }
    }

    static void warm_start(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(nodes);
            F impulse[kMaxRows];
            for (uint32_t r = 0; r < g.rows; ++r) impulse[r] = F::load(view.row[g.first_row + r].impulse);
            joints.apply(impulse, g.rows);
            joints.scatter(nodes);
        }
    }

    // x <- -(S + c)^-1 x.
    static void solve_block(const JointView& view, const JointGroup& g, F (&x)[kMaxRows]) {
        const LaneScalar* l = view.factor + g.first_factor;
        for (uint32_t r = 1; r < g.held; ++r)
            for (uint32_t c = 0; c < r; ++c) x[r] = x[r] - F::load(l[triangle(r, c)].value) * x[c];
        for (uint32_t r = 0; r < g.held; ++r) x[r] = F::all(0) - F::load(l[triangle(r, r)].value) * x[r];
        for (uint32_t r = g.held; r-- > 0;)
            for (uint32_t c = 0; c < r; ++c) x[c] = x[c] - F::load(l[triangle(r, c)].value) * x[r];
    }

    // c p of a row.
    static F yielding(const JointView& view, const JointGroup& g, uint32_t r, const F (&p)[kMaxRows]) {
        F sum = F::all(0);
        if (g.first_compliance == kNoLanes) return sum;
        const LaneScalar* c = view.compliance + g.first_compliance;
        for (uint32_t k = 0; k < g.held; ++k)
            sum = sum + F::load(c[r > k ? triangle(r, k) : triangle(k, r)].value) * p[k];
        return sum;
    }

    // stiffening: what of a rigid row's effective mass is left out; softness: of the impulse already there.
    static void locked_rows(const JointView& view, Joints& joints, const F& stiffening, const F& softness,
                            bool biased) {
        const JointGroup& g = joints.g;
        if (g.held == 0) return;
        const F one = F::all(1);
        LaneRow* row = view.row + g.first_row;
        F x[kMaxRows], p[kMaxRows];
        for (uint32_t r = 0; r < g.held; ++r) {
            const F rigid = F::load(row[r].rigid), wanted = F::load(row[r].bias);
            p[r] = F::load(row[r].impulse);
            const F bias = biased ? wanted : (one - rigid) * wanted;
            x[r] = (one - rigid * stiffening) * (F::load(row[r].locked) * joints.velocity(r) - bias);
        }
        if (g.first_compliance != kNoLanes)
            for (uint32_t r = 0; r < g.held; ++r) x[r] = x[r] + yielding(view, g, r, p);
        solve_block(view, g, x);
        for (uint32_t r = 0; r < g.held; ++r) {
            x[r] = x[r] - F::load(row[r].rigid) * softness * p[r];
            (p[r] + x[r]).store(row[r].impulse);
        }
        joints.apply(x, g.held);
    }

    // What an axis row changes of its row's impulse at velocity v.
    static F axis_change(LaneAxis& axis, const F& v, bool biased) {
        const F sign = F::load(axis.sign), before = F::load(axis.impulse);
        const F target = F::load(biased ? axis.target : axis.relaxed_target);
        const F step = F::load(axis.mass) * (target - sign * v - F::load(axis.compliance) * before);
        const F after = clamp(before + step, F::load(axis.least), F::load(axis.most));
        after.store(axis.impulse);
        return sign * (after - before);
    }

    // One after another; those along one row, side by side, are applied together.
    static void axis_rows(const JointView& view, Joints& joints, bool biased) {
        const uint32_t end = joints.g.first_axis + joints.g.axes;
        for (uint32_t a = joints.g.first_axis; a < end;) {
            if (!view.axis[a].used) {
                ++a;
                continue;
            }
            const uint32_t r = view.axis[a].row;
            LaneRow& row = view.row[joints.g.first_row + r];
            const F own = F::load(row.own);
            F v = joints.velocity(r), sum = F::all(0);
            for (; a < end && view.axis[a].row == r; ++a) {
                if (!view.axis[a].used) continue;
                const F change = axis_change(view.axis[a], v, biased);
                v = v + own * change;
                sum = sum + change;
            }
            (F::load(row.impulse) + sum).store(row.impulse);
            joints.apply(r, sum);
        }
    }

    static void sweep(const JointView& view, uint32_t begin, uint32_t end, SweepNode* nodes, const F& stiffening,
                      const F& softness, bool biased) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(nodes);
            locked_rows(view, joints, stiffening, softness, biased);
            axis_rows(view, joints, biased);
            joints.scatter(nodes);
        }
    }

    static void sweep_biased(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes, const SweepTerms& terms) {
        sweep(view, begin, end, nodes, F::all(1 - terms.mass_scale), F::all(terms.impulse_scale), true);
    }

    static void sweep_relaxed(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        sweep(view, begin, end, nodes, F::all(0), F::all(0), false);
    }

    static float residual(JointView view, uint32_t begin, uint32_t end, const SweepNode* nodes) {
        const F zero = F::all(0);
        F largest = zero;
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(nodes);
            F p[kMaxRows];
            for (uint32_t r = 0; r < g.held; ++r) p[r] = F::load(view.row[g.first_row + r].impulse);
            for (uint32_t r = 0; r < g.held; ++r) {
                const LaneRow& row = view.row[g.first_row + r];
                const F left = F::load(row.locked) * joints.velocity(r) - F::load(row.bias) + yielding(view, g, r, p);
                largest = F::max(largest, F::max(left, zero - left));
            }
        }
        alignas(32) float each[kLanes];
        largest.store(each);
        float most = 0;
        for (float x : each) most = x > most ? x : most;
        return most;
    }

    static constexpr JointKernels table(const char* name) {
        return {name, prepare, warm_start, sweep_biased, sweep_relaxed, residual};
    }
};

}  // namespace taut
