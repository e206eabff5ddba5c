// Corotated strain.  c = R^T F - 1, R the rotation nearest to F (of a mirrored one too): S - 1 with S the symmetric
// part of the polar decomposition F = R S, shear as 2 S_ij; rows as of the Green strain. In the frame of the singular
// values, a = U^T dF V and R^T dF = dS + W S with W the turning of R, each pair i, j has
//   dS_ij = (sigma_i a_ij + sigma_j a_ji)/(sigma_i + sigma_j),   W_ij = (a_ij - a_ji)/(sigma_i + sigma_j),
// and from S^2 = F^T F, twice differentiated, with s . c = M : (S - 1) and w_ij = sigma_i/(sigma_i + sigma_j),
//   d2(s . c)[a, a] = sum_ijk M_ij (4 w_ij W_ki dS_kj + 2 w_ij sigma_j W_ki W_kj);
// of a surface, whose normal turns with it, also 2 M_ij/(sigma_i + sigma_j) a_ni a_nj.
// J of a fixed R is exact where M and S commute, as those of an isotropic D do: for these the principal stretches are
// the same material in three rows, with a spectrum in closed form. Here it takes one of 9x9.
#include "constraints/continuum.h"
#include "constraints/singular_values.h"
#include "constraints/voigt.h"

namespace taut {
namespace {

template <int Dim>
class Corotated {
public:
    static constexpr int kDim = Dim, kRows = kVoigtRows<Dim>;
    struct Data {};
    using G = Gradient<Dim>;
    using Stress = Eigen::Matrix<double, kRows, 1>;
    using Tensor = Eigen::Matrix<double, Dim, Dim>;
    using F = Deformation<Dim>;
    using Hessian = Eigen::Matrix<double, 3 * Dim, 3 * Dim>;

    Corotated(const Data&, const F& f) : at_(singular_values<Dim>(f)) {
        for (int i = 0; i < Dim; ++i)
            for (int j = 0; j < Dim; ++j) {
                const double sum = at_.sigma[i] + at_.sigma[j];
                sum_(i, j) = std::max(sum, kLeastGap);
                weight_(i, j) = i == j || sum < kLeastGap ? 0.5 : at_.sigma[i] / sum;
            }
    }

    void error(double* c) const {
        const Tensor s = at_.v * at_.sigma.asDiagonal() * at_.v.transpose();
        for (int r = 0; r < kRows; ++r) c[r] = r < Dim ? s(r, r) - 1 : 2 * s(voigt_first<Dim>(r), voigt_second<Dim>(r));
    }
    void jacobian(const G& g, double* j) const {
        const G along = at_.v.transpose() * g;
        for (int r = 0; r < kRows; ++r)
            Vec3::Map(j + 3 * r) = at_.u.template leftCols<Dim>() * (slope(unit(r)) * along);
    }

    // d2/da2 in the frame of the singular values, a by columns.
    struct Form {
        SingularValues<Dim> at;
        Hessian h;
        using Node = G;
        Node node(const G& g) const { return at.v.transpose() * g; }
        Mat3 block(const G& n, const G& m) const {
            Mat3 b = Mat3::Zero();
            for (int j = 0; j < Dim; ++j)
                for (int l = 0; l < Dim; ++l) b += n[j] * m[l] * h.template block<3, 3>(3 * j, 3 * l);
            return at.u * b * at.u.transpose();
        }
    };
    Form curvature(const Stress& stress, Curvature part) const {
        Form form{at_, bend(stress)};
        if (part == Curvature::positive) clip_negative<3 * Dim>(form.h);
        return form;
    }
    Form hessian(const Stress& stress, const RowMatrix<kRows>& d, Curvature part) const {
        Eigen::Matrix<double, kRows, 3 * Dim> p = Eigen::Matrix<double, kRows, 3 * Dim>::Zero();
        for (int r = 0; r < kRows; ++r) {
            const Tensor slopes = slope(unit(r));
            for (int j = 0; j < Dim; ++j) p.row(r).template segment<Dim>(3 * j) = slopes.col(j).transpose();
        }
        Form form{at_, bend(stress)};
        const Eigen::Matrix<double, kRows, 3 * Dim> dp = d.lazyProduct(p);
        form.h += p.transpose().lazyProduct(dp);
        if (part == Curvature::positive) clip_negative<3 * Dim>(form.h);
        return form;
    }

private:
    // v^T M v of one row.
    Tensor unit(int r) const {
        const G a = at_.v.row(voigt_first<Dim>(r)).transpose(), b = at_.v.row(voigt_second<Dim>(r)).transpose();
        Tensor m = a * b.transpose();
        if (r >= Dim) m += b * a.transpose();
        return m;
    }
    Tensor turned(const Stress& s) const {
        Tensor m = Tensor::Zero();
        for (int r = 0; r < kRows; ++r) m += s[r] * unit(r);
        return m;
    }
    // d(M : S)/da_ij, of a surface within it.
    Tensor slope(const Tensor& m) const { return 2 * m.cwiseProduct(weight_); }

    Hessian bend(const Stress& s) const {
        const Tensor m = turned(s);
        const Tensor mixed = m.cwiseProduct(weight_);
        const Tensor turns = 0.5 * (mixed * at_.sigma.asDiagonal() + at_.sigma.asDiagonal() * mixed.transpose());
        Hessian h = Hessian::Zero();
        for (int j = 0; j < Dim; ++j)
            for (int i = 0; i < Dim; ++i) {
                const Tensor column = second_slope(i, j, mixed, turns);
                for (int l = 0; l < Dim; ++l) h.col(3 * j + i).template segment<Dim>(3 * l) = column.col(l);
            }
        if constexpr (Dim == 2)
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j) h(3 * i + 2, 3 * j + 2) = 2 * m(i, j) / sum_(i, j);
        return h;
    }
    // Half the gradient of that square, at a_ij = 1 alone.
    Tensor second_slope(int i, int j, const Tensor& mixed, const Tensor& turns) const {
        Tensor ds = Tensor::Zero(), w = Tensor::Zero();
        ds(i, j) = ds(j, i) = i == j ? 1 : weight_(i, j);
        if (i != j) w(i, j) = 1 / sum_(i, j), w(j, i) = -w(i, j);
        const Tensor by_w = 2 * ds * mixed.transpose() + 2 * w * turns, by_ds = 2 * w * mixed;
        Tensor out;
        for (int l = 0; l < Dim; ++l)
            for (int k = 0; k < Dim; ++k)
                out(k, l) = k == l
                                ? by_ds(k, k)
                                : (by_w(k, l) - by_w(l, k)) / sum_(k, l) + weight_(k, l) * (by_ds(k, l) + by_ds(l, k));
        return out;
    }

    SingularValues<Dim> at_;
    Tensor sum_, weight_;
};

}  // namespace

constinit const ElementType kCorotatedTri3 = continuum_element<3, Corotated<2>>("corotated tri3");
constinit const ElementType kCorotatedQuad4 = continuum_element<4, Corotated<2>>("corotated quad4");
constinit const ElementType kCorotatedTet4 = continuum_element<4, Corotated<3>>("corotated tet4");
constinit const ElementType kCorotatedHex8 = continuum_element<8, Corotated<3>>("corotated hex8");

}  // namespace taut
