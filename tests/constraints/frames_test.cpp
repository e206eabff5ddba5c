// Joints between frames against answers found without them: rotations put together by hand, the ball joint, singular
// poses.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "constraints/ball.h"
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"
#include "instance.h"

namespace taut::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kFrameSamples = 300;

const ConstraintType* const kFrameTypes[] = {&kFixed,     &kHinge,     &kSlider, &kCylindrical,
                                             &kUniversal, &kConeTwist, &kSixDof, &kWheel};

// Coordinates of a type where frame b is turned by a_from_b and shifted by offset [m] in frame a, wherever a is.
Vector coordinates(const ConstraintType& type, const Mat3& a_from_b, const Vec3& offset = Vec3::Zero(),
                   uint64_t seed = 1) {
    Random random(seed);
    Instance at(type, 1);
    sample_frames(random, a_from_b, at.data.data(), at.pose.data());
    const auto& joint = *reinterpret_cast<const JointFrames*>(at.data.data());
    const Vec3 anchor = at.pose[0].x + at.pose[0].R * joint.anchor_a;
    const Vec3 world_offset = at.pose[0].R * (joint.frame_a * offset);
    at.pose[1].x = anchor + world_offset - at.pose[1].R * joint.anchor_b;
    return at.error();
}

// The angle's own matrices, not those of the library.
Mat3 rotation(int axis, double angle) { return Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix(); }

// Rows 0-2 along a's axes.
bool slides(const ConstraintType& type) {
    return &type == &kSlider || &type == &kCylindrical || &type == &kSixDof || &type == &kWheel;
}
// Axes of both ends are held square to each other.
bool has_cross(const ConstraintType& type) { return &type == &kUniversal || &type == &kWheel; }

class EveryFrameType : public testing::TestWithParam<const ConstraintType*> {};
INSTANTIATE_TEST_SUITE_P(List, EveryFrameType, testing::ValuesIn(kFrameTypes),
                         [](const auto& param) { return std::string(param.param->name); });

TEST_P(EveryFrameType, IsZeroWhereTheFramesCoincide) {
    const int rows = GetParam() == &kConeTwist ? 5 : GetParam()->rows;  // without a swing it has no direction
    for (uint64_t seed = 1; seed <= 50; ++seed)
        EXPECT_LE(coordinates(*GetParam(), Mat3::Identity(), Vec3::Zero(), seed).head(rows).norm(), 4e-15);
}

TEST_P(EveryFrameType, DoesNotDependOnWhereThePairIs) {
    Random random(3);
    for (int i = 0; i < kFrameSamples; ++i) {
        Instance at(*GetParam(), static_cast<uint64_t>(i));
        const Vector before = at.error();
        const Mat3 turn = random.rotation().toRotationMatrix();
        for (Pose& x : at.pose) x = {turn * x.x + Vec3(3, -2, 1), turn * x.R};
        Vector after = at.error();
        if (!slides(at.type)) after.head<3>() = (turn.transpose() * after.head<3>()).eval();
        EXPECT_LE((after - before).norm(), 1e-13);
    }
}

// No force on the pair from within.
TEST_P(EveryFrameType, ForcesAndMomentsAreEqualAndOpposite) {
    for (uint64_t seed = 1; seed <= kFrameSamples; ++seed) {
        const Instance at(*GetParam(), seed);
        const Vector force = at.jacobian().transpose() * at.lambda;
        const Vec3 fa = force.segment<3>(0), fb = force.segment<3>(6);
        const Vec3 moment = force.segment<3>(3) + force.segment<3>(9) + at.pose[0].x.cross(fa) + at.pose[1].x.cross(fb);
        EXPECT_LE((fa + fb).norm(), 1e-13);
        if (slides(at.type))
            EXPECT_LE(moment.norm(), 1e-11);
        else {  // anchors apart: the force has an arm
            const Vec3 d = at.error().head<3>();
            EXPECT_LE((moment - d.cross(Vec3(at.lambda.head<3>()))).norm(), 1e-11);
        }
    }
}

