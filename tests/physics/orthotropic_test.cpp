// Solids with three axes against Hooke's law.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr double kE[3] = {4e6, 1e6, 2e6};  // [Pa]
constexpr double kNu23 = 0.2, kNu13 = 0.35, kNu12 = 0.4;
constexpr double kShear[3] = {5e5, 8e5, 3e5};  // 23, 13, 12 [Pa]
constexpr double kForce = 10, kSection = 0.01;

struct Pulled {
    double along, across_y, across_z;  // strains
};

// A bar along x that is pulled by both of its ends, with axes turned by q.
Pulled pull(const Quat& q, bool hex, bool each) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Beam bar({1, 0.1, 0.1}, 11, 3, 3, hex);
    taut_solid_def def = bar.def(TAUT_SOLID_ORTHOTROPIC, 1, 0);
    const double nu[3] = {kNu23, kNu13, kNu12};
    for (int i = 0; i < 3; ++i) {
        def.orthotropic.young_moduli[i] = static_cast<float>(kE[i]);
        def.orthotropic.poisson_ratios[i] = static_cast<float>(nu[i]);
        def.orthotropic.shear_moduli[i] = static_cast<float>(kShear[i]);
    }
    const std::vector<taut_quat> cells(def.cell_count, q.narrow());
    if (each)
        def.orthotropic.cells = cells.data();
    else
        def.orthotropic.axes = q.narrow();
    def.filter.mask = 0;
    def.damping = 0.05f;
    const taut_solid solid = add(world, def);
    const std::vector<taut_body> body = bodies_of(solid);
    for (int i = 0; i < static_cast<int>(3 * pace().hz); ++i) {
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) {
                const double share = (j == 1 ? 2 : 1) * (k == 1 ? 2 : 1) / 16.0;
                for (const auto& [end, sign] : {std::pair(0, -1.0), std::pair(10, 1.0)})
                    ok(taut_body_apply_force(body[bar.at(end, j, k)], Vec(sign * kForce * share, 0, 0).narrow(), {}));
            }
        world.step();
    }
    const std::vector<Vec> x = points_of(solid);
    return {norm(x[bar.at(7, 1, 1)] - x[bar.at(3, 1, 1)]) / 0.4 - 1,
            norm(x[bar.at(5, 2, 1)] - x[bar.at(5, 0, 1)]) / 0.1 - 1,
            norm(x[bar.at(5, 1, 2)] - x[bar.at(5, 1, 0)]) / 0.1 - 1};
}

class Orthotropic : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Of, Orthotropic, testing::Bool(),
                         [](const auto& each) { return each.param ? "Hexahedra" : "Tetrahedra"; });

constexpr double kStress = kForce / kSection;

TEST_P(Orthotropic, StretchesAndThinsAlongItsAxes) {
    const double tolerance = (GetParam() ? 0.01 : 0.03) * kStress / kE[1];
    const Pulled first = pull({}, GetParam(), false);
    EXPECT_NEAR(first.along, kStress / kE[0], tolerance);
    EXPECT_NEAR(first.across_y, -kNu12 * kStress / kE[0], tolerance);
    EXPECT_NEAR(first.across_z, -kNu13 * kStress / kE[0], tolerance);
    // Axis 2 along x, and axis 1 across.
    const Pulled second = pull(Quat::turn({0, 0, 1}, -kPi / 2), GetParam(), true);
    EXPECT_NEAR(second.along, kStress / kE[1], tolerance);
    EXPECT_NEAR(second.across_y, -kNu12 * kStress / kE[0], tolerance);
    EXPECT_NEAR(second.across_z, -kNu23 * kStress / kE[1], tolerance);
    // Axis 3 along x.
    const Pulled third = pull(Quat::turn({0, 1, 0}, kPi / 2), GetParam(), false);
    EXPECT_NEAR(third.along, kStress / kE[2], tolerance);
    EXPECT_NEAR(third.across_y, -kNu23 * kStress / kE[1], tolerance);
    EXPECT_NEAR(third.across_z, -kNu13 * kStress / kE[0], tolerance);
}

// Between the axes: 1/E = (1/E_1 + 1/E_2 + 1/G_12 - 2 nu_12/E_1)/4 at an eighth of a turn.
TEST_P(Orthotropic, IsAsSoftBetweenItsAxesAsTheirShear) {
    const double soft = (1 / kE[0] + 1 / kE[1] + 1 / kShear[2] - 2 * kNu12 / kE[0]) / 4;
    EXPECT_NEAR(pull(Quat::turn({0, 0, 1}, kPi / 4), GetParam(), true).along, kStress * soft,
                (GetParam() ? 0.01 : 0.05) * kStress * soft);
}

TEST(OrthotropicDef, IsChecked) {
    World world;
    const Beam bar({1, 0.1, 0.1}, 3, 2, 2, true);
    const taut_solid_def good = bar.def(TAUT_SOLID_ORTHOTROPIC, 1, 0);
    const auto refused = [&](auto&& change) {
        taut_solid_def def = good;
        change(def);
        taut_solid out{};
        return taut_world_add_solid(world.handle, &def, &out) == TAUT_INVALID_ARGUMENT ? taut_last_error() : "";
    };
    const auto contains = [](const std::string& text, const char* word) {
        return text.find(word) != std::string::npos;
    };
    EXPECT_TRUE(contains(refused([](auto& def) { def.orthotropic.young_moduli[1] = 0; }), "young_moduli[1]"));
    EXPECT_TRUE(contains(refused([](auto& def) { def.orthotropic.shear_moduli[2] = -1; }), "shear_moduli[2]"));
    EXPECT_TRUE(contains(refused([](auto& def) { def.orthotropic.poisson_ratios[0] = 2; }), "no stable material"));
    EXPECT_TRUE(contains(refused([](auto& def) { def.orthotropic.axes = {}; }), "orthotropic.axes"));
    EXPECT_TRUE(contains(refused([](auto& def) { def.yield_stress = 1e5f; }), "yield_stress"));
    const taut_quat axes[2] = {{0, 0, 0, 1}, {1, 1, 0, 0}};
    EXPECT_TRUE(contains(refused([&](auto& def) { def.orthotropic.cells = axes; }), "orthotropic.cells[1]"));
    add(world, good);
}

}  // namespace
