// Neo-Hookean rows.  c = (|F|, det F - alpha) (Macklin and Mueller 2021): W = mu/2 |F|^2 + lambda/2 (det F - alpha)^2,
// alpha = 1 + mu/lambda, is least at every rotation (Smith et al. 2018); the balance of the two there is why neither
// row is 0. dc/dF = (F/|F|, cof F). It has no force at F = 0, where noise alone takes it away.
#include "constraints/spectral.h"

namespace taut {
namespace {

struct NeoHookeanRows {
    static constexpr int kRows = 2;
    static constexpr bool kOpen = false;
    struct Data {
        double alpha;
    };
    using Rows = Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>;
    using Stress = Eigen::Vector2d;

    NeoHookeanRows(const Data& data, const Mat3& f) : data_(data), f_(f) {
        cofactor_.col(0) = f.col(1).cross(f.col(2));
        cofactor_.col(1) = f.col(2).cross(f.col(0));
        cofactor_.col(2) = f.col(0).cross(f.col(1));
    }
    static void sample(Random& random, Data& data) { data.alpha = random.between(1, 2); }
    SingularValues<3> values() const { return singular_values<3>(f_); }

    void error(double* c) const {
        c[0] = f_.norm();
        c[1] = f_.col(0).dot(cofactor_.col(0)) - data_.alpha;
    }
    void jacobian(const Vec3& g, double* j) const {
        Vec3::Map(j) = f_ * g / size(f_.norm());
        Vec3::Map(j + 3) = cofactor_ * g;
    }
    static Rows slopes(const Vec3& sigma) {
        Rows out;
        out << sigma.transpose() / size(sigma.norm()), volume_slopes(sigma).transpose();
        return out;
    }
    static void bend(const Stress& s, SpectralForm& form) {
        const Vec3& sigma = form.at.sigma;
        const double length = size(sigma.norm()), each = s[0] / length;
        const Vec3 along = sigma / length;
        form.scaling += each * (Mat3::Identity() - along * along.transpose());
        form.flip.array() += each;
        form.twist.array() += each;
        bend_volume(s[1], form);
    }

private:
    static double size(double norm) { return std::max(norm, 1e-9); }
    Data data_;
    Mat3 f_, cofactor_;
};

using NeoHookean = Spectral<NeoHookeanRows>;

}  // namespace

constinit const ElementType kNeoHookeanTet4 =
    continuum_element<4, NeoHookean>("neo Hookean tet4", &ElementKernels::neo_hookean_tet4);
constinit const ElementType kNeoHookeanHex8 = continuum_element<8, NeoHookean>("neo Hookean hex8");

}  // namespace taut
