// Free spin over a substep, against the equation that it solves and against what a free body keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/motion_rig.h"
#include "starts.h"

namespace taut::test {
namespace {

// A body of random principal moments, in its principal axes or turned out of them.
class RandomSpin : public testing::TestWithParam<uint32_t> {
protected:
    RandomSpin() : engine_(GetParam()) {
        const double a = std::exp(number_(engine_)), b = std::exp(number_(engine_));
        const double share = std::uniform_real_distribution<double>(0.1, 0.9)(engine_);
        const Vec3 moments(a, b, std::abs(a - b) + share * (a + b - std::abs(a - b)));  // any body keeps the triangle
        inertia_ = moments.asDiagonal();
        if (GetParam() % 2) {
            const Mat3 R = Quat(random(), random(), random(), random()).normalized().toRotationMatrix();
            inertia_ = R * inertia_ * R.transpose();
        }
        mass_.inertia = Sym3::of(inertia_);
        mass_.inv_inertia = Sym3::of(inertia_.inverse());
        direction_ = Vec3(random(), random(), random()).normalized();
    }
    double random() { return number_(engine_); }
    // In the place of a batch, beside one that spins at `beside`.
    Vec3 after_step(const Vec3& before, int place = 0, const Vec3& beside = Vec3::Zero(), bool damped = false) const {
        MotionRig rig;
        for (int i = 0; i < kBodies; ++i) {
            rig.set_mass(i, mass_);
            put(i == place ? before : beside, rig.motion[i].w);
        }
        rig.predict(motion_kernels(), kStep, 0b1111, damped ? 0b1111 : 0);
        const Vec3 predicted = vector_of(rig.velocity[place].angular);
        return damped ? predicted : Vec3(2 * predicted - before);  // of those not damped the mean of the two
    }

    static constexpr double kStep = 1.0 / 240;
    NodeMass mass_;
    Mat3 inertia_;
    Vec3 direction_;

private:
    std::mt19937 engine_;
    std::normal_distribution<double> number_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, RandomSpin, testing::Range(1u, 1 + starts(200u)));

// From a millionth of a radian in a substep to a tenth.
TEST_P(RandomSpin, SolvesTheMidpointRuleAndKeepsEnergyAndMomentum) {
    for (double turn = 1e-6; turn < 0.2; turn *= 10) {
        const Vec3 before = turn / kStep * direction_, after = after_step(before);
        const Vec3 middle = 0.5 * (before + after), momentum = inertia_ * before;
        const double step = 2 * std::tan(0.5 * turn) / turn * kStep;  // whose rule turns as exp(h m) does
        const Vec3 residual = inertia_ * (after - before) + step * middle.cross(Vec3(inertia_ * middle));
        EXPECT_LE(residual.norm(), 2e-10 * momentum.norm()) << turn;
        EXPECT_NEAR((inertia_ * after).norm() / momentum.norm(), 1, 1e-9) << turn;
        EXPECT_NEAR(after.dot(inertia_ * after) / before.dot(momentum), 1, 1e-9) << turn;
    }
}

// Where a substep turns it by radians, one of the two is kept and the other does not rise.
TEST_P(RandomSpin, KeepsEnergyOrMomentumAtAnySpeed) {
    for (double turn = 0.1; turn < 100; turn *= 1.5) {
        const Vec3 before = turn / kStep * direction_, after = after_step(before);
        const double energy = after.dot(inertia_ * after) / before.dot(inertia_ * before);
        const double momentum = (inertia_ * after).norm() / (inertia_ * before).norm();
        EXPECT_NEAR(std::max(energy, momentum), 1, 1e-5) << turn << ": " << energy << ", " << momentum;
    }
}

TEST_P(RandomSpin, LosesEnergyWhereDamped) {
    for (double turn = 1e-6; turn < 100; turn *= turn < 0.1 ? 10 : 1.5) {
        const Vec3 before = turn / kStep * direction_, after = after_step(before, 0, Vec3::Zero(), true);
        EXPECT_LE(after.dot(inertia_ * after), before.dot(inertia_ * before) * (1 + 1e-12)) << turn;
    }
}

// Nothing of a body tells on those beside it, not even how fast they are, and one at rest stays.
TEST_P(RandomSpin, DoesNotDependOnWhoIsBesideIt) {
    for (double turn = 1e-6; turn < 100; turn *= 3) {
        const Vec3 before = turn / kStep * direction_, alone = after_step(before);
        for (const double beside : {0.0, 1e-9 * turn, turn, 1e3 * turn, 1e200})
            for (int place = 0; place < kBodies; ++place)
                EXPECT_EQ(after_step(before, place, beside * Vec3(random(), random(), random())), alone)
                    << turn << " beside " << beside;
        EXPECT_EQ(after_step(Vec3::Zero(), 1, before), Vec3::Zero());
    }
}

}  // namespace
}  // namespace taut::test
