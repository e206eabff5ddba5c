// Laws of cloths that act on one side alone: softer in compression, stiffer beyond a strain, tethers.
#include <set>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

struct Taken {
    const char* name;
    taut_deformable_solve solve;
    taut_solver solver;
};

void PrintTo(const Taken& taken, std::ostream* out) { *out << taken.name; }

constexpr Taken kTaken[] = {
    {"Direct", TAUT_DEFORMABLE_DIRECT, TAUT_SOLVER_BLOCK_LDLT},
    {"Swept", TAUT_DEFORMABLE_SWEPT, TAUT_SOLVER_BLOCK_LDLT},
    {"GaussSeidel", TAUT_DEFORMABLE_DIRECT, TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL},
};

class ClothLaw : public testing::TestWithParam<Taken> {
protected:
    static constexpr double kSide = 0.1;     // of a cell [m]
    static constexpr double kPulled = 1000;  // stiffness of a link [N/m]

    // How far the middle of two cells comes that are held at either end, as each of its two vertices is pushed by a
    // force; of one cell held at one end, how much longer it becomes.
    double shift(taut_cloth_def def, double force) const {
        World world([&](taut_world_def& of) {
            of.gravity = {0, 0, 0};
            of.solver = GetParam().solver;
        });
        def.solve = GetParam().solve;
        def.area_density = 50;
        def.damping = 0.02f;
        def.stretch_tolerance = 1e-4f;  // of swept ones
        def.filter.mask = 0;
        const taut_cloth cloth = add(world, def);
        for (uint32_t v : {0u, 1u, 4u, 5u})
            if (v < def.point_count) ok(taut_cloth_pin(cloth, v, 1));
        const std::vector<taut_body> body = bodies_of(cloth);
        for (int i = 0; i < 180; ++i) {
            for (uint32_t v : {2u, 3u}) ok(taut_body_apply_force(body[v], Vec(force, 0, 0).narrow(), {0, 0, 0}));
            world.step();
        }
        const std::vector<Vec> x = points_of(cloth);
        EXPECT_NEAR(x[2].x, x[3].x, near());
        return 0.5 * (x[2].x + x[3].x) - kSide;
    }
    // Swept ones yield by a few times their tolerance [m].
    static double near() { return GetParam().solve == TAUT_DEFORMABLE_SWEPT ? 1.5e-4 : 3e-5; }
    static taut_cloth_def links(const Sheet& sheet) {
        taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
        for (float& each : def.stretch_compliance) each = 1 / static_cast<float>(kPulled);
        def.shear_compliance = std::numeric_limits<float>::infinity();
        return def;
    }

    Sheet cell_{2, 2, kSide, kSide, 0}, cells_{3, 2, 2 * kSide, kSide, 0};
};
INSTANTIATE_TEST_SUITE_P(Of, ClothLaw, testing::ValuesIn(kTaken), testing::PrintToStringParamName());

// One side pulls with k x, the other pushes with s k x.
TEST_P(ClothLaw, LinksArePressedBySoMuchLess) {
    taut_cloth_def def = links(cells_);
    for (const float share : {0.5f, 0.25f, 0.0f}) {
        def.compression = share;
        for (const double force : {4.0, -4.0})
            EXPECT_NEAR(shift(def, force), force / (kPulled * (1 + static_cast<double>(share))), near())
                << share << ' ' << force;
    }
}

// k x = F up to the limit e L, then k x + K (x - e L) = F.
TEST_P(ClothLaw, LinksAreStifferBeyondTheLimit) {
    constexpr double kLimit = 0.03, kBeyond = 9000;
    taut_cloth_def def = links(cell_);
    def.strain_limit = static_cast<float>(kLimit);
    def.limit_compliance = 1 / static_cast<float>(kBeyond);
    for (const double force : {2.0, 2.9, 3.5, 8.0}) {
        const double free = force / kPulled, least = kLimit * kSide;
        const double expected = free <= least ? free : (force + kBeyond * least) / (kPulled + kBeyond);
        EXPECT_NEAR(shift(def, force), expected, near()) << force;
    }
}

// The same under a sheet's own S (1 + e) w, S = k (e + e^2/2), shared by two edges.
TEST_P(ClothLaw, TrianglesAreStifferBeyondTheLimit) {
    constexpr double kLimit = 0.04, kBeyond = 9000, kSheet = 1000;
    taut_cloth_def def = cell_.def(TAUT_CLOTH_TRIANGLES);
    for (float& each : def.stretch_stiffness) each = static_cast<float>(kSheet);
    def.poisson_ratio = 0;
    def.strain_limit = static_cast<float>(kLimit);
    def.limit_compliance = 1 / static_cast<float>(kBeyond);
    const auto force_at = [&](double e) {
        return kSheet * (e + e * e / 2) * (1 + e) * kSide / 2 + kBeyond * kSide * std::max(0.0, e - kLimit);
    };
    for (const double strain : {0.02, 0.039, 0.043, 0.05})
        EXPECT_NEAR(shift(def, force_at(strain)), strain * kSide, near()) << strain;
}

