// The fused contact sweep, a template over the lanes (simd/lanes.h). Included by one file for each build.
//
// Soft normal row (frequency f, damping ratio z, om = 2 pi f): compliance k_n / a2, a1 = 2 z + h om, a2 = h om a1:
//   dp = -mass_scale/k_n (vn + bias) - impulse_scale p,  p >= 0
// Friction on the circular cone: q = p_t - K^-1 v_t; if |q| > mu p_n the step is isotropic, q = p_t - v_t / k_max,
// which opposes the slip, then projected on the circle. Where surfaces move, v_t is what misses their speed.
// Rolling and spinning friction: the same on the relative angular velocity, after the points of a pair, with the sum of
// their normal impulses times an arm as the limit.
//
// Static friction: a point that slides has the coefficient mu_k, one that sticks mu_s. Which of the two it does is
// decided by the substep before, for within one the law has no unique answer:
//   sticks -> slides   if mu_s p_n does not stop it, |p_t - v_t / k_max| > mu_s p_n, and it does not creep:
//                      |v_t| / k_max > s (mu_s - mu_k) P, with s = kSlips and P the sum of p_n over its pair. Among
//                      points that hold together some are at mu_s p_n, and slip by what sweeps leave.
//   slides -> sticks   if mu_k p_n stops it: |p_t - v_t / k_max| <= mu_k p_n; or if friction would turn round against
//                      what it was, as then the slip went through 0: at once.
//
// Friction by direction: the row of tangent 2 is r times that of the unit vector, which makes the ellipse with the axes
// mu, r mu the circle of radius mu, and a slip along the ellipse's normal one against the impulse (associated flow).
#pragma once

#include <type_traits>

#include "constraints/sweep_side.inl"

namespace taut {

template <class F>
struct ContactSweep {
    using V = Vec3Lanes<F>;
    using Side = SweepSide<F>;

    static V load(const float (&p)[3][kLanes]) { return {F::load(p[0]), F::load(p[1]), F::load(p[2])}; }

    struct Frame {  // of a lane group
        V n, t1, t2;
        F friction;
        explicit Frame(const LaneGroup& g)
            : n(ContactSweep::load(g.normal)),
              t1(ContactSweep::load(g.tangent)),
              t2(cross(n, t1)),
              friction(F::load(g.friction)) {}
    };

    struct ShiftLanes {
        V dx, q;
        F w;
        ShiftLanes(const uint32_t node[kLanes], const SweepShift* shifts) {
            const float* row[kLanes];
            F s[8];
            for (int i = 0; i < kLanes; ++i) row[i] = shifts[node[i]].dx;
            F::transpose(row, s);
            dx = {s[0], s[1], s[2]};
            q = {s[4], s[5], s[6]};
            w = s[7];
        }
        V turning(const V& r) const {  // of the point at r: R r - r = 2 (w q x r + q x (q x r))
            const V t = cross(q, r), d = w * t + cross(q, t);
            return d + d;
        }
        V motion(const V& r) const { return dx + turning(r); }
    };

    struct PointTerms {  // of a normal row
        F bias, mass_scale, impulse_scale;
    };
    struct HitTerms : PointTerms {
        F hit;  // 1: is hit, and the row also answers for what friction does to it
    };

    // The impulse that the normal row of a point asks for, which closes at vn and has old; below 0 it would pull.
    static F normal_row(const F& mass, const F& old, const F& vn, const PointTerms& terms) {
        return old - terms.mass_scale * mass * (vn + terms.bias) - terms.impulse_scale * old;
    }
    // What is left of it where friction gives the row a speed more.
    static F after_friction(const F&, const F& asked, const F&, const PointTerms&) { return F::max(asked, F::all(0)); }
    static F after_friction(const F& mass, const F& asked, const F& speed, const HitTerms& terms) {
        return F::max(asked - terms.hit * mass * speed, F::all(0));
    }
    static void keep_normal(LanePoint& p, const F& next) {
        next.store(p.impulse[0]);
        F::max(next, F::load(p.peak)).store(p.peak);
    }

