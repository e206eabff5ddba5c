// The energy of whole islands of minimisation, in a step of a world: gradients and matrices by central differences,
// along the projection where obstacles hold points, and direct solutions by the products.
#include <random>

#include "api/access.h"
#include "physics/deformable_lab.h"
#include "solvers/island_energy.h"
#include "world.h"

namespace taut::test::island {
namespace {

using lab::add;
using lab::Beam;
using lab::BodyPlan;
using lab::Sheet;
using Numbers = std::vector<double>;

constexpr double kYoung = 1e5, kPoisson = 0.3;  // [Pa]

// Islands with all that E has terms for, each on its own; they are looked at once the step has solved them.
class Scene : StageObserver {
public:
    using Look = std::function<void(IslandEnergy&, MinimisationMemory&, const EnergyIsland&)>;

    explicit Scene(taut_scheme scheme)
        : world_([&](taut_world_def& def) {
              def.solver = TAUT_SOLVER_MINIMISATION;
              def.scheme = scheme;
              def.time_step = 1.0f / 24;
              def.substeps = 1;
          }) {
        world_.add_ground();
        add_led_beam();
        add_cube_in_corner();
        add_cubes_in_each_other();
        add_ring_in_itself();
        add_cube_in_mesh();
        add_cloths();
    }
    // After a step that gives what schemes remember.
    void look(const Look& at) {
        world_.step();
        look_ = at;
        {
            const Hold hold(world_of(world_.handle), Use::write);
            ASSERT_NE(hold.world(), nullptr);
            hold.world()->observer = this;
        }
        world_.step();
    }

private:
    void after(World& w, const StageEnd& end) override {
        if (end.stage != Stage::solve) return;
        SolverSettings settings{};
        SolverReport report;
        Substep substep{
            w.team,    w.system, w.partition.groups[end.group], w.partition.blocks, w.nodes, settings, report,
            w.scratch, true};
        MinimisationMemory& m = w.scratch.minimisation.get();
        const size_t holds = m.hold.size(), pairs = m.pair.size();
        for (const EnergyIsland& island : m.island) {
            const Array<uint32_t> hold_of = m.hold_of;
            IslandEnergy energy(substep, island, false);
            energy.find_damping();
            look_(energy, m, island);
            m.hold_of = hold_of;
            m.hold.resize(holds);
            m.pair.resize(pairs);
        }
    }

