// The fused sweep of elements, a template over the lanes (simd/lanes.h) and the element. Included by one file for each
// build. An element says, of the spans d_n from node 0 to node n > 0, what C and J_n are; J_0 is less their sum; and
// what makes a strain of C.
#pragma once

#include "constraints/element_lanes.h"
#include "constraints/sweep_side.inl"
#include "simd/angle.h"

namespace taut {

// Distance: C = |d| - length.
template <class F>
struct LinkLanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = 2, kRows = 1, kNumbers = 1;

    static void evaluate(const LaneScalar* number, const V (&d)[kNodes - 1], F (&c)[kRows], V (&j)[kNodes - 1][kRows]) {
        const F length = F::sqrt(dot(d[0], d[0]));
        c[0] = length - F::load(number[0].value);
        j[0][0] = (F::all(1) / F::max(length, F::all(1e-12f))) * d[0];
    }
    static F strain(const LaneScalar* number) { return F::all(1) / F::max(F::load(number[0].value), F::all(1e-12f)); }
};

// F = sum d_n g_n^T by columns, of gradients that lie node by node.
template <class F, uint32_t Nodes, uint32_t Dim>
struct GradientLanes {
    Vec3Lanes<F> f[Dim];
    F g[Nodes - 1][Dim];

    GradientLanes(const LaneScalar* number, const Vec3Lanes<F> (&d)[Nodes - 1]) {
        for (uint32_t n = 0; n < Nodes - 1; ++n)
            for (uint32_t k = 0; k < Dim; ++k) {
                g[n][k] = F::load(number[(n + 1) * Dim + k].value);
                f[k] = n == 0 ? g[n][k] * d[n] : f[k] + g[n][k] * d[n];
            }
    }
};

// Green strain of a triangle: C = ((|f_1|^2 - 1)/2, (|f_2|^2 - 1)/2, f_1.f_2); see green.cpp.
template <class F>
struct GreenTri3Lanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = 3, kRows = 3, kNumbers = 6;

    static void evaluate(const LaneScalar* number, const V (&d)[kNodes - 1], F (&c)[kRows], V (&j)[kNodes - 1][kRows]) {
        const GradientLanes<F, kNodes, 2> at(number, d);
        const F half = F::all(0.5f);
        c[0] = half * dot(at.f[0], at.f[0]) - half;
        c[1] = half * dot(at.f[1], at.f[1]) - half;
        c[2] = dot(at.f[0], at.f[1]);
        for (uint32_t n = 0; n < kNodes - 1; ++n) {
            j[n][0] = at.g[n][0] * at.f[0];
            j[n][1] = at.g[n][1] * at.f[1];
            j[n][2] = at.g[n][0] * at.f[1] + at.g[n][1] * at.f[0];
        }
    }
    static F strain(const LaneScalar*) { return F::all(1); }
};

// Neo-Hookean rows of a tetrahedron: C = (|F|, det F - alpha); see neo_hookean.cpp.
template <class F>
struct NeoHookeanTet4Lanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = 4, kRows = 2, kNumbers = 13;

    static void evaluate(const LaneScalar* number, const V (&d)[kNodes - 1], F (&c)[kRows], V (&j)[kNodes - 1][kRows]) {
        const GradientLanes<F, kNodes, 3> at(number, d);
        const V* f = at.f;
        const V cofactor[3] = {cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])};
        c[0] = F::sqrt(dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]));
        c[1] = dot(f[0], cofactor[0]) - F::load(number[kNumbers - 1].value);
        const F over = F::all(1) / F::max(c[0], F::all(1e-9f));
        for (uint32_t n = 0; n < kNodes - 1; ++n) {
            const F* g = at.g[n];
            j[n][0] = over * (g[0] * f[0] + g[1] * f[1] + g[2] * f[2]);
            j[n][1] = g[0] * cofactor[0] + g[1] * cofactor[1] + g[2] * cofactor[2];
        }
    }
    static F strain(const LaneScalar*) { return F::all(1); }
};

// Bend over a common edge whose rest is flat: C = sum_n k_n d_n; see quadratic_bend.cpp. How soft its sweeps leave it
// is no strain that substeps are taken for, and neither is that of the fold below.
template <class F>
struct QuadraticBendLanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = 4, kRows = 3, kNumbers = 4;

    static void evaluate(const LaneScalar* number, const V (&d)[kNodes - 1], F (&c)[kRows], V (&j)[kNodes - 1][kRows]) {
        const F zero = F::all(0);
        V sum{zero, zero, zero};
        for (uint32_t n = 0; n < kNodes - 1; ++n) {
            const F k = F::load(number[n + 1].value);
            sum = sum + k * d[n];
            j[n][0] = {k, zero, zero};
            j[n][1] = {zero, k, zero};
            j[n][2] = {zero, zero, k};
        }
        c[0] = sum.x, c[1] = sum.y, c[2] = sum.z;
    }
    static F strain(const LaneScalar*) { return F::all(0); }
};

