// Singular values of deformation gradients in lanes: the steps of singular_values.cpp, which tells what they are, with
// choices in place of branches.
#pragma once

#include <limits>

#include "simd/vec3_lanes.h"

namespace taut {

// F = U diag(sigma) V^T, by columns.
template <class F>
struct SingularLanes {
    using V = Vec3Lanes<F>;
    V u[3], v[3];
    F sigma[3];

    static SingularLanes of(const V (&f)[3]) {
        constexpr int kSweeps = 10;
        const F zero = F::all(0), one = F::all(1);
        SingularLanes at;
        at.v[0] = {one, zero, zero}, at.v[1] = {zero, one, zero}, at.v[2] = {zero, zero, one};
        V b[3] = {f[0], f[1], f[2]};
        unsigned turned = 1;
        for (int sweep = 0; turned && sweep < kSweeps; ++sweep) {
            turned = turn(b, at.v, 0, 1);
            turned |= turn(b, at.v, 0, 2);
            turned |= turn(b, at.v, 1, 2);
        }
        for (const int p : {0, 1, 0}) sort(b, at.v, p);
        at.find_directions(b);
        return at;
    }

    void store(double* to) const {
        for (int i = 0; i < 3; ++i, to += 7 * F::kWidth) {
            u[i].store(to);
            v[i].store(to + 3 * F::kWidth);
            sigma[i].store(to + 6 * F::kWidth);
        }
    }
    static SingularLanes load(const double* from) {
        SingularLanes at;
        for (int i = 0; i < 3; ++i, from += 7 * F::kWidth) {
            at.u[i] = V::load(from);
            at.v[i] = V::load(from + 3 * F::kWidth);
            at.sigma[i] = F::load(from + 6 * F::kWidth);
        }
        return at;
    }

private:
    static constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

    // Lanes whose columns p and q were not orthogonal; they are now. The tangent of the turn is the smaller root of
    // t^2 + t (|b_q|^2 - |b_p|^2)/(b_p.b_q) - 1 = 0.
    static unsigned turn(V (&b)[3], V (&v)[3], int p, int q) {
        const F zero = F::all(0), one = F::all(1);
        const F pp = dot(b[p], b[p]), qq = dot(b[q], b[q]), pq = dot(b[p], b[q]);
        const F square = pq * pq, least = F::all(kRounding * kRounding) * pp * qq;
        const unsigned turned = F::greater(square, least);
        if (!turned) return 0;
        const F d = qq - pp, e = pq + pq;
        const F size = F::max(d, zero - d) + F::sqrt(d * d + e * e);
        const F t = F::if_greater(square, least, F::if_greater(zero, d, zero - e, e) / size, zero);
        const F c = one / F::sqrt(one + t * t), s = c * t;
        for (V* const m : {b, v}) {
            const V first = m[p];
            m[p] = c * first - s * m[q];
            m[q] = s * first + c * m[q];
        }
        return turned;
    }

    // By falling length; one of a pair that changes places is turned round, which keeps det V.
    static void sort(V (&b)[3], V (&v)[3], int p) {
        const F here = dot(b[p], b[p]), next = dot(b[p + 1], b[p + 1]), zero = F::all(0);
        for (V* const m : {b, v}) {
            const V first = m[p];
            m[p] = if_greater(next, here, m[p + 1], first);
            m[p + 1] = if_greater(next, here, V{zero, zero, zero} - first, m[p + 1]);
        }
    }

    // The part of a across the unit vector u.
    static V across(const V& unit, const V& a) { return a - dot(unit, a) * unit; }

    // What F leaves open of U is as in V.
    void find_directions(const V (&b)[3]) {
        const F zero = F::all(0), one = F::all(1), rounding = F::all(kRounding);
        const F length = F::sqrt(dot(b[0], b[0])), second = F::sqrt(dot(b[1], b[1]));
        u[0] = if_greater(length, zero, one / length * b[0], v[0]);
        const F thin = rounding * length;
        const V wanted = if_greater(second, thin, b[1], v[1]), other = if_greater(second, thin, v[1], v[2]);
        const V first = across(u[0], wanted), last = across(u[0], other);
        const F left = dot(first, first), least = F::all(1e-16) * dot(wanted, wanted);
        const V chosen = if_greater(left, least, first, last);
        u[1] = one / F::sqrt(dot(chosen, chosen)) * chosen;
        u[2] = cross(u[0], u[1]);
        for (int i = 0; i < 3; ++i) sigma[i] = dot(u[i], b[i]);
    }
};

// (S + |S|)/2 of a symmetric S = U diag(sigma) V^T, with |S| = V diag(|sigma|) V^T.
template <class F>
void positive_part(F (&s)[3][3]) {
    using V = Vec3Lanes<F>;
    const F zero = F::all(0), half = F::all(0.5);
    const V column[3] = {{s[0][0], s[1][0], s[2][0]}, {s[0][1], s[1][1], s[2][1]}, {s[0][2], s[1][2], s[2][2]}};
    const auto at = SingularLanes<F>::of(column);
    for (int j = 0; j < 3; ++j) {
        V sum = column[j];
        for (int k = 0; k < 3; ++k) {
            const F size = F::max(at.sigma[k], zero - at.sigma[k]);
            const F part[3] = {at.v[k].x, at.v[k].y, at.v[k].z};
            sum = sum + (size * part[j]) * at.v[k];
        }
        s[0][j] = half * sum.x, s[1][j] = half * sum.y, s[2][j] = half * sum.z;
    }
}

}  // namespace taut
