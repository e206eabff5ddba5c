// Energies of solids by principal stretches, with or without the volume as a row (stretches.cpp), a template over the
// lanes (simd/doubles.h). Included by one file for each build.
#pragma once

#include "constraints/energy_kernels.h"
#include "constraints/singular_lanes.h"
#include "simd/doubles.h"

namespace taut {

template <class F, int Nodes, bool Volume>
struct StretchEnergy {
    using V = Vec3Lanes<F>;
    static constexpr int kRows = Volume ? 4 : 3, kNumbers = 3 * Nodes, kWidth = 3 * Nodes, kLanesOf = F::kWidth;
    static constexpr double kLeastGap = 1e-6;  // as of singular_values.h

    // Lanes beyond the last element repeat it.
    static uint32_t which(const EnergyLanes& of, int lane) {
        const auto i = static_cast<uint32_t>(lane);
        return i < of.count ? i : of.count - 1;
    }

    struct Numbers {
        alignas(64) double g[kNumbers][kLanesOf];
        alignas(64) double softness[kLanesOf];

        explicit Numbers(const EnergyLanes& of) {
            for (int lane = 0; lane < kLanesOf; ++lane) {
                const size_t e = of.element[which(of, lane)];
                for (int k = 0; k < kNumbers; ++k) g[k][lane] = of.data[e * kNumbers + static_cast<size_t>(k)];
                softness[lane] = of.softness[e];
            }
        }
        V gradient(int n) const { return V::load(g[3 * n]); }
    };

    // F = sum_n (x_n - x_0) g_n^T by columns.
    static void deform(const EnergyLanes& of, const Numbers& numbers, V (&f)[3]) {
        alignas(64) double apart[kNumbers][kLanesOf];
        for (int lane = 0; lane < kLanesOf; ++lane) {
            const uint32_t* const node = of.node + which(of, lane) * Nodes;
            const double* const origin = of.place + node[0] * of.stride;
            for (int n = 1; n < Nodes; ++n)
                for (int k = 0; k < 3; ++k) apart[3 * n + k][lane] = of.place[node[n] * of.stride + k] - origin[k];
        }
        for (int n = 1; n < Nodes; ++n) {
            const V d = V::load(apart[3 * n]), g = numbers.gradient(n);
            f[0] = n == 1 ? g.x * d : f[0] + g.x * d;
            f[1] = n == 1 ? g.y * d : f[1] + g.y * d;
            f[2] = n == 1 ? g.z * d : f[2] + g.z * d;
        }
    }

    // The rows C, of the volume also dC/dsigma, and the stress D C.
    struct Rows {
        F c[kRows], stress[kRows], slope[3];

        Rows(const EnergyLanes& of, const Numbers& numbers, const F (&sigma)[3]) {
            const F one = F::all(1), scale = one / F::load(numbers.softness);
            for (int i = 0; i < 3; ++i) {
                c[i] = sigma[i] - one;
                slope[i] = sigma[(i + 1) % 3] * sigma[(i + 2) % 3];
            }
            if constexpr (Volume) c[3] = sigma[0] * slope[0] - one;
            for (int r = 0; r < kRows; ++r) {
                F sum = F::all(of.material[r * kRows]) * c[0];
                for (int k = 1; k < kRows; ++k) sum = sum + F::all(of.material[r * kRows + k]) * c[k];
                stress[r] = scale * sum;
            }
        }
        // dW/dsigma
        F tension(int i) const {
            if constexpr (Volume)
                return stress[i] + stress[3] * slope[i];
            else
                return stress[i];
        }
    };

    static void evaluate(const EnergyLanes& of, double* frame, double* energy, double* force) {
        const Numbers numbers(of);
        V f[3];
        deform(of, numbers, f);
        const auto at = SingularLanes<F>::of(f);
        at.store(frame);
        const Rows rows(of, numbers, at.sigma);
        F sum = rows.stress[0] * rows.c[0];
        for (int r = 1; r < kRows; ++r) sum = sum + rows.stress[r] * rows.c[r];
        alignas(64) double out[kLanesOf];
        (F::all(0.5) * sum).store(out);
        for (uint32_t i = 0; i < of.count; ++i) energy[i] = out[i];
        if (force) find_forces(of, numbers, at, rows, force);
    }
    // dW/dx_n = P g_n with P = U diag(dW/dsigma) V^T.
    static void find_forces(const EnergyLanes& of, const Numbers& numbers, const SingularLanes<F>& at, const Rows& rows,
                            double* force) {
        V drawn[3];
        for (int i = 0; i < 3; ++i) drawn[i] = rows.tension(i) * at.u[i];
        const V p[3] = {at.v[0].x * drawn[0] + at.v[1].x * drawn[1] + at.v[2].x * drawn[2],
                        at.v[0].y * drawn[0] + at.v[1].y * drawn[1] + at.v[2].y * drawn[2],
                        at.v[0].z * drawn[0] + at.v[1].z * drawn[1] + at.v[2].z * drawn[2]};
        alignas(64) double out[kWidth][kLanesOf];
        for (int n = 0; n < Nodes; ++n) {
            const V g = numbers.gradient(n);
            (g.x * p[0] + g.y * p[1] + g.z * p[2]).store(out[3 * n]);
        }
        for (uint32_t i = 0; i < of.count; ++i)
            for (int k = 0; k < kWidth; ++k) force[i * kWidth + static_cast<uint32_t>(k)] = out[k][i];
    }

    // The second derivative of W by a = U^T dF V, as of spectral.h.
    struct Form {
        F scaling[3][3], flip[3], twist[3];