// The bound is not wild: the price of closed forms, row by row, and of one length that weighs slide against rotation.
// Anchors are within half a metre of each other, as those of a slide are.
TEST_P(EveryFrameType, PositiveStiffnessIsOfTheOrderOfTheExactOne) {
    double worst = 0;
    for (uint64_t seed = 1; seed <= kFrameSamples; ++seed) {
        Instance at(*GetParam(), seed);
        const auto& joint = *reinterpret_cast<const JointFrames*>(at.data.data());
        const Vec3 anchor = at.pose[0].x + at.pose[0].R * joint.anchor_a;
        at.pose[1].x = anchor + 0.3 * Random(seed).vector() - at.pose[1].R * joint.anchor_b;
        const Eigen::SelfAdjointEigenSolver<Matrix> exact(symmetric(at.stiffness(Curvature::raw)));
        const Eigen::SelfAdjointEigenSolver<Matrix> bound(symmetric(at.stiffness(Curvature::positive)));
        worst = std::max(worst, bound.eigenvalues().maxCoeff() / exact.eigenvalues().cwiseAbs().maxCoeff());
    }
    // Those of a cone's swing and its direction, which are held one by one, cancel in part.
    EXPECT_LE(worst, slides(*GetParam()) || GetParam() == &kConeTwist ? 4 : 2);
}

// Anchor rows are a ball joint: a chain's tension is as stiff whatever joints it is made of.
TEST_P(EveryFrameType, TensionIsThatOfTheBallJoint) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        Instance at(*GetParam(), seed), ball(kBall, seed);
        const auto& joint = *reinterpret_cast<const JointFrames*>(at.data.data());
        *reinterpret_cast<BallData*>(ball.data.data()) = {joint.anchor_a, joint.anchor_b};
        ball.pose = at.pose;
        at.lambda.setZero();
        at.lambda.head<3>() = ball.lambda;
        if (slides(at.type)) {  // closed, and the same force in axes of a
            const Vec3 d = ball.error();
            at.pose[1].x -= d;
            ball.pose[1].x -= d;
            at.lambda.head<3>() = (at.pose[0].R * joint.frame_a.toRotationMatrix()).transpose() * ball.lambda;
        }
        const Matrix difference = at.stiffness(Curvature::positive) - ball.stiffness(Curvature::positive);
        if (!slides(at.type)) {
            EXPECT_EQ(largest(difference), 0);
            continue;
        }
        // Motions that keep the offset at zero: z = y + ...; what is left is the rotation's part of the coupling.
        const Matrix j = at.jacobian().topRows(3);
        const Eigen::FullPivLU<Matrix> lu(j);
        const Matrix free = lu.kernel();
        const Matrix left = free.transpose() * difference * free;
        const Mat3 turned = hat(ball.lambda) / std::sqrt(Vec3(ball.lambda).norm());
        const Matrix rotation_of_a = free.middleRows(3, 3);
        const Matrix expected = 0.25 * (turned * rotation_of_a).transpose() * (turned * rotation_of_a);
        EXPECT_LE(largest(left - expected), 1e-11);
    }
}

// Singular poses: opposed and parallel axes, the Cardan lock, and just beside them.
TEST_P(EveryFrameType, StaysFiniteAtAndBesideItsSingularPoses) {
    for (int axis = 0; axis < 3; ++axis)
        for (int other = 0; other < 3; ++other)
            for (double angle : {0.0, kPi / 2, -kPi / 2, kPi, -kPi})
                for (double beside : {0.0, 1e-300, 1e-16, 1e-13, 1e-12, 1e-9, 1e-6, 1e-4, -1e-7}) {
                    Random random(2);
                    Instance at(*GetParam(), 5);
                    sample_frames(random, rotation(axis, angle) * rotation(other, beside), at.data.data(),
                                  at.pose.data());
                    EXPECT_TRUE(at.error().allFinite());
                    ASSERT_TRUE(at.jacobian().allFinite());
                    EXPECT_LE(largest(at.jacobian()), 1e6);
                    EXPECT_TRUE(at.stiffness(Curvature::raw).allFinite());
                    const Matrix k = at.stiffness(Curvature::positive);
                    ASSERT_TRUE(k.allFinite());
                    EXPECT_GE(least_eigenvalue(symmetric(k)), -1e-12 * largest(k));
                    if (&at.type != &kConeTwist && &at.type != &kSixDof) continue;
                    for (int r = 3; r < at.type.rows; ++r)  // no row without a motion that answers it
                        EXPECT_GE(at.jacobian().row(r).norm(), 0.5)
                            << "row " << r << ", axes " << axis << other << ", angle " << angle << " + " << beside;
                }
}

