#include "continuum_lab.h"

#include <algorithm>
#include <functional>

namespace taut::test {
namespace {

// ---------------------------------------------------------------- shapes

constexpr int kSide = 4;  // nodes along a side of a patch

uint32_t grid_node(int i, int j, int k = 0) { return static_cast<uint32_t>((k * kSide + j) * kSide + i); }

// Nodes of a grid, each moved by up to 0.15 of its spacing; turned and moved as a whole.
Patch jittered_grid(uint64_t seed, int dim) {
    Random random(seed);
    Patch patch;
    for (int k = 0; k < (dim == 3 ? kSide : 1); ++k)
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const auto inside = [](int c) { return c > 0 && c < kSide - 1; };
                Vec3 at(i, j, k);
                const Vec3 off = 0.15 * random.vector();
                if (inside(i)) at.x() += off.x();
                if (inside(j)) at.y() += off.y();
                if (dim == 3 && inside(k)) at.z() += off.z();
                if (inside(i) && inside(j) && (dim == 2 || inside(k))) patch.inner.push_back(grid_node(i, j, k));
                patch.rest.push_back(at);
            }
    patch.content = dim == 3 ? 27 : 9;
    const Mat3 turn = random.rotation().toRotationMatrix();
    for (Vec3& each : patch.rest) each = turn * each + Vec3(3, -2, 1);
    patch.axes = dim == 3 ? Mat3::Identity() : Mat3(turn * Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
    patch.axes.conservativeResize(3, dim);
    return patch;
}

template <int Nodes, int Dim>
void add_point(Patch& patch, std::span<const uint32_t> nodes, const GaussPoint<Nodes, Dim>& point) {
    ShapePoint made{{nodes.begin(), nodes.end()}, Matrix(Dim, Nodes), point.weight};
    for (int n = 0; n < Nodes; ++n)
        for (int a = 0; a < Dim; ++a) made.g(a, n) = point.g[n][a];
    patch.points.push_back(made);
}

template <int Nodes>
void corners_of(const Patch& patch, std::span<const uint32_t> nodes, Vec3 (&x)[Nodes]) {
    for (size_t n = 0; n < Nodes; ++n) x[n] = patch.rest[nodes[n]];
}

// act(nodes of a cell) for each.
void for_cells(int dim, const std::function<void(const std::vector<uint32_t>&)>& act) {
    for (int k = 0; k < (dim == 3 ? kSide - 1 : 1); ++k)
        for (int j = 0; j + 1 < kSide; ++j)
            for (int i = 0; i + 1 < kSide; ++i) {
                std::vector<uint32_t> nodes;
                for (int up = 0; up < dim - 1; ++up)
                    for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
                        nodes.push_back(grid_node(i + a, j + b, k + up));
                act(nodes);
            }
}

Patch tri3_patch(uint64_t seed) {
    Patch patch = jittered_grid(seed, 2);
    for_cells(2, [&](const std::vector<uint32_t>& q) {
        for (const auto& nodes : {std::vector{q[0], q[1], q[2]}, std::vector{q[0], q[2], q[3]}}) {
            Vec3 x[3];
            corners_of(patch, nodes, x);
            GaussPoint<3, 2> point;
            if (tri3_point(x, patch.axes.col(0), point)) add_point(patch, nodes, point);
        }
    });
    return patch;
}

Patch quad4_patch(uint64_t seed) {
    Patch patch = jittered_grid(seed, 2);
    for_cells(2, [&](const std::vector<uint32_t>& nodes) {
        Vec3 x[4];
        corners_of(patch, nodes, x);
        GaussPoint<4, 2> point[4];
        if (quad4_points(x, patch.axes.col(0), point))
            for (const auto& each : point) add_point(patch, nodes, each);
    });
    return patch;
}

Patch tet4_patch(uint64_t seed) {
    Patch patch = jittered_grid(seed, 3);
    // Six to a cell, round its diagonal from corner 0 to corner 6.
    constexpr uint32_t kRing[7] = {1, 2, 3, 7, 4, 5, 1};
    for_cells(3, [&](const std::vector<uint32_t>& cell) {
        for (int t = 0; t < 6; ++t) {
            const std::vector<uint32_t> nodes{cell[0], cell[kRing[t]], cell[kRing[t + 1]], cell[6]};
            Vec3 x[4];
            corners_of(patch, nodes, x);
            GaussPoint<4, 3> point;
            if (tet4_point(x, point)) add_point(patch, nodes, point);
        }
    });
    return patch;
}

Patch hex8_patch(uint64_t seed) {
    Patch patch = jittered_grid(seed, 3);
    for_cells(3, [&](const std::vector<uint32_t>& nodes) {
        Vec3 x[8];
        corners_of(patch, nodes, x);
        GaussPoint<8, 3> point[8];
        if (hex8_points(x, point))
            for (const auto& each : point) add_point(patch, nodes, each);
    });
    return patch;
}

// Points at random in the grid, of the eight nodes next to each; the last of them has no weight.
Patch meshless_patch(uint64_t seed) {
    Patch patch = jittered_grid(seed, 3);
    Random random(seed + 1000);
    for (int p = 0; p < 27; ++p) {
        const Vec3 at = patch.rest[grid_node(1, 1, 1)] + 0.5 * random.vector();
        std::vector<uint32_t> near(patch.rest.size());
        for (uint32_t n = 0; n < near.size(); ++n) near[n] = n;
        std::ranges::sort(near, {}, [&](uint32_t n) { return (patch.rest[n] - at).squaredNorm(); });
        near.resize(8);
        const double reach = (patch.rest[near[7]] - at).squaredNorm();
        Vec3 x[8];
        double weight[8];
        corners_of(patch, near, x);
        for (int n = 0; n < 8; ++n) weight[n] = std::max(0.0, 1 - (x[n] - at).squaredNorm() / reach);
        GaussPoint<8, 3> point;
        if (meshless_point(x, weight, 1, point)) add_point(patch, near, point);
    }
    return patch;
}

constexpr ShapeCase kShapes[] = {{"tri3", 2, true, tri3_patch},
                                 {"quad4", 2, true, quad4_patch},
                                 {"tet4", 3, true, tet4_patch},
                                 {"hex8", 3, true, hex8_patch},
                                 {"hex8", 3, false, meshless_patch}};

// ---------------------------------------------------------------- strains

Vector rows_of(const Matrix& e) {
    if (e.rows() == 2) return Vec3(e(0, 0), e(1, 1), 2 * e(0, 1));
    Vector out(6);
    out << e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1);
    return out;
}

Matrix green_of(const Matrix& f) { return 0.5 * (f.transpose() * f - Matrix::Identity(f.cols(), f.cols())); }

// sigma, the last one signed, and V.
std::pair<Vector, Matrix> stretches_of(const Matrix& f) {
    const Eigen::JacobiSVD<Matrix> svd(f, Eigen::ComputeThinU | Eigen::ComputeThinV);
    Vector sigma = svd.singularValues();
    if (f.cols() == 3 && f.determinant() < 0) sigma[2] = -sigma[2];
    return {sigma, svd.matrixV()};
}

Matrix biot_of(const Matrix& f) {
    const auto [sigma, v] = stretches_of(f);
    return v * (sigma.array() - 1).matrix().asDiagonal() * v.transpose();
}

constexpr StrainCase kStrains[] = {
    {"Green", [](const Matrix& f, double) { return rows_of(green_of(f)); }, false, false},
    {"corotated", [](const Matrix& f, double) { return rows_of(biot_of(f)); }, true, true},
    {"principal stretches", [](const Matrix& f, double) -> Vector { return stretches_of(f).first.array() - 1; }, true,
     true},
    {"stretches and volume",
     [](const Matrix& f, double) -> Vector {
         Vector out(4);
         out << (stretches_of(f).first.array() - 1).matrix(), f.determinant() - 1;
         return out;
     },
     true, true},
    {"neo Hookean",
     [](const Matrix& f, double alpha) -> Vector { return Eigen::Vector2d(f.norm(), f.determinant() - alpha); }, false,
     true},
};

// ---------------------------------------------------------------- materials

double quadratic_energy(const Matrix& e, double mu, double lambda) {
    return mu * (e * e).trace() + 0.5 * lambda * e.trace() * e.trace();
}
template <size_t Size, class Make>
bool into(double* compliance, Make make) {
    double out[Size];
    if (!make(out)) return false;
    std::copy_n(out, Size, compliance);
    return true;
}
bool make_solid(const Isotropic& of, double* c, double&) {
    return into<36>(c, [&](double(&out)[36]) { return hooke_solid(of, out); });
}
bool make_sheet(const Isotropic& of, double* c, double&) {
    return into<9>(c, [&](double(&out)[9]) { return hooke_sheet(of, out); });
}

constexpr MaterialCase kMaterials[] = {
    {"St. Venant and Kirchhoff", "Green", 3, make_solid,
     [](const Matrix& f, const Constants& of) { return quadratic_energy(green_of(f), of.mu(), of.lambda()); }},
    {"St. Venant and Kirchhoff, sheet", "Green", 2, make_sheet,
     [](const Matrix& f, const Constants& of) { return quadratic_energy(green_of(f), of.mu(), of.sheet_lambda()); }},
    {"corotated Hooke", "corotated", 3, make_solid,
     [](const Matrix& f, const Constants& of) { return quadratic_energy(biot_of(f), of.mu(), of.lambda()); }},
    {"corotated Hooke, sheet", "corotated", 2, make_sheet,
     [](const Matrix& f, const Constants& of) { return quadratic_energy(biot_of(f), of.mu(), of.sheet_lambda()); }},
    {"corotated Hooke of stretches", "principal stretches", 3,
     [](const Isotropic& of, double* c, double&) {
         return into<9>(c, [&](double(&out)[9]) { return hooke_stretches(of, out); });
     },
     [](const Matrix& f, const Constants& of) { return quadratic_energy(biot_of(f), of.mu(), of.lambda()); }},
    {"fixed corotated", "stretches and volume", 3,
     [](const Isotropic& of, double* c, double&) {
         return into<16>(c, [&](double(&out)[16]) { return fixed_corotated(of, out); });
     },
     [](const Matrix& f, const Constants& of) {
         return of.mu() * biot_of(f).squaredNorm() + 0.5 * of.lambda() * std::pow(f.determinant() - 1, 2);
     }},
    {"neo-Hookean", "neo Hookean", 3,
     [](const Isotropic& of, double* c, double& alpha) {
         return into<4>(c, [&](double(&out)[4]) { return neo_hookean(of, out, alpha); });
     },
     [](const Matrix& f, const Constants& of) {
         const double volume = of.lambda() + of.mu();
         return 0.5 * of.mu() * f.squaredNorm() + 0.5 * volume * std::pow(f.determinant() - 1 - of.mu() / volume, 2);
     }},
};

}  // namespace

std::span<const ShapeCase> shape_cases() { return kShapes; }
std::span<const StrainCase> strain_cases() { return kStrains; }
std::span<const MaterialCase> material_cases() { return kMaterials; }

}  // namespace taut::test