    // Its end in the ground, the other led.
    void add_led_beam() {
        Beam beam({0.4, 0.1, 0.1}, 5, 3, 3, false);
        for (taut_pos& p : beam.points) p.y -= 0.005 + 0.05 * p.x;
        taut_solid_def def = beam.def(TAUT_SOLID_FIXED_COROTATED, kYoung, kPoisson);
        def.damping = 0.02f;
        def.stiffness_damping = 0.03f;
        const taut_solid solid = add(world_, def);
        beam.hold(solid);
        for (uint32_t v = 0; v < 9; ++v) lab::ok(taut_body_set_velocity(lab::bodies_of(solid)[v], {0.3f, 0.2f, 0}, {}));
    }
    // In the ground and a wall, and about a sphere.
    void add_cube_in_corner() {
        add_cube({3, -0.01, 0}, TAUT_SOLID_NEO_HOOKEAN);
        add_static(world_.box({0.1, 0.5, 0.5}), {2.91, 0.2, 0.1});
        add_static(world_.sphere(0.1), {3.3, 0.1, 0.1});
    }
    void add_cubes_in_each_other() {
        add_cube({6, 1, 0}, TAUT_SOLID_ST_VENANT_KIRCHHOFF);
        add_cube({6.19, 1.03, 0.02}, TAUT_SOLID_COROTATED);
    }
    // A bar bent by more than a turn.
    void add_ring_in_itself() {
        constexpr double kTurn = 6.6;
        Beam bar({1, 0.1, 0.1}, 21, 3, 3, false);
        std::vector<taut_pos> points = bar.points;
        for (taut_pos& p : points) {
            const double turn = kTurn * p.x, r = 1 / kTurn - (p.y - 0.05) + 0.02 * p.x;
            p = {9 + r * std::sin(turn), 1 - r * std::cos(turn), p.z + 0.03 * p.x};
        }
        taut_solid_def def = bar.def(TAUT_SOLID_FIXED_COROTATED, kYoung, kPoisson);
        def.points = def.rest = points.data();
        def.self_collision = 1;
        def.damping = 0.01f;
        add(world_, def);
    }
    void add_cube_in_mesh() {
        std::vector<taut_vec3> vertices;
        for (int i = 0; i < 8; ++i)
            vertices.push_back({i & 1 ? 0.5f : -0.5f, i & 2 ? 0.1f : -0.1f, i & 4 ? 0.5f : -0.5f});
        const uint32_t indices[] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
        const taut_shape box = world_.shape(taut_mesh_def_init, taut_world_add_mesh, [&](taut_mesh_def& def) {
            def.vertices = vertices.data();
            def.vertex_count = 8;
            def.indices = indices;
            def.triangle_count = 12;
        });
        lab::ok(taut_shape_sample_distance(box, 0.02f));
        add_static(box, {11.6, 0.9, 0.1});
        add_cube({12, 0.98, 0}, TAUT_SOLID_FIXED_COROTATED);
    }
    // Of triangles over a sphere, and of links.
    void add_cloths() {
        for (const taut_cloth_kind kind : {TAUT_CLOTH_TRIANGLES, TAUT_CLOTH_LINKS}) {
            const bool links = kind == TAUT_CLOTH_LINKS;
            Sheet sheet(6, 5, 0.5, 0.4, 1);
            for (taut_pos& p : sheet.points) p.x += links ? 18 : 15, p.y += 0.02 * std::sin(20 * p.x + 9 * p.z);
            taut_cloth_def def = sheet.def(kind);
            def.stretch_compliance[0] = def.stretch_compliance[1] = 1e-3f;
            def.shear_compliance = 1e-2f;
            def.bending_stiffness = 1e-3f;
            def.thickness = 0.02f;
            if (links) {
                def.uv = nullptr;
                def.filter.mask = 0;
            } else {
                def.stretch_stiffness[0] = def.stretch_stiffness[1] = 200;
                def.shear_stiffness = 80;
            }
            lab::ok(taut_cloth_pin(add(world_, def), 0, 1));
        }
        add_static(world_.sphere(0.3), {15.25, 0.71, 0.2});
    }
    void add_cube(const lab::Vec& corner, taut_solid_material material) {
        Beam cube({0.2, 0.2, 0.2}, 4, 4, 4, false);
        for (taut_pos& p : cube.points) p = (lab::Vec(p) + corner).pos();
        taut_solid_def def = cube.def(material, kYoung, kPoisson);
        def.damping = 0.01f;
        add(world_, def);
    }
    void add_static(taut_shape shape, const lab::Vec& position) {
        BodyPlan plan;
        plan.kind = TAUT_BODY_STATIC;
        plan.shape = shape;
        plan.position = position;
        world_.add(plan);
    }

