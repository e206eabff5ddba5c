// What a kinematic body carries by friction stays where it lies on it.
#include "physics/lab.h"

namespace {

using namespace lab;

struct Rate {
    double hertz;
    uint32_t substeps;
};

void PrintTo(const Rate& rate, std::ostream* out) { *out << rate.hertz << " Hz, " << rate.substeps << " substeps"; }

class Carrier : public testing::TestWithParam<Rate> {
protected:
    World world{[](taut_world_def& def) {
        def.time_step = static_cast<float>(1 / GetParam().hertz);
        def.substeps = GetParam().substeps;
        def.sleeping = 0;
    }};
    taut_body carrier{};
    std::vector<taut_body> loads;

    int frames(double time) const { return static_cast<int>(std::lround(time * GetParam().hertz)); }
    void add_carrier(taut_shape shape) {
        carrier = world.add(
            {.kind = TAUT_BODY_KINEMATIC, .shape = shape, .position = {0, -0.15, 0}, .friction = 0.7});
    }
    void add_load(taut_shape shape, const Vec& at, const Vec& spin = {}) {
        loads.push_back(world.add({.shape = shape,
                                   .position = at,
                                   .velocity = cross(spin, at),
                                   .spin = spin,
                                   .mass = 3.0 + static_cast<double>(loads.size()),
                                   .friction = 0.7}));
    }
    void add_loads(const Vec& spin = {}) {
        add_load(world.box({0.12, 0.2, 0.15}), {0.9, 0.2, 0.2}, spin);
        add_load(world.cylinder(0.12, 0.25), {-0.7, 0.25, 0.4}, spin);
        add_load(world.box({0.2, 0.05, 0.1}), {0.1, 0.05, -0.8}, spin);
        add_load(world.box({0.15, 0.06, 0.15}), {-0.9, 0.06, -0.4}, spin);
    }
    // As seen from the carrier.
    Vec place(taut_body load) const {
        const BodyState c = state(carrier);
        return c.rotation.rotate_back(position(load) - c.position);
    }
    std::vector<Vec> places() const {
        std::vector<Vec> out;
        for (const taut_body load : loads) out.push_back(place(load));
        return out;
    }
    double furthest(const std::vector<Vec>& from) const {
        double most = 0;
        for (size_t i = 0; i < loads.size(); ++i) most = std::max(most, norm(place(loads[i]) - from[i]));
        return most;
    }
    void move_to(const Vec& at) const {
        taut_pose pose{};
        pose.position = at.pos();
        pose.rotation = {0, 0, 0, 1};
        ok(taut_body_move_kinematic(carrier, &pose));
        world.step();
    }
};

// w^2 r of 1.7 m/s^2 at most, of 6.9 that friction gives.
TEST_P(Carrier, TurnsLoadsRound) {
    const Vec spin(0, 1.3, 0);
    add_carrier(world.cylinder(1.5, 0.15));
    add_loads(spin);
    ok(taut_body_set_velocity(carrier, Vec().narrow(), spin.narrow()));
    const std::vector<Vec> start = places();
    world.step(frames(30));
    EXPECT_LT(furthest(start), 0.01);
    for (const taut_body load : loads) EXPECT_NEAR(state(load).spin.y, 1.3, 0.01);
}

// A ship's deck that heaves and sways; 3.6 m/s^2 at most.
TEST_P(Carrier, ShuttlesLoads) {
    for (const Vec& along : {Vec(0.35, 0, 0), Vec(0, 0.35, 0), Vec(0.2, 0.2, 0.2)}) {
        loads.clear();
        add_carrier(world.box({1.5, 0.15, 1.5}));
        add_loads();
        const std::vector<Vec> start = places();
        const int count = frames(30);
        for (int i = 1; i <= count; ++i)
            move_to(Vec(0, -0.15, 0) + (1 - std::cos(2 * kPi * 0.5 * i / GetParam().hertz)) * along);
        EXPECT_LT(furthest(start), 0.01) << along.x << ", " << along.y;
        for (const taut_body load : loads) ok(taut_body_remove(load));
        ok(taut_body_remove(carrier));
    }
}

// Beyond its cone friction holds nothing: mu g is all that a load gets.
TEST_P(Carrier, HoldsNoLoadBeyondItsCone) {
    add_carrier(world.box({8, 0.15, 8}));
    add_load(world.box({0.2, 0.1, 0.2}), {0, 0.1, 0});
    const double time = 0.5;
    for (int i = 1; i <= frames(time); ++i) {
        ok(taut_body_set_velocity(carrier, Vec(12 * i / GetParam().hertz, 0, 0).narrow(), Vec().narrow()));
        world.step();
    }
    EXPECT_NEAR(velocity(loads[0]).x / (0.7 * kG * time), 1, 0.05);
}

INSTANTIATE_TEST_SUITE_P(At, Carrier,
                         testing::Values(Rate{30, 1}, Rate{30, 4}, Rate{60, 1}, Rate{60, 2}, Rate{60, 4}, Rate{60, 8},
                                         Rate{60, 16}, Rate{120, 4}, Rate{240, 2}));

}  // namespace
