// Tangled solids in worlds of real time: taut_solid_recover, some of Newton's steps a frame.
#include <random>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

struct RecoverCase {
    taut_solid_material material;
    double rate;  // steps a second [Hz]
    uint64_t seed;
};
void PrintTo(const RecoverCase& of, std::ostream* out) {
    *out << (of.material == TAUT_SOLID_NEO_HOOKEAN ? "neo_hookean_" : "fixed_corotated_") << of.rate << "_Hz_"
         << of.seed;
}

constexpr uint32_t kStepsAFrame = 4;  // of Newton's method

// A cube of 1 m over ground, whose vertices are anywhere within it.
class Tangled {
public:
    explicit Tangled(const RecoverCase& of, const std::function<void(taut_world_def&)>& change = {})
        : world([&](taut_world_def& def) {
              def.time_step = static_cast<float>(1 / of.rate);
              if (change) change(def);
          }) {
        const Beam cube({1, 1, 1}, 5, 5, 5, false);
        taut_solid_def def = cube.def(of.material, 1e5, 0.3);
        std::mt19937_64 random(of.seed);
        const auto unit = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
        std::vector<taut_pos> points = cube.points;
        for (taut_pos& p : points) p = {unit(), unit() + 1, unit()};
        def.rest = def.points;
        def.points = points.data();
        world.add_ground();
        solid = add(world, def);
    }
    uint32_t inverted() const {
        uint32_t count = 0, below = 0;
        taut_solid_get_volumes(solid, nullptr, 0, &count);
        std::vector<float> volume(count);
        ok(taut_solid_get_volumes(solid, volume.data(), count, &count));
        for (const float each : volume) below += each <= 0;
        return below;
    }

    World world;
    taut_solid solid{};
};

class Recovers : public testing::TestWithParam<RecoverCase> {};

// Then it springs up from what strain is left, falls, and is in one piece over the ground.
TEST_P(Recovers, WithinFramesAndStaysSo) {
    Tangled tangled(GetParam());
    int frames = 0;
    for (int frame = 1; frame <= 20; ++frame) {
        uint32_t left = 0;
        if (tangled.inverted() > 0) frames = frame;
        ok(taut_solid_recover(tangled.solid, kStepsAFrame, &left));
        EXPECT_EQ(left, tangled.inverted());
        tangled.world.step();
    }
    RecordProperty("frames", frames);
    EXPECT_EQ(tangled.inverted(), 0u);
    tangled.world.step(static_cast<int>(GetParam().rate));
    EXPECT_EQ(tangled.inverted(), 0u);
    const std::vector<Vec> points = points_of(tangled.solid);
    for (const Vec& p : points) {
        EXPECT_GT(p.y, -0.05);
        EXPECT_LT(norm(p - points[0]), 2.2);
    }
}
std::vector<RecoverCase> recoveries() {
    std::vector<RecoverCase> out;
    for (const taut_solid_material material : {TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_FIXED_COROTATED})
        for (const double rate : {30.0, 60.0, 120.0, 240.0}) out.push_back({material, rate, 1 + out.size()});
    return out;
}
INSTANTIATE_TEST_SUITE_P(Cubes, Recovers, testing::ValuesIn(recoveries()), testing::PrintToStringParamName());

constexpr RecoverCase kUsual{TAUT_SOLID_NEO_HOOKEAN, 60, 3};

// As long as the same solid takes with it.
TEST(Recover, StaysTangledWithoutIt) {
    Tangled tangled(kUsual);
    tangled.world.step(15);
    EXPECT_GT(tangled.inverted(), 10u);
}

// Neither pushes it: its own forces alone move it, and what they give is dissipated.
TEST(Recover, KeepsTheCentreOfMassAndItsVelocity) {
    Tangled tangled(kUsual, [](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const std::vector<taut_body> vertices = bodies_of(tangled.solid);
    for (size_t v = 0; v < vertices.size(); ++v)
        ok(taut_body_set_velocity(vertices[v], {v % 2 ? 3.0f : -1.0f, 0.5f, 0}, {}));
    const Totals before = totals(vertices);
    const Vec speed = 1 / before.mass * before.momentum;
    ok(taut_solid_recover(tangled.solid, 100, nullptr));
    EXPECT_EQ(tangled.inverted(), 0u);
    EXPECT_LT(norm(totals(vertices).centre - before.centre), 1e-6);
    for (const taut_body body : vertices) EXPECT_LT(norm(velocity(body) - speed), 1e-5);
}

TEST(Recover, LeavesPinnedVerticesAndTouchesNothingElse) {
    Tangled tangled(kUsual);
    const Beam other({1, 1, 1}, 2, 2, 2, false);
    taut_solid_def def = other.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.3);
    const taut_solid calm = add(tangled.world, def);
    const std::vector<Vec> before = points_of(calm);
    const Vec held = points_of(tangled.solid)[17];
    ok(taut_solid_pin(tangled.solid, 17, 1));
    ok(taut_solid_recover(tangled.solid, 100, nullptr));
    EXPECT_EQ(norm(points_of(tangled.solid)[17] - held), 0);
    uint32_t left = 7;
    ok(taut_solid_recover(calm, 100, &left));
    EXPECT_EQ(left, 0u);
    const std::vector<Vec> after = points_of(calm);
    for (size_t v = 0; v < before.size(); ++v) EXPECT_EQ(norm(after[v] - before[v]), 0);
}

TEST(Recover, HasTheSameBitsOnAnyTeam) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        Tangled tangled(kUsual, [&](taut_world_def& def) { def.threads = threads; });
        for (int frame = 0; frame < 5; ++frame) {
            ok(taut_solid_recover(tangled.solid, kStepsAFrame, nullptr));
            tangled.world.step();
        }
        hashes.emplace_back();
        ok(taut_world_get_state_hash(tangled.world.handle, &hashes.back()));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Recover, RefusesWhatIsOutOfRangeAndWorldsThatDoItThemselves) {
    Tangled tangled(kUsual);
    for (const uint32_t steps : {0u, 1001u})
        EXPECT_EQ(taut_solid_recover(tangled.solid, steps, nullptr), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_solid_recover({}, 1, nullptr), TAUT_STALE_HANDLE);
    Tangled minimised(kUsual, [](taut_world_def& def) { def.solver = TAUT_SOLVER_MINIMISATION; });
    EXPECT_EQ(taut_solid_recover(minimised.solid, 1, nullptr), TAUT_UNSUPPORTED);
    EXPECT_NE(std::string(taut_last_error()).find("TAUT_SOLVER_MINIMISATION"), std::string::npos);
}

}  // namespace
