// Tests of pairs of triangles, a template over the lanes (simd/lanes.h). Included by one file for each build. Nearest
// points are those of detect/nearest.h.
#pragma once

#include "constraints/sweep_side.inl"
#include "detect/feature_meetings.inl"

namespace taut {

template <class F>
class TrianglePairTest {
public:
    static void test(TrianglePairs& pairs) {
        const TrianglePairTest both(pairs);
        unsigned near[NearFeatures::kTests];
        int at = 0;
        for (int k = 0; k < 3; ++k) near[at++] = both.is_near(both.from_face(both.x_[0][k], 1));
        for (int k = 0; k < 3; ++k) near[at++] = both.is_near(both.from_face(both.x_[1][k], 0));
        for (int k = 0; k < 3; ++k)
            for (int n = 0; n < 3; ++n) near[at++] = both.is_near(both.between_edges(k, n));
        near[at] = both.straddles(0) & both.straddles(1) & both.is_near(F::all(0));
        for (uint32_t lane = 0; lane < kLanes; ++lane) {
            uint32_t bits = 0;
            for (int i = 0; i < NearFeatures::kTests; ++i) bits |= (near[i] >> lane & 1) << i;
            pairs.near[lane] = bits;
        }
    }
    static unsigned meets(const SurfaceBoxLanes& lanes, const SurfaceBoxEnds& box) {
        return are_near(lanes, box, F::all(0));
    }
    static unsigned passes(const SurfaceLeaf& leaf, const PassingTriangle& by, float (&moved)[kLanes]) {
        const unsigned met = meets(leaf.way, by.way);
        if (met == 0) return 0;
        const V apart{F::load(leaf.v[0]) - F::all(by.v[0]), F::load(leaf.v[1]) - F::all(by.v[1]),
                      F::load(leaf.v[2]) - F::all(by.v[2])};
        const F speed = F::sqrt(dot(apart, apart)) + (F::load(leaf.spread) + F::all(by.spread));
        const F way = least(F::all(by.time), F::load(leaf.left)) * speed;
        way.store(moved);
        return met & are_near(leaf.box, by.box, F::all(by.reach) + way);
    }
    static constexpr TrianglePairKernel table(const char* name) {
        return {name, test, meets, passes, FeatureMeetings<F>::of_faces, FeatureMeetings<F>::of_edges};
    }

private:
    using V = Vec3Lanes<F>;

    explicit TrianglePairTest(const TrianglePairs& pairs) {
        const F zero = F::all(0);
        for (int side = 0; side < 2; ++side) {
            for (int k = 0; k < 3; ++k) {
                const auto& x = pairs.corner[side][k];
                x_[side][k] = {F::load(x[0]), F::load(x[1]), F::load(x[2])};
            }
            for (int k = 0; k < 3; ++k) {
                along_[side][k] = x_[side][(k + 1) % 3] - x_[side][k];
                squared_[side][k] = dot(along_[side][k], along_[side][k]);
                per_squared_[side][k] = F::if_greater(squared_[side][k], zero, F::all(1) / squared_[side][k], zero);
            }
        }
        const F reach = F::load(pairs.reach);
        reach_squared_ = F::if_greater(zero, reach, F::all(-1), F::all(kRoom) * reach * reach);
        const F beside = F::all(2) * F::load(pairs.moved);
        beside_squared_ = F::all(kRoom) * beside * beside;
    }

    // By no more than so far apart along each axis.
    static unsigned are_near(const SurfaceBoxLanes& lanes, const SurfaceBoxEnds& box, const F& by) {
        unsigned apart = 0;
        for (int i = 0; i < 3; ++i)
            apart |= F::greater(F::load(lanes.lo[i]), F::all(box.hi[i]) + by) |
                     F::greater(F::all(box.lo[i]), F::load(lanes.hi[i]) + by);
        return ~apart & kAllLanes;
    }

