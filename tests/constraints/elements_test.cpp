// What each element type says about itself: a batch against its row form, which is tested as constraint types are, and
// energies against finite differences. Any new type in the list is tested without a line here.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "constraints/element.h"
#include "instance.h"

namespace taut::test {
namespace {

constexpr uint64_t kBatches = 100;

// Some instances of one type with nodes of their own, in a batch that names them in another order.
struct Batch {
    Batch(const ElementType& t, uint64_t seed) : type(t) {
        const auto nodes = static_cast<size_t>(t.row.nodes), numbers = static_cast<size_t>(t.numbers);
        data.resize(kCount * numbers);
        for (uint32_t i = 0; i < kCount; ++i) {
            instance.emplace_back(t.row, seed * kCount + i);
            if (numbers > 0) std::memcpy(&data[i * numbers], instance[i].data.data(), numbers * sizeof(double));
            for (size_t n = 0; n < nodes; ++n) pose.push_back(instance[i].pose[n]);
        }
        for (uint32_t i = 0; i < kCount; ++i) {
            element.push_back(kCount - 1 - i);
            for (size_t n = 0; n < nodes; ++n) node.push_back(static_cast<uint32_t>((kCount - 1 - i) * nodes + n));
        }
        for (double& each : softness) each = 0.5 + 0.25 * static_cast<double>(&each - softness);
        const int rows = t.row.rows;
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> normal;
        Matrix root(rows, rows);
        for (double& each : root.reshaped()) each = normal(engine);
        stiffness = 20 * root.transpose() * root + Matrix::Identity(rows, rows);
    }
    ElementBatch view() const { return {kCount, node.data(), element.data(), data.data(), pose.data()}; }
    const Instance& of(uint32_t i) const { return instance[element[i]]; }
    ElementStiffness d() const { return {stiffness.data(), softness}; }
    Matrix d_of(uint32_t i) const { return stiffness / softness[element[i]]; }
    size_t width() const { return static_cast<size_t>(type.row.nodes * type.freedoms); }
    std::vector<double> lambda() const {
        std::vector<double> all;
        for (uint32_t i = 0; i < kCount; ++i) all.insert(all.end(), of(i).lambda.begin(), of(i).lambda.end());
        return all;
    }
    // Columns and rows of the freedoms of a matrix over all of the nodes.
    Matrix freedoms(const Matrix& whole, bool rows) const {
        Matrix out(rows ? width() : whole.rows(), width());
        for (int n = 0; n < type.row.nodes; ++n)
            for (int m = 0; m < type.row.nodes; ++m) {
                const int f = type.freedoms;
                if (rows)
                    out.block(n * f, m * f, f, f) = whole.block(n * kDof, m * kDof, f, f);
                else
                    out.middleCols(n * f, f) = whole.middleCols(n * kDof, f);
            }
        return out;
    }
    double energy(uint32_t i) const {
        double out[kCount];
        element_energy(type, view(), d(), out);
        return out[i];
    }

