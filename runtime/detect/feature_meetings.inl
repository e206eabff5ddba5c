// When features on their way first come within a reach, by conservative advancement, a template over the lanes
// (simd/lanes.h): meet() of detect/surface_finder.h. Included by one file for each build.
#pragma once

#include "constraints/sweep_side.inl"
#include "detect/triangle_pairs.h"

namespace taut {

template <class F>
class FeatureMeetings {
public:
    static unsigned of_faces(const FeatureLanes& of) { return FeatureMeetings(of).template meet<VertexFace>(of); }
    static unsigned of_edges(const FeatureLanes& of) { return FeatureMeetings(of).template meet<EdgeEdge>(of); }

private:
    using V = Vec3Lanes<F>;

    struct Near {
        F squared;        // distance [m^2]
        unsigned inside;  // within both features, not at the rim of one
    };

    explicit FeatureMeetings(const FeatureLanes& of) {
        for (int i = 0; i < 4; ++i) {
            x_[i] = {F::load(of.x[i][0]), F::load(of.x[i][1]), F::load(of.x[i][2])};
            v_[i] = {F::load(of.v[i][0]), F::load(of.v[i][1]), F::load(of.v[i][2])};
        }
    }

    static F least(const F& a, const F& b) { return F::if_greater(a, b, b, a); }
    static F clamped(const F& x) {
        const F zero = F::all(0), one = F::all(1), above = F::max(x, zero);
        return F::if_greater(above, one, one, above);
    }
    static F squared(const V& a) { return dot(a, a); }
    static F inverse(const F& x) {
        const F zero = F::all(0);
        return F::if_greater(x, zero, F::all(1) / x, zero);
    }

    struct VertexFace {
        static constexpr int kFirst = 1;
        static F size(const V (&x)[4]) {
            return least(least(squared(x[2] - x[1]), squared(x[3] - x[1])), squared(x[3] - x[2]));
        }
        static F from_edge(const V& p, const V& a, const V& b) {
            const V along = b - a, from = p - a;
            return squared(from - clamped(dot(from, along) * inverse(squared(along))) * along);
        }
        static Near nearest(const V (&x)[4]) {
            const F zero = F::all(0);
            const V p = x[0] - x[1], a = x[2] - x[1], b = x[3] - x[1];
            const F aa = squared(a), ab = dot(a, b), bb = squared(b), pa = dot(p, a), pb = dot(p, b);
            const F area = aa * bb - ab * ab,
                    per_area = F::if_greater(area, F::all(1e-12f) * aa * bb, F::all(1) / area, zero);
            const F s = (bb * pa - ab * pb) * per_area, t = (aa * pb - ab * pa) * per_area, rest = F::all(1) - s - t;
            const F within = least(least(s, t), rest);
            const F rim =
                least(least(from_edge(x[0], x[1], x[2]), from_edge(x[0], x[2], x[3])), from_edge(x[0], x[3], x[1]));
            return {F::if_greater(within, zero, squared(p - s * a - t * b), rim), F::greater(within, zero)};
        }
    };

    struct EdgeEdge {
        static constexpr int kFirst = 2;
        static F size(const V (&x)[4]) { return least(squared(x[1] - x[0]), squared(x[3] - x[2])); }
        static Near nearest(const V (&x)[4]) {
            const V a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
            const F aa = squared(a), bb = squared(b), ab = dot(a, b), ar = dot(a, r), br = dot(b, r);
            const F per_aa = inverse(aa), per_bb = inverse(bb), area = aa * bb - ab * ab, zero = F::all(0);
            const F one = zero - ar * per_aa, middle = F::all(0.5f) * (clamped(one) + clamped(one + ab * per_aa));
            F s = F::if_greater(area, F::all(1e-6f) * aa * bb, clamped((ab * br - bb * ar) / area), middle);
            const F t = clamped((ab * s + br) * per_bb);
            s = clamped((ab * t - ar) * per_aa);
            const F within = least(least(s, F::all(1) - s), least(t, F::all(1) - t));
            return {squared(r + s * a - t * b), F::greater(within, zero)};
        }
    };

    // Of a point of one against one of the other, at most.
    template <class Of>
    F speed() const {
        F most = F::all(0);
        for (int i = 0; i < Of::kFirst; ++i)
            for (int k = Of::kFirst; k < 4; ++k) most = F::max(most, squared(v_[i] - v_[k]));
        return F::sqrt(most);
    }

    template <class Of>
    unsigned meet(const FeatureLanes& of) const {
        const F zero = F::all(0), time = F::load(of.time), both = F::all(of.both), size = F::sqrt(Of::size(x_));
        const F reach = least(both, F::all(of.of_size) * size) + F::all(of.margin), speed = this->speed<Of>();
        F now = zero;
        unsigned on_way = kAllLanes, met = 0;
        for (int step = 0;; ++step) {
            V at[4];
            for (int i = 0; i < 4; ++i) at[i] = x_[i] + now * v_[i];
            const Near near = Of::nearest(at);
            const F beyond = F::sqrt(near.squared) - reach;
            const unsigned there = on_way & ~F::greater(beyond, zero);
            met |= there & near.inside;
            if (step == kMostAdvances) return met | (on_way & F::greater(now, zero) & near.inside);
            on_way &= ~there & F::greater(speed * (time - now), beyond);
            if (on_way == 0) return met;
            now = now + F::if_greater(speed, zero, beyond / speed, zero);
        }
    }

    V x_[4], v_[4];
};

}  // namespace taut