    // Changes an impulse in the plane of two rows by one step against their speeds, and keeps it within a circle. Where
    // nobody comes to the rim, but who has no circle, there is nothing to shorten.
    [[gnu::always_inline]] static void circle(F& p1, F& p2, const F& v1, const F& v2, const float (&mass)[3][kLanes],
                                              const float (&isotropic_mass)[kLanes], const F& limit) {
        const F old1 = p1, old2 = p2;
        const F m11 = F::load(mass[0]), m22 = F::load(mass[1]), m12 = F::load(mass[2]);
        const F iso = F::load(isotropic_mass);
        F q1 = old1 - (m11 * v1 + m12 * v2), q2 = old2 - (m12 * v1 + m22 * v2);
        const F inside = q1 * q1 + q2 * q2, squared = limit * limit, zero = F::all(0);
        if (F::greater(F::if_greater(limit, zero, inside, zero), squared) == 0) {
            p1 = F::if_greater(limit, zero, q1, zero);
            p2 = F::if_greater(limit, zero, q2, zero);
            return;
        }
        q1 = F::if_greater(inside, squared, old1 - iso * v1, q1);
        q2 = F::if_greater(inside, squared, old2 - iso * v2, q2);
        const F length2 = q1 * q1 + q2 * q2;
        const F one = F::all(1);
        const F scale = F::if_greater(length2, squared, limit / F::sqrt(F::max(length2, F::all(1e-30f))), one);
        p1 = F::if_greater(limit, zero, scale * q1, zero);  // squares of what is tiny are 0, as that of no limit
        p2 = F::if_greater(limit, zero, scale * q2, zero);
    }

    // Normal row, then the tangents. Slip is what it was before the normal row and what its impulse adds to it, so that
    // both reach the bodies at once: the same as one after the other, with a shorter way from one point to the next.
    // What is hit answers to friction at once: it turns a corner that hits, which would go in at the speed that this
    // gives it. What rests does so in the next sweep, and friction, the last word here, lets nothing creep.
    // Where no lane bears anything, or comes to, nothing changes; then false.
    template <bool kDriven, class Terms>
    [[gnu::always_inline]] static bool point_rows(LanePoint& p, LaneDrive* drive, const F& pushes, const Frame& f,
                                                  Side& a, Side& b, const Terms& terms) {
        const V ra = load(p.ra), rb = load(p.rb), v = b.at(rb) - a.at(ra);
        const F old = F::load(p.impulse[0]), old1 = F::load(p.impulse[1]), old2 = F::load(p.impulse[2]);
        const F mass = F::load(p.normal_mass), asked = normal_row(mass, old, dot(v, f.n), terms);
        const F first = F::max(asked, F::all(0));
        const bool bears = F::any(first, old, old1, old2);
        if (!kDriven && !bears) return false;
        const F normal = first - old, c1 = F::load(p.coupling[0]), c2 = F::load(p.coupling[1]);
        F v1 = dot(v, f.t1) + c1 * normal, v2 = dot(v, f.t2) + c2 * normal, friction = f.friction;
        if constexpr (kDriven) {
            v1 = v1 - F::load(drive->speed[0]);
            v2 = v2 - F::load(drive->speed[1]);
            friction = friction_now(p, *drive, first, pushes, v1, v2, std::is_same_v<Terms, PointTerms>);
            if (!bears) return false;
        }
        F q1 = old1, q2 = old2;
        circle(q1, q2, v1, v2, p.friction_mass, p.isotropic_mass, friction * first);
        q1.store(p.impulse[1]);
        q2.store(p.impulse[2]);
        const F d1 = q1 - old1, d2 = q2 - old2, next = after_friction(mass, asked, c1 * d1 + c2 * d2, terms);
        keep_normal(p, next);
        const V push = (next - old) * f.n + d1 * f.t1 + d2 * f.t2;
        b.add(push, rb);
        a.subtract(push, ra);
        return true;
    }

