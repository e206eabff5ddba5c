// Nothing tunnels: bullets at cloth, cloth at posts and edges, cloth at itself. What has passed is counted from points
// and triangles alone.
#include "physics/soft_contact_lab.h"

namespace lab {
namespace {

// Edges of a sheet through triangles of the same that have no vertex in common with them.
int crossings(const Sheet& sheet, const std::vector<Vec>& x) {
    int count = 0;
    const auto& t = sheet.triangles;
    for (size_t i = 0; i < t.size(); i += 3)
        for (size_t k = 0; k < t.size(); k += 3) {
            bool apart = true;
            for (size_t m = 0; m < 9; ++m) apart = apart && t[i + m / 3] != t[k + m % 3];
            for (size_t e = 0; e < 3 && apart; ++e)
                count += crosses(x[t[i + e]], x[t[i + (e + 1) % 3]], x[t[k]], x[t[k + 1]], x[t[k + 2]]);
        }
    return count;
}

// ---------------------------------------------------------------- bullets

struct Shot {
    const char* at;
    double x, z;  // from the middle, in cells
    double speed;
    bool swept;
};

std::vector<Shot> shots() {
    std::vector<Shot> out;
    for (const Shot& place : {Shot{"vertex", 0, 0, 0, false}, Shot{"edge", 0.5, 0, 0, false},
                              Shot{"diagonal", 0.5, 0.5, 0, false}, Shot{"face", 0.3, 0.6, 0, false}})
        for (const double speed : {1.0, 10.0, 50.0, 300.0})
            for (const bool swept : {false, true}) out.push_back({place.at, place.x, place.z, speed, swept});
    return out;
}

class BulletAtCloth : public testing::TestWithParam<Shot> {};
INSTANTIATE_TEST_SUITE_P(Shots, BulletAtCloth, testing::ValuesIn(shots()), [](const auto& each) {
    return std::string(each.param.at) + "_" + std::to_string(static_cast<int>(each.param.speed)) +
           (each.param.swept ? "_swept" : "");
});

TEST_P(BulletAtCloth, DoesNotPass) {
    const Shot& shot = GetParam();
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    constexpr int kSide = 11;
    constexpr double kLength = 1, kCell = kLength / (kSide - 1), kRadius = 0.02;
    const Sheet sheet(kSide, kSide, kLength, kLength, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.area_density = 0.5f;
    def.solve = shot.swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < kSide; ++i)
        for (const int k : {0, kSide - 1})
            for (const uint32_t v : {sheet.at(i, k), sheet.at(k, i)}) ok(taut_cloth_pin(cloth, v, 1));
    const Vec from = {0.5 * kLength + shot.x * kCell, 0.5, 0.5 * kLength + shot.z * kCell};
    const taut_body bullet =
        world.add({.shape = world.sphere(kRadius), .position = from, .velocity = {0, -shot.speed, 0}, .mass = 0.01});
    const int frames = static_cast<int>(60 / shot.speed) + 12;
    for (int i = 0; i < frames; ++i) {
        world.step();
        ASSERT_TRUE(finite(bullet));
        double lowest = 0;
        for (const Vec& x : points_of(cloth)) lowest = std::min(lowest, x.y);
        ASSERT_GE(position(bullet).y, lowest - kRadius) << "frame " << i;
    }
}

// ---------------------------------------------------------------- posts and edges

struct Throw {
    double speed, thick;
    bool swept;
};
// Of the faster ones the quick tests take each speed and thickness once.
std::vector<Throw> throws(bool quick) {
    std::vector<Throw> out;
    for (const double speed : {2.0, 5.0, 10.0, 20.0})
        for (const double thick : {0.005, 0.02})
            for (const bool swept : {false, true})
                if ((swept || speed < 5 || (speed > 5 && thick < 0.01)) == quick) out.push_back({speed, thick, swept});
    return out;
}

class ClothAtPost : public testing::TestWithParam<Throw> {};
void PrintTo(const Throw& tested, std::ostream* out) {
    *out << tested.speed << '_' << 1000 * tested.thick << (tested.swept ? "_swept" : "");
}
INSTANTIATE_TEST_SUITE_P(Throws, ClothAtPost, testing::ValuesIn(throws(true)), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Soak, ClothAtPost, testing::ValuesIn(throws(false)), testing::PrintToStringParamName());

TEST_P(ClothAtPost, NeverHasItWithin) {
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Sheet sheet(13, 13, 0.6, 0.6, 0.4);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.thickness = static_cast<float>(GetParam().thick);
    def.solve = GetParam().swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const taut_cloth cloth = add(world, def);
    set_velocities(bodies_of(cloth), {0, -GetParam().speed, 0});
    // Along z, off the rows of vertices.
    constexpr double kRadius = 0.01, kHalf = 0.5, kAt = 0.31;
    world.add({.kind = TAUT_BODY_STATIC,
               .shape = world.capsule(kRadius, kHalf),
               .position = {kAt, 0, 0.3},
               .rotation = Quat::turn({1, 0, 0}, 0.5 * kPi)});
    const Vec one = {kAt, 0, 0.3 - kHalf}, other = {kAt, 0, 0.3 + kHalf};
    for (int i = 0; i < 40; ++i) {
        world.step();
        const std::vector<Vec> x = points_of(cloth);
        for (size_t t = 0; t < sheet.triangles.size(); t += 3)
            ASSERT_FALSE(
                crosses(one, other, x[sheet.triangles[t]], x[sheet.triangles[t + 1]], x[sheet.triangles[t + 2]]))
                << "frame " << i;
    }
    double lowest = 1, highest = -1;  // it was caught, not passed by
    for (const Vec& x : points_of(cloth)) lowest = std::min(lowest, x.y), highest = std::max(highest, x.y);
    EXPECT_GT(highest, -0.1);
}

// ---------------------------------------------------------------- itself

class ClothAtItself : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Ways, ClothAtItself, testing::Bool(),
                         [](const auto& each) { return std::string(each.param ? "swept" : "direct"); });

TEST_P(ClothAtItself, FallsInAHeapWithoutACrossing) {
    const World world;
    world.add_ground(0.5);
    constexpr int kSide = 13;
    Sheet sheet(kSide, kSide, 0.6, 0.6, 0);
    for (taut_pos& p : sheet.points) {  // upright, leaning, wavy
        const double up = p.x;
        p = {0.03 * up + 0.004 * std::sin(30 * up), 0.02 + up, p.z};
    }
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.thickness = 0.01f;
    def.self_collision = 1;
    def.solve = GetParam() ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < 90; ++i) world.step();
    EXPECT_EQ(crossings(sheet, points_of(cloth)), 0);
    double highest = 0;
    for (const Vec& x : points_of(cloth)) highest = std::max(highest, x.y);
    EXPECT_LT(highest, 0.4) << "it does not fall";
}

}  // namespace
}  // namespace lab
