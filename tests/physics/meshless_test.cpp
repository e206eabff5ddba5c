// Solids without a mesh and sheets of quadrilaterals: linear fields exactly, beams and strips as theory says.
#include <random>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

const float kMixed[3][3] = {{1.06f, 0.05f, -0.02f}, {-0.03f, 0.95f, 0.04f}, {0.02f, 0.01f, 1.03f}};

Vec mapped(const taut_pos& p) {
    const auto row = [&](int r) {
        return static_cast<double>(kMixed[r][0]) * p.x + static_cast<double>(kMixed[r][1]) * p.y +
               static_cast<double>(kMixed[r][2]) * p.z;
    };
    return {row(0), row(1), row(2)};
}
std::vector<taut_pos> mapped(const std::vector<taut_pos>& points) {
    std::vector<taut_pos> out;
    for (const taut_pos& p : points) out.push_back(mapped(p).pos());
    return out;
}

// Von Mises' stress of St. Venant's and Kirchhoff's law at that map.
double mises_of_map(double young, double nu) {
    double e[3][3], s[3][3], det = 0;
    const auto f = [](int r, int c) { return static_cast<double>(kMixed[r][c]); };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            e[i][j] = i == j ? -0.5 : 0;
            for (int k = 0; k < 3; ++k) e[i][j] += 0.5 * f(k, i) * f(k, j);
        }
    const double mu = young / (2 * (1 + nu)), lame = young * nu / ((1 + nu) * (1 - 2 * nu));
    const double trace = e[0][0] + e[1][1] + e[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s[i][j] = 2 * mu * e[i][j] + (i == j ? lame * trace : 0);
    det = f(0, 0) * (f(1, 1) * f(2, 2) - f(1, 2) * f(2, 1)) - f(0, 1) * (f(1, 0) * f(2, 2) - f(1, 2) * f(2, 0)) +
          f(0, 2) * (f(1, 0) * f(2, 1) - f(1, 1) * f(2, 0));
    double cauchy[3][3] = {}, mean = 0, sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) cauchy[i][j] += f(i, k) * s[k][l] * f(j, l) / det;
    for (int i = 0; i < 3; ++i) mean += cauchy[i][i] / 3;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += std::pow(cauchy[i][j] - (i == j ? mean : 0), 2);
    return std::sqrt(1.5 * sum);
}

taut_solid_def cloud_def(const std::vector<taut_pos>& points, double young, double nu) {
    taut_solid_def def;
    taut_solid_def_init(&def);
    def.corners = TAUT_SOLID_MESHLESS;
    def.material = TAUT_SOLID_ST_VENANT_KIRCHHOFF;
    def.points = points.data();
    def.point_count = static_cast<uint32_t>(points.size());
    def.young_modulus = static_cast<float>(young);
    def.poisson_ratio = static_cast<float>(nu);
    def.filter.mask = 0;
    return def;
}
std::vector<float> stresses_of(taut_solid solid) {
    uint32_t count = 0;
    taut_solid_get_stresses(solid, nullptr, 0, &count);
    std::vector<float> out(count);
    ok(taut_solid_get_stresses(solid, out.data(), count, &count));
    return out;
}
double mass_of_all(taut_solid solid) {
    double sum = 0;
    for (const taut_body body : bodies_of(solid)) sum += mass_of(body).mass;
    return sum;
}

// ---------------------------------------------------------------- meshless

