// Grains: contacts between them against brute force, mechanics, and the same particles on the path of all bodies.
#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "physics/lab.h"

namespace {

using namespace lab;

struct GrainPlan {
    double radius = 0.05, mass = 1;
    Vec position{}, velocity{};
    double friction = 0.5, gravity_scale = 1;
    int32_t group = 0;
    bool grain = true;
};

// Spheres are shared by radius.
class Sand {
public:
    explicit Sand(const std::function<void(taut_world_def&)>& change = {}) : world(change) {}

    taut_body add(const GrainPlan& plan) {
        auto [at, is_new] = sphere_.try_emplace(plan.radius);
        if (is_new) at->second = world.sphere(plan.radius);
        taut_particle_def d;
        taut_particle_def_init(&d);
        d.mass = static_cast<float>(plan.mass);
        d.position = plan.position.pos();
        d.velocity = plan.velocity.narrow();
        d.gravity_scale = static_cast<float>(plan.gravity_scale);
        d.shape = at->second;
        d.material.friction = static_cast<float>(plan.friction);
        d.filter.group = plan.group;
        d.collider_flags = plan.grain ? TAUT_COLLIDER_GRAIN : 0;
        taut_body out{};
        ok(taut_world_add_particle(world.handle, &d, &out));
        grains.push_back(out);
        return out;
    }
    void add_walls(double half, double height) {
        world.add_ground();
        for (const Vec& side : {Vec{1, 0, 0}, Vec{-1, 0, 0}, Vec{0, 0, 1}, Vec{0, 0, -1}})
            world.add({.kind = TAUT_BODY_STATIC,
                       .shape = world.box({side.x != 0 ? 0.5 : half + 1, height, side.z != 0 ? 0.5 : half + 1}),
                       .position = (half + 0.5) * side + Vec{0, height, 0}});
    }
    // A lattice, each a little out of its place.
    void pour(int count, int row, unsigned seed, bool grain = true) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> jitter(-0.01, 0.01);
        for (int i = 0; i < count; ++i) {
            const Vec at{0.12 * (i % row - 0.5 * (row - 1)), 0.1 + 0.12 * (i / (row * row)),
                         0.12 * (i / row % row - 0.5 * (row - 1))};
            add({.position = at + Vec{jitter(random), jitter(random), jitter(random)}, .grain = grain});
        }
    }
    double deepest() const {  // overlap of two grains in the last step [m]
        double deep = 0;
        for (const taut_contact& contact : world.contacts()) deep = std::max(deep, -double{contact.separation});
        return deep;
    }
    Vec momentum(double mass) const {
        Vec sum;
        for (const taut_body grain : grains) sum += mass * velocity(grain);
        return sum;
    }
    double kinetic(double mass) const {
        double sum = 0;
        for (const taut_body grain : grains) sum += 0.5 * mass * dot(velocity(grain), velocity(grain));
        return sum;
    }

    World world;
    std::vector<taut_body> grains;

private:
    std::map<double, taut_shape> sphere_;
};

// At a step of its own.
const auto kWeightless = [](taut_world_def& def) {
    def.gravity = {0, 0, 0};
    def.time_step = 1.0f / 60;
};

// When two come nearest within a time as they move, how near [m].
double nearest(const Vec& apart, const Vec& parting, double time) {
    const double squared = dot(parting, parting);
    const double at = squared > 0 ? std::clamp(-dot(apart, parting) / squared, 0.0, time) : 0;
    return norm(apart + at * parting);
}

