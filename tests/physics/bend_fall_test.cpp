// Cloth that resists bending falls freely: whatever its stiffness against its weight, inner forces give no momentum and
// no energy. What it has of it comes from how it is thrown.
#include <algorithm>

#include "physics/deformable_lab.h"

namespace lab {
namespace {

struct FallingBend {
    double bending, density;  // [N m], [kg/m^2]
    double wave;              // of its shape at rest [m]; 0: flat, which bends by another law
    bool swept;
};

void PrintTo(const FallingBend& of, std::ostream* out) {
    *out << of.bending * 1e4 << '_' << of.density * 100 << (of.wave > 0 ? "_wavy" : "_flat")
         << (of.swept ? "_swept" : "_direct");
}

std::vector<FallingBend> falling_bends() {
    std::vector<FallingBend> out;
    for (const double bending : {1e-4, 1e-2, 1.0})
        for (const double density : {0.1, 5.0})
            for (const double wave : {0.0, 0.05})
                for (const bool swept : {false, true})
                    if (swept || bending == 1) out.push_back({bending, density, wave, swept});
    return out;
}

double energy_of(const std::vector<taut_body>& bodies) {
    double sum = 0;
    for (const taut_body body : bodies) {
        const Vec v = velocity(body);
        sum += mass_of(body).mass * (0.5 * dot(v, v) + kG * position(body).y);
    }
    return sum;
}

class BendFalls : public testing::TestWithParam<FallingBend> {};
INSTANTIATE_TEST_SUITE_P(Cloths, BendFalls, testing::ValuesIn(falling_bends()), testing::PrintToStringParamName());

TEST_P(BendFalls, KeepsMomentumAndGainsNoEnergy) {
    const World world;
    Sheet sheet(9, 9, 0.6, 0.6, 0);
    for (taut_pos& point : sheet.points) point.y = GetParam().wave * std::sin(7 * point.x) * std::cos(6 * point.z);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.area_density = static_cast<float>(GetParam().density);
    def.bending_stiffness = static_cast<float>(GetParam().bending);
    def.solve = GetParam().swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const std::vector<taut_body> bodies = bodies_of(add(world, def));
    double mass = 0;
    for (size_t n = 0; n < bodies.size(); ++n) {  // a corner is kicked, and all of it spins a little
        const Vec x = position(bodies[n]) - Vec{0.3, 0, 0.3};
        const Vec kick = n == 0 ? Vec{0.3, 1, -0.2} : Vec{};
        set_velocities({bodies[n]}, kick + cross(Vec{0.4, 0.2, -0.3}, x));
        mass += mass_of(bodies[n]).mass;
    }
    const Vec before = momentum_of(bodies);
    const double energy = energy_of(bodies), fall = mass * kG * 0.5 * kG;  // of a second
    for (int i = 1; i <= 60; ++i) {
        world.step();
        const Vec wanted = before + Vec{0, -mass * kG * i / 60, 0};
        ASSERT_LT(norm(momentum_of(bodies) - wanted), 1e-4 * (norm(before) + mass * kG)) << "frame " << i;
        ASSERT_LT(energy_of(bodies) - energy, 1e-4 * fall) << "frame " << i;
    }
}

}  // namespace
}  // namespace lab