    static constexpr uint32_t kCount = 5;
    const ElementType& type;
    std::vector<Instance> instance;
    std::vector<double> data;
    std::vector<Pose> pose;
    std::vector<uint32_t> node, element;
    double softness[kCount];
    RowMajor stiffness;
};

class EveryElement : public testing::TestWithParam<const ElementType*> {
protected:
    template <class Check>
    void for_samples(Check check) {
        for (uint64_t seed = 1; seed <= kBatches && !HasFailure(); ++seed) {
            SCOPED_TRACE(testing::Message() << GetParam()->name << ", seed " << seed);
            check(Batch(*GetParam(), seed));
        }
    }
};

std::string name_of(const testing::TestParamInfo<const ElementType*>& info) {
    std::string name = info.param->name;
    std::ranges::replace(name, ' ', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(List, EveryElement, testing::ValuesIn(element_types().begin(), element_types().end()),
                         name_of);

TEST_P(EveryElement, KeepsItsContract) {
    const ElementType& type = *GetParam();
    EXPECT_TRUE(type.freedoms == 3 || type.freedoms == 6);
    EXPECT_TRUE(type.row.nodes >= 1 && type.row.nodes <= kMaxNodes);
    EXPECT_TRUE(type.row.rows >= 1 && type.row.rows <= kMaxRows);
    EXPECT_EQ(type.row.data_size, static_cast<size_t>(type.numbers) * sizeof(double));
    EXPECT_EQ(type.row.bound, Bound::free);
}

TEST_P(EveryElement, BatchesSayWhatRowsSay) {
    for_samples([](const Batch& b) {
        const auto rows = static_cast<size_t>(b.type.row.rows), nodes = static_cast<size_t>(b.type.row.nodes);
        for (const int columns : {b.type.freedoms, kDof}) {
            std::vector<double> error(b.kCount * rows), without(error),
                jacobian(b.kCount * nodes * rows * static_cast<size_t>(columns), 0.0);
            b.type.evaluate(b.view(), error.data(), jacobian.data(), columns);
            b.type.evaluate(b.view(), without.data(), nullptr, columns);
            EXPECT_EQ(error, without);
            for (uint32_t i = 0; i < b.kCount; ++i) {
                EXPECT_EQ(Vector(Vector::Map(&error[i * rows], b.type.row.rows)), b.of(i).error());
                const Matrix own = b.of(i).jacobian();
                for (size_t n = 0; n < nodes; ++n)
                    for (size_t r = 0; r < rows; ++r)
                        for (size_t k = 0; k < static_cast<size_t>(columns); ++k)
                            EXPECT_EQ(jacobian[((i * nodes + n) * rows + r) * static_cast<size_t>(columns) + k],
                                      own(static_cast<long>(r), static_cast<long>(n * kDof + k)));
            }
        }
    });
}

TEST_P(EveryElement, StiffnessesOfBatchesAreThoseOfRows) {
    for_samples([](const Batch& b) {
        for (const Curvature part : {Curvature::raw, Curvature::positive}) {
            std::vector<double> k(b.kCount * b.width() * b.width(), 1e300);
            b.type.stiffness(b.view(), b.lambda().data(), part, k.data());
            for (uint32_t i = 0; i < b.kCount; ++i)
                EXPECT_EQ(Matrix(Eigen::Map<RowMajor>(&k[i * b.width() * b.width()], b.width(), b.width())),
                          b.freedoms(b.of(i).stiffness(part), true));
        }
    });
}

// Row forms keep the contract of constraint types: J and K by differences, and K's positive part not below it.
TEST_P(EveryElement, DerivativesMatchFiniteDifferences) {
    for_samples([](const Batch& b) {
        const Instance& at = b.of(0);
        const Matrix j = at.jacobian(), k = at.stiffness(Curvature::raw);
        EXPECT_LE(largest(j - derivative(at, [](const Instance& i) { return i.error(); })), 1e-8 * (1 + largest(j)));
        EXPECT_LE(largest(k + derivative(
                                  at, [](const Instance& i) -> Vector { return i.jacobian().transpose() * i.lambda; })),
                  1e-8 * (1 + largest(k)));
        EXPECT_GE(least_eigenvalue(at.stiffness(Curvature::positive) - symmetric(k)), -1e-12 * (1 + largest(k)));
    });
}

// dW/dx = J^T D C.
TEST_P(EveryElement, ForcesAreTheGradientOfTheEnergy) {
    for_samples([](Batch b) {
        const Instance& at = b.of(0);
        const Vector force = at.jacobian().transpose() * (b.d_of(0) * at.error());
        const auto first = static_cast<size_t>(b.node[0]);
        for (int c = 0; c < at.coordinates(); ++c) {
            if (c % kDof >= b.type.freedoms) continue;
            const auto energy = [&](double step) {
                const Pose kept = b.pose[first + static_cast<size_t>(c / kDof)];
                b.pose[first + static_cast<size_t>(c / kDof)] = at.moved(c, step).pose[static_cast<size_t>(c / kDof)];
                const double w = b.energy(0);
                b.pose[first + static_cast<size_t>(c / kDof)] = kept;
                return w;
            };
            constexpr double kStep = 1e-4;
            const double slope =
                (8 * (energy(kStep) - energy(-kStep)) - (energy(2 * kStep) - energy(-2 * kStep))) / (12 * kStep);
            EXPECT_NEAR(slope, force[c], 1e-7 * (1 + force.norm()));
        }
    });
}

TEST_P(EveryElement, EnergyKnowsNoPlaceAndNoDirectionOfIsotropicStiffness) {
    if (GetParam()->row.nodes == 1) GTEST_SKIP() << "it is held by the world";
    for_samples([](Batch b) {
        b.stiffness = Matrix::Identity(b.type.row.rows, b.type.row.rows);
        const double before = b.energy(0);
        const Mat3 turn = Quat(0.3, -0.5, 0.7, 0.1).normalized().toRotationMatrix();
        for (Pose& pose : b.pose) pose = {turn * pose.x + Vec3(5, -3, 2), turn * pose.R};
        EXPECT_NEAR(b.energy(0), before, 1e-12 * (1 + before));
    });
}

// The positive part of J^T D J + K, by another route: where a type has no way of its own it is the nearest such matrix,
// which splits the sum into parts that are orthogonal and of one sign.
TEST_P(EveryElement, SumsArePositiveAndNotBelowTheirParts) {
    for_samples([](const Batch& b) {
        std::vector<double> k(b.kCount * b.width() * b.width());
        positive_sum(b.type, b.view(), b.d(), b.lambda().data(), k.data());
        for (uint32_t i = 0; i < b.kCount; ++i) {
            const Matrix got = Eigen::Map<RowMajor>(&k[i * b.width() * b.width()], b.width(), b.width());
            const Matrix j = b.freedoms(b.of(i).jacobian(), false);
            const Matrix sum =
                j.transpose() * b.d_of(i) * j + symmetric(b.freedoms(b.of(i).stiffness(Curvature::raw), true));
            const double scale = 1 + largest(sum);
            EXPECT_LE(largest(got - got.transpose()), 1e-12 * scale);
            EXPECT_GE(least_eigenvalue(symmetric(got)), -1e-11 * scale);
            EXPECT_GE(least_eigenvalue(symmetric(got - sum)), -1e-11 * scale);
            if (!b.type.hessian) {
                EXPECT_LE(largest(got * (got - sum)), 1e-10 * scale * scale);
            }
        }
    });
}

TEST_P(EveryElement, StaysFiniteWhereItDegenerates) {
    for (const double force : {0.0, 1.0, -1.0, 1e12, -1e12}) {
        Batch b(*GetParam(), 3);
        std::fill(b.pose.begin(), b.pose.end(), b.pose[0]);
        std::vector<double> lambda(b.lambda().size(), force), k(b.kCount * b.width() * b.width());
        positive_sum(b.type, b.view(), b.d(), lambda.data(), k.data());
        for (const double each : k) EXPECT_TRUE(std::isfinite(each));
        for (uint32_t i = 0; i < b.kCount; ++i) EXPECT_TRUE(std::isfinite(b.energy(i)));
    }
}

}  // namespace
}  // namespace taut::test
