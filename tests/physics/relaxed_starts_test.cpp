// Statics from random starts: every vertex and its velocity are disturbed, and taut_world_relax finds the one rest.
#include <random>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

// Numbers in [-1, 1], by seed; of seed 0 none.
class Disturbance {
public:
    explicit Disturbance(uint64_t seed) : random_(seed), none_(seed == 0) {}
    Vec vector() { return {number(), number(), number()}; }
    double number() { return none_ ? 0 : 2 * std::ldexp(static_cast<double>(random_() >> 11), -53) - 1; }

private:
    std::mt19937_64 random_;
    bool none_;
};

struct RestCase {
    const char* name;
    std::vector<Vec> (*rest)(uint64_t seed);  // found from the start of that seed
};
void PrintTo(const RestCase& of, std::ostream* out) { *out << of.name; }

constexpr double kFast = 5;  // [m/s]

World still_world() {
    return World([](taut_world_def& def) { def.solver = TAUT_SOLVER_MINIMISATION; });
}

// All but those that are held.
void disturb(const std::vector<taut_body>& bodies, const std::vector<uint32_t>& held, Disturbance& by) {
    for (uint32_t v = 0; v < bodies.size(); ++v)
        if (std::ranges::find(held, v) == held.end())
            ok(taut_body_set_velocity(bodies[v], (kFast * by.vector()).narrow(), {}));
}

void relax(const World& world) {
    taut_relaxation done{};
    ok(taut_world_relax(world.handle, 1e-5f, 5000, &done));
    EXPECT_EQ(done.converged, 1u) << done.steps << " steps leave " << done.residual;
}

// Each vertex off by up to half of the height.
std::vector<Vec> cantilever(uint64_t seed) {
    const World world = still_world();
    const Beam beam({0.5, 0.1, 0.1}, 6, 2, 2, false);
    taut_solid_def def = beam.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3);
    std::vector<taut_pos> points = beam.points;
    Disturbance by(seed);
    for (size_t v = 4; v < points.size(); ++v) points[v] = (Vec(points[v]) + 0.05 * by.vector()).pos();
    def.rest = def.points;
    def.points = points.data();
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    disturb(bodies_of(solid), {0, 1, 2, 3}, by);
    relax(world);
    return points_of(solid);
}

// From each vertex off by so much where nothing holds it.
std::vector<Vec> relaxed_cloth(taut_cloth_def def, std::vector<taut_pos> points, const std::vector<uint32_t>& held,
                               double off, uint64_t seed) {
    const World world = still_world();
    Disturbance by(seed);
    for (uint32_t v = 0; v < points.size(); ++v)
        if (std::ranges::find(held, v) == held.end()) points[v] = (Vec(points[v]) + off * by.vector()).pos();
    def.rest = def.points;
    def.points = points.data();
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const uint32_t v : held) ok(taut_cloth_pin(cloth, v, 1));
    disturb(bodies_of(cloth), held, by);
    relax(world);
    return points_of(cloth);
}

// By two corners.
std::vector<Vec> hung_sheet(uint64_t seed) {
    const Sheet sheet(11, 11, 1, 1, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.bending_stiffness = 0.1f;
    return relaxed_cloth(def, sheet.points, {sheet.at(0, 0), sheet.at(0, 10)}, 0.1, seed);
}

// A strip by its ends, by a quarter of its width: what is folded over stays so, as it does not resist bending.
std::vector<Vec> catenary(uint64_t seed) {
    const Sheet strip(61, 2, 1.2, 0.02, 0);
    taut_cloth_def def = strip.def(TAUT_CLOTH_TRIANGLES);
    def.stretch_stiffness[0] = def.stretch_stiffness[1] = 5e4f;
    def.shear_stiffness = 2e4f;
    std::vector<taut_pos> points = strip.points;
    for (taut_pos& p : points) {
        p.x /= 1.2;
        p.y = 1.1 * (p.x - 1) * p.x;
    }
    return relaxed_cloth(def, points, {0, 1, 120, 121}, 0.005, seed);
}

const RestCase kRests[] = {{"cantilever", cantilever}, {"sheet", hung_sheet}, {"catenary", catenary}};

class RelaxedStarts : public testing::TestWithParam<std::tuple<RestCase, uint64_t>> {};

// Within 0.1 % of how far it hangs.
TEST_P(RelaxedStarts, EndInOneRest) {
    const auto& [of, starts] = GetParam();
    const std::vector<Vec> expected = of.rest(0);
    double low = 0;
    for (const Vec& p : expected) low = std::max(low, -p.y);
    for (uint64_t seed = 1; seed <= starts; ++seed) {
        const std::vector<Vec> found = of.rest(seed);
        double most = 0;
        for (size_t v = 0; v < found.size(); ++v) most = std::max(most, norm(found[v] - expected[v]));
        EXPECT_LT(most, 1e-3 * low) << "start " << seed;
    }
}
INSTANTIATE_TEST_SUITE_P(Ten, RelaxedStarts, testing::Combine(testing::ValuesIn(kRests), testing::Values(10u)));
INSTANTIATE_TEST_SUITE_P(Soak, RelaxedStarts, testing::Combine(testing::ValuesIn(kRests), testing::Values(100u)));

}  // namespace
