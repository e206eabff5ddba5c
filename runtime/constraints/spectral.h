// Strains of isotropic materials: rows c(sigma) of the singular values alone,  F = U diag(sigma) V^T. With a = U^T dF
// V, and psi = d(s . c)/dsigma, the second derivative of s . c falls apart (Smith et al. 2019, section 4) into
//   d2(s . c)/dsigma2                            on a_11, a_22, a_33
//   (psi_i - psi_j)/(sigma_i - sigma_j)  (flip)  on (a_ij + a_ji)/sqrt 2
//   (psi_i + psi_j)/(sigma_i + sigma_j)  (twist) on (a_ij - a_ji)/sqrt 2
// and dc/dF^T D dc/dF adds to the first alone: the spectrum of any sum is one of 3x3 and six numbers. A class E gives
//   kRows; Data; E(data, F); error(c); jacobian(g, j)   as of continuum.h
//   kOpen                 whether directions of equal sigma are open, and s says nothing of them
//   values()              singular values of F
//   slopes(sigma)         dc/dsigma: [row][3]
//   bend(s, form)         adds the numbers above, of pairs by the third direction
#pragma once

#include "constraints/continuum.h"
#include "constraints/singular_values.h"

namespace taut {

struct SpectralForm {
    SingularValues<3> at;
    Mat3 scaling = Mat3::Zero();
    Vec3 flip = Vec3::Zero(), twist = Vec3::Zero();

    using Node = Vec3;
    Vec3 node(const Vec3& g) const { return at.v.transpose() * g; }
    Mat3 block(const Vec3& n, const Vec3& m) const {
        const Vec3 own = 0.5 * (twist + flip), cross = 0.5 * (flip - twist), nm = n.cwiseProduct(m);
        Mat3 b;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            b(i, i) = scaling(i, i) * nm[i] + own[k] * nm[j] + own[j] * nm[k];
            b(i, j) = scaling(i, j) * n[i] * m[j] + cross[k] * n[j] * m[i];
            b(j, i) = scaling(j, i) * n[j] * m[i] + cross[k] * n[i] * m[j];
        }
        return at.u * b * at.u.transpose();
    }
    // Of pairs of equal sigma, the limit of (psi_i - psi_j)/(sigma_i - sigma_j) where psi is the slope of one energy,
    // the same in each direction, whose second derivative is `scaling`. At rest it is all of the stiffness against
    // shear.
    void close_equal() {
        for (int k = 0; k < 3; ++k) {
            const int i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
            if (at.sigma[i] - at.sigma[j] < kLeastGap) flip[k] = 0.5 * (scaling(i, i) + scaling(j, j)) - scaling(i, j);
        }
    }
    void clip() {
        clip_negative<3>(scaling);
        flip = flip.cwiseMax(0);
        twist = twist.cwiseMax(0);
    }
};

template <class E>
struct Spectral : E {
    static constexpr int kDim = 3;
    using Stress = Eigen::Matrix<double, E::kRows, 1>;
    using E::E;

    SpectralForm curvature(const Stress& s, Curvature part) const {
        SpectralForm form{this->values()};
        E::bend(s, form);
        if (part == Curvature::positive) form.clip();
        return form;
    }
    SpectralForm hessian(const Stress& s, const RowMatrix<E::kRows>& d, Curvature part) const {
        SpectralForm form{this->values()};
        E::bend(s, form);
        const auto slopes = E::slopes(form.at.sigma);
        form.scaling += slopes.transpose() * d * slopes;
        if constexpr (E::kOpen) form.close_equal();
        if (part == Curvature::positive) form.clip();
        return form;
    }
};

// The second derivatives of det F = sigma_1 sigma_2 sigma_3, times s.
inline void bend_volume(double s, SpectralForm& form) {
    const Vec3 sigma = s * form.at.sigma;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        form.scaling(i, j) += sigma[k];
        form.scaling(j, i) += sigma[k];
    }
    form.flip -= sigma;
    form.twist += sigma;
}

// Of det F by sigma.
inline Vec3 volume_slopes(const Vec3& sigma) { return {sigma[1] * sigma[2], sigma[2] * sigma[0], sigma[0] * sigma[1]}; }

// The second derivatives of s . sigma, s of the three stretches.
inline void bend_stretches(const Vec3& s, SpectralForm& form) {
    for (int k = 0; k < 3; ++k) {
        const int i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
        const double a = form.at.sigma[i], b = form.at.sigma[j];
        form.flip[k] += (s[i] - s[j]) / std::max(a - b, kLeastGap);
        form.twist[k] += (s[i] + s[j]) / std::max(a + b, kLeastGap);
    }
}

}  // namespace taut