// Every sample of a scattered cloud strains by the map alone, whether the library made it or the test did.
TEST(Meshless, StrainsExactlyInALinearField) {
    constexpr double kYoung = 1e6, kNu = 0.3;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> off(-0.02, 0.02), in(0.05, 0.35);
    Beam box({0.4, 0.4, 0.4}, 5, 5, 5, true);
    for (taut_pos& p : box.points) p = {p.x + off(random), p.y + off(random), p.z + off(random)};
    const std::vector<taut_pos> at = mapped(box.points);
    std::vector<taut_pos> samples;
    for (int i = 0; i < 40; ++i) samples.push_back({in(random), in(random), in(random)});
    const std::vector<float> volumes(samples.size(), 0.064f / 40);
    for (const bool made : {true, false}) {
        const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        taut_solid_def def = cloud_def(box.points, kYoung, kNu);
        def.rest = box.points.data();
        def.points = at.data();
        if (!made) {
            def.samples = samples.data();
            def.sample_volumes = volumes.data();
            def.sample_count = static_cast<uint32_t>(samples.size());
            // All vertices weigh something.
            def.neighbour_radius = 1;
        }
        taut_solid solid{};
        const taut_result added = taut_world_add_solid(world.handle, &def, &solid);
        if (!made && added != TAUT_OK) {
            // Some vertex may be beyond all of the 40 samples: that is said.
            EXPECT_NE(std::string(taut_last_error()).find("is of no cell"), std::string::npos) << taut_last_error();
            continue;
        }
        ok(added);
        const std::vector<float> stress = stresses_of(solid);
        ASSERT_GE(stress.size(), 40u);
        for (const float each : stress) EXPECT_NEAR(each / mises_of_map(kYoung, kNu), 1, 1e-5);
    }
}

// Its mass is that of the box that a lattice fills.
TEST(Meshless, WeighsWhatItFills) {
    const World world;
    const Beam box({0.5, 0.2, 0.42}, 6, 3, 5, true);
    const taut_solid solid = add(world, cloud_def(box.points, 1e6, 0.3));
    EXPECT_NEAR(mass_of_all(solid), 1000 * 0.5 * 0.2 * 0.42, 1e-3);
    EXPECT_EQ(stresses_of(solid).size(), 8 * box.cells.size() / 8);
}

// Vertices within, let go from elsewhere, come to where the map of the held boundary has them.
TEST(Meshless, RestsInALinearField) {
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Beam box({0.4, 0.4, 0.4}, 5, 5, 5, true);
    std::vector<taut_pos> at = mapped(box.points);
    const auto inner = [](int i, int j, int k) { return i % 4 != 0 && j % 4 != 0 && k % 4 != 0; };
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k)
                if (inner(i, j, k)) at[box.at(i, j, k)].y += 0.01 * (i + k - j);
    taut_solid_def def = cloud_def(box.points, 1e6, 0.3);
    def.rest = box.points.data();
    def.points = at.data();
    def.damping = 0.02f;
    def.mass_damping = 20;
    const taut_solid solid = add(world, def);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k)
                if (!inner(i, j, k)) ok(taut_solid_pin(solid, box.at(i, j, k), 1));
    world.step(150);
    const std::vector<Vec> x = points_of(solid);
    for (uint32_t v = 0; v < x.size(); ++v) EXPECT_LE(norm(x[v] - mapped(box.points[v])), 1e-6) << v;
}

// Euler and Bernoulli's beam with shear, as for meshes: four cells across are too stiff as hexahedra are, by 1/4^2.
TEST(Meshless, CantileverSinksAsTheorySays) {
    constexpr double kYoung = 1e6, kNu = 0.3, kSink = 0.026;
    const Vec size(0.5, 0.1, 0.1);
    const Beam beam(size, 21, 5, 5, true);
    const double area = size.y * size.z, inertia = size.z * std::pow(size.y, 3) / 12;
    const double shear = kYoung / (2 * (1 + kNu));
    const double load =
        kSink / (std::pow(size.x, 4) / (8 * kYoung * inertia) + size.x * size.x / (2 * 5.0 / 6 * shear * area));
    const World world([&](taut_world_def& def) {
        def.gravity = {0, static_cast<float>(-load / (1000 * area)), 0};
        def.substeps = 1;
    });
    taut_solid_def def = cloud_def(beam.points, kYoung, kNu);
    def.damping = 0.03f;
    def.mass_damping = 10;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    world.step(120);
    const double sink = size.y / 2 - points_of(solid)[beam.at(20, 2, 2)].y;
    EXPECT_NEAR(sink / kSink, 1 - 1.0 / 16, 0.02);
}

