// Motion over a substep against the formulas by Eigen, node by node; both builds give the same bits.
#include "integrate/motion_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "starts.h"
#include "unit/motion_rig.h"

namespace taut::test {
namespace {

constexpr double kStep = 1.0 / 240, kNan = std::numeric_limits<double>::quiet_NaN();

void rotate(const double theta[3], double q[4]) {
    const Quat turn = rotation_from_vector(Vec3(theta[0], theta[1], theta[2]));
    std::copy_n(turn.coeffs().data(), 4, q);
}

// Nodes anywhere, which turn by `turn` a substep or so.
class Motions : public testing::TestWithParam<uint32_t> {
protected:
    Motions() : engine_(GetParam()) {}

    double number() { return number_(engine_); }
    Vec3 vector(double size) { return size * Vec3(number(), number(), number()); }
    Quat turned() { return Quat(number(), number(), number(), number()).normalized(); }
    MotionRig rig(double turn) {
        MotionRig out;
        for (int i = 0; i < kBodies; ++i) {
            MotionRow& m = out.motion[i];
            put(vector(100), m.x);
            put(turned(), m.q);
            for (auto* v : {&m.v, &m.slow_v, &out.velocity[i].linear}) put(vector(10), *v);
            for (auto* w : {&m.w, &m.slow_w, &out.velocity[i].angular}) put(vector(turn / kStep), *w);
            put(vector(1000), out.load[i].linear);
            put(Vec3(vector_of(m.x) + vector(0.1)), out.found[i].x);
            put(Quat(rotation_from_vector(vector(0.03)) * quat_of(m.q)), out.found[i].q);
            put(Vec3(vector_of(m.w) + vector(0.1 * turn / kStep)), out.start[i].angular);
            put(vector_of(m.x), out.pose[i].x);
            const Mat3 R = turned().toRotationMatrix();
            std::copy_n(R.data(), 9, out.pose[i].R);
            NodeMass mass;
            mass.mass = std::exp(number());
            mass.inv_mass = 1 / mass.mass;
            mass.gravity_scale = number();
            const double a = std::exp(number()), b = std::exp(number());
            mass.inertia = Sym3::of(R * Vec3(a, b, 0.9 * (a + b)).asDiagonal() * R.transpose());
            out.set_mass(i, mass);
        }
        return out;
    }

    std::mt19937 engine_;
    std::normal_distribution<double> number_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, Motions, testing::Range(1u, 1 + starts(100u)));

// What the momentum would make of the spin at the end of a substep, and most of its energy, twice, in axes of the body.
struct Ends {
    Mat3 inertia, axes;
    Vec3 momentum;
    double most;

