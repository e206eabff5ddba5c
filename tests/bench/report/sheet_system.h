// A falling sheet as the linear systems of a step, assembled from element evaluations alone.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <vector>

#include "constraints/element.h"

namespace bench {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

struct SheetPlan {
    bool links = true;                // along warp and weft; else St-Venant-Kirchhoff triangles
    int side = 10;                    // vertices; two opposite corners are fixed, between which no row is straight
    double mass = 0.1, h = 0.01;      // of a vertex [kg], of a step [s]
    double compliance = 0;            // of a link [m/N]
    double young = 1e9, nu = 0.49;    // of triangles [Pa]
    double thickness = 1e-3;          // [m]
    double size = 1, gravity = 9.81;  // [m], [m/s^2]
};

// Both are of velocities, as in Tournier et al. 2015, with K = -dJ^T/dx lambda of the last step's lambda:
//   compliance (eq. 21)   [M + h^2 K, -J^T; -J, -C/h^2] (v, mu) = (p + h f, phi/h)
//   stiffness (eq. 19)    (M + h^2 (J^T C^-1 J + K)) v = p + h f - h J^T C^-1 phi
class SheetSystem {
public:
    explicit SheetSystem(const SheetPlan& plan);

    // J, K, C and phi where the sheet is.
    void assemble();
    Sparse compliance_form() const;
    // Of links with that stiffness in the place of their own [N/m]; 0: their own.
    Sparse stiffness_form(double link_stiffness = 0) const;
    Vector compliance_side() const;
    Vector stiffness_side() const;
    long freedoms() const { return freedoms_; }
    // By a direct solve of the compliance form.
    void step();

private:
    void add_links();
    void add_triangles();
    Vector stacked(const std::vector<double>& of) const { return Vector::Map(of.data(), static_cast<long>(of.size())); }

    SheetPlan plan_;
    const taut::ElementType* type_;
    std::vector<taut::Pose> pose_;
    std::vector<uint32_t> node_;         // [elements][nodes]
    std::vector<double> data_, lambda_;  // [elements][numbers], [elements][rows]
    std::vector<Matrix> compliance_;     // [elements], rows x rows
    std::vector<long> first_;            // freedom of a vertex, -1: fixed
    long freedoms_ = 0;
    Vector velocity_, phi_;
    Sparse jacobian_, curvature_, give_, stiff_;  // give: C, stiff: C^-1 (links: none)
};

// Largest over least absolute eigenvalue of a symmetric matrix; in long double where it is to be trusted beyond 1e14.
double condition(const Sparse& a, bool precise);
// A diagonal by which a matrix is scaled from both sides so that the largest entry of each row is 1.
Vector equilibration(const Sparse& a);
Sparse equilibrated(const Sparse& a);

// After each iteration of the method of minimum residuals (Paige and Saunders 1975), from zero: act(count, |b - A x| /
// |b|, x); false ends it.
template <class Act>
void minimum_residuals(const Sparse& a, const Vector& b, uint32_t most, Act&& act) {
    const double size = b.norm();
    Vector x = Vector::Zero(b.size()), v_before = x, v = b / size, w_before = x, w = x;
    double beta = 0, eta = size, c_before = 1, c = 1, s_before = 0, s = 0, residual = 1;
    for (uint32_t k = 1; k <= most; ++k) {
        // Lanczos: a three-term basis in which A is tridiagonal.
        Vector next = a * v - beta * v_before;
        const double alpha = v.dot(next);
        next -= alpha * v;
        const double beta_next = next.norm();
        // Givens rotations make that triangular.
        const double delta = c * alpha - c_before * s * beta, above = s * alpha + c_before * c * beta,
                     far = s_before * beta, rho = std::hypot(delta, beta_next);
        c_before = c, s_before = s;
        c = delta / rho, s = beta_next / rho;
        const Vector direction = (v - far * w_before - above * w) / rho;
        w_before = w, w = direction;
        x += c * eta * w;
        residual *= std::abs(s);
        eta *= -s;
        if (!act(k, residual, x) || beta_next == 0) return;
        v_before = v, v = next / beta_next, beta = beta_next;
    }
}

}  // namespace bench
