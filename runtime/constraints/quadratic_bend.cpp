// Bend of two triangles over their common edge, flat at rest.  C = sum_n k_n x_n [m], J_n = k_n 1, K = 0: of a flat
// pose it is 0, and of one bent by theta without stretch |C| = 2 |e| sin(theta/2), |e| theta where that is small. The
// k_n are sums of cotangents (shape_functions.h); the energy of a plate of bending stiffness kappa [N m] is 1/2 kappa
// 3/(A_2 + A_3) |C|^2, which is that of its mean curvature (Bergou et al. 2006).
#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct QuadraticBend {
    static constexpr int kRows = 3, kPoints = 4;
    static constexpr uint8_t kAngular = 0;
    struct Data {
        double weight[4];
    };

    static void evaluate(const Data& data, const Vec3* p, double* error, double* jacobian) {
        Vec3 c = Vec3::Zero();  // from x_0, as the weights sum to zero
        for (int n = 1; n < 4; ++n) c += data.weight[n] * (p[n] - p[0]);
        Vec3::Map(error) = c;
        if (!jacobian) return;
        for (int n = 0; n < 4; ++n) Mat3::Map(jacobian + 9 * n) = data.weight[n] * Mat3::Identity();
    }
    static void stiffness(const Data&, const Vec3*, const double*, Curvature, double*) {}
    static void hessian(const Data& data, const Vec3*, const double*, const double* d, double softness, Curvature,
                        double* k) {
        const Mat3 modulus = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(d) / softness;
        Eigen::Map<PointStiffness<QuadraticBend>> out(k);
        for (int n = 0; n < 4; ++n)
            for (int m = 0; m < 4; ++m) out.block<3, 3>(3 * n, 3 * m) = data.weight[n] * data.weight[m] * modulus;
    }
};

void sample_quadratic_bend(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& weight = static_cast<QuadraticBend::Data*>(data)->weight;
    for (int n = 1; n < 4; ++n) weight[n] = random.between(-2, 2);
    weight[0] = -(weight[1] + weight[2] + weight[3]);
    random.poses(x, 4);
}

}  // namespace

constinit const ElementType kQuadraticBendElement =
    point_element<QuadraticBend>("quadratic bend", sample_quadratic_bend, &ElementKernels::quadratic_bend);

}  // namespace taut
