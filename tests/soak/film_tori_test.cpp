// Soft rings that fall into a bowl by minimisation, five steps a film frame (Gast and Schroeder 2014, figure 1).
#include <string>

#include "scenes/running_scene.h"

namespace {

using namespace lab;

constexpr double kOuter = 1.35;  // radius of the bowl, its centre as high [m]
constexpr double kTube = 0.09;   // a ring's thickness [m]

struct Rings {
    explicit Rings(const char* name) : run(name) {
        for (const auto& each : run.world.solid_vertices) vertices.insert(vertices.end(), each.begin(), each.end());
    }
    double energy() const {  // of motion and height [J]
        const Totals sum = totals(vertices);
        return sum.kinetic + kG * sum.height;
    }
    size_t inverted() const {
        size_t out = 0;
        for (const taut_solid solid : run.world.solids) {
            uint32_t count = 0;
            taut_solid_get_volumes(solid, nullptr, 0, &count);
            std::vector<float> volume(count);
            ok(taut_solid_get_volumes(solid, volume.data(), count, &count));
            out += static_cast<size_t>(std::count_if(volume.begin(), volume.end(), [](float v) { return v <= 0; }));
        }
        return out;
    }
    size_t outside() const {  // vertices beyond the bowl's outer sphere or its rim
        return static_cast<size_t>(std::count_if(vertices.begin(), vertices.end(), [](taut_body v) {
            const Vec x = position(v);
            return x.y < kOuter && norm(x - Vec(0, kOuter, 0)) > kOuter;
        }));
    }

    RunningScene run;
    std::vector<taut_body> vertices;
};

// deepest: of a vertex within a ring or the bowl, of a ring's thickness; inverted: of all cells, at the end.
void fall(const char* name, int steps, double deepest, double inverted) {
    Rings rings(name);
    const double start = rings.energy();
    double depth = 0;
    uint64_t solves = 0;
    for (int i = 0; i < steps; ++i) {
        rings.run.step();
        const taut_profile profile = rings.run.world.profile();
        depth = std::max(depth, static_cast<double>(profile.penetration));
        solves += profile.solves;
        ASSERT_TRUE(rings.run.sound()) << "step " << i;
        ASSERT_LT(rings.energy(), start * (1 + 1e-6)) << "step " << i;
    }
    size_t cells = 0;
    for (const scenes::Solid& each : rings.run.scene.solids) cells += each.cells.size() / 4;
    const size_t below = rings.inverted();
    testing::Test::RecordProperty("solves_a_step", std::to_string(static_cast<double>(solves) / steps));
    testing::Test::RecordProperty("deepest_m", std::to_string(depth));
    testing::Test::RecordProperty("inverted_of_cells", std::to_string(below) + " of " + std::to_string(cells));
    EXPECT_EQ(rings.outside(), 0u);
    EXPECT_LT(depth, deepest * kTube);
    EXPECT_LE(static_cast<double>(below), inverted * static_cast<double>(cells));
}

TEST(FilmToriShort, EightComeToRest) { fall("film_tori2_e1e5", 150, 0.5, 0); }
TEST(FilmTori, TwentySevenComeToRest) { fall("film_tori3_e1e5", 240, 0.5, 0); }
// Until the last have landed; some hundred cells are inside out where many press at once.
TEST(FilmTori, AHundredAndTwentyFiveFallIn) { fall("film_tori5_e1e5", 80, 0.5, 0.02); }

}  // namespace
