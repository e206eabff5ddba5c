// Raw matrices of elements' energies, J^T D J + K, by differences of their forces: of every type at its samples, and of
// solids where principal stretches are equal or nearly, where they are inverted, and where all of a cell is one point.
#include <gtest/gtest.h>

#include "continuum_lab.h"

namespace taut::test {
namespace {

constexpr double kUnit = 1;  // softness

RowMajor raw_hessian(const Single& at, const Matrix& d) {
    RowMajor out(at.width(), at.width()), material = d;
    const Vector lambda = -(d * at.error());
    element_hessian(at.type, at.view(), {material.data(), &kUnit}, lambda.data(), Curvature::raw, out.data());
    return out;
}

// -d(force)/dx by central differences of fourth order.
Matrix differences(const Single& at, const Matrix& d, double step) {
    Matrix out(at.width(), at.width());
    for (int c = 0; c < at.width(); ++c) {
        const auto force = [&](double by) {
            Single moved = at;
            moved.pose[c / 3].x[c % 3] += by;
            return moved.force(d);
        };
        out.col(c) = -(8 * (force(step) - force(-step)) - (force(2 * step) - force(-2 * step))) / (12 * step);
    }
    return out;
}

Matrix stiffness_of(const ElementType& type) {
    const int rows = type.row.rows;
    Matrix d = Matrix::Identity(rows, rows);
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < rows; ++k) d(r, k) += 0.3 / (1 + r + k);
    return d;
}

TEST(Hessian, OfEveryTypeIsThatOfItsEnergy) {
    for (const ElementType* type : element_types())
        for (uint64_t seed = 1; seed <= 20; ++seed) {
            if (type->freedoms != 3) continue;  // of bodies, whose turns are none of these coordinates
            const Single at(*type, seed);
            // Rows of principal stretches are those of an isotropic material alone.
            const bool isotropic = std::string_view(type->name).find("stretches") != std::string_view::npos;
            Matrix d = isotropic ? Matrix(Matrix::Identity(type->row.rows, type->row.rows)) : stiffness_of(*type);
            if (type->row.rows == 4 && isotropic) d(3, 3) = 1.7;
            const Matrix raw = raw_hessian(at, d);
            EXPECT_LE(largest(raw - differences(at, d, 1e-3)), 2e-6 * (1 + largest(raw))) << type->name << " " << seed;
            EXPECT_LE(largest(raw - raw.transpose()), 1e-12 * (1 + largest(raw))) << type->name;
        }
}

struct State {
    const char* name;
    Vec3 stretch;
    double within;  // of differences, which a kink or a narrow gap makes worse
};

// Of each solid material, in turned frames. Mirrored: the last stretch is negative.
TEST(Hessian, IsExactAtEqualAndInvertedStretches) {
    const State states[] = {{"rest", {1, 1, 1}, 1e-6},
                            {"two equal", {1.3, 1.3, 0.7}, 1e-6},
                            {"two equal below", {1.3, 0.7, 0.7}, 1e-6},
                            {"all but equal", {1.3, 1.3 - 1e-9, 0.7}, 1e-6},
                            {"a little apart", {1.3, 1.3 - 1e-5, 0.7}, 1e-6},
                            {"pressed flat", {1.2, 0.9, 1e-12}, 1e-6},
                            {"mirrored", {1.3, 0.8, -0.4}, 1e-6},
                            {"mirrored and equal", {1.1, 1.1, -0.5}, 1e-6},
                            {"far mirrored", {3.0, 2.5, -1.5}, 1e-6}};
    int cases = for_materials([&](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        if (material.dim != 3) return;
        for (const State& state : states)
            for (uint64_t seed = 1; seed <= 5; ++seed) {
                Single at(type, 2 * seed + 1);
                const Matrix d = modulus_of(material, {1, 0.3}, at);
                if (d.size() == 0) continue;
                const Mat3 u = random_rotation(seed), v = random_rotation(seed + 100);
                at.set_f(u * state.stretch.asDiagonal() * v.transpose());
                const Matrix raw = raw_hessian(at, d);
                EXPECT_LE(largest(raw - differences(at, d, 2e-3)), state.within * (1 + largest(raw)))
                    << type.name << " " << material.name << ", " << state.name << " " << seed;
            }
    });
    EXPECT_GT(cases, 5);
}

// Where stretches cancel, as in one point, the energy has a ridge: the matrix is that of one side, steep and finite,
// and no direction that leads off it is held.
TEST(Hessian, IsFiniteAndSymmetricWhereACellIsAPointAnEdgeOrAFace) {
    for_materials([&](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        if (material.dim != 3) return;
        for (const Vec3& stretch : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, -1), Vec3(2, 0.5, -0.5)}) {
            Single at(type, 3);
            const Matrix d = modulus_of(material, {1, 0.3}, at);
            if (d.size() == 0) continue;
            at.set_f(random_rotation(5) * stretch.asDiagonal() * random_rotation(6));
            if (stretch.isZero(0)) std::fill(std::begin(at.pose), std::end(at.pose), at.pose[0]);
            const Matrix raw = raw_hessian(at, d);
            EXPECT_TRUE(raw.allFinite()) << type.name;
            EXPECT_LE(largest(raw - raw.transpose()), 1e-9 * (1 + largest(raw))) << type.name;
        }
    });
}

}  // namespace
}  // namespace taut::test