    // The coefficient of a point that bears `first` and slips at v. relaxed: also what it does from now on.
    static F friction_now(const LanePoint& p, LaneDrive& drive, const F& first, const F& load, const F& v1, const F& v2,
                          bool relaxed) {
        const F zero = F::all(0), one = F::all(1), iso = F::load(p.isotropic_mass);
        const F kinetic = F::load(drive.friction[0]), sticking = F::load(drive.friction[1]);
        const F e1 = F::load(p.impulse[1]) - iso * v1, e2 = F::load(p.impulse[2]) - iso * v2;
        const F back = zero - (e1 * F::load(drive.way[0]) + e2 * F::load(drive.way[1]));
        const F goes_on = F::if_greater(F::load(drive.slid), zero, F::if_greater(back, zero, zero, one), zero);
        const F friction = F::if_greater(goes_on, zero, kinetic, sticking);
        if (!relaxed) return friction;
        const F most = first * friction, slip = F::sqrt(v1 * v1 + v2 * v2), least = F::all(1e-30f);
        const F creep = F::if_greater(goes_on, zero, zero, F::all(kSlips) * (sticking - kinetic) * load);
        const F ratio = F::max(slip, least) / F::max(kinetic * first, least);
        const F compliance = F::if_greater(F::all(1e30f), ratio, ratio, F::all(1e30f));
        const F slides = F::if_greater(iso * slip, creep, compliance, zero);
        const F fresh = F::if_greater(zero, F::load(drive.slid), one, zero);
        F::if_greater(e1 * e1 + e2 * e2, most * most, F::if_greater(fresh, zero, zero, slides), zero)
            .store(drive.slides);
        return friction;
    }

    // Of the points of a group.
    static LaneDrive* drive_of(const LaneView& contacts, const LaneGroup& g, uint32_t point) {
        return g.first_drive == kNoLanes ? nullptr : contacts.drive + g.first_drive + point;
    }

    // The frame of rows, in which tangent 2 counts less where friction has a direction.
    static Frame frame_of_rows(const LaneView& contacts, const LaneGroup& g) {
        Frame f(g);
        f.t2 = F::load(contacts.drive[g.first_drive].part) * f.t2;
        return f;
    }

    // What points did in the last substep decides what they do in this one.
    [[gnu::noinline]] static void begin_friction(LaneView contacts, const LaneGroup& g) {
        for (uint32_t k = 0; k < g.points; ++k) {
            LaneDrive& drive = *drive_of(contacts, g, k);
            F::load(drive.slides).store(drive.slid);
            for (int t = 0; t < 2; ++t) F::load(g.point[k].impulse[1 + t]).store(drive.way[t]);
        }
    }

    [[gnu::noinline]] static void rolling_rows(LaneView contacts, const LaneGroup& g, const Frame& f, Side& a,
                                               Side& b) {
        LaneRolling& r = contacts.rolling[g.rolling];
        F load = F::all(0);
        for (uint32_t k = 0; k < g.points; ++k) load = load + F::load(g.point[k].impulse[0]);
        const F old0 = F::load(r.impulse[0]), most = F::load(r.arm[0]) * load;
        const F step = F::load(r.spin_mass) * dot(b.spin() - a.spin(), f.n);
        const F least = F::all(0) - most, q0 = F::max(least, F::all(0) - F::max(least, step - old0));  // both ways
        q0.store(r.impulse[0]);
        const V spin = (q0 - old0) * f.n;
        b.add_spin(spin);
        a.subtract_spin(spin);
        const V slip = b.spin() - a.spin();
        const F old1 = F::load(r.impulse[1]), old2 = F::load(r.impulse[2]);
        F q1 = old1, q2 = old2;
        circle(q1, q2, dot(slip, f.t1), dot(slip, f.t2), r.roll_mass, r.isotropic_mass, F::load(r.arm[1]) * load);
        q1.store(r.impulse[1]);
        q2.store(r.impulse[2]);
        const V roll = (q1 - old1) * f.t1 + (q2 - old2) * f.t2;
        b.add_spin(roll);
        a.subtract_spin(roll);
    }

