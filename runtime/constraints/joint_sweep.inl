// The sweep of joints, a template over the lanes (simd/lanes.h). Included by one file for each build.
//
// Locked rows, as one block:  dp = -(S + c)^-1 (J v - bias + c p),   S = J W J^T.  Then each axis row:
// mu += (target - s J v - c mu) / (k + c), within its bounds.
//
// A sweep leaves what spans many joints nearly unsolved, and the impulses that the next substep starts from sum up what
// it was: they integrate J v, as a spring does. Were the bias that closes gaps in them they would integrate C as well:
// with a, the share that a sweep solves, d^3 C = -a (d^2 C + d C + rate C) a substep, which grows without bound where
// a < rate (Hurwitz). What closes gaps therefore moves the positions alone, and is taken back after that.
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
            const F zero = F::all(0);
            bool any_held = false;
            for (uint32_t n = 0; n < g.nodes; ++n) {
                const F held = side[n].held();
                const bool is_held = F::greater(held, zero) != 0;
                any_held = any_held || is_held;
                for (uint32_t c = 0; c < g.rows; ++c) {
                    const V turned = side[n].turn(angular(n, c));
                    const uint32_t end = c < g.held ? g.held : c + 1;
                    for (uint32_t r = c; r < end; ++r) {
                        F both = dot(angular(n, r), turned);
                        if (r < g.first_turn) {
                            F moved = side[n].inv_mass * dot(linear(n, r), linear(n, c));
                            if (is_held)
                                moved = F::if_greater(held, zero, side[n].moved(linear(n, r), linear(n, c)), moved);
                            both = both + moved;
                        }
                        s[triangle(r, c)] = n == 0 ? both : s[triangle(r, c)] + both;
                    }
                }
            }
            if (any_held) drop_held(s);
        }

    private:
        // What locks leave a row but rounding is nothing.
        void drop_held(F (&s)[21]) const {
            const F zero = F::all(0);
            for (uint32_t r = 0; r < g.rows; ++r) {
                F whole = zero, held = zero;
                for (uint32_t n = 0; n < g.nodes; ++n) {
                    const V turn = angular(n, r);
                    whole = whole + side[n].most_turn() * dot(turn, turn);
                    if (r < g.first_turn) whole = whole + side[n].inv_mass * dot(linear(n, r), linear(n, r));
                    held = F::max(held, side[n].held());
                }
                F& own = s[triangle(r, r)];
                own = F::if_greater(held, zero, F::if_greater(own, F::all(kLeastFree) * whole, own, zero), own);
            }
        }
        V part(uint32_t n, uint32_t r, uint32_t first) const {
            const LaneScalar* j = jacobian + 6 * (n * g.rows + r) + first;
            return {F::load(j[0].value), F::load(j[1].value), F::load(j[2].value)};
        }
    };

    static F clamp(const F& x, const F& least, const F& most) {
        const F zero = F::all(0);
        return zero - F::max(zero - F::max(x, least), zero - most);
    }

    // Of forces f of locked rows at levers r the positive part of K is at most (f . r + |f||r|)/2 (Tournier et al.
    // 2015, eq. 22; the eigenvalues of lever.h). Rows that move are along three axes e, and turn by r x e; what they
    // leave of a lever, e x (r x e) summed, is twice the lever. Torques are left out: theirs would take the spin of
    // wheels.
    static void stiffen(JointView view, uint32_t begin, uint32_t end, float h) {
        const F half = F::all(0.5f), rate = F::all(1 / h);
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            LaneStiffness& out = view.stiffness[i];
            if (g.first_turn < 3 || g.nodes > 2) continue;
            const Joints joints(view, g);
            const auto impulse = [&](uint32_t r) {
                const LaneRow& row = view.row[g.first_row + r];
                return rate * F::load(row.locked) * F::load(row.impulse);
            };
            for (uint32_t n = 0; n < g.nodes; ++n) {
                V f = impulse(0) * joints.linear(n, 0), lever = cross(joints.linear(n, 0), joints.angular(n, 0));
                for (uint32_t r = 1; r < 3; ++r) {
                    f = f + impulse(r) * joints.linear(n, r);
                    lever = lever + cross(joints.linear(n, r), joints.angular(n, r));
                }
                lever = half * lever;
                const F size = F::sqrt(dot(f, f) * dot(lever, lever));
                (half * (dot(f, lever) + size)).store(out.of[n]);
            }
        }
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

    // C with what of its drift has come, and the biases. An elastic row's law is J v + c p = -rate C at the end of the
    // substep. Where its spring is stiffer than h^2 S of its ends bears, it is a rigid row that yields: the change
    // alone is kept, J v + c dp = 0, and what of the law that does not hold moves the positions.
    static void set_biases(const JointView& view, const JointGroup& g, const F& frame_left, const SweepTerms& terms) {
        const F zero = F::all(0), share = F::all(terms.bias_rate), inv_h = F::all(terms.inv_h);
        const bool elastic = g.first_compliance != kNoLanes;
        F p[kMaxRows];
        for (uint32_t r = 0; r < g.held; ++r) p[r] = F::load(view.row[g.first_row + r].impulse);
        for (uint32_t r = 0; r < g.rows; ++r) {
            LaneRow& row = view.row[g.first_row + r];
            LaneCoordinate& at = view.coordinate[g.first_row + r];
            const F come = F::load(at.damped_drift) - frame_left * F::load(at.drift), locked = F::load(row.locked);
            const F c = F::load(at.value) + come;
            c.store(at.value);
            F kept = zero, rate = locked * share;
            if (elastic && r < g.held) {
                const F soft = F::load(view.compliance[g.first_compliance + triangle(r, r)].value) * inv_h;
                const F spring = F::load(at.rate), law = zero - spring * c, yields = locked * yielding(view, g, r, p);
                rate = F::if_greater(spring, zero, spring, rate);
                kept = F::if_greater(soft, spring * F::load(row.own), law, yields);
            }
            kept.store(row.kept_bias);
            (zero - rate * c).store(row.bias);
        }
    }

    // A stop with a spring that is stiffer than its ends bear yields as such a row does.
    static void set_axis(LaneAxis& axis, const LaneAxisLaw& law, const LaneCoordinate& at, const F& k) {
        const F zero = F::all(0), tiny = F::all(1e-30f), sign = F::load(axis.sign), base = F::load(law.base);
        const F turn = F::load(law.turn), half = F::all(0.5f) * turn, c = F::load(at.value);
        const F off = c - F::load(law.near);
        const F turns = F::if_greater(off, half, turn, zero) - F::if_greater(zero - off, half, turn, zero);
        const F gap = sign * (c - turns - F::load(law.at)), open = F::load(law.open), push = F::load(law.push);
        const F target = base - F::if_greater(gap, zero, open, F::load(law.closed)) * gap;
        F::if_greater(target, push, push, target).store(axis.target);
        const F compliance = F::max(F::load(law.compliance), F::load(law.softness) * k);
        compliance.store(axis.compliance);
        const F spring = F::load(law.relaxed);
        F kept = base - F::if_greater(gap, zero, open, spring) * gap;
        if (axis.part < kDriving) {
            const F yields = F::if_greater(compliance * open, spring * k, kept, compliance * F::load(axis.impulse));
            kept = F::if_greater(gap, zero, kept, F::if_greater(spring, zero, yields, kept));
        }
        kept.store(axis.relaxed_target);
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

    static void prepare(JointView view, uint32_t begin, uint32_t end, const SweepNode* nodes, float frame_left,
                        const SweepTerms& terms) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(nodes);
            F s[21];
            joints.couplings(s);
            for (uint32_t r = 0; r < g.rows; ++r) s[triangle(r, r)].store(view.row[g.first_row + r].own);
            if (g.first_compliance != kNoLanes)
                for (uint32_t e = 0; e < triangle(g.held, 0); ++e)
                    s[e] = s[e] + F::load(view.compliance[g.first_compliance + e].value);
            factor(view, g, s);
            set_biases(view, g, F::all(frame_left), terms);
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

    static void locked_rows(const JointView& view, Joints& joints, bool corrects) {
        const JointGroup& g = joints.g;
        if (g.held == 0) return;
        LaneRow* row = view.row + g.first_row;
        F x[kMaxRows], p[kMaxRows];
        for (uint32_t r = 0; r < g.held; ++r) {
            p[r] = F::load(row[r].impulse);
            x[r] = F::load(row[r].locked) * joints.velocity(r) - F::load(corrects ? row[r].bias : row[r].kept_bias);
        }
        if (g.first_compliance != kNoLanes)
            for (uint32_t r = 0; r < g.held; ++r) x[r] = x[r] + yielding(view, g, r, p);
        solve_block(view, g, x);
        for (uint32_t r = 0; r < g.held; ++r) (p[r] + x[r]).store(row[r].impulse);
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

    // A drive without limit against a stop: no forces fulfil both, and those that sweeps find grow without end. The
    // stop wins, and neither keeps what it takes back of the drive's push.
    static void unwind(LaneAxis& drive, F& pushed, LaneAxis& stop, const F& change) {
        const F zero = F::all(0);
        const F taken = clamp(zero - change, zero - F::max(zero - pushed, zero), F::max(pushed, zero));
        (F::load(drive.impulse) - F::load(drive.sign) * taken).store(drive.impulse);
        (F::load(stop.impulse) + F::load(stop.sign) * taken).store(stop.impulse);
        pushed = pushed - taken;
    }

    // One after another, stops last; those along one row, side by side, are applied together.
    static void axis_rows(const JointView& view, Joints& joints, bool biased) {
        const uint32_t end = joints.g.first_axis + joints.g.axes;
        for (uint32_t a = joints.g.first_axis; a < end;) {
            if (!view.axis[a].used) {
                ++a;
                continue;
            }
            const uint32_t r = view.axis[a].row;
            LaneRow& row = view.row[joints.g.first_row + r];
            const F own = F::load(row.own), zero = F::all(0);
            F v = joints.velocity(r), sum = zero, pushed = zero;  // by a drive without limit
            LaneAxis* drive = nullptr;
            for (; a < end && view.axis[a].row == r; ++a) {
                LaneAxis& axis = view.axis[a];
                if (!axis.used) continue;
                const F change = axis_change(axis, v, biased);
                v = v + own * change;
                sum = sum + change;
                if (axis.part == kDriving) {
                    drive = &axis;
                    pushed = F::if_greater(F::all(kUnlimited), F::load(axis.most), zero, change);
                } else if (drive && axis.part < kDriving) {
                    unwind(*drive, pushed, axis, change);
                }
            }
            (F::load(row.impulse) + sum).store(row.impulse);
            joints.apply(r, sum);
        }
    }

    static void solve(const JointView& view, Joints& joints, SweepNode* nodes, bool corrects) {
        joints.gather(nodes);
        locked_rows(view, joints, corrects);
        axis_rows(view, joints, corrects);
        joints.scatter(nodes);
    }

    static void sweep(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            Joints joints(view, view.group[i]);
            solve(view, joints, nodes, false);
        }
    }

    static void keep(JointView view, uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            for (uint32_t r = g.first_row; r < g.first_row + g.rows; ++r)
                F::load(view.row[r].impulse).store(view.row[r].kept);
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a)
                F::load(view.axis[a].impulse).store(view.axis[a].kept);
        }
    }

    static void correct(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            Joints joints(view, view.group[i]);
            solve(view, joints, nodes, true);
        }
    }

    static void take_back(JointView view, uint32_t begin, uint32_t end, SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = view.group[i];
            Joints joints(view, g);
            joints.gather(nodes);
            F change[kMaxRows];
            for (uint32_t r = 0; r < g.rows; ++r) {
                LaneRow& row = view.row[g.first_row + r];
                change[r] = F::load(row.kept) - F::load(row.impulse);
                F::load(row.kept).store(row.impulse);
            }
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a)
                F::load(view.axis[a].kept).store(view.axis[a].impulse);
            joints.apply(change, g.rows);
            joints.scatter(nodes);
        }
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
        return {name, stiffen, prepare, warm_start, sweep, keep, correct, take_back, residual};
    }
};

}  // namespace taut
