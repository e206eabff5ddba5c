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

// ---------------------------------------------------------------- posts and edges

// What stands along z, its upper end above x = 0, y = 0; what is thrown comes along -y and never has its core within.
struct Ledge {
    const char* name;
    double core;  // of it, from y = 0 [m]
    void (*make)(const World&);
};
constexpr double kLedgeHalf = 0.6;

const std::vector<Ledge>& ledges() {
    static const std::vector<Ledge> all = {
        {"post", -0.01,
         [](const World& w) {
             w.add({.kind = TAUT_BODY_STATIC,
                    .shape = w.capsule(0.01, kLedgeHalf),
                    .position = {0, -0.01, 0},
                    .rotation = Quat::turn({1, 0, 0}, 0.5 * kPi)});
         }},
        {"edge", -0.005,
         [](const World& w) {
             w.add({.kind = TAUT_BODY_STATIC,
                    .shape = w.box({0.2, 0.2, kLedgeHalf}),
                    .position = {0, -0.2 * std::sqrt(2.0), 0},
                    .rotation = Quat::turn({0, 0, 1}, 0.25 * kPi)});
         }},
        {"blade", -0.005,
         [](const World& w) {
             w.add({.kind = TAUT_BODY_STATIC, .shape = w.box({0.005, 0.3, kLedgeHalf}), .position = {0, -0.3, 0}});
         }},
    };
    return all;
}

struct Wrap {
    const char* thrown;
    const Ledge* ledge;
    double speed;  // [m/s]
    bool swept;    // of a cloth
};

std::vector<Wrap> wraps() {
    struct Held {
        const char* thrown;
        bool swept;
        double up_to[3];  // of each ledge [m/s]
    };
    static constexpr Held kHeld[] = {{"cloth", false, {30, 300, 100}},
                                     {"cloth", true, {100, 300, 300}},
                                     {"cable", false, {0, 300, 300}},
                                     {"links", false, {0, 300, 20}}};
    std::vector<Wrap> out;
    for (const Held& held : kHeld)
        for (size_t k = 0; k < ledges().size(); ++k)
            for (const double speed : {1.0, 3.0, 10.0, 20.0, 30.0, 100.0, 300.0})
                if (speed <= held.up_to[k]) out.push_back({held.thrown, &ledges()[k], speed, held.swept});
    return out;
}

class WrapsAround : public testing::TestWithParam<Wrap> {};
INSTANTIATE_TEST_SUITE_P(Ledges, WrapsAround, testing::ValuesIn(wraps()), [](const auto& each) {
    const Wrap& wrap = each.param;
    return std::string(wrap.thrown) + "_" + wrap.ledge->name + "_" + std::to_string(static_cast<int>(wrap.speed)) +
           (wrap.swept ? "_swept" : "");
});

TEST_P(WrapsAround, AndNeverHasItWithin) {
    const Wrap& wrap = GetParam();
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    wrap.ledge->make(world);
    const ThingPlan plan = {.at = {0.013, 0.5, 0.021}, .velocity = {0, -wrap.speed, 0}, .swept = wrap.swept};
    const bool is_cloth = std::string(wrap.thrown) == "cloth";
    const Sheet sheet(9, 9, 0.4, 0.4, 0);
    const std::vector<taut_body> bodies =
        is_cloth ? bodies_of(make_cloth(world, plan, 9))
                 : bodies_of(make_cable(world, plan,
                                        std::string(wrap.thrown) == "cable" ? TAUT_CABLE_PARTICLES : TAUT_CABLE_LINKS));
    const Vec one = {0, wrap.ledge->core, -kLedgeHalf}, other = {0, wrap.ledge->core, kLedgeHalf};
    // Of a cable until its ends have swung as far round as may bring them under it.
    const int frames = is_cloth ? static_cast<int>(30 / wrap.speed) + 12 : static_cast<int>(45 / wrap.speed) + 1;
    for (int i = 0; i < frames; ++i) {
        world.step();
        std::vector<Vec> x;
        for (const taut_body body : bodies) x.push_back(position(body));
        double highest = -1;
        for (const Vec& each : x) highest = std::max(highest, each.y);
        ASSERT_GT(highest, wrap.ledge->core) << "has passed, frame " << i;
        for (size_t t = 0; is_cloth && t < sheet.triangles.size(); t += 3)
            ASSERT_FALSE(
                crosses(one, other, x[sheet.triangles[t]], x[sheet.triangles[t + 1]], x[sheet.triangles[t + 2]]))
                << "frame " << i;
        for (size_t n = 1; !is_cloth && n < x.size(); ++n) {
            const double a = x[n - 1].x, b = x[n].x;
            if (a * b >= 0) continue;
            ASSERT_GT((x[n - 1].y * b - x[n].y * a) / (b - a), wrap.ledge->core) << "frame " << i;
        }
    }
}

}  // namespace
}  // namespace lab
