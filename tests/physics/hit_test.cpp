// What hits a body that a joint holds: the joint answers within the same substep.
#include <random>

#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"

namespace lab {
namespace {

enum class Held { fixed, at_its_stop };

// A ball without restitution flies against a panel of 30 kg that the world holds. Its velocity at the lowest, in parts
// of that at which it came; negative: it came back.
double least_after_hit(Held held, double mass, double speed, std::mt19937& random) {
    World w([](taut_world_def& def) { weightless(def); });
    const taut_body panel = w.add({.shape = w.box({0.5, 1, 0.03}), .mass = 30});
    if (held == Held::at_its_stop) {
        hinge(w, {}, panel, {-0.5, 0, 0}, {0, 1, 0}, limited(0, 1.5));
    } else {
        auto def = at(w, taut_fixed_joint_def_init, {}, panel, {-0.5, 0, 0}, {1, 0, 0});
        taut_joint joint{};
        ok(taut_world_add_fixed_joint(w.handle, &def, &joint));
    }
    const Vec from(between(random, -0.3, 0.4), between(random, -0.8, 0.8), -1 - between(random, 0, speed / 60));
    const taut_body ball = w.add({.shape = w.sphere(0.2), .position = from, .velocity = {0, 0, speed}, .mass = mass});
    double least = speed;
    for (int frame = 0; frame < 90; ++frame) {
        w.step();
        least = std::min(least, velocity(ball).z);
    }
    return least / speed;
}

class HitOn : public testing::TestWithParam<Held> {};

// Swept after the joint was solved, the panel gives way in each substep as if free, and the impulse grows: balls of 30
// to 300 kg came back with a third to a half of their speed.
TEST_P(HitOn, NothingBouncesWithoutRestitution) {
    std::mt19937 random(1);
    for (const double mass : {3.0, 30.0, 300.0, 1000.0})
        for (const double speed : {5.0, 50.0})
            for (int start = 0; start < 8; ++start)
                EXPECT_GT(least_after_hit(GetParam(), mass, speed, random), -0.06) << mass << " kg at " << speed;
}

INSTANTIATE_TEST_SUITE_P(Panel, HitOn, testing::Values(Held::fixed, Held::at_its_stop),
                         [](const auto& of) { return of.param == Held::fixed ? "fixed" : "at_its_stop"; });

// A plate on a motor comes down on a box of 1 kg and 10 cm. What the box presses on was swept, and the plate went on to
// the ground from 10 kN on.
TEST(Press, StopsAtWhatItPresses) {
    for (const double mass : {10.0, 100.0, 1e3, 1e4})
        for (const double force : {1e2, 1e3, 1e4, 1e5}) {
            World w;
            w.add_ground();
            w.add({.shape = w.box({0.05, 0.05, 0.05}), .position = {0, 0.05, 0}, .mass = 1});
            const taut_body plate =
                w.add({.shape = w.box({0.5, 0.1, 0.5}), .position = {0, 0.35, 0}, .mass = mass, .gravity_scale = 0});
            slider(w, {}, plate, {0, 0.35, 0}, {0, 1, 0}, motor(-0.1, force));
            double lowest = 1;
            for (int frame = 0; frame < 300; ++frame) {
                w.step();
                lowest = std::min(lowest, position(plate).y - 0.1);
            }
            EXPECT_GT(lowest, 0.095) << mass << " kg, " << force << " N";
        }
}

}  // namespace
}  // namespace lab
