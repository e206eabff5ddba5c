#include "models/soft_reading.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

// Of a symmetric 3x3: sqrt(3/2) of its part without the mean.
double von_mises(const Mat3& stress) {
    const Mat3 part = stress - stress.trace() / 3 * Mat3::Identity();
    return std::sqrt(1.5) * part.norm();
}

// One element of a solid. With f_n = J_n^T D C the forces of W on its nodes, sum f_n x_n^T = V P F^T = V det F sigma.
CellState element_state(const World& world, const ElementSet& set, uint32_t e) {
    const ConstraintType& row = set.type->row;
    Pose x[kMaxNodes];
    const auto nodes = set.nodes_of(e);
    for (size_t n = 0; n < nodes.size(); ++n) x[n].x = world.nodes.motion[nodes[n]].x;
    double c[kMaxRows], j[kMaxNodes * kMaxRows * kDof] = {};
    row.evaluate(set.data_of(e), x, c, j);
    const double* g = set.data_of(e);
    Mat3 f = Mat3::Zero(), moment = Mat3::Zero();
    for (int n = 0; n < row.nodes; ++n) {
        const Vec3 at = x[n].x - x[0].x;
        f += at * Vec3::Map(g + 3 * n).transpose();
        Vec3 force = Vec3::Zero();
        for (int r = 0; r < row.rows; ++r) {
            double stress = 0;
            for (int k = 0; k < row.rows; ++k) stress += set.stiffness[r * row.rows + k] * c[k];
            force += stress * Vec3::Map(j + (n * row.rows + r) * kDof);
        }
        moment += force * at.transpose();
    }
    const double volume = f.determinant();  // the forces are already over the softness, 1/V
    return {volume != 0 ? von_mises(moment / volume) : 0, volume};
}

}  // namespace

void soft_normals(const World& world, const Soft& soft, Array<Vec3>& out) {
    out.assign(soft.vertices(), Vec3(Vec3::Zero()));
    for (uint32_t t = 0; t < soft.triangles(); ++t) {
        const uint32_t* corner = &soft.triangle[3 * size_t{t}];
        Vec3 x[3];
        for (int n = 0; n < 3; ++n) x[n] = vertex_of(world, soft, corner[n]);
        const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
        for (int n = 0; n < 3; ++n) {
            const Vec3 a = x[(n + 1) % 3] - x[n], b = x[(n + 2) % 3] - x[n];
            out[corner[n]] += angle_of(a.cross(b).norm(), a.dot(b)) * normal;
        }
    }
    for (Vec3& normal : out)
        if (normal.norm() > 0) normal.normalize();
}

double triangle_strain(const World& world, const Soft& soft, uint32_t triangle) {
    Eigen::Matrix<double, 3, 2> f = Eigen::Matrix<double, 3, 2>::Zero();
    for (uint32_t n = 0; n < 3; ++n)
        f += vertex_of(world, soft, soft.triangle[3 * size_t{triangle} + n]) *
             Eigen::RowVector2d::Map(&soft.rest[6 * size_t{triangle} + 2 * n]);
    const Eigen::Matrix2d c = f.transpose() * f;
    const double mean = 0.5 * c.trace(), apart = hypotenuse(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
    return std::sqrt(mean + apart) - 1;
}

uint32_t cells_of(const World& world, const Soft& soft) {
    return world.elements.set[soft.sets[0].set].size() / soft.cell_points;
}

bool is_meshless(const World& world, const Soft& soft) {
    return soft.kind == SoftKind::solid && soft.cell_points == 1 &&
           world.elements.set[soft.sets[0].set].type->row.nodes == 8;
}

CellState cell_state(const World& world, const Soft& soft, uint32_t cell) {
    const ElementSet& set = world.elements.set[soft.sets[0].set];
    CellState sum;
    for (uint32_t k = 0; k < soft.cell_points; ++k) {
        const CellState at = element_state(world, set, cell * soft.cell_points + k);
        sum.stress += at.stress / soft.cell_points;
        sum.volume += at.volume / soft.cell_points;
    }
    return sum;
}

}  // namespace taut
