// What kinematic bodies squeeze further than there is room stays where it is, and stays there when they let it go.
#include <algorithm>

#include "physics/surface_lab.h"

namespace lab {
namespace {

struct Press {
    int hz;
    uint32_t substeps;
    double speed, left, aside;  // [m/s]; of the body's height; of the lift's middle [m]
    int bodies = 1;             // one on the other
    double slows = 0;           // how long it takes to get going upon its way back [s]
};
void PrintTo(const Press& press, std::ostream* out) {
    *out << press.hz << " Hz, " << press.substeps << " substeps, " << press.speed << " m/s, " << press.left
         << " left, off by " << press.aside << " m, " << press.bodies << " bodies, slows for " << press.slows << " s";
}

enum class Kind { box, ball, capsule, hull };
constexpr double kHalf = 0.4;

taut_shape shape_of(const World& world, Kind kind) {
    if (kind == Kind::ball) return world.sphere(kHalf);
    if (kind == Kind::capsule) return world.capsule(0.25, 0.15);
    if (kind == Kind::box) return world.box({0.5, kHalf, 0.3});
    std::vector<taut_vec3> corners;  // a frustum
    for (const double y : {-1.0, 1.0})
        for (const double x : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) corners.push_back(Vec((0.5 - 0.1 * y) * x, kHalf * y, 0.4 * z).narrow());
    return hull(world, corners);
}

struct Outcome {
    double aside = 0, above = 0;      // of the first body, from where it lay on the lift [m]
    double fastest = 0, released = 0;  // squeezed, and upwards on the way back [m/s]
};

// A lift of 0.3 m drives up to a ceiling, waits for a second and comes back.
Outcome squeeze(Kind kind, const Press& press) {
    constexpr double kRoom = 3.3;
    World world([&](taut_world_def& def) {
        def.time_step = 1.0f / static_cast<float>(press.hz);
        def.substeps = press.substeps;
        def.sleeping = 0;
    });
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({4, 0.5, 4}), .position = {0, kRoom + 0.5, 0}});
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(), .position = {0, -3, 0}});
    const taut_body lift = world.add(
        {.kind = TAUT_BODY_KINEMATIC, .shape = world.box({1.5, 0.15, 1.5}), .position = {0, -0.15, 0}});
    std::vector<taut_body> pile;
    for (int i = 0; i < press.bodies; ++i)
        pile.push_back(world.add({.shape = shape_of(world, kind),
                                  .position = {press.aside, (2 * i + 1) * kHalf, -press.aside / 3},
                                  .mass = 12}));
    world.step(press.hz / 2);
    const Vec start = position(pile[0]);
    const int way = static_cast<int>(press.hz * (kRoom - 2 * kHalf * press.bodies * press.left) / press.speed);
    Outcome out;
    const auto drive = [&](double speed) {
        ok(taut_body_set_velocity(lift, Vec(0, speed, 0).narrow(), {}));
        world.step();
    };
    for (int i = 0; i < way + press.hz; ++i) {
        drive(i < way ? press.speed : 0);
        for (const taut_body body : pile) out.fastest = std::max(out.fastest, norm(velocity(body)));
    }
    const double slow = press.slows * press.hz;
    for (int i = 0; position(lift).y > 0; ++i) {
        drive(-press.speed * std::min(1.0, (i + 0.5) / std::max(slow, 0.5)));
        out.released = std::max(out.released, velocity(pile[0]).y);
    }
    for (int i = 0; i < press.hz; ++i) drive(0);
    const Vec moved = position(pile[0]) - start;
    out.aside = std::hypot(moved.x, moved.z);
    out.above = position(pile[0]).y - position(lift).y - 0.15 - kHalf;
    return out;
}

class LiftUnderACeiling : public testing::TestWithParam<Press> {};

TEST_P(LiftUnderACeiling, LetsGoWhatItSqueezes) {
    for (const Kind kind : {Kind::box, Kind::ball, Kind::capsule, Kind::hull}) {
        const Outcome out = squeeze(kind, GetParam());
        EXPECT_LT(out.aside, 0.1) << static_cast<int>(kind);
        EXPECT_NEAR(out.above, 0, 0.01) << static_cast<int>(kind) << ": not on the lift";
        EXPECT_LT(out.fastest, GetParam().speed + 3) << static_cast<int>(kind);
        EXPECT_LT(out.released, 1) << static_cast<int>(kind);
    }
}

INSTANTIATE_TEST_SUITE_P(Presses, LiftUnderACeiling,
                         testing::Values(Press{60, 4, 0.7, 0.85, 0}, Press{60, 4, 2, 0.5, 0.4},
                                         Press{60, 4, 4, 0.35, 0.25, 1, 0.3}, Press{60, 4, 6, 0.7, 0.35},
                                         Press{60, 1, 3, 0.6, 0.2}, Press{60, 16, 3, 0.6, 0.2},
                                         Press{30, 4, 1.5, 0.55, 0.1}, Press{30, 4, 4, 0.7, 0.3},
                                         Press{120, 4, 5, 0.45, 0.2}, Press{240, 4, 5, 0.6, 0.3},
                                         Press{240, 1, 1.5, 0.3, 0.1}, Press{60, 4, 0.5, 0.2, 0.05}));

// However long it lasts, weight draws nothing through the lift.
TEST(SqueezedBox, StaysBetweenLiftAndCeiling) {
    for (const int hz : {60, 240}) {
        World world([&](taut_world_def& def) {
            def.time_step = 1.0f / static_cast<float>(hz);
            def.sleeping = 0;
        });
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({2, 0.5, 2}), .position = {0, 2.2, 0}});
        const taut_body lift =
            world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.box({1, 0.2, 1}), .position = {0, -0.2, 0}});
        const taut_body box = world.add({.shape = world.box({0.4, 0.4, 0.4}), .position = {0, 0.4, 0}, .mass = 30});
        ok(taut_body_set_velocity(lift, {0, 1, 0}, {}));
        world.step(3 * hz / 2);
        ok(taut_body_set_velocity(lift, {}, {}));
        world.step(hz);
        const Vec start = position(box);
        EXPECT_NEAR(start.y, 1.6, 0.1) << hz << " Hz: in the middle of what is left";
        world.step(20 * hz);
        EXPECT_LT(norm(position(box) - start), 0.02) << hz << " Hz";
    }
}

}  // namespace
}  // namespace lab