// Angle between two triangles over their common edge: C = theta - rest; see dihedral.cpp.
template <class F>
struct DihedralLanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = 4, kRows = 1, kNumbers = 1;

    static void evaluate(const LaneScalar* number, const V (&d)[kNodes - 1], F (&c)[kRows], V (&j)[kNodes - 1][kRows]) {
        constexpr float kPi = 3.14159265f;
        const F pi = F::all(kPi), whole = F::all(2 * kPi), tiny = F::all(1e-24f);
        const V& e = d[0];
        const F square = F::max(dot(e, e), tiny), length = F::sqrt(square), least = F::all(1e-12f) * square * square;
        const V normal[2] = {cross(e, d[1]), cross(d[2], e)};
        const F bend = angle_of(dot(e, cross(normal[1], normal[0])), length * dot(normal[0], normal[1])) -
                       F::load(number[0].value);
        c[0] = F::if_greater(bend, pi, bend - whole, F::if_greater(F::all(-kPi), bend, bend + whole, bend));
        const V none = {F::all(0), F::all(0), F::all(0)};
        j[0][0] = none;
        for (uint32_t side = 0; side < 2; ++side) {
            const V& m = normal[side];
            const V h = (length / F::max(F::max(dot(m, m), least), F::all(1e-37f))) * m;
            j[side + 1][0] = h;
            j[0][0] = j[0][0] - (dot(d[side + 1], e) / square) * h;
        }
    }
    static F strain(const LaneScalar*) { return F::all(0); }
};

template <class F, class Element>
struct ElementSweepLanes {
    using V = Vec3Lanes<F>;
    static constexpr uint32_t kNodes = Element::kNodes, kRows = Element::kRows, kSpans = kNodes - 1;
    static constexpr uint32_t kSoftness = 3 * kSpans + Element::kNumbers, kImpulse = kSoftness + 1,
                              kYield = kImpulse + kRows;

    // Velocities, inverse masses and translations since the frame began of kLanes particles.
    struct Point {
        F velocity[4], pose[4];  // v, pad; dx, inverse mass

        void gather(const uint32_t node[kLanes], const SweepNode* nodes, const SweepPose* poses) {
            const float* row[kLanes];
            for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
            F::transpose(row, velocity);
            for (int i = 0; i < kLanes; ++i) row[i] = poses[node[i]].dx;
            F::transpose(row, pose);
        }
        // What no impulse moves is not written: groups on other threads read it.
        void scatter(const uint32_t node[kLanes], SweepNode* nodes) const {
            alignas(32) float nowhere[4];
            float* row[kLanes];
            for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
            const unsigned still = ~F::greater(inv_mass(), F::all(0)) & kAllLanes;
            for (unsigned left = still; left != 0; left &= left - 1) row[__builtin_ctz(left)] = nowhere;
            F::transpose_back(velocity, row);
        }
        const F& inv_mass() const { return pose[3]; }
        V move() const { return {velocity[0], velocity[1], velocity[2]}; }
        V after(const F& h) const { return V{pose[0], pose[1], pose[2]} + h * move(); }
        void add(const V& impulse) {
            velocity[0] = velocity[0] + inv_mass() * impulse.x;
            velocity[1] = velocity[1] + inv_mass() * impulse.y;
            velocity[2] = velocity[2] + inv_mass() * impulse.z;
        }
    };

    // x <- -A^-1 x of a symmetric A, row by row its lower triangle; a row that nothing moves stays at 0.
    static void solve(F (&a)[triangle(kRows, 0)], F (&x)[kRows]) {
        const F zero = F::all(0), one = F::all(1);
        F pivot[kRows];
        for (uint32_t r = 0; r < kRows; ++r) {
            for (uint32_t c = 0; c < r; ++c) {
                F sum = a[triangle(r, c)];
                for (uint32_t k = 0; k < c; ++k) sum = sum - a[triangle(r, k)] * a[triangle(c, k)] * pivot[k];
                a[triangle(r, c)] = sum;
            }
            F d = a[triangle(r, r)];
            for (uint32_t c = 0; c < r; ++c) d = d - a[triangle(r, c)] * a[triangle(r, c)] * pivot[c];
            pivot[r] = F::if_greater(d, zero, one / F::if_greater(d, zero, d, one), zero);
        }
        for (uint32_t r = 1; r < kRows; ++r)
            for (uint32_t c = 0; c < r; ++c) x[r] = x[r] - a[triangle(r, c)] * pivot[c] * x[c];
        for (uint32_t r = kRows; r-- > 0;) {
            x[r] = zero - pivot[r] * x[r];
            for (uint32_t c = r + 1; c < kRows; ++c) x[r] = x[r] - pivot[r] * a[triangle(c, r)] * x[c];
        }
    }

