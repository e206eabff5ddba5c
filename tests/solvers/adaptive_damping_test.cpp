// The size of geometric stiffness: as large as the exact one in every direction, blind to the force's sign.
#include "solvers/adaptive_damping.h"

#include <gtest/gtest.h>

#include "constraints/instance.h"

namespace taut::test {
namespace {

Matrix size_of_stiffness(const Instance& at, double sign = 1) {
    RowMajor k(at.coordinates(), at.coordinates());
    k.setConstant(1e300);  // must be overwritten
    const Vector force = sign * at.lambda;
    stiffness_magnitude(at.type, at.data.data(), at.pose.data(), force.data(), k.data());
    return k;
}

class SizeOfStiffness : public testing::TestWithParam<const ConstraintType*> {
protected:
    template <class Check>
    static void for_instances(Check&& check) {
        for (uint64_t seed = 1; seed <= 40; ++seed) {
            SCOPED_TRACE(seed);
            check(Instance(*GetParam(), seed));
        }
    }
};

TEST_P(SizeOfStiffness, IsSymmetricPositiveAndBlindToTheForcesSign) {
    for_instances([](const Instance& at) {
        const Matrix k = size_of_stiffness(at);
        const double scale = 1 + k.cwiseAbs().maxCoeff();
        EXPECT_LE((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-12 * scale);
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(k).eigenvalues()[0], -1e-7 * scale);
        EXPECT_LE((k - size_of_stiffness(at, -1)).cwiseAbs().maxCoeff(), 1e-12 * scale);
    });
}

// Of levers |K| x is as long as K x; where nodes are coupled x.|K| x is at least |x.K x|.
TEST_P(SizeOfStiffness, IsNoSmallerThanTheExactOneInAnyDirection) {
    for_instances([](const Instance& at) {
        const Matrix raw = at.stiffness(Curvature::raw), k = size_of_stiffness(at);
        std::mt19937_64 engine(7);
        std::uniform_real_distribution<double> number(-1, 1);
        for (int i = 0; i < 20; ++i) {
            Vector x(at.coordinates());
            for (double& value : x) value = number(engine);
            const double tolerance = 1e-7 * (1 + raw.norm());
            if (at.type.couples_nodes)
                EXPECT_GE(x.dot(k * x), std::abs(x.dot(raw * x)) - tolerance);
            else
                EXPECT_NEAR((k * x).norm(), (raw * x).norm(), tolerance);
        }
    });
}

TEST_P(SizeOfStiffness, LetsANodePairMoveTogether) {
    for_instances([](const Instance& at) {
        Vector together = Vector::Zero(at.coordinates());
        for (int n = 0; n < at.type.nodes; ++n) together.segment<3>(kDof * n) = Vec3(1, -2, 3);
        const Matrix k = size_of_stiffness(at);
        EXPECT_LE((k * together).norm(), 1e-7 * (1 + k.norm()));
    });
}

INSTANTIATE_TEST_SUITE_P(Types, SizeOfStiffness,
                         testing::ValuesIn(constraint_types().begin(), constraint_types().end()),
                         [](const auto& tested) { return std::string(tested.param->name); });

}  // namespace
}  // namespace taut::test
