// Principal stretches.  c_i = sigma_i - 1, falling, the last one negative where det F is (Irving et al. 2004);
// dc_i/dF = u_i v_i^T. With an isotropic D, energy and force are those of corotated Hooke. With the volume as a fourth
// row, det F - 1, they are of the fixed corotated material (Stomakhin et al. 2012), W = mu sum c_i^2 + lambda/2 c_4^2.
// Both know what is mirrored from what is not, and leave F = 0. Where stretches are equal, as at rest, these rows have
// no slope against shear: all of it is curvature, which only the sum with D knows there. They are for the energy form.
#include "constraints/spectral.h"

namespace taut {
namespace {

template <bool Volume>
struct Stretches {
    static constexpr int kRows = Volume ? 4 : 3;
    static constexpr bool kOpen = true;
    struct Data {};
    using Rows = Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>;
    using Stress = Eigen::Matrix<double, kRows, 1>;

    Stretches(const Data&, const Mat3& f) : at_(taut::singular_values<3>(f)) {}
    const SingularValues<3>& values() const { return at_; }

    void error(double* c) const {
        Vec3::Map(c) = at_.sigma - Vec3::Ones();
        if constexpr (Volume) c[3] = at_.sigma.prod() - 1;
    }
    void jacobian(const Vec3& g, double* j) const {
        const Vec3 along = at_.v.transpose() * g;
        Eigen::Map<Rows>(j).noalias() = slopes(at_.sigma) * along.asDiagonal() * at_.u.transpose();
    }
    static Rows slopes(const Vec3& sigma) {
        Rows out;
        out.template topRows<3>().setIdentity();
        if constexpr (Volume) out.row(3) = volume_slopes(sigma).transpose();
        return out;
    }
    static void bend(const Stress& s, SpectralForm& form) {
        bend_stretches(s.template head<3>(), form);
        if constexpr (Volume) bend_volume(s[3], form);
    }

private:
    SingularValues<3> at_;
};

using PrincipalStretches = Spectral<Stretches<false>>;
using StretchesAndVolume = Spectral<Stretches<true>>;

}  // namespace

constinit const ElementType kStretchTet4 =
    continuum_element<4, PrincipalStretches>("principal stretches tet4", nullptr, &EnergyKernels::stretch_tet4);
constinit const ElementType kStretchHex8 =
    continuum_element<8, PrincipalStretches>("principal stretches hex8", nullptr, &EnergyKernels::stretch_hex8);
constinit const ElementType kStretchVolumeTet4 =
    continuum_element<4, StretchesAndVolume>("stretches and volume tet4", nullptr, &EnergyKernels::stretch_volume_tet4);
constinit const ElementType kStretchVolumeHex8 =
    continuum_element<8, StretchesAndVolume>("stretches and volume hex8", nullptr, &EnergyKernels::stretch_volume_hex8);

}  // namespace taut