// Angles that grow up to half a turn: no turn but none is zero.
double four_tangents(double angle) { return 4 * std::tan(angle / 4); }

// Opposed frames, exactly and nearly, are as far off as can be: a joint that was torn there is pulled back.
TEST_P(EveryFrameType, IsFarFromZeroWhereTheFramesOpposeEachOther) {
    if (has_cross(*GetParam())) GTEST_SKIP() << "its axes stay square when both of them turn over";
    for (int axis = 1; axis < 3; ++axis)
        for (int other = 0; other < 3; ++other)
            for (double beside : {0.0, 1e-300, 1e-16, 1e-9, 1e-5, 1e-3, -1e-7}) {
                const Vector c = coordinates(*GetParam(), rotation(axis, kPi) * rotation(other, beside));
                EXPECT_GE(c.tail(GetParam()->rows - 3).norm(), kPi - 0.01) << axis << other << " " << beside;
            }
}

// Near half a turn, where angles change their sign, or near a lock.
bool jumps(const Instance& at) {
    const Vector angles = at.error().tail(at.type.rows - 3);
    if (&at.type == &kFixed || &at.type == &kSlider) return angles.norm() > 3.9;
    if (has_cross(at.type)) return std::abs(angles[0]) > 1.4 || angles.cwiseAbs().maxCoeff() > 3.1;
    return &at.type == &kSixDof && (std::abs(angles[1]) > 1.4 || angles.cwiseAbs().maxCoeff() > 3.1);
}

// The samples of the list end at a right angle.
TEST_P(EveryFrameType, DerivativesHoldFarFromAligned) {
    Random random(11);
    for (double off : {1.7, 2.4, 2.9, 3.054})
        for (int i = 0; i < 40; ++i) {
            Instance at(*GetParam(), 1);
            const Mat3 turned = swing_after_twist(off, random.between(-3, 3), random.between(-2.5, 2.5));
            sample_frames(random, turned, at.data.data(), at.pose.data());
            if (jumps(at)) continue;
            const Matrix j = at.jacobian(), by_j = derivative(at, [](const Instance&x) { return x.error(); });
            ASSERT_LE(largest(j - by_j), 1e-6 * largest(j)) << off << "\n" << j << "\n\n" << by_j;
            const Matrix k = at.stiffness(Curvature::raw);
            const Matrix by_k =
                -derivative(at, [](const Instance& x) -> Vector { return x.jacobian().transpose() * x.lambda; });
            ASSERT_LE(largest(k - by_k), 1e-6 * largest(k)) << off << "\n" << k << "\n\n" << by_k;
            const Matrix bound = at.stiffness(Curvature::positive);
            EXPECT_GE(least_eigenvalue(symmetric(bound) - symmetric(k)), -1e-10 * largest(k));
        }
}

TEST(Fixed, MisalignmentIsAlongTheAxisAndTheRotationVectorToFirstOrder) {
    Random random(1);
    for (int i = 0; i < kFrameSamples; ++i) {
        const Vec3 axis = random.vector().normalized();
        const double angle = random.between(0, kPi);
        const Vec3 offset = random.vector();
        for (const ConstraintType* type : {&kFixed, &kSlider}) {
            const Vector c = coordinates(*type, Eigen::AngleAxisd(angle, axis).toRotationMatrix(), offset);
            EXPECT_LE((Vec3(c.tail<3>()) - four_tangents(angle) * axis).norm(), 4e-15 / std::max(1e-3, kPi - angle));
            EXPECT_NEAR(c.head<3>().norm(), offset.norm(), 1e-14);
        }
    }
}

// Steering and spin are read apart, and the axle's camber is the third angle, whatever the others are.
TEST(Wheel, AnglesAreThoseOfSteeringCamberAndSpin) {
    for (const double steering : {-2.5, -0.4, 0.0, 0.7})
        for (const double camber : {-0.5, 0.0, 0.2})
            for (const double spin : {-3.1, -1.6, 0.0, 0.3, 1.5707963, 2.9}) {
                const Vec3 offset(0.3, -0.1, 0.2);
                const Vector c =
                    coordinates(kWheel, rotation(0, steering) * rotation(2, camber) * rotation(1, spin), offset);
                EXPECT_LE((c.head<3>() - offset).norm(), 1e-14);
                EXPECT_NEAR(c[3], -camber, 1e-14);
                EXPECT_NEAR(c[4], steering, 1e-14);
                EXPECT_NEAR(c[5], spin, 1e-14);
            }
}

