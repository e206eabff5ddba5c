// Light nodes that bear much, with every solver that iterates over rows: a net of particles on rigid rods, hung by two
// corners and let go from horizontal, in steps in which the geometric stiffness of its rods, h^2 f / (l m) = 0.2 to 11
// a rod below the hooks, is far beyond what impulses along the rods' old directions bear.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "physics/lab.h"
#include "solvers/solver.h"

namespace taut::test {
namespace {

struct NetStep {
    size_t solver;
    double hz;  // without substeps
};

std::vector<NetStep> net_steps() {
    std::vector<NetStep> steps;
    for (size_t s = 0; s < solvers().size(); ++s)
        if (!solvers()[s]->direct && !solvers()[s]->lanes && !solvers()[s]->energies)
            for (const double hz : {30.0, 60.0, 120.0, 240.0}) steps.push_back({s, hz});
    return steps;
}

std::string net_step_name(const testing::TestParamInfo<NetStep>& step) {
    return std::string(solvers()[step.param.solver]->name) + "_" + std::to_string(std::lround(step.param.hz));
}

class LightNet : public testing::TestWithParam<NetStep> {
protected:
    static constexpr int kSide = 8;
    static constexpr double kNode = 0.01, kSpacing = 0.02;  // [kg], [m]

    LightNet() {
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) node_.push_back(world_.particle(kNode, {kSpacing * i, 0, kSpacing * j}));
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                if (i + 1 < kSide) tie(at(i, j), at(i + 1, j));
                if (j + 1 < kSide) tie(at(i, j), at(i, j + 1));
            }
        for (const int i : {0, kSide - 1}) world_.rod({0}, hook(i), node_[at(i, 0)], {}, kSpacing);
    }

    static size_t at(int i, int j) { return static_cast<size_t>(i * kSide + j); }
    static lab::Vec hook(int i) { return {kSpacing * i, kSpacing, 0}; }
    void tie(size_t a, size_t b) {
        world_.rod(node_[a], {}, node_[b], {}, kSpacing);
        rod_.push_back({a, b});
    }
    double longest_stretch() const {
        double most = 0;
        for (const auto& [a, b] : rod_)
            most = std::max(most, lab::norm(lab::position(node_[a]) - lab::position(node_[b])) / kSpacing - 1);
        return most;
    }
    double energy() const {
        const lab::Totals all = lab::totals(node_);
        return all.kinetic + lab::kG * all.height;
    }

    lab::World world_{[](taut_world_def& def) {
        def.solver = static_cast<taut_solver>(GetParam().solver);
        def.time_step = static_cast<float>(1 / GetParam().hz);
        def.substeps = 1;
        def.fixed_substeps = 1;
    }};
    std::vector<taut_body> node_;
    std::vector<std::pair<size_t, size_t>> rod_;
};

INSTANTIATE_TEST_SUITE_P(EveryRowSolver, LightNet, testing::ValuesIn(net_steps()), net_step_name);

// What falls from the height of the hooks by the net's length has v^2 = 2 g l; the free edge whips, to less than twice
// that. Rods hold where iterations suffice, in short steps.
TEST_P(LightNet, FallsAndSwingsWithoutGainingEnergy) {
    const double length = kSpacing * (kSide * std::sqrt(2.0) + 1), fall = std::sqrt(2 * lab::kG * length);
    const double start = energy(), scale = kSide * kSide * kNode * lab::kG * length;
    double fastest = 0, most = start, stretch = 0;
    for (int i = 0; i < GetParam().hz / 2; ++i) {
        world_.step();
        for (const taut_body node : node_) fastest = std::max(fastest, lab::norm(lab::velocity(node)));
        most = std::max(most, energy());
        stretch = std::max(stretch, longest_stretch());
    }
    EXPECT_LE(fastest, 2 * fall);
    EXPECT_GE(fastest, 0.5 * fall);
    EXPECT_LE(most - start, 1e-3 * scale);
    if (GetParam().hz >= 240) {
        EXPECT_LE(stretch, 0.1);
    }
}

}  // namespace
}  // namespace taut::test