TEST(Meshless, LandsAndRests) {
    for (const taut_solid_material material : {TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_COROTATED}) {
        const World world;
        world.add_ground();
        Beam cube({0.4, 0.4, 0.4}, 4, 4, 4, true);
        for (taut_pos& p : cube.points) p.y += 0.1;
        taut_solid_def def = cloud_def(cube.points, 1e5, 0.4);
        def.material = material;
        def.filter.mask = UINT64_MAX;
        def.damping = 0.01f;
        const taut_solid solid = add(world, def);
        world.step(180);
        double low = 1, high = 0, fastest = 0;
        for (const Vec& x : points_of(solid)) low = std::min(low, x.y), high = std::max(high, x.y);
        for (const taut_body body : bodies_of(solid)) fastest = std::max(fastest, norm(velocity(body)));
        EXPECT_GE(low, 0);
        EXPECT_NEAR(high, 0.4, 0.03);
        EXPECT_LE(fastest, 0.02);
    }
}

// ---------------------------------------------------------------- quadrilaterals

struct Patch {
    // A rectangle of distorted quadrilaterals in the plane y = 1.
    Patch(int across, double bend) : n(across) {
        std::mt19937 random(5);
        std::uniform_real_distribution<double> off(-bend, bend);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const bool inside = i > 0 && k > 0 && i + 1 < n && k + 1 < n;
                points.push_back(
                    {(i + (inside ? off(random) : 0)) / (n - 1), 1, (k + (inside ? off(random) : 0)) / (n - 1)});
                uv.push_back(static_cast<float>(points.back().x));
                uv.push_back(static_cast<float>(points.back().z));
            }
        for (int i = 0; i + 1 < n; ++i)
            for (int k = 0; k + 1 < n; ++k)
                quads.insert(quads.end(), {at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
    uint32_t at(int i, int k) const { return static_cast<uint32_t>(i * n + k); }
    taut_cloth_def def() const {
        taut_cloth_def out;
        taut_cloth_def_init(&out);
        out.kind = TAUT_CLOTH_QUADS;
        out.points = points.data();
        out.point_count = static_cast<uint32_t>(points.size());
        out.quads = quads.data();
        out.quad_count = static_cast<uint32_t>(quads.size() / 4);
        out.uv = uv.data();
        out.filter.mask = 0;
        out.gravity_scale = 0;
        return out;
    }

    int n;
    std::vector<taut_pos> points;
    std::vector<uint32_t> quads;
    std::vector<float> uv;
};

class Quads : public testing::TestWithParam<taut_cloth_strain> {};
INSTANTIATE_TEST_SUITE_P(By, Quads, testing::Values(TAUT_CLOTH_STRAIN_GREEN, TAUT_CLOTH_STRAIN_COROTATED),
                         [](const auto& each) {
                             return each.param == TAUT_CLOTH_STRAIN_GREEN ? "Green" : "Corotated";
                         });

// The patch test: a held rim that is mapped linearly has the vertices within come to where the map has them.
TEST_P(Quads, RestInALinearField) {
    const World world;
    const Patch patch(5, 0.25);
    const auto at = [](const taut_pos& p) { return taut_pos{1.1 * p.x + 0.05 * p.z, p.y, 0.96 * p.z}; };
    std::vector<taut_pos> now;
    for (const taut_pos& p : patch.points) now.push_back(at(p));
    for (int i = 1; i < 4; ++i)
        for (int k = 1; k < 4; ++k) now[patch.at(i, k)].x += 0.03 * (k - 2);
    taut_cloth_def def = patch.def();
    def.strain = GetParam();
    def.rest = patch.points.data();
    def.points = now.data();
    def.damping = 0.01f;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k)
            if (i % 4 == 0 || k % 4 == 0) ok(taut_cloth_pin(cloth, patch.at(i, k), 1));
    world.step(360);
    const std::vector<Vec> x = points_of(cloth);
    for (uint32_t v = 0; v < x.size(); ++v) EXPECT_LE(norm(x[v] - Vec(at(patch.points[v]))), 1e-6) << v;
}

// A strip pulled by its ends, which slide sideways: stress E e, of plane strain E/(1 - nu^2) e, and contraction nu e or
// nu/(1 - nu) e, for small e.
TEST_P(Quads, StretchAndContractAsTheirStateOfStressSays) {
    constexpr double kStiffness = 5000, kNu = 0.3, kForce = 10;
    for (const bool plane_strain : {false, true}) {
        const World world;
        const Patch patch(5, 0.25);
        taut_cloth_def def = patch.def();
        def.strain = GetParam();
        def.stretch_stiffness[0] = def.stretch_stiffness[1] = static_cast<float>(kStiffness);
        def.shear_stiffness = static_cast<float>(kStiffness / (2 * (1 + kNu)));
        def.poisson_ratio = static_cast<float>(kNu);
        def.plane_strain = plane_strain ? 1 : 0;
        def.damping = 0.02f;
        def.mass_damping = 5;
        def.area_density = 20;
        const taut_cloth cloth = add(world, def);
        const std::vector<taut_body> bodies = bodies_of(cloth);
        for (int i = 0; i < 600; ++i) {
            for (int k = 0; k < 5; ++k) {
                const double share = k % 4 == 0 ? 0.125 : 0.25;
                ok(taut_body_apply_force(bodies[patch.at(0, k)], Vec(-kForce * share, 0, 0).narrow(), {}));
                ok(taut_body_apply_force(bodies[patch.at(4, k)], Vec(kForce * share, 0, 0).narrow(), {}));
            }
            world.step();
        }
        const std::vector<Vec> x = points_of(cloth);
        const double stretch = norm(x[patch.at(4, 2)] - x[patch.at(0, 2)]) - 1;
        const double across = 1 - norm(x[patch.at(2, 4)] - x[patch.at(2, 0)]);
        const double young = kStiffness / (plane_strain ? 1 - kNu * kNu : 1);
        const double nu = plane_strain ? kNu / (1 - kNu) : kNu;
        EXPECT_NEAR(stretch, kForce / young, 0.01 * kForce / young) << plane_strain;
        EXPECT_NEAR(across, nu * kForce / young, 0.01 * kForce / young) << plane_strain;
    }
}

// As stiff along as it is said to be, in either direction.
TEST_P(Quads, HaveAWarpAndAWeft) {
    for (const bool weft : {false, true}) {
        const World world;
        const Patch patch(4, 0.2);
        taut_cloth_def def = patch.def();
        def.strain = GetParam();
        def.stretch_stiffness[0] = 8000;
        def.stretch_stiffness[1] = 2000;
        def.poisson_ratio = 0;
        def.damping = 0.02f;
        def.mass_damping = 5;
        def.area_density = 20;
        const taut_cloth cloth = add(world, def);
        const std::vector<taut_body> bodies = bodies_of(cloth);
        for (int i = 0; i < 600; ++i) {
            for (int k = 0; k < 4; ++k) {
                const double force = 20 * (k % 3 == 0 ? 1.0 / 6 : 1.0 / 3);
                const Vec along = weft ? Vec(0, 0, force) : Vec(force, 0, 0);
                const uint32_t low = weft ? patch.at(k, 0) : patch.at(0, k);
                const uint32_t high = weft ? patch.at(k, 3) : patch.at(3, k);
                ok(taut_body_apply_force(bodies[low], (-along).narrow(), {}));
                ok(taut_body_apply_force(bodies[high], along.narrow(), {}));
            }
            world.step();
        }
        const std::vector<Vec> x = points_of(cloth);
        const double stretch =
            norm(weft ? x[patch.at(1, 3)] - x[patch.at(1, 0)] : x[patch.at(3, 1)] - x[patch.at(0, 1)]) - 1;
        const double expected = 20 / (weft ? 2000.0 : 8000.0);
        EXPECT_NEAR(stretch, expected, 0.02 * expected) << weft;
    }
}

}  // namespace
