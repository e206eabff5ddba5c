// A planar chain of rigid bodies hinged end to end, in angles from straight down, integrated by Runge-Kutta:
//   sum_j A_ij cos(t_i - t_j) t_j'' + sum_j A_ij sin(t_i - t_j) t_j'^2 + g c_i sin t_i = 0
// It has no joint forces, no constraints and no substeps in common with the library.
#pragma once

#include <cmath>
#include <vector>

namespace lab {

struct ChainBody {
    double mass, inertia, reach, length;  // [kg], [kg m^2], hinge to centre and to the next hinge [m]
};

class ReferenceChain {
public:
    ReferenceChain(const std::vector<ChainBody>& bodies, double gravity, double start)
        : n_(bodies.size()), bodies_(bodies), a_(n_ * n_), c_(n_), angle(n_, start), rate(n_, 0.0) {
        std::vector<double> below(n_, 0.0);  // mass beyond the body's far hinge
        for (size_t i = n_ - 1; i-- > 0;) below[i] = below[i + 1] + bodies[i + 1].mass;
        for (size_t i = 0; i < n_; ++i) {
            const ChainBody& b = bodies[i];
            c_[i] = gravity * (b.mass * b.reach + b.length * below[i]);
            a_[i * n_ + i] = b.inertia + b.mass * b.reach * b.reach + b.length * b.length * below[i];
            for (size_t j = i + 1; j < n_; ++j)
                a_[i * n_ + j] = a_[j * n_ + i] =
                    b.length * (bodies[j].mass * bodies[j].reach + bodies[j].length * below[j]);
        }
    }

    void step(double h) {
        std::vector<double> a1, a2, a3, a4;
        const std::vector<double> q = angle, v = rate;
        acceleration(q, v, a1);
        const auto v2 = sum(v, a1, h / 2), q2 = sum(q, v, h / 2);
        acceleration(q2, v2, a2);
        const auto v3 = sum(v, a2, h / 2), q3 = sum(q, v2, h / 2);
        acceleration(q3, v3, a3);
        const auto v4 = sum(v, a3, h), q4 = sum(q, v3, h);
        acceleration(q4, v4, a4);
        for (size_t i = 0; i < n_; ++i) {
            angle[i] = q[i] + h / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + v4[i]);
            rate[i] = v[i] + h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
        }
    }

    // Of the last body's centre, to the side of the anchor [m].
    double side() const {
        double x = 0;
        for (size_t i = 0; i < n_; ++i) x += (i + 1 < n_ ? bodies_[i].length : bodies_[i].reach) * std::sin(angle[i]);
        return x;
    }
    double energy() const {
        double sum = 0;
        for (size_t i = 0; i < n_; ++i) {
            sum -= c_[i] * std::cos(angle[i]);
            for (size_t j = 0; j < n_; ++j)
                sum += 0.5 * a_[i * n_ + j] * std::cos(angle[i] - angle[j]) * rate[i] * rate[j];
        }
        return sum;
    }

private:
    static std::vector<double> sum(const std::vector<double>& a, const std::vector<double>& b, double s) {
        std::vector<double> out(a);
        for (size_t i = 0; i < out.size(); ++i) out[i] += s * b[i];
        return out;
    }

    // Cholesky of the mass matrix, in place.
    void acceleration(const std::vector<double>& q, const std::vector<double>& v, std::vector<double>& out) {
        std::vector<double> m(n_ * n_), co(n_), si(n_);
        out.assign(n_, 0.0);
        for (size_t i = 0; i < n_; ++i) co[i] = std::cos(q[i]), si[i] = std::sin(q[i]);
        for (size_t i = 0; i < n_; ++i) {
            out[i] = -c_[i] * si[i];
            for (size_t j = 0; j < n_; ++j) {
                m[i * n_ + j] = a_[i * n_ + j] * (co[i] * co[j] + si[i] * si[j]);
                out[i] -= a_[i * n_ + j] * (si[i] * co[j] - co[i] * si[j]) * v[j] * v[j];
            }
        }
        for (size_t i = 0; i < n_; ++i)
            for (size_t j = 0; j <= i; ++j) {
                double s = m[i * n_ + j];
                for (size_t k = 0; k < j; ++k) s -= m[i * n_ + k] * m[j * n_ + k];
                m[i * n_ + j] = i == j ? std::sqrt(s) : s / m[j * n_ + j];
            }
        for (size_t i = 0; i < n_; ++i) {
            for (size_t k = 0; k < i; ++k) out[i] -= m[i * n_ + k] * out[k];
            out[i] /= m[i * n_ + i];
        }
        for (size_t i = n_; i-- > 0;) {
            for (size_t k = i + 1; k < n_; ++k) out[i] -= m[k * n_ + i] * out[k];
            out[i] /= m[i * n_ + i];
        }
    }

    size_t n_;
    std::vector<ChainBody> bodies_;
    std::vector<double> a_, c_;

public:
    std::vector<double> angle, rate;  // [rad], [rad/s]
};

// The chain of chain10_rR and swing_rR: ten 1 kg links of 0.5 x 0.2 x 0.2 m, a cube of 0.5 m with r kg.
inline ReferenceChain chain_of_ten(double r, double angle_from_down, double gravity = 9.81) {
    std::vector<ChainBody> bodies(10, {1.0, (0.5 * 0.5 + 0.2 * 0.2) / 12, 0.25, 0.5});
    bodies.push_back({r, r * (0.5 * 0.5 + 0.5 * 0.5) / 12, 0.25, 0.5});
    return {bodies, gravity, angle_from_down};
}

}  // namespace lab
