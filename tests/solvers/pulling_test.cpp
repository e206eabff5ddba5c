// Elements that only pull, in every solver and form: a spring while they are long, nothing while they are short.
#include <gtest/gtest.h>

#include "rig.h"

namespace taut::test {
namespace {

struct Form {
    size_t solver;
    ElementForm form;
    JointSolve solve;
};

std::vector<Form> forms() {
    std::vector<Form> out;
    for (size_t i = 0; i < solvers().size(); ++i) {
        out.push_back({i, ElementForm::rows, JointSolve::direct});
        if (!solvers()[i]->direct) continue;
        out.push_back({i, ElementForm::folded, JointSolve::direct});
        out.push_back({i, ElementForm::energy, JointSolve::direct});
        out.push_back({i, ElementForm::rows, JointSolve::swept});
    }
    return out;
}

class Pulling : public testing::TestWithParam<Form> {
protected:
    static constexpr double kMass = 0.7, kLength = 1;

    // A particle on the x axis, beside a link from the origin; where it is and its velocity after a substep.
    Vec3 velocity_after(double x, double v, double compliance, double softness = 1) {
        Rig rig;
        rig.gravity.setZero();
        rig.settings.sweeps = 100;
        const uint32_t ends[] = {rig.fixed(), rig.particle(kMass, Vec3(x, 0, 0), Vec3(v, lateral_, 0))};
        ElementSet& set = rig.w.elements.set[rig.w.elements.add(kLinkElement)];
        set.pulls = true;
        set.form = GetParam().form;
        set.solve = GetParam().solve;
        set_compliance(set, compliance / softness, 0);
        rig.w.elements.insert(set, 0, ends, softness);
        *set.data_of(0) = kLength;
        h_ = rig.h;
        rig.begin(*solvers()[GetParam().solver]);
        rig.predict();
        rig.solve();
        rig.move();
        rig.relax();
        lambda_ = *set.lambda_of(0);
        position_ = rig.w.nodes.motion[ends[1]].x.x();
        return rig.w.nodes.motion[ends[1]].v;
    }

    static bool in_lanes() {
        const Solver& solver = *solvers()[GetParam().solver];
        return solver.lanes && (!solver.direct || GetParam().solve == JointSolve::swept);
    }

    double h_ = 0, lambda_ = 0, lateral_ = 0, position_ = 0;
};
std::string name_of(const testing::TestParamInfo<Form>& param) {
    const Form& of = param.param;
    const char* const names[] = {"rows", "folded", "energy"};
    return std::string(solvers()[of.solver]->name) + "_" + names[static_cast<int>(of.form)] +
           (of.solve == JointSolve::swept ? "_swept" : "");
}
INSTANTIATE_TEST_SUITE_P(Of, Pulling, testing::ValuesIn(forms()), name_of);

// Implicit Euler along the line: m v' = m v - h (C + h v') / c, where C + h v' > 0.
TEST_P(Pulling, IsASpringWhereItIsLong) {
    for (const double compliance : {1e-3, 1e-5})
        for (const double softness : {1.0, 2.0})
            for (const double stretch : {0.02, 0.1}) {
                const double v = -0.4;
                const Vec3 after = velocity_after(kLength + stretch, v, compliance, softness);
                const double expected = (kMass * v - h_ * stretch / compliance) / (kMass + h_ * h_ / compliance);
                if (stretch + h_ * expected < 0) continue;  // a stiff one comes to its length
                EXPECT_NEAR(position_, kLength + stretch + h_ * expected, 1e-6) << compliance << ' ' << stretch;
                // Sweeps take what is stiffer than h^2 / m as rigid: what closes it moves positions alone.
                if (in_lanes() && compliance < h_ * h_ / kMass) continue;
                EXPECT_NEAR(after.x(), expected, 2e-5 * (1 + std::abs(expected))) << compliance << ' ' << stretch;
                EXPECT_NEAR(lambda_, kMass * (expected - v) / h_, 1e-3 * std::abs(lambda_));
            }
}

TEST_P(Pulling, DoesNothingWhereItIsShort) {
    lateral_ = 0.3;
    for (const double compliance : {1e-3, 1e-5}) {
        const Vec3 after = velocity_after(0.6, 2, compliance);
        EXPECT_EQ(after.x(), 2);
        EXPECT_NEAR(after.y(), 0.3, 1e-7);
        EXPECT_EQ(lambda_, 0);
    }
}

// It is caught within the substep in which it becomes long.
TEST_P(Pulling, CatchesWhatComesToItsEnd) {
    const double gap = 0.002, v = 3, compliance = 1e-5;
    const Vec3 after = velocity_after(kLength - gap, v, compliance);
    const double expected = (kMass * v + h_ * gap / compliance) / (kMass + h_ * h_ / compliance);
    ASSERT_GT(h_ * v, gap);
    EXPECT_NEAR(after.x(), expected, 1e-4);
    EXPECT_LT(lambda_, 0);
}

}  // namespace
}  // namespace taut::test