    Ends(const MotionRig& rig, int i, bool damped) {
        const double* const n = rig.mass[i].inertia;
        inertia = Sym3{n[0], n[1], n[2], n[3], n[4], n[5]}.matrix();
        axes = quat_of(rig.motion[i].q).toRotationMatrix();
        const Mat3 from = Eigen::Map<const Mat3>(rig.pose[i].R);
        const auto in_body = [&](const double(&w)[3]) { return Vec3(from.transpose() * vector_of(w)); };
        const Vec3 before = in_body(rig.motion[i].w), free = in_body(rig.start[i].angular);
        const Vec3 solved = in_body(rig.velocity[i].angular), given = inertia * (solved - free), l = inertia * before;
        momentum = axes.transpose() * (from * (l + given));
        if (!damped) momentum += inertia * (2 * free - before) - rotation_from_vector(kStep * free).conjugate() * l;
        const double work = given.dot(free + solved), first = given.dot(2 * before + solved - free);
        most = before.dot(l) + (damped ? std::max(work, std::min(first, 0.0)) : work);
    }
    double energy(const Vec3& w) const { return w.dot(inertia * w); }
};

// The momentum is kept where the energy is no more than the most; else the nearest with that energy, which is along
// the gradient of it: l - I w = mu w, mu > 0.
void expect_kept(const Ends& ends, const Vec3& world) {
    const Vec3 w = ends.axes.transpose() * world, exact = ends.inertia.inverse() * ends.momentum;
    if (ends.energy(exact) <= ends.most) {
        EXPECT_LE((w - exact).norm(), 1e-9 * exact.norm());
        return;
    }
    EXPECT_LE(ends.energy(w), std::max(ends.most, 0.0) + 1e-9 * ends.energy(exact));
    if (ends.most < 0.01 * ends.energy(exact)) return;  // hardly anything is left
    EXPECT_GE(ends.energy(w), 0.98 * ends.most);
    const Vec3 off = ends.momentum - ends.inertia * w;
    EXPECT_GE(off.dot(w), 0.97 * off.norm() * w.norm());
}

constexpr double kTurns[] = {1e-6, 0.01, 0.2, 1, 10};

TEST_P(Motions, PredictsVelocityPoseAndTurn) {
    for (const double turn : kTurns) {
        const MotionRig before = rig(turn);
        const Vec3 gravity = vector(10);
        for (const MotionKernels* kernels : motion_builds()) {
            MotionRig now = before;
            const Bodies far = now.predict(*kernels, kStep, 0, 0, gravity);
            for (int i = 0; i < kBodies; ++i) {
                const MotionRow& m = before.motion[i];
                const MassRow& mass = before.mass[i];
                const Vec3 v = vector_of(m.v) + kStep * (mass.gravity_scale * gravity +
                                                         mass.inv_mass * vector_of(before.load[i].linear));
                EXPECT_EQ(vector_of(now.velocity[i].linear), v);
                EXPECT_EQ(vector_of(now.velocity[i].angular), vector_of(m.w)) << "not turning by itself";
                EXPECT_EQ(vector_of(now.pose[i].x), vector_of(m.x));
                const Mat3 R = quat_of(m.q).toRotationMatrix();
                EXPECT_EQ(Mat3(Eigen::Map<const Mat3>(now.pose[i].R)), R);
                const Vec3 away = (quat_of(m.q) * quat_of(before.found[i].q).conjugate()).vec();
                EXPECT_EQ(far >> i & 1, away.norm() > 0.5 * 0.05);
                EXPECT_EQ(now.sweep[i].velocity.linear[3], static_cast<float>(mass.inv_mass));
                EXPECT_EQ(now.sweep[i].velocity.angular[3], static_cast<float>(mass.inv_mass));
                for (int k = 0; k < 3; ++k) {
                    EXPECT_EQ(now.sweep[i].velocity.linear[k], static_cast<float>(v[k]));
                    EXPECT_EQ(now.sweep[i].velocity.angular[k], static_cast<float>(m.w[k]));
                    EXPECT_EQ(now.sweep_pose[i].linear[k], static_cast<float>(m.x[k] - before.found[i].x[k]));
                }
            }
        }
    }
}

TEST_P(Motions, MovesByItsVelocity) {
    for (const double turn : kTurns) {
        const MotionRig before = rig(turn);
        for (const MotionKernels* kernels : motion_builds()) {
            MotionRig now = before;
            kernels->commit(now.rows(), now.batch, kStep, rotate);
            for (int i = 0; i < kBodies; ++i) {
                const PairRow& u = before.velocity[i];
                const Vec3 x = vector_of(before.motion[i].x) + kStep * vector_of(u.linear);
                const Quat q =
                    (rotation_from_vector(kStep * vector_of(u.angular)) * quat_of(before.motion[i].q)).normalized();
                EXPECT_EQ(vector_of(now.motion[i].x), x);
                EXPECT_LE((quat_of(now.motion[i].q).coeffs() - q.coeffs()).norm(), 4e-16) << turn;
                const Quat dq = q * quat_of(before.found[i].q).conjugate();
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(now.shift[i].linear[k], x[k] - before.found[i].x[k], 1e-7);
                for (int k = 0; k < 4; ++k) EXPECT_NEAR(now.shift[i].angular[k], dq.coeffs()[k], 1e-7);
            }
        }
    }
}

TEST_P(Motions, KeepsTheSolvedVelocity) {
    constexpr double kTurn = 0.05, kKappa = 0.3;
    for (const double turn : kTurns) {
        const MotionRig before = rig(turn);
        const Bodies turning = engine_() % 16, slow = engine_() % 16;
        for (const MotionKernels* kernels : motion_builds()) {
            MotionRig now = before;
            EXPECT_EQ(now.store(*kernels, {kStep, kTurn, kKappa, 1e6, rotate}, turning, slow), 0b1111u);
            for (int i = 0; i < kBodies; ++i) {
                const MotionRow& m = before.motion[i];
                const Vec3 v = vector_of(before.velocity[i].linear), w = vector_of(before.velocity[i].angular);
                const bool turns = (turning >> i & 1) != 0, far = kStep * w.norm() > kTurn;
                const bool is_mean = turns && (slow >> i & 1) == 0;
                const Vec3 near = is_mean ? Vec3(w + (vector_of(before.start[i].angular) - vector_of(m.w))) : w;
                EXPECT_EQ(vector_of(now.motion[i].v), v);
                if (turns && far)
                    expect_kept(Ends(before, i, (slow >> i & 1) != 0), vector_of(now.motion[i].w));
                else
                    EXPECT_EQ(vector_of(now.motion[i].w), near);
                const double kappa = slow >> i & 1 ? kKappa : 1;
                const Vec3 slow_v = vector_of(m.slow_v) + kappa * (v - vector_of(m.slow_v));
                const Vec3 slow_w = vector_of(m.slow_w) + kappa * (w - vector_of(m.slow_w));
                EXPECT_EQ(vector_of(now.motion[i].slow_v), slow_v);
                EXPECT_EQ(vector_of(now.motion[i].slow_w), slow_w);
            }
        }
    }
}

TEST_P(Motions, FindsWhatIsNotSane) {
    const MotionRig before = rig(0.01);
    for (int i = 0; i < kBodies; ++i)
        for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e7})
            for (const MotionKernels* kernels : motion_builds())
                for (int which = 0; which < 4; ++which) {
                    MotionRig now = before;
                    double* const places[] = {&now.velocity[i].linear[1], &now.velocity[i].angular[2],
                                              &now.motion[i].x[0], &now.motion[i].q[2]};
                    *places[which] = bad;
                    const bool position = which >= 2 && bad == 1e7;  // may be as large
                    EXPECT_EQ(now.store(*kernels, {kStep, 0.05, 1, 1e6, rotate}, 0, 0),
                              position ? 0b1111u : 0b1111u & ~(1u << i));
                }
}