TEST(Hinge, AngleIsTheTurnAboutItsAxis) {
    for (double angle = -3.1; angle <= 3.1; angle += 0.1)
        for (const ConstraintType* type : {&kHinge, &kCylindrical}) {
            const Vector c = coordinates(*type, rotation(0, angle), Vec3(0.3, 0, 0));
            EXPECT_NEAR(c[5], angle, 1e-14);
            EXPECT_LE(c.segment<2>(3).norm(), 1e-14);
        }
    EXPECT_NEAR(std::abs(coordinates(kHinge, rotation(0, kPi))[5]), kPi, 1e-14);
}

TEST(Hinge, MisalignmentsAreTheTiltOfTheAxis) {
    for (double tilt : {-0.3, 1e-6, 0.2, 1.9, -3.0, 3.12})
        for (const ConstraintType* type : {&kHinge, &kCylindrical}) {
            EXPECT_NEAR(coordinates(*type, rotation(2, tilt) * rotation(0, 1.1))[3], four_tangents(tilt), 1e-13);
            EXPECT_NEAR(coordinates(*type, rotation(1, tilt) * rotation(0, 1.1))[4], -four_tangents(tilt), 1e-13);
        }
}

// A hinge that is held on its axis and turned by its rate: dC = w . X.
TEST(Hinge, RateIsTheAngularVelocityAboutTheAxis) {
    Random random(4);
    Instance at(kHinge, 1);
    sample_frames(random, rotation(0, 1.2), at.data.data(), at.pose.data());
    const auto& joint = *reinterpret_cast<const JointFrames*>(at.data.data());
    const Vec3 axis = at.pose[0].R * (joint.frame_a * Vec3::UnitX());
    EXPECT_LE((at.jacobian().row(5).segment<3>(9).transpose() - axis).norm(), 1e-14);
}

TEST(Slider, CoordinatesAreTheOffsetInFrameA) {
    Random random(5);
    for (int i = 0; i < kFrameSamples; ++i) {
        const Vec3 offset = 3 * random.vector();
        const Mat3 turned = random.rotation().toRotationMatrix();
        for (const ConstraintType* type : {&kSlider, &kCylindrical, &kSixDof})
            EXPECT_LE((Vec3(coordinates(*type, turned, offset).head<3>()) - offset).norm(), 1e-14);
    }
}

TEST(Universal, AnglesAreThoseOfTheCross) {
    for (double first = -3; first <= 3; first += 0.5)
        for (double last = -3; last <= 3; last += 0.5)
            for (double cross : {0.0, 0.4, -1.0}) {
                const Vector c = coordinates(kUniversal, rotation(0, first) * rotation(2, cross) * rotation(1, last));
                EXPECT_NEAR(c[3], -cross, 1e-14);
                EXPECT_NEAR(c[4], first, 1e-14);
                EXPECT_NEAR(c[5], last, 1e-14);
            }
}

TEST(ConeTwist, IsTheSwingTwistDecomposition) {
    Random random(6);
    for (int i = 0; i < kFrameSamples; ++i) {
        const double swing = random.between(0, 3), direction = random.between(-kPi, kPi),
                     twist = random.between(-3.1, 3.1);
        const Vec3 across(0, std::cos(direction), std::sin(direction));
        const Mat3 turned = Eigen::AngleAxisd(swing, across).toRotationMatrix() * rotation(0, twist);
        const Vector c = coordinates(kConeTwist, turned);
        EXPECT_NEAR(c[3], swing, 1e-13);
        EXPECT_NEAR(c[4], twist, 1e-12);
        const double azimuth = std::atan2(-std::cos(direction), std::sin(direction));  // a right angle from its axis
        EXPECT_NEAR(std::remainder(c[5] - azimuth, 2 * kPi), 0, 1e-12 / std::max(1e-3, swing));
        const Quat q(turned);  // the decomposition's usual form
        EXPECT_NEAR(std::remainder(2 * std::atan2(q.x(), q.w()) - c[4], 2 * kPi), 0, 1e-12);
    }
}

