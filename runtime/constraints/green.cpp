// Green strain.  c = ((|f_1|^2 - 1)/2, ..., f_2.f_3, f_1.f_3, f_1.f_2), f_j the columns of F: E = (F^T F - 1)/2 with
// shear as 2 E_ij; of a surface ((|f_1|^2 - 1)/2, (|f_2|^2 - 1)/2, f_1.f_2).  dc/dF g: g_j f_j and g_i f_j + g_j f_i;
// d2(s . c)/dF2 = S x 1, S the symmetric matrix of s: a block of nodes is (g_n.S g_m) 1 (Tournier et al. 2015, appendix
// A), and its positive part that of S. With Hooke's D it is the material of St. Venant and Kirchhoff. c is the same for
// a mirrored F and its gradient is 0 at F = 0: what is turned inside out stays so.
//
// The sum takes S and dc/dF^T D dc/dF each by itself, as only S may be negative: the sum's own projection is tighter
// under pressure and costs a spectrum of 9x9 an element.
#include "constraints/continuum.h"
#include "constraints/voigt.h"

namespace taut {
namespace {

template <int Dim>
struct Green {
    static constexpr int kDim = Dim, kRows = kVoigtRows<Dim>;
    struct Data {};
    using G = Gradient<Dim>;
    using Stress = Eigen::Matrix<double, kRows, 1>;
    using Tensor = Eigen::Matrix<double, Dim, Dim>;
    using Rows = Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>;

    Green(const Data&, const Deformation<Dim>& f) : f_(f) {}

    void error(double* c) const {
        for (int r = 0; r < kRows; ++r) {
            const double product = f_.col(first(r)).dot(f_.col(second(r)));
            c[r] = r < Dim ? 0.5 * (product - 1) : product;
        }
    }
    void jacobian(const G& g, double* j) const {
        Eigen::Map<Rows> out(j);
        for (int r = 0; r < Dim; ++r) out.row(r) = (g[r] * f_.col(r)).transpose();
        for (int r = Dim; r < kRows; ++r)
            out.row(r) = (g[first(r)] * f_.col(second(r)) + g[second(r)] * f_.col(first(r))).transpose();
    }

    struct Geometric {
        Tensor s;
        struct Node {
            G g, sg;
        };
        Node node(const G& g) const { return {g, s * g}; }
        Mat3 block(const Node& n, const Node& m) const { return n.sg.dot(m.g) * Mat3::Identity(); }
    };
    Geometric curvature(const Stress& stress, Curvature part) const {
        Geometric form;
        for (int r = 0; r < kRows; ++r) form.s(first(r), second(r)) = form.s(second(r), first(r)) = stress[r];
        if (part == Curvature::positive) clip_negative<Dim>(form.s);
        return form;
    }

    struct Sum {
        Geometric geometric;
        Green at;
        RowMatrix<kRows> d;
        struct Node {
            typename Geometric::Node g;
            Rows j, dj;
        };
        Node node(const G& g) const {
            Node n{geometric.node(g), {}, {}};
            at.jacobian(g, n.j.data());
            n.dj = d.lazyProduct(n.j);
            return n;
        }
        Mat3 block(const Node& n, const Node& m) const {
            Mat3 out = n.j.transpose().lazyProduct(m.dj);
            out.diagonal().array() += n.g.sg.dot(m.g.g);
            return out;
        }
    };
    Sum hessian(const Stress& stress, const RowMatrix<kRows>& d, Curvature part) const {
        return {curvature(stress, part), *this, d};
    }

private:
    static constexpr int first(int r) { return voigt_first<Dim>(r); }
    static constexpr int second(int r) { return voigt_second<Dim>(r); }
    Deformation<Dim> f_;
};

}  // namespace

constinit const ElementType kGreenTri3 = continuum_element<3, Green<2>>("Green tri3", &ElementKernels::green_tri3);
constinit const ElementType kGreenQuad4 = continuum_element<4, Green<2>>("Green quad4");
constinit const ElementType kGreenTet4 = continuum_element<4, Green<3>>("Green tet4");
constinit const ElementType kGreenHex8 = continuum_element<8, Green<3>>("Green hex8");

}  // namespace taut
