// Coulomb's law on a held sheet of many small triangles, several of which things slide over within a frame: nothing
// catches on edges and vertices within what is flat, and all that is convex holds.
#include <tuple>

#include "physics/soft_contact_lab.h"

namespace lab {
namespace {

constexpr double kSlope = 0.6, kSlide = 0.3;  // tangent of the slope, friction

// Held in all vertices, level, gravity leaning towards x.
void add_sheet(const World& world, int rows, int columns, double length, double width, bool swept) {
    Sheet sheet(rows, columns, length, width, -0.01);
    for (taut_pos& point : sheet.points) point = (Vec(point) - Vec{0.25 * length, 0, 0.5 * width}).pos();
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    def.material.friction = static_cast<float>(kSlide);
    def.solve = swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < sheet.points.size(); ++v) ok(taut_cloth_pin(cloth, v, 1));
}

struct FineSlide {
    const ThingKind* kind;
    bool swept;
    int rate;         // frames a second
    double triangle;  // side of the sheet's squares [m]
};

std::vector<FineSlide> fine_slides() {
    std::vector<FineSlide> out;
    for (const ThingKind& kind : thing_kinds()) {
        const std::string name = kind.name;
        if (name == "ball" || name == "capsule" || name == "cylinder" || name == "cone") continue;  // these roll
        for (const bool swept : {false, true})
            for (const int rate : {60, 240})
                for (const double triangle : {0.03, 0.12}) out.push_back({&kind, swept, rate, triangle});
    }
    return out;
}

class FineSheet : public testing::TestWithParam<FineSlide> {
protected:
    FineSheet()
        : world([](taut_world_def& def) {
              const double angle = std::atan(kSlope);
              def.gravity = Vec{kG * std::sin(angle), -kG * std::cos(angle), 0}.narrow();
              def.time_step = 1.0f / static_cast<float>(GetParam().rate);
          }) {
        add_sheet(world, 56, 32, 55 * GetParam().triangle, 31 * GetParam().triangle, GetParam().swept);
    }
    World world;
};
INSTANTIATE_TEST_SUITE_P(Kinds, FineSheet, testing::ValuesIn(fine_slides()), [](const auto& each) {
    return std::string(each.param.kind->name) + (each.param.swept ? "_swept_" : "_") + std::to_string(each.param.rate) +
           "Hz_" + std::to_string(static_cast<int>(std::lround(1000 * each.param.triangle))) + "mm";
});

TEST_P(FineSheet, BrakesByCoulombsLaw) {
    const std::string name = GetParam().kind->name;
    const double height = name == "solid"                         ? 0.16
                          : name == "box"                         ? 0.07
                          : name == "cloth"                       ? 0.01
                          : name == "grain" || name == "particle" ? 0.05
                                                                  : 0.02;
    const std::vector<taut_body> bodies =
        GetParam().kind->make(world, {.at = {0.013, height, 0.021}, .friction = kSlide, .swept = GetParam().swept});
    world.step(GetParam().rate * 3 / 10);
    const Vec before = 1 / totals(bodies).mass * totals(bodies).momentum;
    const int measured = GetParam().rate * 4 / 10;
    world.step(measured);
    const Vec after = 1 / totals(bodies).mass * totals(bodies).momentum;
    const double angle = std::atan(kSlope), time = measured * world.frame();
    const double friction =
        (kG * std::sin(angle) * time - (after - before).x) / (kG * std::cos(angle) * time + (after - before).y);
    EXPECT_NEAR(friction, kSlide, 0.01 * kSlide);
    EXPECT_GT(after.x, 0.5);
}

// What is convex holds what slides over it without friction, edge by edge, and lets it go where a cylinder does: from
// rest at an angle t_0 from the top the speed is v^2 = 2 g r (cos t_0 - cos t), and it leaves at cos t = 2/3 cos t_0.
class FineCylinder : public testing::TestWithParam<std::tuple<const char*, int>> {};
INSTANTIATE_TEST_SUITE_P(Kinds, FineCylinder,
                         testing::Combine(testing::Values("grain", "particle", "ball"), testing::Values(60, 240)),
                         [](const auto& each) {
                             return std::string(std::get<0>(each.param)) + "_" +
                                    std::to_string(std::get<1>(each.param)) + "Hz";
                         });

TEST_P(FineCylinder, IsLeftWhereItsCurveFallsAway) {
    const auto& [name, rate] = GetParam();
    World world([rate = rate](taut_world_def& def) { def.time_step = 1.0f / static_cast<float>(rate); });
    constexpr double kRadius = 0.5, kFirst = 0.3;
    Sheet sheet(61, 11, 3, 0.5, 0);
    for (taut_pos& point : sheet.points) {
        const double angle = (point.x - 1.5) / kRadius;
        point = Vec(kRadius * std::sin(angle), kRadius * std::cos(angle), point.z - 0.25).pos();
    }
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    def.material.friction = 0;
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < sheet.points.size(); ++v) ok(taut_cloth_pin(cloth, v, 1));
    const bool ball = std::string(name) == "ball";
    const double r = kRadius + 0.01 + (ball ? 0.1 : 0.05);
    const ThingPlan plan{.at = {r * std::sin(kFirst), r * std::cos(kFirst), 0.013}, .friction = 0};
    const taut_body body =
        ball ? make_rigid(world, plan, world.sphere(0.1)) : make_grain(world, plan, std::string(name) == "grain");
    const auto off = [&] { return norm(Vec{position(body).x, position(body).y, 0}) - r; };
    const double leaves = 2.0 / 3 * std::cos(kFirst);
    double cosine = std::cos(kFirst), last = 0;
    for (; cosine > leaves + 0.03; cosine = position(body).y / (r + off())) {
        EXPECT_NEAR(off(), 0, 4e-3) << cosine;  // a facet lies up to .6 mm within
        EXPECT_NEAR(norm(velocity(body)), std::sqrt(2 * kG * r * (std::cos(kFirst) - cosine)), 0.04 + kG / rate);
        last = off();
        ASSERT_LT(position(body).x, r);
        world.step();
    }
    for (; cosine > leaves - 0.25; cosine = position(body).y / (r + off())) world.step();
    EXPECT_GT(off(), last + 5e-3) << "held beyond where it leaves";
    EXPECT_NEAR(position(body).z, 0.013, 5e-3);
}

}  // namespace
}  // namespace lab