TEST(ConeTwist, SwingHasAUnitGradientWhereItIsZero) {
    Random random(7);
    Instance at(kConeTwist, 1);
    sample_frames(random, Mat3::Identity(), at.data.data(), at.pose.data());
    const Vec3 b = at.jacobian().row(3).segment<3>(9), a = at.jacobian().row(3).segment<3>(3);
    EXPECT_NEAR(b.norm(), 1, 1e-12);
    EXPECT_EQ(a, Vec3(-b));
}

TEST(SixDof, CardanAnglesRecomposeTheRotation) {
    Random random(8);
    for (int i = 0; i < kFrameSamples; ++i) {
        const Mat3 turned = random.rotation().toRotationMatrix();
        const Vector c = coordinates(kSixDof, turned);
        EXPECT_LE((rotation(0, c[3]) * rotation(1, c[4]) * rotation(2, c[5]) - turned).norm(), 1e-12);
        EXPECT_LE(std::abs(c[4]), kPi / 2);
    }
    for (double middle : {-1.5, -0.7, 0.0, 1.5}) {
        const Vector c = coordinates(kSixDof, rotation(0, -2.0) * rotation(1, middle) * rotation(2, 3.0));
        EXPECT_LE((c.tail<3>() - Vec3(-2, middle, 3)).norm(), 1e-12);
    }
}

// All about X at once is a turn of the hinge, the universal's first angle, the twist and the first Cardan angle.
TEST(Frames, AgreeOnTheTurnAboutTheirMainAxis) {
    for (double angle : {-3.0, -0.4, 1e-9, 2.2}) {
        const Mat3 turned = rotation(0, angle);
        EXPECT_NEAR(coordinates(kHinge, turned)[5], angle, 1e-14);
        EXPECT_NEAR(coordinates(kUniversal, turned)[4], angle, 1e-14);
        EXPECT_NEAR(coordinates(kConeTwist, turned)[4], angle, 1e-14);
        EXPECT_NEAR(coordinates(kSixDof, turned)[3], angle, 1e-14);
    }
}

TEST(Spread, IsTheExactPositivePart) {
    Random random(9);
    for (int i = 0; i < kFrameSamples; ++i) {
        const Vec3 u = 5 * random.vector(), v = i % 7 ? random.vector() : Vec3((i % 2 ? 2 : -2) * u);
        const Matrix raw = spread(u, v, Curvature::raw);
        EXPECT_LE(largest(spread(u, v, Curvature::positive) - positive_part(raw)), 1e-13 * (1 + largest(raw)));
    }
    EXPECT_EQ(spread(Vec3::Zero(), Vec3::Ones(), Curvature::positive), Mat3(Mat3::Zero()));
}

TEST(Dyad, IsTheExactPositivePart) {
    Random random(9);
    for (int i = 0; i < kFrameSamples; ++i) {
        const Vec3 u = 5 * random.vector(), v = i % 7 ? random.vector() : Vec3((i % 2 ? 2 : -2) * u);
        const Matrix raw = dyad(u, v, Curvature::raw);
        EXPECT_LE(largest(dyad(u, v, Curvature::positive) - positive_part(raw)), 1e-13 * (1 + largest(raw)));
    }
    EXPECT_EQ(dyad(Vec3::Zero(), Vec3::Ones(), Curvature::positive), Mat3(Mat3::Zero()));
}

// A torque that turns with its bodies, and nothing else: the bound is the exact positive part.
TEST(Hinge, DrivingTorqueIsBoundedExactly) {
    Random random(10);
    Instance at(kHinge, 1);
    sample_frames(random, rotation(0, 0.8), at.data.data(), at.pose.data());
    at.lambda << 0, 0, 0, 0, 0, 7;
    const Matrix raw = symmetric(at.stiffness(Curvature::raw));
    EXPECT_LE(largest(at.stiffness(Curvature::positive) - positive_part(raw)), 1e-12);
    EXPECT_NEAR(largest(raw), 3.5, 1.5);
}

}  // namespace
}  // namespace taut::test
