// What each constraint type says about itself, against finite differences of its error: any new type in the list is
// tested without a line here.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "instance.h"

namespace taut::test {
namespace {

constexpr uint64_t kSamples = 300;

class EveryConstraint : public testing::TestWithParam<const ConstraintType*> {
protected:
    // Calls check(instance, seed) on random instances until one fails.
    template <class Check>
    void for_samples(Check check) {
        for (uint64_t seed = 1; seed <= kSamples && !HasFailure(); ++seed) {
            SCOPED_TRACE(testing::Message() << GetParam()->name << ", seed " << seed);
            check(Instance(*GetParam(), seed));
        }
    }
};

INSTANTIATE_TEST_SUITE_P(List, EveryConstraint, testing::ValuesIn(constraint_types().begin(), constraint_types().end()),
                         [](const auto& param) { return std::string(param.param->name); });

TEST_P(EveryConstraint, KeepsItsContract) {
    const ConstraintType& type = *GetParam();
    EXPECT_TRUE(type.rows >= 1 && type.rows <= kMaxRows) << type.rows;
    EXPECT_EQ(type.angular >> type.rows, 0);
    EXPECT_TRUE(type.nodes >= 1 && type.nodes <= kMaxNodes) << type.nodes;
    EXPECT_TRUE(type.bound != Bound::cone || type.rows == 3);
    for (const ConstraintType* other : constraint_types())
        EXPECT_EQ(other == &type, std::string(other->name) == type.name);
}

TEST_P(EveryConstraint, SamplesFollowTheirSeed) {
    const Instance one(*GetParam(), 7), same(*GetParam(), 7), other(*GetParam(), 8);
    EXPECT_EQ(one.error(), same.error());
    EXPECT_EQ(one.jacobian(), same.jacobian());
    EXPECT_NE(one.jacobian(), other.jacobian());
}

TEST_P(EveryConstraint, JacobianMatchesFiniteDifferencesOfTheError) {
    for_samples([](const Instance& at) {
        const Matrix j = at.jacobian(), d = derivative(at, [](const Instance&i) { return i.error(); });
        EXPECT_LE(largest(j - d), 1e-8 * (1 + largest(j))) << "J\n" << j << "\nby differences\n" << d;
    });
}

TEST_P(EveryConstraint, ErrorIsTheSameWithAndWithoutJacobian) {
    for_samples([](const Instance& at) {
        Vector c(at.type.rows);
        std::vector<double> j(static_cast<size_t>(at.type.nodes * at.type.rows * kDof));
        at.type.evaluate(at.data.data(), at.pose.data(), c.data(), j.data());
        EXPECT_EQ(c, at.error());
    });
}

// K = -d(J^T lambda)/dx
TEST_P(EveryConstraint, RawStiffnessMatchesFiniteDifferencesOfTheForce) {
    for_samples([](const Instance& at) {
        const Matrix k = at.stiffness(Curvature::raw);
        const Matrix d =
            -derivative(at, [](const Instance& i) -> Vector { return i.jacobian().transpose() * i.lambda; });
        EXPECT_LE(largest(k - d), 1e-8 * (1 + largest(k))) << "K\n" << k << "\nby differences\n" << d;
    });
}

// Exact stiffness is linear in the force.
TEST_P(EveryConstraint, RawStiffnessIsLinearInTheForce) {
    for_samples([](const Instance& at) {
        Instance sum = at, other(at);
        other.lambda = Vector::LinSpaced(at.type.rows, 3, -5);
        sum.lambda = at.lambda - 2 * other.lambda;
        const Matrix k = sum.stiffness(Curvature::raw);
        const Matrix expected = at.stiffness(Curvature::raw) - 2 * other.stiffness(Curvature::raw);
        EXPECT_LE(largest(k - expected), 1e-13 * (1 + largest(expected)));
    });
}

TEST_P(EveryConstraint, PositiveStiffnessScalesWithTheSizeOfTheForce) {
    for_samples([](const Instance& at) {
        Instance twice = at;
        twice.lambda *= 2;
        const Matrix k = at.stiffness(Curvature::positive);
        EXPECT_LE(largest(twice.stiffness(Curvature::positive) - 2 * k), 1e-12 * (1 + largest(k)));
    });
}

// A type that says so has blocks of a node with itself only, and then of its rotation only; a direct solve stores no
// others.
TEST_P(EveryConstraint, CouplesNodesOnlyIfItSaysSo) {
    if (GetParam()->couples_nodes) {
        const Instance pulled = [&] {  // in tension
            Instance i(*GetParam(), 1);
            i.lambda.setConstant(-1);
            return i;
        }();
        Matrix k = pulled.stiffness(Curvature::positive);
        for (int n = 0; n < GetParam()->nodes; ++n) k.block<kDof, kDof>(kDof * n, kDof * n).setZero();
        EXPECT_GT(largest(k), 0);
        return;
    }
    for_samples([](const Instance& at) {
        for (Curvature part : {Curvature::raw, Curvature::positive}) {
            Matrix k = at.stiffness(part);
            for (int n = 0; n < at.type.nodes; ++n) k.block<3, 3>(kDof * n + 3, kDof * n + 3).setZero();
            EXPECT_EQ(largest(k), 0);
        }
    });
}

TEST_P(EveryConstraint, PositiveStiffnessIsSymmetricAndPositive) {
    for_samples([](const Instance& at) {
        const Matrix k = at.stiffness(Curvature::positive);
        const double scale = 1e-300 + largest(k);
        EXPECT_LE(largest(k - k.transpose()), 1e-14 * scale);
        EXPECT_GE(least_eigenvalue(symmetric(k)), -1e-12 * scale) << k;
    });
}

// Less than the exact stiffness would leave a substep unstable (study/damping.md, section 3: under-estimated K).
TEST_P(EveryConstraint, PositiveStiffnessIsNeverBelowTheExactOne) {
    for_samples([](const Instance& at) {
        const Matrix raw = symmetric(at.stiffness(Curvature::raw)), k = at.stiffness(Curvature::positive);
        EXPECT_GE(least_eigenvalue(symmetric(k) - raw), -1e-12 * (1 + largest(raw))) << "K\n"
                                                                                     << k << "\nexact\n"
                                                                                     << raw;
    });
}

// Where each node has one lever, the closed form is the exact positive part.
TEST_P(EveryConstraint, PositiveStiffnessOfSingleLeversIsExact) {
    if (GetParam()->couples_nodes) GTEST_SKIP() << "a sum of several parts, which only dominates";
    for_samples([](const Instance& at) {
        const Matrix raw = symmetric(at.stiffness(Curvature::raw)), k = at.stiffness(Curvature::positive);
        for (int n = 0; n < at.type.nodes; ++n) {
            const Matrix block = raw.block<kDof, kDof>(kDof * n, kDof * n);
            EXPECT_LE(largest(k.block<kDof, kDof>(kDof * n, kDof * n) - positive_part(block)),
                      1e-11 * (1 + largest(block)));
        }
    });
}

// All bytes zero are data with zero levers; equal poses then let the points coincide.
TEST_P(EveryConstraint, StaysFiniteWhereItDegenerates) {
    const ConstraintType& type = *GetParam();
    for (int kind = 0; kind < 4; ++kind) {
        for (double force : {0.0, 1.0, -1.0, 1e-200, 1e12, -1e12}) {
            SCOPED_TRACE(testing::Message() << type.name << ", data " << (kind & 1 ? "zero" : "random") << ", poses "
                                            << (kind & 2 ? "equal" : "random") << ", force " << force);
            Instance at(type, 3);
            if (kind & 1) std::fill(at.data.begin(), at.data.end(), static_cast<unsigned char>(0));
            if (kind & 2) at.pose.fill(at.pose[0]);
            at.lambda.setConstant(force);
            EXPECT_TRUE(at.error().allFinite());
            EXPECT_TRUE(at.jacobian().allFinite());
            EXPECT_TRUE(at.stiffness(Curvature::raw).allFinite());
            const Matrix k = at.stiffness(Curvature::positive);
            ASSERT_TRUE(k.allFinite());
            EXPECT_GE(least_eigenvalue(symmetric(k)), -1e-12 * (1e-300 + largest(k)));
            EXPECT_TRUE(force != 0 || largest(k) == 0);
        }
    }
}

}  // namespace
}  // namespace taut::test