    static void sweep(const ElementView& view, uint32_t begin, uint32_t end, SweepNode* nodes, const SweepPose* poses,
                      const ElementTerms& terms) {
        const F h = F::all(terms.h), zero = F::all(0);
        for (uint32_t i = begin; i < end; ++i) {
            const ElementGroup& g = view.group[i];
            const LaneMaterial& material = view.material[g.set];
            LaneScalar* number = view.number + g.first;
            Point point[kNodes];
            for (uint32_t n = 0; n < kNodes; ++n) point[n].gather(g.node[n], nodes, poses);
            V d[kSpans], j[kSpans][kRows], j0[kRows];
            F c[kRows], mu[kRows];
            const V origin = point[0].after(h);
            for (uint32_t n = 0; n < kSpans; ++n) {
                const V apart = {F::load(number[3 * n].value), F::load(number[3 * n + 1].value),
                                 F::load(number[3 * n + 2].value)};
                d[n] = apart + (point[n + 1].after(h) - origin);
            }
            Element::evaluate(number + 3 * kSpans, d, c, j);
            for (uint32_t r = 0; r < kRows; ++r) {
                V sum = j[0][r];
                for (uint32_t n = 1; n < kSpans; ++n) sum = sum + j[n][r];
                j0[r] = V{zero, zero, zero} - sum;
                mu[r] = terms.first ? zero : F::load(number[kImpulse + r].value);
            }
            const F soft = F::all(terms.inv_act) * F::load(number[kSoftness].value);
            const F time = F::all(terms.h + material.relaxation), damped = F::all(material.relaxation);
            F a[triangle(kRows, 0)], x[kRows];
            for (uint32_t r = 0; r < kRows; ++r) {
                F rate = dot(j0[r], point[0].move());
                for (uint32_t n = 0; n < kSpans; ++n) rate = rate + dot(j[n][r], point[n + 1].move());
                x[r] = c[r] + damped * rate;
                for (uint32_t k = 0; k <= r; ++k) {
                    F s = point[0].inv_mass() * dot(j0[r], j0[k]);
                    for (uint32_t n = 0; n < kSpans; ++n) s = s + point[n + 1].inv_mass() * dot(j[n][r], j[n][k]);
                    a[triangle(r, k)] = time * s;
                }
            }
            F moves[kRows];
            for (uint32_t r = 0; r < kRows; ++r) moves[r] = a[triangle(r, r)];
            for (uint32_t r = 0; r < kRows; ++r)
                for (uint32_t k = 0; k < kRows; ++k) {
                    const uint32_t at = r > k ? triangle(r, k) : triangle(k, r);
                    const F yields = soft * F::all(material.compliance[at]);
                    x[r] = x[r] + yields * mu[k];
                    if (k <= r) a[at] = a[at] + yields;
                }
            solve(a, x);
            if (kRows == 1 && material.pulls > 0) x[0] = zero - F::max(zero - (mu[0] + x[0]), zero) - mu[0];
            F yield = zero;
            for (uint32_t r = 0; r < kRows; ++r) {
                mu[r] = mu[r] + x[r];
                mu[r].store(number[kImpulse + r].value);
                yield = F::max(yield, F::max(mu[r], zero - mu[r]) * moves[r]);
            }
            (yield * Element::strain(number + 3 * kSpans)).store(number[kYield].value);
            V impulse = x[0] * j0[0];
            for (uint32_t r = 1; r < kRows; ++r) impulse = impulse + x[r] * j0[r];
            point[0].add(impulse);
            for (uint32_t n = 0; n < kSpans; ++n) {
                impulse = x[0] * j[n][0];
                for (uint32_t r = 1; r < kRows; ++r) impulse = impulse + x[r] * j[n][r];
                point[n + 1].add(impulse);
            }
            for (uint32_t n = 0; n < kNodes; ++n) point[n].scatter(g.node[n], nodes);
        }
    }
};

template <class F>
constexpr ElementKernels element_sweeps(const char* name) {
    return {name,
            ElementSweepLanes<F, LinkLanes<F>>::sweep,
            ElementSweepLanes<F, GreenTri3Lanes<F>>::sweep,
            ElementSweepLanes<F, NeoHookeanTet4Lanes<F>>::sweep,
            ElementSweepLanes<F, DihedralLanes<F>>::sweep,
            ElementSweepLanes<F, QuadraticBendLanes<F>>::sweep};
}

}  // namespace taut
