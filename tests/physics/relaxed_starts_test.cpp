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

// By an edge.
std::vector<Vec> hung_sheet(uint64_t seed) {
    const World world = still_world();
    const Sheet sheet(11, 11, 1, 1, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    std::vector<taut_pos> points = sheet.points;
    Disturbance by(seed);
    for (size_t v = 0; v < points.size(); ++v)
        if (v != sheet.at(0, 0) && v != sheet.at(0, 10)) points[v] = (Vec(points[v]) + 0.1 * by.vector()).pos();
    def.rest = def.points;
    def.points = points.data();
    def.bending_stiffness = 0.1f;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const uint32_t held : {sheet.at(0, 0), sheet.at(0, 10)}) ok(taut_cloth_pin(cloth, held, 1));
    disturb(bodies_of(cloth), {sheet.at(0, 0), sheet.at(0, 10)}, by);
    relax(world);
    return points_of(cloth);
}

// A strip by its ends, by a quarter of its width: what is folded over stays so, as it does not resist bending.
std::vector<Vec> catenary(uint64_t seed) {
    const World world = still_world();
    const Sheet strip(61, 2, 1.2, 0.02, 0);
    taut_cloth_def def = strip.def(TAUT_CLOTH_TRIANGLES);
    std::vector<taut_pos> points = strip.points;
    Disturbance by(seed);
    for (size_t v = 0; v < points.size(); ++v) {
        points[v].x /= 1.2;
        points[v].y = 1.1 * (points[v].x - 1) * points[v].x;
        if (v >= 2 && v + 2 < points.size()) points[v] = (Vec(points[v]) + 0.005 * by.vector()).pos();
    }
    def.rest = def.points;
    def.points = points.data();
    def.stretch_stiffness[0] = def.stretch_stiffness[1] = 5e4f;
    def.shear_stiffness = 2e4f;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    const std::vector<uint32_t> held{0, 1, 120, 121};
    for (const uint32_t v : held) ok(taut_cloth_pin(cloth, v, 1));
    disturb(bodies_of(cloth), held, by);
    relax(world);
    return points_of(cloth);
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
