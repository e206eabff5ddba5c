// Elements of continua: one at each Gauss point of a shape,  F = sum_n x_n g_n^T [1],  3 x 2 of a surface and 3 x 3 of
// a solid, with g_n = dN_n/dX [1/m] as data, and C = c(F) (Tournier et al. 2015, section 4.2). The g_n sum to zero; a
// node of a shape with fewer has g_n = 0. A struct Strain of one file,
//
//   kRows, kDim;  Data: further numbers of an element
//   Strain(data, F)                 what all of them need of F
//   error(c)                        c(F)
//   jacobian(g, j)                  dc/dF g: [row][3]
//   curvature(s, part)              d2(s . c)/dF2 with s = -lambda, as a form
//   hessian(s, d, part)             the sum of that and dc/dF^T D dc/dF, or a positive bound of it, as a form
//
// where a form gives the block of two nodes,  (block)_ik = sum_jl g_nj d2/dF_ij dF_kl g_ml:
//   Node, node(g)                   what each node is asked for once
//   block(n, m)                     3x3
// Positive in F is positive in the nodes, K = G^T (.) G.
#pragma once

#include "constraints/point_element.h"
#include "constraints/positive_part.h"
#include "constraints/random.h"

namespace taut {

template <int Dim>
using Deformation = Eigen::Matrix<double, 3, Dim>;
template <int Dim>
using Gradient = Eigen::Matrix<double, Dim, 1>;  // of a shape function [1/m]
template <int Rows>
using RowMatrix = Eigen::Matrix<double, Rows, Rows, Eigen::RowMajor>;

template <int Nodes, class Strain>
struct Continuum {
    static constexpr int kRows = Strain::kRows, kPoints = Nodes, kDim = Strain::kDim;
    static constexpr uint8_t kAngular = 0;
    struct Data {
        double g[Nodes][kDim];
        [[no_unique_address]] typename Strain::Data own;
    };
    using G = Gradient<kDim>;

    // From x_0, as the g_n sum to zero: F knows no place.
    static Deformation<kDim> deformation(const Data& data, const Vec3* p) {
        Deformation<kDim> f = (p[1] - p[0]) * G::Map(data.g[1]).transpose();
        for (int n = 2; n < Nodes; ++n) f += (p[n] - p[0]) * G::Map(data.g[n]).transpose();
        return f;
    }
    static void evaluate(const Data& data, const Vec3* p, double* c, double* j) {
        const Strain at(data.own, deformation(data, p));
        at.error(c);
        if (!j) return;
        for (int n = 0; n < Nodes; ++n) at.jacobian(G::Map(data.g[n]), j + n * kRows * 3);
    }
    static void stiffness(const Data& data, const Vec3* p, const double* lambda, Curvature part, double* k) {
        const Strain at(data.own, deformation(data, p));
        write(at.curvature(stress(lambda), part), data, k);
    }
    static void hessian(const Data& data, const Vec3* p, const double* lambda, const double* d, double softness,
                        Curvature part, double* k) {
        const Strain at(data.own, deformation(data, p));
        const RowMatrix<kRows> modulus = RowMatrix<kRows>::Map(d) / softness;
        write(at.hessian(stress(lambda), modulus, part), data, k);
    }

private:
    static Eigen::Matrix<double, kRows, 1> stress(const double* lambda) {
        return -Eigen::Matrix<double, kRows, 1>::Map(lambda);
    }
    template <class Form>
    static void write(const Form& form, const Data& data, double* k) {
        typename Form::Node node[Nodes];
        for (int n = 0; n < Nodes; ++n) node[n] = form.node(G::Map(data.g[n]));
        Eigen::Map<PointStiffness<Continuum>> out(k);
        for (int n = 0; n < Nodes; ++n)
            for (int m = 0; m <= n; ++m) {
                const Mat3 block = form.block(node[n], node[m]);
                out.template block<3, 3>(3 * n, 3 * m) = block;
                if (m < n) out.template block<3, 3>(3 * m, 3 * n) = block.transpose();
            }
    }
};

// A random shape whose points are where they stretch it by half to twice, mirrored at every other seed: away from equal
// stretches, of which the principal ones are no smooth function.
template <int Nodes, class Strain>
void sample_continuum(uint64_t seed, void* data, Pose* x) {
    constexpr int kDim = Strain::kDim;
    using G = Gradient<kDim>;
    Random random(seed);
    auto& numbers = *static_cast<typename Continuum<Nodes, Strain>::Data*>(data);
    if constexpr (requires { Strain::sample(random, numbers.own); }) Strain::sample(random, numbers.own);
    Eigen::Matrix<double, kDim, Nodes> g;
    Eigen::Matrix<double, kDim, kDim> moment;
    do {
        for (double& each : g.reshaped()) each = random.between(-1, 1);
        g.colwise() -= g.rowwise().mean().eval();
        moment = g * g.transpose();
    } while (moment.determinant() < 0.3);
    random.poses(x, Nodes);
    Vec3 stretch(random.between(1.4, 1.8), random.between(0.9, 1.1), random.between(0.5, 0.6));
    if (seed % 2 == 0) stretch[2] = -stretch[2];
    const Mat3 wanted =
        random.rotation().toRotationMatrix() * stretch.asDiagonal() * random.rotation().toRotationMatrix();
    Deformation<kDim> missing = wanted.leftCols<kDim>();
    for (int n = 0; n < Nodes; ++n) missing -= x[n].x * g.col(n).transpose();
    for (int n = 0; n < Nodes; ++n) {
        G::Map(numbers.g[n]) = g.col(n);
        x[n].x += missing * moment.inverse() * g.col(n);
    }
}

template <int Nodes, class Strain>
constexpr ElementType continuum_element(const char* name, ElementSweep ElementKernels::*sweep = nullptr,
                                        EnergyKernel EnergyKernels::*energy = nullptr) {
    ElementType type = point_element<Continuum<Nodes, Strain>>(name, sample_continuum<Nodes, Strain>, sweep);
    type.energy = energy;
    return type;
}

}  // namespace taut
