// Continua: every shape with every strain and material that fits it, from the lists of continuum_lab.h.
#include <gtest/gtest.h>

#include "continuum_lab.h"

namespace taut::test {
namespace {

constexpr Constants kRubber{30, 0.35};
constexpr uint64_t kSeeds = 20;

// Each sample of each type.
template <class Check>
void for_samples(Check check) {
    for_continua([&](const ElementType& type, const ShapeCase& shape, const StrainCase& strain) {
        if (!shape.balanced) return;  // the same type as another shape's
        for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
            SCOPED_TRACE(testing::Message() << type.name << ", seed " << seed);
            Single at(type, seed);
            check(at, strain);
        }
    });
}

Matrix random_affine(uint64_t seed, int dim) {
    Matrix f = Matrix::Identity(3, dim);
    Random random(seed);
    for (double& each : f.reshaped()) each += random.between(-0.3, 0.3);
    return f;
}

TEST(Continua, AllStandInTheList) {
    int solids = 0, sheets = 0;
    const int count = for_continua(
        [&](const ElementType&, const ShapeCase& shape, const StrainCase&) { ++(shape.dim == 3 ? solids : sheets); });
    EXPECT_EQ(solids, 3 * 5);
    EXPECT_EQ(sheets, 2 * 2);
    EXPECT_EQ(count, solids + sheets);
    int covered = 0;
    for (const ElementType* type : element_types())
        for (const ShapeCase& shape : shape_cases()) covered += shape.balanced && is_of_shape(*type, shape);
    EXPECT_EQ(covered, 2 * 5 + 2 * 2);  // of no strain beyond those of the list
}

TEST(Continua, StrainsAreThoseOfTheSingularValueDecomposition) {
    for_samples([](Single& at, const StrainCase& strain) {
        EXPECT_LE(largest(at.error() - strain.of(at.f(), at.alpha())), 1e-12);
    });
}

TEST(Continua, StrainsKnowNoPlaceAndNoRotation) {
    for_samples([](Single& at, const StrainCase&) {
        const Vector before = at.error();
        at.set_positions((random_rotation(7) * at.positions()).colwise() + Vec3(1, -2, 3));
        EXPECT_LE(largest(at.error() - before), 1e-12);
    });
}

// Any affine motion of a patch is the same strain everywhere, and its forces leave the inner nodes alone.
TEST(Continua, PassThePatchTest) {
    for_materials([](const ElementType& type, const ShapeCase& shape, const MaterialCase& material) {
        for (uint64_t seed = 1; seed <= 3; ++seed) {
            SCOPED_TRACE(testing::Message() << type.name << ", " << material.name << ", seed " << seed);
            const Patch patch = shape.patch(seed);
            ASSERT_FALSE(patch.points.empty());
            const Matrix motion = random_affine(seed, 3), f = motion * patch.axes;
            Matrix forces = Matrix::Zero(3, static_cast<long>(patch.rest.size()));
            const StrainCase& strain = *std::ranges::find(strain_cases(), std::string_view(material.strain),
                                                          [](const StrainCase& s) { return std::string_view(s.name); });
            for (const ShapePoint& point : patch.points) {
                Single at(type);
                const Matrix d = modulus_of(material, kRubber, at);
                at.g() = point.g;
                for (size_t n = 0; n < point.nodes.size(); ++n)
                    at.pose[n].x = motion * patch.rest[point.nodes[n]] + Vec3(4, 5, 6);
                EXPECT_LE(largest(at.error() - strain.of(f, at.alpha())), 1e-12);
                const Matrix force = point.weight * at.force(d).reshaped(3, at.nodes());
                for (size_t n = 0; n < point.nodes.size(); ++n)
                    forces.col(point.nodes[n]) += force.col(static_cast<long>(n));
            }
            if (!shape.balanced) continue;
            EXPECT_GT(largest(forces), 1e-2);
            for (const uint32_t n : patch.inner) EXPECT_LE(forces.col(n).norm(), 1e-12 * largest(forces));
        }
    });
}

TEST(Continua, EnergiesAreThoseOfTheirMaterials) {
    const int count = for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
            SCOPED_TRACE(testing::Message() << type.name << ", " << material.name << ", seed " << seed);
            Single at(type, seed);
            const Matrix d = modulus_of(material, kRubber, at);
            const double expected = material.energy(at.f(), kRubber);
            EXPECT_NEAR(at.energy(d), expected, 1e-11 * (1 + expected));
        }
    });
    EXPECT_EQ(count, 3 * 5 + 2 * 2);
}

// The energy of isotropic materials has no direction: turning the material within its shape leaves it.
TEST(Continua, IsotropicMaterialsHaveNoDirection) {
    for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        Single at(type, 5);
        const Matrix d = modulus_of(material, kRubber, at);
        const double before = at.energy(d);
        const Mat3 turn = at.dim() == 3 ? random_rotation(3) : Mat3(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
        at.g() = (turn.topLeftCorner(at.dim(), at.dim()) * at.g()).eval();
        EXPECT_NEAR(at.energy(d), before, 1e-12 * (1 + before)) << type.name;
    });
}

