// Templates over the lanes (simd/lanes.h). Included by one file for each build.
#pragma once

#include "collision/lane_kernels.h"
#include "simd/lanes.h"

namespace taut::collision {

template <class F>
struct LaneBuild {
    static constexpr float kAsked = -1e30f;
    static constexpr uint32_t kMostBlocks = 8;  // of kLanes faces; there are half as many corners

    static unsigned meeting(const BoxLanes& boxes, const float* lo, const float* hi) {
        unsigned apart = 0;
        for (int i = 0; i < 3; ++i) {
            apart |= F::greater(F::load(boxes.lo[i]), F::all(hi[i]));
            apart |= F::greater(F::all(lo[i]), F::load(boxes.hi[i]));
        }
        return ~apart & kAllLanes;
    }

    // In the order in which Eigen adds.
    static float dot(const float* a, const float* b) { return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]); }
    static float at(const Columns& columns, uint32_t row, uint32_t i) {
        return columns.first[row * columns.length + i];
    }
    static F lanes(const Columns& columns, uint32_t row, uint32_t k) {
        return F::load(columns.first + row * columns.length + kLanes * k);
    }
    // x p0 + y p1 + z p2 of kLanes things.
    static F along(const Columns& columns, const float* p, uint32_t k) {
        return lanes(columns, 0, k) * F::all(p[0]) + lanes(columns, 1, k) * F::all(p[1]) +
               lanes(columns, 2, k) * F::all(p[2]);
    }
    static F heights_over(const Columns& planes, const float* p, uint32_t k) {
        return along(planes, p, k) - lanes(planes, 3, k);
    }
    static F least(const F& a, const F& b) { return F::if_greater(a, b, b, a); }
    // A bit for each of kLanes numbers, none of which is above most, that equals it.
    static unsigned equal_bits(const F& numbers, float most) { return ~F::greater(F::all(most), numbers) & kAllLanes; }
    static uint32_t first_of(unsigned bits) { return uint32_t(__builtin_ctz(bits)); }
    // Most of what number(k), kLanes each, tells of columns.
    template <class Number>
    static float most_of(const Columns& columns, Number&& number) {
        F most = number(0);
        for (uint32_t k = 1; k < columns.length / kLanes; ++k) most = F::max(most, number(k));
        return F::largest(most);
    }
    static float highest(const Columns& corners, const float* direction) {
        return most_of(corners, [&](uint32_t k) { return along(corners, direction, k); });
    }
    static float outside(const Columns& planes, const float* point) {
        return most_of(planes, [&](uint32_t k) { return heights_over(planes, point, k); });
    }
    static float way_outside(const Columns& planes, const float* from, const float* to) {
        return most_of(planes,
                       [&](uint32_t k) { return least(heights_over(planes, from, k), heights_over(planes, to, k)); });
    }
    static void extent(const Columns& corners, const float (*rotation)[3], float* least_of, float* most) {
        for (int i = 0; i < 3; ++i) {
            F lo = along(corners, rotation[i], 0), hi = lo;
            for (uint32_t k = 1; k < corners.length / kLanes; ++k) {
                const F reach = along(corners, rotation[i], k);
                lo = least(lo, reach);
                hi = F::max(hi, reach);
            }
            least_of[i] = -F::largest(F::all(0) - lo);
            most[i] = F::largest(hi);
        }
    }
    static float heights(const Columns& corners, const float* direction, float* out) {
        return most_of(corners, [&](uint32_t k) { return put(along(corners, direction, k), out, k); });
    }
    static float heights_over_all(const Columns& planes, const float* point, float* out) {
        return most_of(planes, [&](uint32_t k) { return put(heights_over(planes, point, k), out, k); });
    }
    static F put(const F& numbers, float* out, uint32_t k) {
        numbers.store(out + kLanes * k);
        return numbers;
    }
    static uint32_t support(const Columns& corners, const float* direction) {
        F heights[kMostBlocks / 2];
        const float most = most_of(corners, [&](uint32_t k) { return heights[k] = along(corners, direction, k); });
        const uint32_t blocks = corners.length / kLanes;
        uint32_t k = 0;
        unsigned equal = equal_bits(heights[0], most);
        while (equal == 0 && ++k < blocks) equal = equal_bits(heights[k], most);
        return equal != 0 ? kLanes * k + first_of(equal) : 0;
    }

    // How far every face separates at most, as the other polytope is known so far: no face separates by more than its
    // distance from a point of the other. Those with the largest bounds are asked first.
    template <uint32_t kBlocks>
    struct Bounds {
        const FaceSearch& search;
        F most[kBlocks];
        float largest;

        // The other holds a ball.
        explicit Bounds(const FaceSearch& s) : search(s) {
            most[0] = of_ball(0);
            for (uint32_t k = 1; k < blocks(); ++k) most[k] = of_ball(k);
            find_largest();
        }
        // The face with the largest bound, which is asked no more.
        uint32_t take_largest() {
            uint32_t face = 0;
            for (uint32_t k = blocks(); k-- > 0;) {
                const unsigned equal = equal_bits(most[k], largest);
                face = equal != 0 ? kLanes * k + first_of(equal) : face;
            }
            for (uint32_t k = 0; k < blocks(); ++k) {
                const F number = F::load(kNumbers), i = F::all(float(int(face - kLanes * k)));
                const F up_to = F::if_greater(i, number, most[k], F::all(kAsked));
                most[k] = F::if_greater(number, i, most[k], up_to);
            }
            return face;
        }
        // The other holds a point.
        void lower(const float* point) {
            for (uint32_t k = 0; k < blocks(); ++k) most[k] = least(most[k], heights_over(search.planes, point, k));
            find_largest();
        }

    private:
        uint32_t blocks() const { return kBlocks <= 2 ? kBlocks : search.planes.length / kLanes; }
        // What is beyond the last face is not there.
        F of_ball(uint32_t k) const {
            const F bounds = heights_over(search.planes, search.centre, k) - F::all(search.radius);
            return F::if_greater(F::all(float(int(search.faces - kLanes * k))), F::load(kNumbers), bounds,
                                 F::all(kAsked));
        }
        void find_largest() {
            F all = most[0];
            for (uint32_t k = 1; k < blocks(); ++k) all = F::max(all, most[k]);
            largest = F::largest(all);
        }
    };

    template <uint32_t kBlocks>
    static FaceFound search_faces(const FaceSearch& s) {
        Bounds<kBlocks> bounds(s);
        FaceFound best;
        while (bounds.largest > (best.distance > s.least ? best.distance : s.least)) {
            const uint32_t i = bounds.take_largest();
            const float normal[3] = {at(s.planes, 0, i), at(s.planes, 1, i), at(s.planes, 2, i)};
            float against[3], nearest[3];
            for (int c = 0; c < 3; ++c) {
                const float column[3] = {s.rotation[0][c], s.rotation[1][c], s.rotation[2][c]};
                const float down[3] = {-normal[0], -normal[1], -normal[2]};
                against[c] = dot(column, down);
            }
            const uint32_t corner = support(s.corners, against);
            const float own[3] = {at(s.corners, 0, corner), at(s.corners, 1, corner), at(s.corners, 2, corner)};
            for (int r = 0; r < 3; ++r) nearest[r] = dot(s.rotation[r], own) + s.position[r];
            const float distance = dot(normal, nearest) - at(s.planes, 3, i);
            if (distance > best.distance) best = {i, corner, distance};
            if (distance > s.margin) break;
            bounds.lower(nearest);
        }
        return best;
    }
    static FaceFound best_face(const FaceSearch& s) {
        if (s.planes.length == kLanes) return search_faces<1>(s);
        return s.planes.length == 2 * kLanes ? search_faces<2>(s) : search_faces<kMostBlocks>(s);
    }

    static constexpr LaneKernels table(const char* build) {
        return {build, meeting, highest, support, outside, way_outside, heights, heights_over_all, extent, best_face};
    }

    alignas(64) static constexpr float kNumbers[kLanes] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
};

}  // namespace taut::collision