// Sizes to two orders apart, at rest and in motion, some across many others in a frame: those that come within the
// margin.
TEST(GrainContacts, MeetAllThatBruteForceFinds) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> spread(-1, 1), size(0, 1);
        const bool moves = seed % 2 == 0;
        Sand sand(kWeightless);
        struct Ball {
            Vec x, v;
            double radius;
        };
        std::vector<Ball> balls;
        for (int i = 0; i < 500; ++i) {
            const double speed = moves ? (i % 4 == 0 ? 30 : 0.3) : 0;
            const float radius = static_cast<float>(0.01 * std::pow(60.0, size(random) * size(random)));
            const Vec v{speed * spread(random), speed * spread(random), speed * spread(random)};
            balls.push_back({{2 * spread(random), 2 * spread(random), 2 * spread(random)}, v, radius});
            sand.add({.radius = radius, .position = balls.back().x, .velocity = v});
        }
        const auto dt = static_cast<double>(sand.world.def.time_step);
        uint32_t expected = 0, doubtful = 0;
        for (size_t a = 0; a < balls.size(); ++a)
            for (size_t b = a + 1; b < balls.size(); ++b) {
                const Vec apart = balls[b].x - balls[a].x, parting = balls[b].v - balls[a].v;
                const double both = balls[a].radius + balls[b].radius,
                             smaller = std::min(balls[a].radius, balls[b].radius);
                const double margin = std::clamp(0.1 * smaller, 0.003, 0.01);
                const double lack = nearest(apart, parting, dt) - both - margin;
                expected += lack < 0;
                doubtful += std::abs(lack) < 1e-5;
            }
        sand.world.step();
        const double found = sand.world.profile().touching;
        EXPECT_GT(expected, 10u);
        EXPECT_NEAR(found, expected, doubtful) << "seed " << seed;
    }
}

// Two that hit head on and askew, of unequal masses: momentum to rounding, no energy gained, no overlap after.
TEST(GrainContacts, KeepMomentumAndGainNoEnergy) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    Sand sand(kWeightless);
    for (int i = 0; i < 300; ++i)
        sand.add({.position = {unit(random), unit(random), unit(random)},
                  .velocity = {3 * unit(random), 3 * unit(random), 3 * unit(random)}});
    const double energy = sand.kinetic(1);
    const Vec momentum = sand.momentum(1);
    sand.world.step();
    double most = sand.kinetic(1);
    for (int i = 0; i < 120; ++i) {
        sand.world.step();
        most = std::max(most, sand.kinetic(1));
    }
    EXPECT_LE(most, energy);
    EXPECT_LE(norm(sand.momentum(1) - momentum), 1e-4 * 300);
}

// A small one slides on one so large that it is a floor: at rate mu g to its end, v^2 / (2 mu g); both of levels of the
// search that are far apart.
TEST(GrainContacts, SlideByCoulombsLaw) {
    for (const double mu : {0.1, 0.5, 0.9}) {
        Sand sand;
        sand.add({.radius = 1000, .mass = 1e12, .position = {0, -1000, 0}, .friction = mu, .gravity_scale = 0});
        const taut_body small =
            sand.add({.radius = 0.05, .position = {0, 0.05, 0}, .velocity = {2, 0, 0}, .friction = mu});
        const double way = 4 / (2 * mu * kG);
        sand.world.step(static_cast<int>(1.5 * 2 / (mu * kG) / sand.world.frame()));
        EXPECT_NEAR(position(small).x, way, 0.01 * way + 2 * sand.world.frame()) << mu;
        EXPECT_LE(norm(velocity(small)), 1e-3) << mu;
    }
}

// The lowest of a column bears all others, told as an impulse, and yields no more than its contact margin.
TEST(GrainContacts, AColumnBearsItsWeightAtAnyPace) {
    for (const float hz : {30.0f, 60.0f, 120.0f, 240.0f})
        for (const uint32_t substeps : {2u, 4u, 8u}) {
            Sand sand([&](taut_world_def& def) {
                def.time_step = 1 / hz;
                def.substeps = substeps;
            });
            constexpr int kTall = 40;
            sand.add_walls(0.05, 5);
            for (int i = 0; i < kTall; ++i) sand.add({.position = {0, 0.05 + 0.1 * i, 0}, .friction = 0});
            sand.world.step(static_cast<int>(4 * hz));
            double lowest = 0, height = 1e9;
            for (const taut_contact& contact : sand.world.contacts()) {
                if (contact.normal.y * contact.normal.y < 0.9f || contact.position.y > height) continue;
                if (contact.position.y < 0.05) continue;  // on the ground
                height = contact.position.y;
                lowest = double{contact.normal_impulse};
            }
            const double weight = (kTall - 1) * kG / double{hz} / substeps;
            EXPECT_NEAR(lowest, weight, 0.03 * weight) << hz << " Hz, " << substeps;
            EXPECT_LE(sand.deepest(), 0.005 * 1.1) << hz << " Hz, " << substeps;
        }
}

