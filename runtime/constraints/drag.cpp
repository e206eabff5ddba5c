// Drag of a point in air.  C = G (x - p), J = G, K = 0. Where the compliance of each row and the damping time are both
// d, and p = x + d w lies where air of velocity w is after d, a row's force is
//   -(C + d dC/dt)/d = G (w - v) - G (x_n - x)/d,   in all G^T G (w - v)
// up to the way of a step over that of d: a dashpot to the air, implicit in v. The owner gives G and p in each step.
#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct Drag {
    static constexpr int kRows = 3, kPoints = 1;
    static constexpr uint8_t kAngular = 0;
    struct Data {
        double g[9];  // [row][3]
        double p[3];
    };
    using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

    static void evaluate(const Data& data, const Vec3* p, double* error, double* jacobian) {
        Vec3::Map(error) = Rows::Map(data.g) * (p[0] - Vec3::Map(data.p));
        if (jacobian) Rows::Map(jacobian) = Rows::Map(data.g);
    }
    static void stiffness(const Data&, const Vec3*, const double*, Curvature, double*) {}
    static void hessian(const Data& data, const Vec3*, const double*, const double* d, double softness, Curvature,
                        double* k) {
        const Rows g = Rows::Map(data.g), modulus = Rows::Map(d) / softness, force = modulus * g;
        Rows::Map(k) = g.transpose() * force;
    }
};

void sample_drag(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& numbers = *static_cast<Drag::Data*>(data);
    for (double& each : numbers.g) each = random.between(-2, 2);
    for (double& each : numbers.p) each = random.between(-1, 1);
    random.poses(x, 1);
}

}  // namespace

constinit const ElementType kDragElement = point_element<Drag>("drag", sample_drag);

}  // namespace taut