    // k about the normal, the 2x2 block about the tangents and its larger eigenvalue; where nothing turns, no mass.
    template <class Put>
    [[gnu::noinline]] static void prepare_rolling(LaneRolling& r, const Frame& f, const Side& a, const Side& b,
                                                  const Put& put) {
        const F zero = F::all(0), one = F::all(1), half = F::all(0.5f), tiny = F::all(1e-30f);
        const V w0 = a.turn(f.n) + b.turn(f.n), w1 = a.turn(f.t1) + b.turn(f.t1), w2 = a.turn(f.t2) + b.turn(f.t2);
        const F k0 = dot(f.n, w0), k11 = dot(f.t1, w1), k22 = dot(f.t2, w2), k12 = dot(f.t2, w1);
        const F mean = half * (k11 + k22), diff = half * (k11 - k22);
        const F largest = mean + F::sqrt(diff * diff + k12 * k12);
        const F det = k11 * k22 - k12 * k12;
        const F inv_det = F::if_greater(det, tiny, one / F::max(det, tiny), zero);
        F spin = F::if_greater(k0, tiny, one / F::max(k0, tiny), zero);
        F roll[3] = {k22 * inv_det, k11 * inv_det, zero - k12 * inv_det};
        F isotropic = F::if_greater(largest, tiny, one / F::max(largest, tiny), zero);
        if (const F held = F::max(a.held(), b.held()); F::greater(held, zero) != 0) {
            const F least = F::all(kLeastFree) * (a.most_turn() + b.most_turn());
            spin = F::if_greater(held, zero, F::if_greater(k0, least, spin, zero), spin);
            invert_held(held, {k11, k22, k12}, largest, least, roll, isotropic);
        }
        put(spin, r.spin_mass);
        for (int i = 0; i < 3; ++i) put(roll[i], r.roll_mass[i]);
        put(isotropic, r.isotropic_mass);
    }

    [[gnu::noinline]] static void warm_start_rolling(const LaneRolling& r, const Frame& f, Side& a, Side& b) {
        const V spin = F::load(r.impulse[0]) * f.n + F::load(r.impulse[1]) * f.t1 + F::load(r.impulse[2]) * f.t2;
        b.add_spin(spin);
        a.subtract_spin(spin);
    }

    // Of a group that comes soon, of the same colour as the one at hand: no other thread works on its nodes.
    static void prefetch(LaneView contacts, uint32_t i, uint32_t end, const SweepNode* nodes,
                         const SweepShift* shifts = nullptr) {
        if (contacts.movers == 0 || i >= end) return;
        Side::prefetch(contacts.group[i].a, nodes, shifts, contacts.movers);
        Side::prefetch(contacts.group[i].b, nodes, shifts, contacts.movers);
    }

    // What is told of unit tangents for a row of the second that counts `part` times.
    [[gnu::noinline]] static void scale_rows(const F& part, const F& used, const F& k11, const F& k22, const F& k12,
                                             F (&tangents)[3], F& isotropic, F& c2) {
        const F half = F::all(0.5f), one = F::all(1), tiny = F::all(1e-30f), zero = F::all(0), squared = part * part;
        const F mean = half * (k11 + squared * k22), diff = half * (k11 - squared * k22), across = part * k12;
        const F largest = mean + F::sqrt(diff * diff + across * across);
        const F scaled = F::if_greater(isotropic, zero, used / F::max(largest, tiny), zero);  // locks may leave none
        isotropic = F::if_greater(one, part, scaled, isotropic);
        tangents[1] = tangents[1] / squared;
        tangents[2] = tangents[2] / part;
        c2 = part * c2;
    }

