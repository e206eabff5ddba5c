// Random instances of a constraint type and derivatives by finite differences, for the tests that loop over the list.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <random>
#include <vector>

#include "constraints/constraint.h"

namespace taut::test {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// An instance with poses around it and a force.
struct Instance {
    Instance(const ConstraintType& t, uint64_t seed) : type(t), data(t.data_size), lambda(Vector::Zero(t.rows)) {
        type.sample(seed, data.data(), pose.data());
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> newton(-10, 10);
        for (double& f : lambda) f = newton(engine);
    }

    int coordinates() const { return kDof * type.nodes; }
    Vector error() const {
        Vector c(type.rows);
        type.evaluate(data.data(), pose.data(), c.data(), nullptr);
        return c;
    }
    // rows x (6 nodes)
    Matrix jacobian() const {
        Vector c(type.rows);
        std::vector<double> raw(static_cast<size_t>(type.nodes * type.rows * kDof), 0.0);
        type.evaluate(data.data(), pose.data(), c.data(), raw.data());
        Matrix j(type.rows, coordinates());
        for (int n = 0; n < type.nodes; ++n)
            for (int r = 0; r < type.rows; ++r)
                for (int k = 0; k < kDof; ++k)
                    j(r, n * kDof + k) = raw[static_cast<size_t>((n * type.rows + r) * kDof + k)];
        return j;
    }
    Matrix stiffness(Curvature part) const {
        RowMajor k(coordinates(), coordinates());
        k.setConstant(1e300);  // must be overwritten
        type.stiffness(data.data(), pose.data(), lambda.data(), part, k.data());
        return k;
    }
    // Translation of a node, or a rotation on its left.
    Instance moved(int coordinate, double step) const {
        Instance to = *this;
        Pose& x = to.pose[static_cast<size_t>(coordinate / kDof)];
        const int k = coordinate % kDof;
        if (k < 3)
            x.x[k] += step;
        else
            x.R = Eigen::AngleAxisd(step, Vec3::Unit(k - 3)).toRotationMatrix() * x.R;
        return to;
    }

    const ConstraintType& type;
    std::vector<unsigned char> data;
    std::array<Pose, kMaxNodes> pose;
    Vector lambda;  // [N, N m]
};

// d f / d coordinates by central differences of fourth order: truncation step^4/30 f^(5), rounding 1e-16/step.
inline Matrix derivative(const Instance& at, const std::function<Vector(const Instance&)>& f) {
    constexpr double kStep = 3e-4;
    Matrix d(f(at).size(), at.coordinates());
    for (int k = 0; k < at.coordinates(); ++k)
        d.col(k) = (8 * (f(at.moved(k, kStep)) - f(at.moved(k, -kStep))) -
                    (f(at.moved(k, 2 * kStep)) - f(at.moved(k, -2 * kStep)))) /
                   (12 * kStep);
    return d;
}

inline double largest(const Matrix& m) { return m.cwiseAbs().maxCoeff(); }
inline Matrix symmetric(const Matrix& m) { return 0.5 * (m + m.transpose()); }
inline double least_eigenvalue(const Matrix& m) {
    return Eigen::SelfAdjointEigenSolver<Matrix>(m, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}
// Its eigenvalues clipped at zero.
inline Matrix positive_part(const Matrix& m) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace taut::test