    lab::World world_;
    Look look_;
};

class IslandEnergies : public testing::TestWithParam<taut_scheme> {
protected:
    Numbers random(size_t size, double most) {
        Numbers out(size);
        for (double& each : out) each = most * (2 * std::ldexp(static_cast<double>(random_() >> 11), -53) - 1);
        return out;
    }
    // About where the points are as the substep begins, rather below and to the left of it, into what is there.
    Numbers somewhere(const MinimisationMemory& m, const EnergyIsland& island) {
        Numbers z = random(3 * size_t{island.points}, 2e-3);
        for (uint32_t i = 0; i < island.points; ++i) {
            Eigen::Map<Vec3> each(&z[3 * size_t{i}]);
            each = (m.scale[island.first_point + i] * (each - Vec3(2e-3, 2e-3, 0))).eval();
        }
        return z;
    }
    static uint32_t holds_of(const MinimisationMemory& m, uint32_t p) {
        return m.obstacles.any() && m.hold_of[p] != kNone ? m.hold[m.hold_of[p]].count : 0;
    }
    // Where points may go smoothly after hold(), by point: free ones, along the surfaces that hold them, but not those
    // that are on a surface which let them go, where E has a kink.
    static std::vector<Mat3> smooth_ways(const MinimisationMemory& m, const EnergyIsland& island) {
        std::vector<Mat3> out(island.points, Mat3::Zero());
        for (uint32_t i = 0; i < island.points; ++i) {
            const uint32_t p = island.first_point + i, holds = holds_of(m, p);
            if (!m.free[p] || (m.obstacles.any() && m.touch[p].count > holds)) continue;
            out[i] = holds > 0 ? m.hold[m.hold_of[p]].along : Mat3(Mat3::Identity());
        }
        return out;
    }
    static Numbers beside(const Numbers& z, double part, const Numbers& d) {
        Numbers out = z;
        for (size_t i = 0; i < z.size(); ++i) out[i] += part * d[i];
        return out;
    }
    static double sum_of(const Numbers& a, const Numbers& b) {
        double sum = 0;
        for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] * b[i]);
        return sum;
    }

    std::mt19937_64 random_{7};
    static constexpr double kStep = 2e-6;  // of differences, in z [sqrt(J)]
};
INSTANTIATE_TEST_SUITE_P(Of, IslandEnergies,
                         testing::Values(TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2));

// The scene has what it says: islands with damping, of touching solids, within a mesh; points on one surface and more.
TEST_P(IslandEnergies, AreOfAllKinds) {
    uint32_t islands = 0, damped = 0, on_one = 0, on_more = 0, in_mesh = 0, led = 0;
    size_t pairs = 0;
    Scene(GetParam()).look([&](IslandEnergy& energy, MinimisationMemory& m, const EnergyIsland& island) {
        ++islands;
        damped += island.damped ? 1 : 0;
        Numbers z = somewhere(m, island), g(z.size());
        const size_t before = m.pair.size();
        energy.evaluate(z, g);
        energy.hold(z, g);
        pairs += m.pair.size() > before ? 1 : 0;
        for (uint32_t p = island.first_point; p < island.first_point + island.points; ++p) {
            on_one += holds_of(m, p) == 1 ? 1 : 0;
            on_more += holds_of(m, p) > 1 ? 1 : 0;
            led += m.free[p] ? 0 : 1;
            if (m.obstacles.penalties && m.penalty[p].energy > 0) ++in_mesh;
        }
    });
    EXPECT_EQ(islands, 7u);
    EXPECT_EQ(damped, 5u);
    EXPECT_EQ(pairs, 2u);
    EXPECT_GT(on_one, 20u);
    EXPECT_GT(on_more, 2u);
    EXPECT_GT(in_mesh, 5u);
    EXPECT_EQ(led, 11u);
}

// dE/dz of E(P(z)), at places within obstacles.
TEST_P(IslandEnergies, HaveTheGradientOfDifferences) {
    Scene(GetParam()).look([&](IslandEnergy& energy, MinimisationMemory& m, const EnergyIsland& island) {
        for (int tried = 0; tried < 3; ++tried) {
            const Numbers z = somewhere(m, island), d = random(z.size(), 1);
            Numbers at = z, g(z.size()), up = beside(z, kStep, d), down = beside(z, -kStep, d);
            energy.evaluate(at, g);
            for (uint32_t i = 0; i < z.size(); ++i)
                if (!m.free[island.first_point + i / 3]) up[i] = down[i] = z[i], g[i] = 0;
            const double slope = (energy.evaluate(up, {}) - energy.evaluate(down, {})) / (2 * kStep);
            double expected = 0;
            for (size_t i = 0; i < z.size(); ++i) expected += g[i] * d[i];
            EXPECT_NEAR(slope, expected, 1e-6 * sum_of(g, d)) << "island of " << island.points;
        }
    });
}