template <class T>
bool same(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// All that predict, commit and store leave, of both builds and of fewer nodes, where the last stands for the rest.
TEST_P(Motions, GiveTheSameBitsWhoeverIsBesideThem) {
    for (const double turn : kTurns) {
        const MotionRig before = rig(turn);
        const Vec3 gravity = vector(10);
        const Bodies turning = engine_() % 16, slow = turning & engine_() % 16;
        const auto step = [&](const MotionKernels& kernels, MotionRig& now, Bodies turns, Bodies slows) {
            now.predict(kernels, kStep, turns, slows, gravity);
            kernels.commit(now.rows(), now.batch, kStep, rotate);
            now.store(kernels, {kStep, 0.05, 0.3, 1e6, rotate}, turns, slows);
        };
        MotionRig all = before;
        step(kMotionKernelsBase, all, turning, slow);
        for (const MotionKernels* kernels : motion_builds()) {
            MotionRig now = before;
            step(*kernels, now, turning, slow);
            EXPECT_TRUE(same(now, all)) << turn;
            for (uint32_t i = 0; i < kBodies; ++i) {
                MotionRig alone = before;
                alone.batch = {{i, i, i, i}, {i, i, i, i}, {i, i, i, i}, 1};
                step(*kernels, alone, turning >> i & 1 ? 0b1111 : 0, slow >> i & 1 ? 0b1111 : 0);
                EXPECT_TRUE(same(alone.motion[i], all.motion[i])) << turn;
                EXPECT_TRUE(same(alone.pose[i], all.pose[i]));
                EXPECT_TRUE(same(alone.velocity[i], all.velocity[i]));
                EXPECT_TRUE(same(alone.shift[i], all.shift[i]));
                EXPECT_TRUE(same(alone.sweep[i], all.sweep[i]));
            }
        }
    }
}

// What begin_frame() leaves of nodes that never turn.
void stop_turning(MotionRig& rig) {
    const Mat3 R = Mat3::Identity();
    for (int i = 0; i < kBodies; ++i) {
        for (auto* w : {&rig.motion[i].w, &rig.motion[i].slow_w, &rig.velocity[i].angular, &rig.start[i].angular})
            put(Vec3::Zero(), *w);
        for (auto* q : {&rig.motion[i].q, &rig.found[i].q}) put(Quat(Quat::Identity()), *q);
        std::copy_n(R.data(), 9, rig.pose[i].R);
        for (FloatRow* row : {&rig.shift[i], &rig.sweep_pose[i]}) row->angular[3] = 1;
        for (float* inverse :
             {&rig.sweep_pose[i].linear[3], &rig.sweep[i].velocity.linear[3], &rig.sweep[i].velocity.angular[3]})
            *inverse = static_cast<float>(rig.mass[i].inv_mass);
    }
}

void expect_same(const MotionRig& a, const MotionRig& b) {
    const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    EXPECT_TRUE(same(a.motion, b.motion) && same(a.pose, b.pose) && same(a.velocity, b.velocity));
    EXPECT_TRUE(same(a.shift, b.shift) && same(a.sweep_pose, b.sweep_pose) && same(a.start, b.start));
    EXPECT_TRUE(same(a.sweep, b.sweep));
}

// Full batches, and those whose last stands for what is missing.
TEST_P(Motions, OfParticlesAreTheSameBits) {
    MotionRig before = rig(0);
    stop_turning(before);
    const Vec3 gravity = vector(10);
    const Prediction terms{kStep, {gravity.x(), gravity.y(), gravity.z()}, 0.05, gyroscopic_euler};
    const Keeping keeping{kStep, 1e-3, 0.3, 1e3, rotate};
    for (const MotionKernels* kernels : motion_builds())
        for (uint32_t count = 1; count <= kBodies; ++count) {
            MotionRig whole = before, points = before;
            const MassRow* mass[kBodies];
            Bodies slow = 0;  // every other one
            for (uint32_t i = 0; i < kBodies; ++i) {
                const uint32_t at = std::min(i, count - 1);
                slow |= (at % 2) << i;
                for (MotionRig* each : {&whole, &points})
                    each->batch.node[i] = each->batch.seat[i] = each->batch.motion[i] = at;
                mass[i] = &before.mass[at];
            }
            whole.batch.count = points.batch.count = count;
            kernels->predict(whole.rows(), whole.batch, mass, terms, 0, 0);
            kernels->predict_points(points.rows(), points.batch, mass, terms);
            expect_same(whole, points);
            kernels->commit(whole.rows(), whole.batch, kStep, rotate);
            kernels->commit_points(points.rows(), points.batch, kStep);
            expect_same(whole, points);
            const Bodies all = (1u << count) - 1;
            EXPECT_EQ(kernels->store(whole.rows(), whole.batch, mass, keeping, 0, 0, slow) & all,
                      kernels->store_points(points.rows(), points.batch, keeping, slow));
            expect_same(whole, points);
        }
}

}  // namespace
}  // namespace taut::test