    static F clamped(const F& x) {
        const F zero = F::all(0), one = F::all(1), least = F::max(x, zero);
        return F::if_greater(least, one, one, least);
    }
    static F least(const F& a, const F& b) { return F::if_greater(a, b, b, a); }
    unsigned is_near(const F& squared) const { return ~F::greater(squared, reach_squared_) & kAllLanes; }

    F from_edge(const V& p, int side, int k) const {
        const V from = p - x_[side][k];
        const V apart = from - clamped(dot(from, along_[side][k]) * per_squared_[side][k]) * along_[side][k];
        return dot(apart, apart);
    }
    // Squared distance of a point from a triangle.
    F from_face(const V& p, int side) const {
        const F zero = F::all(0), one = F::all(1);
        const V from = p - x_[side][0], a = along_[side][0], b = x_[side][2] - x_[side][0];
        const F aa = squared_[side][0], bb = squared_[side][2], ab = dot(a, b), pa = dot(from, a), pb = dot(from, b);
        const F area = aa * bb - ab * ab, s = bb * pa - ab * pb, t = aa * pb - ab * pa;
        const F per_area = F::if_greater(area, F::all(kThin) * aa * bb, one / area, zero);
        const V apart = from - (s * per_area) * a - (t * per_area) * b;
        const F rim = least(least(from_edge(p, side, 0), from_edge(p, side, 1)), from_edge(p, side, 2));
        const F above = dot(apart, apart), inside = least(least(s, t), area - s - t);
        return F::if_greater(per_area, zero, F::if_greater(inside, zero, above, unless_beside(rim, above)), rim);
    }
    F between_edges(int k, int n) const {
        const V a = along_[0][k], b = along_[1][n], r = x_[0][k] - x_[1][n];
        const F aa = squared_[0][k], bb = squared_[1][n], ab = dot(a, b), ar = dot(a, r), br = dot(b, r);
        const F area = aa * bb - ab * ab, one = F::all(0) - ar * per_squared_[0][k];
        const F middle = F::all(0.5f) * (clamped(one) + clamped(one + ab * per_squared_[0][k]));
        F s = F::if_greater(area, F::all(kParallel) * aa * bb, clamped((ab * br - bb * ar) / area), middle);
        const F t = clamped((ab * s + br) * per_squared_[1][n]);
        s = clamped((ab * t - ar) * per_squared_[0][k]);
        const V apart = r + s * a - t * b, across = cross(a, b);
        const F squared = dot(apart, apart), height = dot(r, across), sine = dot(across, across);
        const F parallel = F::all(kParallel) * aa * bb;
        return F::if_greater(sine, parallel, unless_beside(squared, height * height / sine), squared);
    }
    // The squared distance of what lies beside the other and of their planes or lines; or that of what is out of reach.
    F unless_beside(const F& squared, const F& above) const {
        const F room = F::all(kRounding) * squared;
        return F::if_greater(squared - above - room, beside_squared_, F::all(kFar), squared);
    }
    // Whether the other triangle has corners on both sides of a plane, or near it.
    unsigned straddles(int side) const {
        const V normal = cross(along_[side][0], x_[side][2] - x_[side][0]);
        const F size = F::sqrt(dot(normal, normal)), zero = F::all(0);
        F high[3];
        F room = zero;
        for (int k = 0; k < 3; ++k) {
            const V from = x_[1 - side][k] - x_[side][0];
            high[k] = dot(normal, from);
            room = F::max(room, dot(from, from));
        }
        room = F::all(kRounding) * size * F::sqrt(room);
        const F most = F::max(F::max(high[0], high[1]), high[2]), less = least(least(high[0], high[1]), high[2]);
        return ~F::greater(zero - room, most) & ~F::greater(less, room) & kAllLanes;
    }

    static constexpr float kRounding = 1e-5f, kRoom = 1 + 1e-4f, kThin = 1e-12f, kParallel = 1e-6f, kFar = 1e30f;

    V x_[2][3], along_[2][3];
    F squared_[2][3], per_squared_[2][3], reach_squared_, beside_squared_;
};

}  // namespace taut