// The same where points are held, and H by the gradients beside it.
TEST_P(IslandEnergies, HaveTheMatricesOfDifferences) {
    Scene(GetParam()).look([&](IslandEnergy& energy, MinimisationMemory& m, const EnergyIsland& island) {
        for (int tried = 0; tried < 3; ++tried) {
            Numbers z = somewhere(m, island), g(z.size()), raw(z.size()), hd(z.size());
            energy.evaluate(z, g);
            energy.hold(z, g);
            const std::vector<Mat3> ways = smooth_ways(m, island);
            Numbers d = random(z.size(), 1);
            for (uint32_t i = 0; i < island.points; ++i) {
                Eigen::Map<Vec3> each(&d[3 * size_t{i}]);
                each = (ways[i] * each).eval();
            }
            energy.linearise(z, Hessian::exact);
            energy.multiply(d, hd);
            Numbers up = beside(z, kStep, d), down = beside(z, -kStep, d), after(z.size()), before(z.size());
            const double slope = (energy.evaluate(up, after) - energy.evaluate(down, before)) / (2 * kStep);
            double expected = 0, most = 0;
            for (size_t i = 0; i < z.size(); ++i) expected += g[i] * d[i];
            EXPECT_NEAR(slope, expected, 1e-6 * sum_of(g, d)) << "island of " << island.points;
            for (const double each : hd) most = std::max(most, std::abs(each));
            for (uint32_t i = 0; i < island.points; ++i) {
                const auto of = [&](const Numbers& from) { return Vec3(Vec3::Map(&from[3 * size_t{i}])); };
                const Vec3 change = ways[i] * (of(after) - of(before)) / (2 * kStep);
                EXPECT_LT((change - ways[i] * of(hd)).norm(), 1e-5 * most)
                    << "point " << i << " of " << island.points << ", held by " << holds_of(m, island.first_point + i);
            }
        }
    });
}

// Matrices are symmetric, the positive one is positive, and what is solved directly is what products make of it.
TEST_P(IslandEnergies, AreSolvedAsTheyMultiply) {
    uint32_t solved = 0;
    Scene(GetParam()).look([&](IslandEnergy& energy, MinimisationMemory& m, const EnergyIsland& island) {
        Numbers z = somewhere(m, island), g(z.size()), image(z.size());
        energy.evaluate(z, g);
        energy.hold(z, g);
        for (const Hessian which : {Hessian::exact, Hessian::positive}) {
            energy.linearise(z, which);
            double most = 0, apart = 0;
            for (uint32_t p = island.first_point; p < island.first_point + island.points; ++p)
                for (uint32_t b = m.row_begin[p]; b < m.row_begin[p + 1]; ++b)
                    for (uint32_t c = m.row_begin[m.column[b]]; c < m.row_begin[m.column[b] + 1]; ++c) {
                        if (m.column[c] != p) continue;
                        const Mat3 one = Mat3::Map(&m.hessian[9 * size_t{b}]),
                                   other = Mat3::Map(&m.hessian[9 * size_t{c}]);
                        most = std::max(most, one.norm());
                        apart = std::max(apart, (one - other.transpose()).norm());
                    }
            EXPECT_LT(apart, 1e-12 * most);
            const Numbers a = random(z.size(), 1), b = random(z.size(), 1);
            Numbers ha(z.size()), hb(z.size());
            energy.multiply(a, ha);
            energy.multiply(b, hb);
            EXPECT_NEAR(dot_of(a, hb), dot_of(b, ha), 1e-10 * sum_of(a, hb));
            EXPECT_TRUE(which == Hessian::exact || dot_of(a, ha) > 0);
        }
        if (std::isinf(energy.direct_cost())) return;
        const Numbers r = random(z.size(), 1);
        Numbers x = r;
        ASSERT_TRUE(energy.solve(x));
        energy.multiply(x, image);
        for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(image[i], r[i], 1e-9) << i;
        ++solved;
    });
    EXPECT_EQ(solved, 5u);
}

}  // namespace
}  // namespace taut::test::island
