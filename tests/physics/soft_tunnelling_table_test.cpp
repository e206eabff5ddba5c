// Table of speeds, thicknesses and pairs of kinds: who is thrown at whom, and that it does not get through, which is
// told from points alone. What holds, at 5 and 20 mm, direct and swept, of speeds of 1, 3, 10, 30, 100 and 300 m/s:
//
//              held sheet                       static wall of that thickness
//   bullet     300                              300
//   grain      300                              300
//   cable      300; of links, swept: 10          300
//   cloth      300                              300
//   solid      10                               direct 30, swept 10
#include <algorithm>
#include <cmath>

#include "physics/soft_contact_lab.h"

namespace lab {
namespace {

// A target that stands still at y = 0; what is thrown comes along -y from half a metre above.
struct Target {
    const char* name;
    bool sheet;  // held all round: what is thrown is to stay above its lowest point; else above y = 0 at its place
    void (*make)(const World&, double thick, bool swept, std::vector<taut_body>& held);
};
struct Thrown {
    const char* name;
    std::vector<taut_body> (*make)(const World&, const ThingPlan&);
    double held_by_sheet[2], held_by_wall[2];  // up to this speed, direct and swept [m/s]
};

void make_held_sheet(const World& world, double thick, bool swept, std::vector<taut_body>& held) {
    constexpr int kSide = 11;
    Sheet sheet(kSide, kSide, 1, 1, 0);
    for (taut_pos& p : sheet.points) p = (Vec(p) - Vec{0.5, 0, 0.5}).pos();
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.area_density = 0.5f;
    def.thickness = static_cast<float>(thick);
    def.solve = swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < kSide; ++i)
        for (const int k : {0, kSide - 1})
            for (const uint32_t v : {sheet.at(i, k), sheet.at(k, i)}) ok(taut_cloth_pin(cloth, v, 1));
    held = bodies_of(cloth);
}
void make_thin_wall(const World& world, double thick, bool, std::vector<taut_body>&) {
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({1, 0.5 * thick, 1})});
}

std::vector<taut_body> make_bullet(const World& world, const ThingPlan& plan) {
    return {world.add({.shape = world.sphere(0.02), .position = plan.at, .velocity = plan.velocity, .mass = 0.01})};
}

const std::vector<Target>& targets() {
    static const std::vector<Target> all = {{"sheet", true, make_held_sheet}, {"wall", false, make_thin_wall}};
    return all;
}
const std::vector<Thrown>& throwns() {
    using List = std::vector<taut_body>;
    static const std::vector<Thrown> all = {
        {"bullet", make_bullet, {300, 300}, {300, 300}},
        {"grain",
         [](const World& w, const ThingPlan& p) { return List{make_grain(w, p, true)}; },
         {300, 300},
         {300, 300}},
        {"cable",
         [](const World& w, const ThingPlan& p) { return bodies_of(make_cable(w, p, TAUT_CABLE_PARTICLES)); },
         {300, 300},
         {300, 300}},
        {"links",
         [](const World& w, const ThingPlan& p) { return bodies_of(make_cable(w, p, TAUT_CABLE_LINKS)); },
         {300, 10},
         {300, 300}},
        {"solid", [](const World& w, const ThingPlan& p) { return bodies_of(make_solid(w, p)); }, {10, 10}, {30, 10}},
        {"cloth",
         [](const World& w, const ThingPlan& p) { return bodies_of(make_cloth(w, p)); },
         {300, 300},
         {300, 300}},
    };
    return all;
}

struct Cell {
    const Thrown* thrown;
    const Target* target;
    double speed, thick;  // [m/s], [m]
    bool swept;
};

std::vector<Cell> cells() {
    std::vector<Cell> out;
    for (const Thrown& thrown : throwns())
        for (const Target& target : targets())
            for (const double speed : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0})
                for (const double thick : {0.005, 0.02})
                    for (const bool swept : {false, true}) {
                        const double(&held)[2] = target.sheet ? thrown.held_by_sheet : thrown.held_by_wall;
                        if (speed <= held[swept]) out.push_back({&thrown, &target, speed, thick, swept});
                    }
    return out;
}

// Lowest point.
double lowest_of(const std::vector<taut_body>& bodies) {
    double out = 1e9;
    for (const taut_body body : bodies) out = std::min(out, position(body).y);
    return out;
}

class TunnellingTable : public testing::TestWithParam<Cell> {};
INSTANTIATE_TEST_SUITE_P(Cells, TunnellingTable, testing::ValuesIn(cells()), [](const auto& each) {
    const Cell& cell = each.param;
    return std::string(cell.thrown->name) + "_" + cell.target->name + "_" +
           std::to_string(static_cast<int>(cell.speed)) + "_" + std::to_string(static_cast<int>(1000 * cell.thick)) +
           (cell.swept ? "_swept" : "");
});

TEST_P(TunnellingTable, NothingGetsThrough) {
    const Cell& cell = GetParam();
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    std::vector<taut_body> held;
    cell.target->make(world, cell.thick, cell.swept, held);
    const std::vector<taut_body> thrown =
        cell.thrown->make(world, {.at = {0.013, 0.5, 0.021}, .velocity = {0, -cell.speed, 0}, .swept = cell.swept});
    const int frames = static_cast<int>(40 / cell.speed) + 12;
    for (int i = 0; i < frames; ++i) {
        world.step();
        const double floor = cell.target->sheet ? lowest_of(held) : 0;
        ASSERT_TRUE(std::ranges::all_of(thrown, [](taut_body body) { return finite(body); })) << "frame " << i;
        ASSERT_GE(lowest_of(thrown), floor - 0.01) << "frame " << i;
    }
}

}  // namespace
}  // namespace lab