    // k_n = n^T (J W J^T) n, the tangential 2x2 block and its larger eigenvalue. put(value, array) writes a value of
    // all lanes, before(point, new mass) comes ahead of a point's. What was hit already keeps the approach speed that
    // it had.
    template <class Before, class Put>
    [[gnu::always_inline]] static void prepare_group(LaneView contacts, const LaneGroup& g, const SweepNode* nodes,
                                                     const Before& before, const Put& put) {
        const F half = F::all(0.5f), zero = F::all(0), one = F::all(1), tiny = F::all(1e-30f);
        const Frame f(g);
        Side a, b;
        a.gather(g.a, nodes);
        b.gather(g.b, nodes);
        const F inv_mass = a.inv_mass + b.inv_mass, stiffness = F::load(g.stiffness);
        const F held = F::max(a.held(), b.held()), least = F::all(kLeastFree) * inv_mass;
        const bool any_held = F::greater(held, zero) != 0;
        const auto linear = [&](const V& p, const V& q) { return a.moved(p, q) + b.moved(p, q); };
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = g.point[k];
            const V ra = load(p.ra), rb = load(p.rb);
            const V an = cross(ra, f.n), bn = cross(rb, f.n), a1 = cross(ra, f.t1), b1 = cross(rb, f.t1);
            const V a2 = cross(ra, f.t2), b2 = cross(rb, f.t2), wa1 = a.turn(a1), wb1 = b.turn(b1);
            const V wan = a.turn(an), wbn = b.turn(bn);
            const F used = F::if_greater(F::load(p.normal_mass), zero, one, zero);  // 1 in a filled place
            F kn = inv_mass + dot(an, wan) + dot(bn, wbn);
            F k11 = inv_mass + dot(a1, wa1) + dot(b1, wb1);
            F k22 = inv_mass + dot(a2, a.turn(a2)) + dot(b2, b.turn(b2));
            F k12 = dot(a2, wa1) + dot(b2, wb1);
            F c1 = dot(a1, wan) + dot(b1, wbn), c2 = dot(a2, wan) + dot(b2, wbn);
            if (any_held) {
                const auto choose = [&](F& of, const F& other) { of = F::if_greater(held, zero, other, of); };
                choose(kn, linear(f.n, f.n) + dot(an, wan) + dot(bn, wbn));
                choose(k11, linear(f.t1, f.t1) + dot(a1, wa1) + dot(b1, wb1));
                choose(k22, linear(f.t2, f.t2) + dot(a2, a.turn(a2)) + dot(b2, b.turn(b2)));
                choose(k12, k12 + linear(f.t1, f.t2));
                choose(c1, c1 + linear(f.t1, f.n));
                choose(c2, c2 + linear(f.t2, f.n));
            }
            const F mean = half * (k11 + k22), diff = half * (k11 - k22);
            const F largest = mean + F::sqrt(diff * diff + k12 * k12);
            const F det = k11 * k22 - k12 * k12, inv_det = used / F::max(det, tiny);
            F mass = stiffness * used / F::max(kn, tiny), isotropic = used / F::max(largest, tiny);
            F tangents[3] = {k22 * inv_det, k11 * inv_det, zero - k12 * inv_det};
            if (any_held) {
                mass = F::if_greater(held, zero, F::if_greater(kn, least, mass, zero), mass);
                invert_held(used * held, {k11, k22, k12}, largest, least, tangents, isotropic);
            }
            if (g.first_drive != kNoLanes)
                scale_rows(F::load(contacts.drive[g.first_drive].part), used, k11, k22, k12, tangents, isotropic, c2);
            const F approach = dot(b.at(rb) - a.at(ra), f.n);
            before(p, mass);
            put(mass, p.normal_mass);
            for (int i = 0; i < 3; ++i) put(tangents[i], p.friction_mass[i]);
            put(isotropic, p.isotropic_mass);
            put(c1, p.coupling[0]);
            put(c2, p.coupling[1]);
            put(F::if_greater(F::load(p.peak), zero, F::load(p.approach), approach), p.approach);
        }
        if (g.rolling != kNoLanes) prepare_rolling(contacts.rolling[g.rolling], f, a, b, put);
    }

    static void prepare(LaneView contacts, uint32_t begin, uint32_t end, const SweepNode* nodes) {
        for (uint32_t i = begin; i < end; ++i)
            prepare_group(
                contacts, contacts.group[i], nodes, [](LanePoint&, const F&) {},
                [](const F& value, float* to) { value.store(to); });
    }

    // An impulse that fitted the levers and masses of the last substep throws a thin body about where these have
    // changed: beyond this share of the mass along the normal it is not carried on (measured: of thin spinning
    // cylinders that hit a wall at 100 m/s one in four gained energy, up to 6 times).
    static constexpr float kOtherMass = 0.2f;

    // How the axes of one side turn with its bodies, and with them where circles reach furthest along the outward
    // normal; gain: how much further a circle of radius 1 reaches. See state/levers.h.
    struct AxleTurn {
        V axis, across;
        F gain;

        AxleTurn(const LaneRolling& axles, int side, const V& outward, const ShiftLanes& at) {
            const V old_axis = ContactSweep::load(axles.axis[side]),
                    old_across = ContactSweep::load(axles.across[side]);
            axis = old_axis + at.turning(old_axis);
            const V beside = outward - dot(axis, outward) * axis;
            const F least = F::all(0.05f), sine = F::sqrt(dot(beside, beside));
            across = (F::all(1) / F::max(sine, least)) * beside;
            gain = dot(across - old_across, outward);
        }
    };

    static void choose(const F& chosen, const V& value, float (&to)[3][kLanes]) {
        const F zero = F::all(0);
        F::if_greater(chosen, zero, value.x, F::load(to[0])).store(to[0]);
        F::if_greater(chosen, zero, value.y, F::load(to[1])).store(to[1]);
        F::if_greater(chosen, zero, value.z, F::load(to[2])).store(to[2]);
    }

