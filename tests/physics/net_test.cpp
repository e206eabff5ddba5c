// Nets of bodies tied by ball joints, hung by three corners: loops everywhere, and forces that change by much.
#include <algorithm>

#include "physics/lab.h"

namespace {

using namespace lab;

class Net {
public:
    static constexpr double kLink = 0.5;  // [m]

    explicit Net(size_t side) : side_(side) {
        for (size_t i = 0; i < side; ++i)
            for (size_t k = 0; k < side; ++k)
                bodies.push_back(world.add({.position = place(i, k), .mass = 1, .inertia = {0.02, 0.02, 0.02}}));
        constexpr double kHalf = kLink / 2;
        for (size_t i = 0; i < side; ++i)
            for (size_t k = 0; k < side; ++k) {
                if (i + 1 < side) world.ball(at(i, k), {kHalf, 0, 0}, at(i + 1, k), {-kHalf, 0, 0});
                if (k + 1 < side) world.ball(at(i, k), {0, 0, kHalf}, at(i, k + 1), {0, 0, -kHalf});
            }
        for (auto [i, k] : {std::pair<size_t, size_t>{0, 0}, {side - 1, 0}, {0, side - 1}})
            world.ball({}, place(i, k), at(i, k), {});
    }

    double energy() const {  // [J]
        const Totals t = totals(bodies);
        return t.kinetic + kG * t.height;
    }

    World world;
    std::vector<taut_body> bodies;

private:
    static Vec place(size_t i, size_t k) { return {kLink * static_cast<double>(i), 0, kLink * static_cast<double>(k)}; }
    taut_body at(size_t i, size_t k) const { return bodies[i * side_ + k]; }

    size_t side_;
};

class HangingNet : public testing::TestWithParam<size_t> {};

// A second solve costs as much as the first: it must stay the exception also where forces change in every substep.
TEST_P(HangingNet, FallsWithClosedJointsAndFewSecondSolves) {
    Net net(GetParam());
    const double start = net.energy();
    double gap = 0, most = start;
    uint32_t solves = 0, resolves = 0;
    for (int frame = 0; frame < 120; ++frame) {
        net.world.step();
        const taut_profile profile = net.world.profile();
        gap = std::max(gap, static_cast<double>(profile.joint_error));
        most = std::max(most, net.energy());
        solves += profile.solves;
        resolves += profile.resolves;
    }
    EXPECT_LE(gap, 0.01 * Net::kLink);
    EXPECT_LE(most - start, 0.001 * static_cast<double>(net.bodies.size()) * kG * Net::kLink);
    EXPECT_EQ(solves, 120 * net.world.def.substeps);
    EXPECT_LE(resolves, solves / 3);
    RecordProperty("gap_pct", std::to_string(100 * gap / Net::kLink));
    RecordProperty("resolves", std::to_string(resolves));
    RecordProperty("energy_J", std::to_string(most - start));
}

INSTANTIATE_TEST_SUITE_P(Side, HangingNet, testing::Values(6, 12, 24),
                         [](const auto& tested) { return std::to_string(tested.param); });

}  // namespace