// Two that hang on a pin by a long way: no further than the way along the cloth and its slack.
TEST_P(ClothLaw, TethersHoldWhatHangs) {
    constexpr int kRows = 20;
    constexpr double kLength = 1, kSlack = 0.02, kCompliance = 1e-5, kDensity = 0.5;
    const Sheet sheet(kRows, 3, kLength, 0.1, 0);
    double low[2];
    for (const uint32_t tethers : {0u, 2u}) {
        World world([&](taut_world_def& of) { of.solver = GetParam().solver; });
        std::vector<taut_pos> hung = sheet.points;
        for (taut_pos& p : hung) p = {0, -p.x, p.z};
        taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
        def.points = hung.data();
        def.solve = GetParam().solve;
        def.area_density = kDensity;
        for (float& each : def.stretch_compliance) each = 0.2f;  // far too soft
        def.shear_compliance = 0.2f;
        def.damping = 0.05f;
        def.filter.mask = 0;
        def.tethers = tethers;
        def.tether_slack = static_cast<float>(kSlack);
        def.limit_compliance = static_cast<float>(kCompliance);
        const taut_cloth cloth = add(world, def);
        for (int k = 0; k < 3; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
        double lowest = 0;
        for (int i = 0; i < 300; ++i) {
            world.step();
            for (const Vec& x : points_of(cloth)) lowest = std::min(lowest, x.y);
        }
        low[tethers > 0] = -points_of(cloth)[sheet.at(kRows - 1, 1)].y;
        if (tethers > 0) {
            EXPECT_GT(lowest, -(1 + kSlack) * kLength - 0.02);
        }
        // Let go, it falls.
        for (int k = 0; k < 3; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 0));
        for (int i = 0; i < 60; ++i) world.step();
        EXPECT_LT(points_of(cloth)[sheet.at(0, 1)].y, -3);
    }
    const double load = kDensity * kLength * 0.1 * kG;
    EXPECT_GT(low[0], 1.2 * kLength);
    EXPECT_LT(low[1], (1 + kSlack) * kLength + load * kCompliance + 1e-4);
    EXPECT_GT(low[1], kLength);
}

// A net that falls into its pins, through slack, pressure and its limit: motion, height and links together lose energy
// from step to step, where they are solved at once.
TEST(ClothLaws, GainNoEnergy) {
    constexpr int kSide = 9;
    constexpr double kSpring = 500, kPressed = 0.3, kLimit = 0.02, kBeyond = 5000;
    World world;
    const Sheet sheet(kSide, kSide, 0.8, 0.8, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    for (float& each : def.stretch_compliance) each = 1 / static_cast<float>(kSpring);
    def.shear_compliance = std::numeric_limits<float>::infinity();
    def.compression = static_cast<float>(kPressed);
    def.strain_limit = static_cast<float>(kLimit);
    def.limit_compliance = 1 / static_cast<float>(kBeyond);
    def.area_density = 1;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const int k : {0, kSide - 1}) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
    const std::vector<taut_body> body = bodies_of(cloth);
    bool presses = false, limits = false;
    const auto energy = [&] {
        const std::vector<Vec> x = points_of(cloth);
        double sum = 0;
        for (const taut_body each : body) {
            const double m = mass_of(each).mass;
            const Vec v = velocity(each);
            sum += m * (0.5 * dot(v, v) + kG * position(each).y);
        }
        std::set<std::pair<uint32_t, uint32_t>> seen;
        for (size_t i = 0; i < sheet.triangles.size(); ++i) {
            const uint32_t a = sheet.triangles[i], b = sheet.triangles[i - i % 3 + (i + 1) % 3];
            if (!seen.emplace(std::min(a, b), std::max(a, b)).second) continue;
            const Vec rest = Vec(sheet.points[b]) - Vec(sheet.points[a]);
            const double c = norm(x[b] - x[a]) - norm(rest), beyond = c - kLimit * norm(rest);
            if (rest.x == 0 || rest.z == 0) sum += 0.5 * (c < 0 ? kPressed : 1) * kSpring * c * c;
            if (beyond > 0) sum += 0.5 * kBeyond * beyond * beyond;
            presses = presses || c < -1e-4;
            limits = limits || beyond > 1e-4;
        }
        return sum;
    };
    double last = energy();
    const double scale = totals(body).mass * kG * 0.8;
    for (int i = 0; i < 300; ++i) {
        world.step();
        const double now = energy();
        EXPECT_LE(now, last + 1e-4 * scale) << i;
        last = now;
    }
    EXPECT_TRUE(presses && limits);
}

}  // namespace