    // Cores of one side's levers turn with its bodies. before(k), after(k): the skin of a point.
    template <class Before, class After>
    static void turn_points(const LaneGroup& g, int side, const V& outward, const F& turned, const ShiftLanes& at,
                            const Before& before, const After& after) {
        const F zero = F::all(0);
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = g.point[k];
            float(&lever)[3][kLanes] = side == 0 ? p.ra : p.rb;
            const V core = load(lever) - before(k), change = at.turning(core);
            choose(turned, core + change + after(k), lever);
            const F gain = dot(outward, change) + dot(outward, after(k) - before(k));
            (F::load(p.gap0) - F::if_greater(turned, zero, gain, zero)).store(p.gap0);
        }
    }
    static void turn_side(LaneView contacts, const LaneGroup& g, int side, const V& outward, const F& turned,
                          const ShiftLanes& at) {
        const V ball = F::load(g.round[side]) * outward;
        const auto same = [&](uint32_t) { return ball; };
        if (!g.has_axes) return turn_points(g, side, outward, turned, at, same, same);
        LaneRolling& axles = contacts.rolling[g.rolling];
        const AxleTurn now(axles, side, outward, at);
        const V was = load(axles.across[side]);
        turn_points(
            g, side, outward, turned, at, [&](uint32_t k) { return ball + F::load(axles.rim[k][side]) * was; },
            [&](uint32_t k) { return ball + F::load(axles.rim[k][side]) * now.across; });
        choose(turned, now.axis, axles.axis[side]);
        choose(turned, now.across, axles.across[side]);
    }

    static void turn(LaneView contacts, uint32_t group, const LaneTurns& turns, const SweepShift* shifts,
                     const SweepNode* nodes) {
        const LaneGroup& g = contacts.group[group];
        const V n = load(g.normal);
        turn_side(contacts, g, 1, F::all(-1) * n, F::load(turns.turned[1]), ShiftLanes(g.b, shifts));
        turn_side(contacts, g, 0, n, F::load(turns.turned[0]), ShiftLanes(g.a, shifts));
        const F zero = F::all(0), part = F::all(kOtherMass);
        const F chosen = F::max(F::load(turns.turned[0]), F::load(turns.turned[1]));
        const auto put = [&](const F& value, float* to) { F::if_greater(chosen, zero, value, F::load(to)).store(to); };
        const auto drop_impulse = [&](LanePoint& p, const F& mass) {
            const F was = F::load(p.normal_mass), change = F::max(mass - was, was - mass);
            for (float(&impulse)[kLanes] : p.impulse) {
                const F kept = F::load(impulse);
                put(F::if_greater(change, part * was, zero, kept), impulse);
            }
        };
        prepare_group(contacts, contacts.group[group], nodes, drop_impulse, put);
    }

    // Whether a lane has an impulse.
    static bool bears(const LaneGroup& g) {
        bool any = g.rolling != kNoLanes;
        for (uint32_t k = 0; k < g.points && !any; ++k) {
            const LanePoint& p = g.point[k];
            any = F::any(F::load(p.impulse[0]), F::load(p.impulse[1]), F::load(p.impulse[2]));
        }
        return any;
    }

    static void warm_start(LaneView contacts, uint32_t begin, uint32_t end, SweepNode* nodes) {
        prefetch(contacts, begin, end, nodes);
        for (uint32_t i = begin; i < end; ++i) {
            prefetch(contacts, i + 1, end, nodes);
            const LaneGroup& g = contacts.group[i];
            if (g.first_drive != kNoLanes) begin_friction(contacts, g);
            if (!bears(g)) continue;
            const Frame f(g);
            const V t2 = g.first_drive == kNoLanes ? f.t2 : frame_of_rows(contacts, g).t2;
            Side a, b;
            a.gather(g.a, nodes);
            b.gather(g.b, nodes);
            for (uint32_t k = 0; k < g.points; ++k) {
                const LanePoint& p = g.point[k];
                const V push = F::load(p.impulse[0]) * f.n + F::load(p.impulse[1]) * f.t1 + F::load(p.impulse[2]) * t2;
                b.add(push, load(p.rb));
                a.subtract(push, load(p.ra));
            }
            if (g.rolling != kNoLanes) warm_start_rolling(contacts.rolling[g.rolling], f, a, b);
            a.scatter(g.a, nodes);
            b.scatter(g.b, nodes);
        }
    }

    // terms(point) -> PointTerms.
    template <class Terms>
    [[gnu::always_inline]] static void sweep_group(LaneView contacts, const LaneGroup& g, SweepNode* nodes,
                                                   Terms&& terms) {
        if (g.first_drive != kNoLanes)
            sweep_driven(contacts, g, nodes, terms);
        else
            sweep_points<false>(contacts, g, Frame(g), nodes, terms);
    }
    template <class Terms>
    [[gnu::noinline]] static void sweep_driven(LaneView contacts, const LaneGroup& g, SweepNode* nodes, Terms& terms) {
        sweep_points<true>(contacts, g, frame_of_rows(contacts, g), nodes, terms);
    }
    template <bool kDriven, class Terms>
    [[gnu::always_inline]] static void sweep_points(LaneView contacts, const LaneGroup& g, const Frame& f,
                                                    SweepNode* nodes, Terms& terms) {
        Side a, b;
        a.gather(g.a, nodes);
        b.gather(g.b, nodes);
        bool changed = g.rolling != kNoLanes;
        F pushes = F::all(0);
        for (uint32_t k = 0; kDriven && k < g.points; ++k) pushes = pushes + F::load(g.point[k].impulse[0]);
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = g.point[k];
            changed |= point_rows<kDriven>(p, drive_of(contacts, g, k), pushes, f, a, b, terms(p));
        }
        if (!changed) return;
        if (g.rolling != kNoLanes) {
            if constexpr (kDriven)
                rolling_rows(contacts, g, Frame(g), a, b);
            else
                rolling_rows(contacts, g, f, a, b);
        }
        a.scatter(g.a, nodes);
        b.scatter(g.b, nodes);
    }

    // Gaps of a group's points at the start of the substep.
    static void measure_gaps(LaneView contacts, const LaneGroup& g, const Frame& f, const SweepShift* shifts) {
        if (g.has_axes) return measure_round_gaps(contacts.rolling[g.rolling], g, f, shifts);
        const ShiftLanes at_a(g.a, shifts), at_b(g.b, shifts);
        const V round_a = F::load(g.round[0]) * f.n, round_b = F::load(g.round[1]) * f.n;
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = g.point[k];
            V core_a = load(p.ra), core_b = load(p.rb);
            if (g.is_round) core_a = core_a - round_a, core_b = core_b + round_b;
            (F::load(p.gap0) + dot(at_b.motion(core_b) - at_a.motion(core_a), f.n)).store(p.gap);
        }
    }
    // The same with circles about axes.
    [[gnu::noinline]] static void measure_round_gaps(const LaneRolling& axles, const LaneGroup& g, const Frame& f,
                                                     const SweepShift* shifts) {
        const ShiftLanes at_a(g.a, shifts), at_b(g.b, shifts);
        const V back = F::all(-1) * f.n, round_a = F::load(g.round[0]) * f.n, round_b = F::load(g.round[1]) * back;
        const AxleTurn axle_a(axles, 0, f.n, at_a), axle_b(axles, 1, back, at_b);
        const V across_a = load(axles.across[0]), across_b = load(axles.across[1]);
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = g.point[k];
            const F rim_a = F::load(axles.rim[k][0]), rim_b = F::load(axles.rim[k][1]);
            const V core_a = load(p.ra) - round_a - rim_a * across_a, core_b = load(p.rb) - round_b - rim_b * across_b;
            const F cores = dot(at_b.motion(core_b) - at_a.motion(core_a), f.n);
            (F::load(p.gap0) + cores - rim_a * axle_a.gain - rim_b * axle_b.gain).store(p.gap);
        }
    }

    // Open: reach the surface within the substep, no sooner; overlapping: soft push. What hits is stopped at once: a
    // soft row leaves it impulse_scale of its speed, and a bullet as much of its way through the wall.
    static void sweep_biased(LaneView contacts, uint32_t begin, uint32_t end, SweepNode* nodes,
                             const SweepShift* shifts, const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h), rate = F::all(terms.bias_rate);
        const F least = F::all(-terms.push), slow = F::all(-terms.hit);
        const F soft_mass = F::all(terms.mass_scale), soft_impulse = F::all(terms.impulse_scale);
        prefetch(contacts, begin, end, nodes, shifts);
        for (uint32_t i = begin; i < end; ++i) {
            prefetch(contacts, i + 1, end, nodes, shifts);
            const LaneGroup& g = contacts.group[i];
            if (shifts) measure_gaps(contacts, g, Frame(g), shifts);
            sweep_group(contacts, g, nodes, [&](const LanePoint& p) {
                const F gap = F::load(p.gap), hit = slow - F::load(p.approach), rigid = F::max(gap, hit);
                const F scale = F::if_greater(rigid, zero, one, soft_mass);
                const F bias = F::if_greater(gap, zero, gap * inv_h, F::max(rate * gap, least));
                return HitTerms{{bias, scale, F::if_greater(rigid, zero, zero, soft_impulse)},
                                F::if_greater(hit, zero, one, zero)};
            });
        }
    }

    static void sweep_relaxed(LaneView contacts, uint32_t begin, uint32_t end, SweepNode* nodes,
                              const SweepTerms& terms) {
        const F zero = F::all(0), one = F::all(1), inv_h = F::all(terms.inv_h);
        prefetch(contacts, begin, end, nodes);
        for (uint32_t i = begin; i < end; ++i) {
            prefetch(contacts, i + 1, end, nodes);
            sweep_group(contacts, contacts.group[i], nodes, [&](const LanePoint& p) {
                const F gap = F::load(p.gap);
                return PointTerms{F::if_greater(gap, zero, gap * inv_h, zero), one, zero};
            });
        }
    }

    struct FlightLanes {
        V gained, moved;
        FlightLanes(const uint32_t node[kLanes], const SweepFlight* flights) {
            const float* row[kLanes];
            F s[8];
            for (int i = 0; i < kLanes; ++i) row[i] = flights[node[i]].gained;
            F::transpose(row, s);
            gained = {s[0], s[1], s[2]};
            moved = {s[4], s[5], s[6]};
        }
    };

    // Along the normal a point flies c + u t + a t^2 / 2 within the substep; u = v - h a / 2 of the velocity v at its
    // end (solvers/restitution.h). It arrives where c + h v < 0, at the speed sqrt(u^2 - 2 a c).
    static void find_impacts(LaneView contacts, uint32_t begin, uint32_t end, const SweepNode* nodes,
                             const SweepShift* shifts, const SweepFlight* flights, const ImpactTerms& terms,
                             uint16_t* found) {
        const F zero = F::all(0), half = F::all(0.5f), inv_h = F::all(terms.inv_h);
        const F slow = F::all(terms.threshold * terms.threshold);
        for (uint32_t i = begin; i < end; ++i) {
            const LaneGroup& g = contacts.group[i];
            uint16_t* const hits = found + 4 * static_cast<size_t>(i);
            for (int k = 0; k < 4; ++k) hits[k] = 0;
            if (!g.bounces) continue;
            const Frame f(g);
            Side a, b;
            a.gather(g.a, nodes);
            b.gather(g.b, nodes);
            measure_gaps(contacts, g, f, shifts);
            const FlightLanes of_a(g.a, flights), of_b(g.b, flights);
            const F gained = dot(of_b.gained - of_a.gained, f.n), moved = dot(of_b.moved - of_a.moved, f.n);
            const F least = F::max(slow, gained * gained);
            for (uint32_t k = 0; k < g.points; ++k) {
                const LanePoint& p = g.point[k];
                const F gap = F::load(p.gap) + moved, vn = dot(b.at(load(p.rb)) - a.at(load(p.ra)), f.n);
                const F u = vn - half * gained, closing = zero - F::if_greater(gap, zero, gap * inv_h + vn, u);
                const F squared = u * u - (gained + gained) * inv_h * F::max(gap, zero);
                const F bounces = F::if_greater(closing, zero, F::load(p.restitution), zero);
                hits[k] = static_cast<uint16_t>(F::greater(F::if_greater(bounces, zero, squared, zero), least));
            }
        }
    }

    static constexpr ContactKernels table(const char* name) {
        return {name, prepare, turn, warm_start, sweep_biased, sweep_relaxed, find_impacts};
    }
};

}  // namespace taut