// The same grains as bodies of the general path: as high a heap, and as much at rest.
TEST(GrainContacts, HeapAsOtherParticlesDo) {
    double height[2], overlap[2];
    for (const bool grain : {false, true}) {
        Sand sand;
        sand.add_walls(0.35, 2);
        sand.pour(600, 6, 3, grain);
        sand.world.step(static_cast<int>(4 / sand.world.frame()));
        height[grain] = 0;
        double fastest = 0;
        for (const taut_body each : sand.grains) {
            height[grain] += position(each).y / 600;
            fastest = std::max(fastest, norm(velocity(each)));
        }
        overlap[grain] = sand.deepest();
        EXPECT_LE(fastest, 0.02);
    }
    EXPECT_NEAR(height[1], height[0], 0.05 * height[0]);  // others sink in deeper

    EXPECT_LE(overlap[1], 1.2 * overlap[0] + 0.001);
}

// Groups that do not collide, and a joint between two, are as for other bodies.
TEST(GrainContacts, ObeyFiltersAndJoints) {
    Sand sand;
    sand.world.add_ground();
    const taut_body low = sand.add({.position = {0, 0.05, 0}, .group = -1});
    const taut_body through = sand.add({.position = {0, 0.3, 0}, .group = -1});
    const taut_body on = sand.add({.position = {1, 0.05, 0}}), top = sand.add({.position = {1, 0.3, 0}});
    const taut_body tied = sand.add({.position = {2, 0.05, 0}}), to = sand.add({.position = {2, 0.11, 0}});
    sand.world.rod(tied, {}, to, {}, 0.06);
    sand.world.step(static_cast<int>(2 / sand.world.frame()));
    EXPECT_LE(position(through).y, 0.06) << position(low).y;
    EXPECT_GE(position(top).y, 0.14) << position(on).y;
    EXPECT_NEAR(norm(position(to) - position(tied)), 0.06, 1e-3);
}

// A heap sleeps as one, wakes by what falls on it, and by what is taken out of it.
TEST(GrainContacts, SleepAndWakeTogether) {
    Sand sand([](taut_world_def& def) { def.sleeping = 1; });
    sand.add_walls(0.25, 2);
    sand.pour(100, 4, 5);
    const auto steps = [&](double time) { return static_cast<int>(time / sand.world.frame()); };
    sand.world.step(steps(6));
    ASSERT_EQ(sand.world.profile().awake, 0u);
    std::vector<Vec> rest;
    for (const taut_body each : sand.grains) rest.push_back(position(each));
    sand.world.step(steps(1));
    for (size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(norm(position(sand.grains[i]) - rest[i]), 0);
    const taut_body dropped = sand.add({.position = {0, 2, 0}});
    sand.world.step(steps(0.9));
    EXPECT_GT(sand.world.profile().awake, 20u);
    sand.world.step(steps(6));
    ASSERT_EQ(sand.world.profile().awake, 0u);
    EXPECT_GT(position(dropped).y, 0.2);
    ok(taut_body_remove(sand.grains[10]));
    sand.world.step(2);
    EXPECT_GT(sand.world.profile().awake, 20u);
}

// What comes into the slot of one that is gone inherits no push.
TEST(GrainContacts, ForgetWhatIsGone) {
    Sand sand(kWeightless);
    sand.add({.position = {0, 0, 0}});
    sand.add({.position = {0.0, 0.099, 0}});
    sand.world.step(1);
    ok(taut_body_remove(sand.grains[1]));
    sand.grains.pop_back();
    const taut_body later = sand.add({.position = {0, 0.105, 0}});
    const double before = norm(velocity(sand.grains[0]));
    sand.world.step(1);
    EXPECT_LE(norm(velocity(later)), before + 1e-6);
}

TEST(GrainContacts, AreRefusedWhereNothingSpins) {
    World world;
    taut_body_def d;
    taut_body_def_init(&d);
    d.shape = world.sphere(0.1);
    d.collider_flags = TAUT_COLLIDER_GRAIN;
    taut_body out{};
    EXPECT_EQ(taut_world_add_body(world.handle, &d, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("grain"), std::string::npos);
}

TEST(GrainContacts, TakeNoMemoryOnceWarm) {
    Sand sand;
    sand.add_walls(0.35, 2);
    sand.pour(600, 6, 3);
    sand.world.step(static_cast<int>(5 / sand.world.frame()));
    uint64_t calls = 0;
    for (int i = 0; i < 60; ++i) {
        sand.world.step();
        calls += sand.world.profile().allocations;
    }
    EXPECT_EQ(calls, 0u);
}

}  // namespace
