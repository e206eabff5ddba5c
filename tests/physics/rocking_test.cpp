// Round bodies that rock, roll and wobble on what holds them, and towers that sway, lose energy, as mechanics says, or
// keep it.
#include "physics/surface_lab.h"
#include "starts.h"

#include <algorithm>
#include <random>

namespace {

using namespace lab;

struct Rocker {
    const char* name;
    taut_shape (*make)(const World&);
};

const Rocker kRockers[] = {
    {"cone", [](const World& w) { return w.cone(0.25, 0.22); }},
    {"disc", [](const World& w) { return w.cylinder(0.28, 0.05); }},
    {"cylinder", [](const World& w) { return w.cylinder(0.22, 0.18); }},
    {"rod", [](const World& w) { return w.cylinder(0.1, 0.3); }},
    {"coin", [](const World& w) { return w.cylinder(0.1, 0.01); }},
    {"capsule", [](const World& w) { return w.tapered_capsule(0.13, 0.13, 0.17); }},
    {"tapered capsule", [](const World& w) { return w.tapered_capsule(0.2, 0.1, 0.16); }},
};

void add_static(const World& world, taut_shape shape, const Vec& position = {}, const Quat& rotation = {}) {
    world.add({.kind = TAUT_BODY_STATIC, .shape = shape, .position = position, .rotation = rotation});
}

struct Support {
    const char* name;
    void (*add)(const World&);
};

const Support kSupports[] = {
    {"plane", [](const World& w) { add_static(w, w.plane()); }},
    {"groove",
     [](const World& w) {
         for (double side : {-1.0, 1.0}) add_static(w, w.plane({side, 1, 0}));
     }},
    {"corner",
     [](const World& w) {
         for (double side : {-1.0, 1.0}) {
             add_static(w, w.plane({side, 1, 0}));
             add_static(w, w.plane({0, 0.5, side}), {0, 0, -0.2 * side});
         }
     }},
    {"edge",  // of a box on the ground
     [](const World& w) {
         add_static(w, w.box({1, 0.1, 1}), {-1, 0.1, 0});
         add_static(w, w.plane());
     }},
    {"mesh_groove",
     [](const World& w) {
         Triangles sides;
         for (double side : {-1.0, 1.0})
             sides.add_quad({0, 0, -3 * side}, {0, 0, 3 * side}, {3 * side, 3, 3 * side}, {3 * side, 3, -3 * side});
         add_static(w, mesh(w, sides));
     }},
    {"hills",
     [](const World& w) {
         const auto hills = [](double x, double z) { return 0.05 * (std::sin(7 * x) + std::sin(5 * z)); };
         add_static(w, height_field(w, 25, 25, 0.25, hills), {-3, 0, -3});
     }},
    {"logs",  // side by side, longer than anything rolls
     [](const World& w) {
         for (double x : {-1.0, -0.6, -0.2, 0.2, 0.6, 1.0})
             add_static(w, w.cylinder(0.2, 4), {x, 0, 0}, Quat::turn({1, 0, 0}, kPi / 2));
         add_static(w, w.plane(), {0, -1, 0});
     }},
};

class Start {  // a random one
public:
    explicit Start(uint32_t seed) : bits_(seed) {}
    double within(double most) { return most * (2 * (bits_() * 0x1p-32) - 1); }

private:
    std::mt19937 bits_;
};

// Kinetic and of height [J/kg].
double energy_of(taut_body body) {
    float mass = 0;
    taut_vec3 centre{};
    taut_sym3 inertia{};
    ok(taut_body_get_mass(body, &mass, &centre, &inertia));
    const BodyState s = state(body);
    const double spinning = 0.5 * dot(s.spin, spin_momentum(s, inertia)) / static_cast<double>(mass);
    return 0.5 * dot(s.velocity, s.velocity) + spinning + kG * (s.position + s.rotation.rotate(centre)).y;
}

// What a body dropped at random has gained in the end, at most, over the least that it had before [J/kg]; looked at
// once it lies on something.
double most_gained(const Rocker& rocker, const Support& support, uint32_t substeps, uint32_t seed) {
    constexpr int kFalls = 40, kFrames = 900;
    const World world([&](taut_world_def& def) { def.substeps = substeps; });
    support.add(world);
    Start start(seed);
    const auto vector = [&](double most) { return Vec{start.within(most), start.within(most), start.within(most)}; };
    const Vec at = Vec(0, 0.45, 0) + vector(0.1), axis = vector(1);
    const taut_body body = world.add({.shape = rocker.make(world),
                                      .position = at,
                                      .rotation = Quat::turn(axis, start.within(kPi)),
                                      .velocity = vector(0.3),
                                      .spin = vector(2)});
    world.step(kFalls);
    double least = energy_of(body), gained = 0;
    for (int frame = kFalls; frame < kFrames; ++frame) {
        world.step();
        const double energy = energy_of(body);
        least = std::min(least, energy);
        gained = std::max(gained, energy - least);
    }
    EXPECT_GT(state(body).position.y, -1) << rocker.name << " fell off " << support.name;
    return gained;
}

class RockingOn : public testing::TestWithParam<Support> {};

// Contacts that came late drove them to 0.3 J/kg and more, the height of 30 mm, and so on average. What a blow drove in
// is pushed out by some mm, one in hundreds of coins over an edge or wedged between logs by 13 to 15: 0.15 J/kg.
TEST_P(RockingOn, GainsNoEnergy) {
    const uint32_t count = starts(12u);
    const double mean_bound = 0.012 * std::sqrt(12.0 / count);  // the mean of fewer varies more
    for (const Rocker& rocker : kRockers)
        for (const uint32_t substeps : {4u, 16u}) {
            double mean = 0, most = 0;
            for (uint32_t seed = 0; seed < count; ++seed) {
                const double gained = most_gained(rocker, GetParam(), substeps, seed);
                mean += gained / count;
                most = std::max(most, gained);
            }
            std::printf("%s on %s, %d substeps: gains %.4f J/kg, at most %.4f\n", rocker.name, GetParam().name,
                        static_cast<int>(substeps), mean, most);
            EXPECT_LE(mean, mean_bound) << rocker.name << ", " << substeps << " substeps";
            EXPECT_LE(most, 0.15) << rocker.name << ", " << substeps << " substeps";
        }
}

INSTANTIATE_TEST_SUITE_P(A, RockingOn, testing::ValuesIn(kSupports),
                         [](const auto& tested) -> std::string { return tested.param.name; });

using MakePart = taut_shape (*)(const World&, const Vec& half);

taut_shape hull_of_cube(const World& world, const Vec& half) {
    std::vector<taut_vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(Vec(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z).narrow());
    return hull(world, corners);
}

struct Part {
    const char* name;
    MakePart make;
    double height;  // [m]
};
const Part kParts[] = {
    {"boxes", [](const World& w, const Vec& half) { return w.box(half); }, 0.5},
    {"hulls", hull_of_cube, 0.5},
    {"discs", [](const World& w, const Vec& half) { return w.cylinder(half.x, half.y); }, 0.1},
};

// Of parts askew that are pushed over a little: the fastest of them after 15 s [m/s].
double sway_of_tower(const Part& part, bool on_plane, int parts, uint32_t seed) {
    const World world([](taut_world_def& def) { def.sleeping = 0; });
    if (on_plane)
        add_static(world, world.plane());
    else
        add_static(world, part.make(world, {2, 0.05, 2}), {0, -0.05, 0});
    Start start(seed);
    std::vector<taut_body> tower;
    const Vec push(start.within(0.3), 0, start.within(0.3));
    for (int i = 0; i < parts; ++i)
        tower.push_back(world.add({.shape = part.make(world, {0.25, 0.5 * part.height, 0.25}),
                                   .position = {start.within(0.02), (i + 0.5) * part.height, start.within(0.02)},
                                   .velocity = (i + 1.0) / parts * push}));
    world.step(900);
    double fastest = 0;
    for (const taut_body body : tower) fastest = std::max(fastest, norm(velocity(body)));
    return fastest;
}

// Where contacts answered a tilt to the front by a push to the side, one of six whirled for ever, at 0.03 to 0.1 m/s;
// where points of a patch were chosen anew in every frame, one of three of discs.
// Six discs still turn on their rims at 5 to 18 mm/s in 1 of 50 starts (of 320, before and after contacts kept forces).
TEST(Tower, ThatSwaysComesToRest) {
    int towers = 0, swaying = 0;
    for (const Part& part : kParts)
        for (const bool on_plane : {true, false})
            for (const int parts : {5, 6})
                for (uint32_t seed = 0; seed < starts(12u); ++seed) {
                    const double speed = sway_of_tower(part, on_plane, parts, seed);
                    EXPECT_LT(speed, 0.03) << parts << ' ' << part.name
                                           << (on_plane ? " on a plane" : " on their like") << ", start " << seed;
                    ++towers;
                    swaying += speed >= 0.005;
                }
    EXPECT_LE(swaying, towers / 20) << "of " << towers;
}

}  // namespace