// At rest there is no force, and the stiffness is that of linear elasticity in every material.
TEST(Continua, RestIsWithoutForceAndLinearAroundIt) {
    for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        for (uint64_t seed = 1; seed <= 5; ++seed) {
            SCOPED_TRACE(testing::Message() << type.name << ", " << material.name << ", seed " << seed);
            Single at(type, seed);
            const Matrix d = modulus_of(material, kRubber, at);
            const Matrix rotation = random_rotation(seed).leftCols(at.dim());
            at.set_f(rotation);
            EXPECT_LE(at.force(d).norm(), 1e-11 * kRubber.young * at.g().norm());
            Random random(seed);
            Matrix u(3, at.nodes());
            for (double& each : u.reshaped()) each = random.between(-1, 1);
            const Matrix turned = rotation.transpose() * (u * at.g().transpose());
            const Matrix strain = symmetric(turned);
            const double lambda = at.dim() == 3 ? kRubber.lambda() : kRubber.sheet_lambda();
            const double expected = 2 * kRubber.mu() * strain.squaredNorm() + lambda * strain.trace() * strain.trace();
            const Matrix k = at.sum(-(d * at.error()), d);
            const Vector move = u.reshaped();
            EXPECT_NEAR(move.dot(k * move), expected, 1e-8 * (1 + expected));
        }
    });
}

// ---------------------------------------------------------------- inverted

// Out of a point, along the rest shape or its mirror image; Green and neo-Hookean strains have no slope there.
TEST(Continua, LeaveAPointWhereTheirRotationIsKnown) {
    for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        Single at(type, 1);
        const Matrix d = modulus_of(material, kRubber, at);
        at.set_positions(Matrix::Zero(3, at.nodes()));
        const auto strain = std::ranges::find(strain_cases(), std::string_view(material.strain),
                                              [](const StrainCase& s) { return std::string_view(s.name); });
        if (!strain->unfolds) {
            EXPECT_EQ(at.force(d).norm(), 0) << type.name;
            return;
        }
        const Matrix push = at.force(d).reshaped(3, at.nodes());
        const Matrix along = push * at.g().transpose();  // 3 x dim
        EXPECT_GT(along.norm(), 0.1) << type.name;
        if (at.dim() == 3) {
            EXPECT_GT(along.determinant(), 0) << type.name;
        }
    });
}

// A mirrored solid is pushed through the plane that it was mirrored on; of Green strain it is at rest.
TEST(Continua, TellAMirroredSolidFromItself) {
    for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        if (type.numbers / type.row.nodes != 3) return;
        Single at(type, 1);
        const Matrix d = modulus_of(material, kRubber, at);
        const Mat3 turn = random_rotation(4);
        at.set_f(turn * Vec3(1, 1, -0.9).asDiagonal());
        const double before = at.energy(d);
        const Mat3 back = turn * Vec3(0, 0, 1).asDiagonal();
        const Matrix moment = at.g() * at.g().transpose();
        const Matrix u = back * moment.inverse() * at.g();  // moves the third stretch alone
        const double power = at.force(d).dot(Vector(u.reshaped()));
        const auto strain = std::ranges::find(strain_cases(), std::string_view(material.strain),
                                              [](const StrainCase& s) { return std::string_view(s.name); });
        at.set_f(turn);
        if (strain->mirrors) {
            EXPECT_GT(power, 0.1) << type.name;
            EXPECT_GT(before, at.energy(d) + 0.1) << type.name;
        } else {
            EXPECT_LT(power, 0) << type.name;
        }
    });
}

// ---------------------------------------------------------------- positive parts

// Where the shape is as wide in every direction, G G^T = 1, the nodes' matrix has F's spectrum: what is nearest there
// is nearest to the whole. Of Green strain only the geometric part is.
TEST(Continua, PositivePartsAreTheNearestInTheDeformation) {
    for_samples([](Single& at, const StrainCase& strain) {
        const Mat3 wanted = random_rotation(9) * Vec3(1.3, 0.8, -0.5).asDiagonal() * random_rotation(10);
        const Eigen::SelfAdjointEigenSolver<Matrix> moment(at.g() * at.g().transpose());
        at.g() = (moment.operatorInverseSqrt() * at.g()).eval();
        at.set_f(wanted.leftCols(at.dim()));
        const Vector lambda = Vector::LinSpaced(at.type.row.rows, 7, -9);
        const Matrix d = 5 * Matrix::Identity(at.type.row.rows, at.type.row.rows);
        const Matrix j = at.jacobian(), raw = at.stiffness(lambda, Curvature::raw);
        const Matrix positive = at.stiffness(lambda, Curvature::positive), sum = at.sum(lambda, d);
        EXPECT_LT(least_eigenvalue(raw), -0.1);
        EXPECT_LE(largest(positive - positive_part(raw)), 1e-11 * (1 + largest(raw)));
        const Matrix elastic = j.transpose() * d * j;
        const Matrix expected =
            std::string_view(strain.name) == "Green" ? Matrix(elastic + positive) : positive_part(elastic + raw);
        EXPECT_LE(largest(sum - expected), 1e-11 * (1 + largest(expected)));
    });
}

// With equal stretches, as at rest, the directions of the principal ones are open: what a material asks for there is
// not.
TEST(Continua, SumsOfMaterialsAreSmoothAtEqualStretches) {
    for_materials([](const ElementType& type, const ShapeCase&, const MaterialCase& material) {
        for (const double size : {0.9, 1.0, 1.1}) {
            Single at(type, 2);
            const Matrix d = modulus_of(material, kRubber, at);
            const auto sum_at = [&](double off) {
                at.set_f((random_rotation(6) * Vec3(size + off, size, size - off).asDiagonal()).leftCols(at.dim()));
                return at.sum(-(d * at.error()), d);
            };
            const Matrix equal = sum_at(0);
            EXPECT_LE(largest(sum_at(1e-7) - equal), 1e-4 * largest(equal)) << type.name << ", " << size;
        }
    });
}

}  // namespace
}  // namespace taut::test