        Form(const EnergyLanes& of, const Numbers& numbers, const SingularLanes<F>& at) {
            const Rows rows(of, numbers, at.sigma);
            const F scale = F::all(1) / F::load(numbers.softness), gap = F::all(kLeastGap), half = F::all(0.5);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    F sum = F::all(of.material[i * kRows + j]);
                    if constexpr (Volume) {
                        const F both = F::all(of.material[3 * kRows + j]) * rows.slope[i] +
                                       F::all(of.material[i * kRows + 3]) * rows.slope[j];
                        sum = sum + both + F::all(of.material[3 * kRows + 3]) * rows.slope[i] * rows.slope[j];
                    }
                    scaling[i][j] = scale * sum;
                    if constexpr (Volume)
                        if (i != j) scaling[i][j] = scaling[i][j] + rows.stress[3] * at.sigma[3 - i - j];
                }
            for (int k = 0; k < 3; ++k) {
                const int i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
                const F apart = at.sigma[i] - at.sigma[j], together = at.sigma[i] + at.sigma[j];
                flip[k] = (rows.stress[i] - rows.stress[j]) / F::max(apart, gap);
                twist[k] = (rows.stress[i] + rows.stress[j]) / F::max(together, gap);
                if constexpr (Volume) {
                    flip[k] = flip[k] - rows.stress[3] * at.sigma[k];
                    twist[k] = twist[k] + rows.stress[3] * at.sigma[k];
                }
                const F equal = half * (scaling[i][i] + scaling[j][j]) - scaling[i][j];
                flip[k] = F::if_greater(gap, apart, equal, flip[k]);
            }
        }
        // Its eigenvalues are those of the scaling, and flips and twists (spectral.h).
        void take_positive() {
            positive_part(scaling);
            for (int k = 0; k < 3; ++k) {
                flip[k] = F::max(flip[k], F::all(0));
                twist[k] = F::max(twist[k], F::all(0));
            }
        }
        // Column j of the block of two nodes, whose gradients are n and m along V.
        void column(int j, const F (&n)[3], const F (&m)[3], F (&out)[3]) const {
            const F half = F::all(0.5);
            for (int i = 0; i < 3; ++i) {
                const int k = 3 - i - j;
                if (i != j) {
                    out[i] = scaling[i][j] * (n[i] * m[j]) + half * (flip[k] - twist[k]) * (n[j] * m[i]);
                    continue;
                }
                const int a = (i + 1) % 3, b = (i + 2) % 3;
                out[i] = scaling[i][i] * (n[i] * m[i]) + half * (twist[b] + flip[b]) * (n[a] * m[a]) +
                         half * (twist[a] + flip[a]) * (n[b] * m[b]);
            }
        }
    };

    // Blocks of two nodes but the first: what this has is less the sum of the others'.
    static void hessian(const EnergyLanes& of, const double* frame, bool positive, double* k) {
        const Numbers numbers(of);
        const auto at = SingularLanes<F>::load(frame);
        Form form(of, numbers, at);
        if (positive) form.take_positive();
        F along[Nodes][3];
        for (int n = 1; n < Nodes; ++n)
            for (int i = 0; i < 3; ++i) along[n][i] = dot(at.v[i], numbers.gradient(n));
        alignas(64) double out[kWidth][kWidth][kLanesOf];
        for (int n = 1; n < Nodes; ++n)
            for (int m = 1; m <= n; ++m) {
                V rows[3];  // of (U b)^T
                for (int j = 0; j < 3; ++j) {
                    F b[3];
                    form.column(j, along[n], along[m], b);
                    rows[j] = b[0] * at.u[0] + b[1] * at.u[1] + b[2] * at.u[2];
                }
                put(3 * n, 3 * m, at.u[0].x * rows[0] + at.u[1].x * rows[1] + at.u[2].x * rows[2], out);
                put(3 * n, 3 * m + 1, at.u[0].y * rows[0] + at.u[1].y * rows[1] + at.u[2].y * rows[2], out);
                put(3 * n, 3 * m + 2, at.u[0].z * rows[0] + at.u[1].z * rows[1] + at.u[2].z * rows[2], out);
            }
        for (int r = 3; r < kWidth; ++r)
            for (int c = 0; c < 3; ++c) put_first(r, c, out);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c <= r; ++c) put_first(r, c, out);
        for (uint32_t i = 0; i < of.count; ++i)
            for (int r = 0; r < kWidth; ++r)
                for (int c = 0; c < kWidth; ++c) *k++ = out[r][c][i];
    }
    // Three rows of a column, and the same above the diagonal.
    static void put(int row, int column, const V& value, double (&out)[kWidth][kWidth][kLanesOf]) {
        const F each[3] = {value.x, value.y, value.z};
        for (int i = 0; i < 3; ++i) {
            each[i].store(out[row + i][column]);
            each[i].store(out[column][row + i]);
        }
    }
    static void put_first(int row, int column, double (&out)[kWidth][kWidth][kLanesOf]) {
        F sum = F::load(out[row][column + 3]);
        for (int c = column + 6; c < kWidth; c += 3) sum = sum + F::load(out[row][c]);
        sum = F::all(0) - sum;
        sum.store(out[row][column]);
        sum.store(out[column][row]);
    }
};

template <class F>
constexpr EnergyKernels energy_kernels_of(const char* name) {
    constexpr auto of = []<class Energy>(Energy) { return EnergyKernel{Energy::evaluate, Energy::hessian}; };
    return {name, of(StretchEnergy<F, 4, false>{}), of(StretchEnergy<F, 8, false>{}), of(StretchEnergy<F, 4, true>{}),
            of(StretchEnergy<F, 8, true>{})};
}

}  // namespace taut
