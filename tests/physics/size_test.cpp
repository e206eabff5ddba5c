// Like motions of unlike sizes. With all lengths and gravity times s, and the masses of s^3, the equations of motion
// are those of s = 1 in units of s: velocities times s, times, angles and friction as they are. So a world of any size
// must move as that of one metre does. What does not are lengths that the library states in metres; how much they are
// felt is what is measured here. Sizes are the edge of a box.
#include <algorithm>
#include <random>

#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

struct Place {
    double size;  // s [m]
    double away;  // of the scene from the world's origin [m]
};

void PrintTo(const Place& p, std::ostream* out) { *out << p.size << "m_" << p.away << "m_away"; }

// A world of size s at a place; positions are given and read in units of s.
class Scaled {
public:
    explicit Scaled(const Place& place)
        : s(place.size),
          origin(place.away, 0, -place.away),
          world([&](taut_world_def& def) { def.gravity = Vec(0, -kG * s, 0).narrow(); }) {}

    Vec at(const Vec& p) const { return origin + s * p; }
    Vec read(taut_body body) const { return 1 / s * (position(body) - origin); }
    taut_body ground(const Quat& turn = {}, double restitution = 0) const {
        const Vec half(20, 1, 20);
        return world.add({.kind = TAUT_BODY_STATIC,
                          .shape = world.box(s * half),
                          .position = at(-1 * turn.rotate({0, half.y, 0})),
                          .rotation = turn,
                          .restitution = restitution});
    }
    taut_body box(const Vec& p, const Quat& turn = {}, const Vec& velocity = {}) const {
        return world.add({.shape = world.box(s * Vec(0.5, 0.5, 0.5)),
                          .position = at(p),
                          .rotation = turn,
                          .velocity = s * velocity});
    }

    double s;
    Vec origin;
    World world;
};

using Motion = std::vector<Vec>;  // places, in units of s

Motion drop(const Place& place) {
    const Scaled scaled(place);
    scaled.ground();
    const taut_body box = scaled.box({0, 1.5, 0});
    Motion out;
    for (int i = 0; i < 90; ++i) {
        scaled.world.step();
        out.push_back(scaled.read(box));
    }
    return out;
}

Motion stack(const Place& place) {
    const Scaled scaled(place);
    scaled.ground();
    std::vector<taut_body> boxes;
    for (int i = 0; i < 5; ++i) boxes.push_back(scaled.box({0.02 * (i % 2), 0.5 + 1.01 * i, 0}));
    scaled.world.step(300);
    Motion out;
    for (taut_body box : boxes) out.push_back(scaled.read(box));
    return out;
}

// Down a slope of tan 0.8 with friction 0.5: it slides.
Motion slide(const Place& place) {
    const Scaled scaled(place);
    const Quat turn = Quat::turn({0, 0, 1}, -std::atan(0.8));
    scaled.ground(turn);
    const taut_body box = scaled.box(turn.rotate({0, 0.5, 0}), turn);
    Motion out;
    for (int i = 0; i < 60; ++i) {
        scaled.world.step();
        out.push_back(scaled.read(box));
    }
    return out;
}

// A box on an arm of two sizes, let go at 60 degrees.
Motion pendulum(const Place& place) {
    const Scaled scaled(place);
    const double angle = kPi / 3;
    const taut_body bob = scaled.box({2 * std::sin(angle), -2 * std::cos(angle), 0});
    scaled.world.ball({}, scaled.at({0, 0, 0}), bob, -scaled.s * Vec(2 * std::sin(angle), -2 * std::cos(angle), 0));
    Motion out;
    for (int i = 0; i < 240; ++i) {
        scaled.world.step();
        out.push_back(scaled.read(bob));
    }
    return out;
}

// Falls two sizes and bounces with a restitution of a half.
Motion bounce(const Place& place) {
    const Scaled scaled(place);
    scaled.ground({}, 0.5);
    const taut_body box = scaled.box({0, 2.5, 0});
    Motion out;
    for (int i = 0; i < 60; ++i) {
        scaled.world.step();
        out.push_back(scaled.read(box));
    }
    return out;
}

// Furthest that two motions are apart, in sizes.
double apart(const Motion& a, const Motion& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
    return most;
}

struct Scene {
    const char* name;
    Motion (*run)(const Place&);
    double bound;  // of the difference to 1 m at the origin, in sizes
};

const Scene kScenes[] = {
    {"drop", drop, 5e-3}, {"stack", stack, 3e-3}, {"slide", slide, 2e-5}, {"pendulum", pendulum, 5e-6}};

class EverySize : public testing::TestWithParam<Place> {};

TEST_P(EverySize, MovesAsOneMetreDoes) {
    for (const Scene& scene : kScenes) {
        const double off = apart(scene.run({1, 0}), scene.run(GetParam()));
        RecordProperty(scene.name, std::to_string(off));
        EXPECT_LE(off, scene.bound) << scene.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, EverySize,
                         testing::Values(Place{0.01, 0}, Place{0.03, 0}, Place{0.1, 0}, Place{0.3, 0}, Place{1, 1e4},
                                         Place{10, 0}, Place{100, 0}));

TEST(Size, BouncesAlike) {
    const Motion one = bounce({1, 0});
    const auto lowest = std::min_element(one.begin(), one.end(), [](auto& a, auto& b) { return a.y < b.y; });
    const double rise = std::max_element(lowest, one.end(), [](auto& a, auto& b) { return a.y < b.y; })->y - 0.5;
    EXPECT_NEAR(rise, 2 * 0.5 * 0.5, 0.05) << "in sizes: the height of the fall times the restitution's square";
    for (double size : {0.01, 0.1, 0.3, 3.0}) EXPECT_LE(apart(one, bounce({size, 0})), 0.01) << size;
    // Contacts are looked for within 0.5 m of motion ahead: what does more in a frame may bounce one frame later.
    for (double size : {30.0, 100.0}) EXPECT_LE(apart(one, bounce({size, 0})), 0.2) << size;
}

// A column sags by a length that knows no size, g h^2, and buckles by it where it is small.
TEST(Size, SmallColumnsStandAsBigOnesDo) {
    std::mt19937 random(5);
    for (int start = 0; start < 20; ++start) {
        const double side = 0.02 * std::pow(10.0, between(random, 0, 1));
        const int count = 5 + start % 8;
        const bool plane = start % 2 == 0;
        World world;
        if (plane)
            world.add_ground(0.5);
        else
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({2, 0.5, 2}), .position = {0, -0.5, 0}});
        taut_body top{};
        for (int i = 0; i < count; ++i) {
            const Vec at(between(random, -0.02, 0.02), i + 0.5, between(random, -0.02, 0.02));
            top = world.add({.shape = world.box(0.5 * side * Vec(1, 1, 1)), .position = side * at});
        }
        world.step(600);
        EXPECT_GT(position(top).y, (count - 0.6) * side) << count << " cubes of " << side << " m, start " << start;
    }
}

}  // namespace
