// A rigid rod on a ball joint against the exact pendulum.
#include "physics/lab.h"

namespace {

using namespace lab;

class PendulumAtAmplitude : public testing::TestWithParam<double> {};

// T = 4 sqrt(I / (m g l)) K(sin(A / 2)),  I = m l^2 + I_c about the pivot.
TEST_P(PendulumAtAmplitude, PeriodMatchesEllipticIntegralAndEnergyStays) {
    const double amplitude = GetParam() * kPi / 180;
    const Vec half(0.06, 0.5, 0.09);
    World world;
    const Quat turn = Quat::turn({0, 0, 1}, amplitude);
    const Vec top(0, half.y, 0);
    const taut_body rod =
        world.add({.shape = world.box(half), .position = -turn.rotate(top), .rotation = turn, .mass = 3});
    world.ball({}, {0, 0, 0}, rod, top);
    const double inertia = 3 * (half.x * half.x + half.y * half.y) / 3 + 3 * half.y * half.y;
    const double exact = 4 * std::sqrt(inertia / (3 * kG * half.y)) * elliptic_k(std::sin(amplitude / 2));

    auto energy = [&] {  // above hanging
        const Totals t = totals({rod});
        return t.kinetic + kG * (t.height + 3 * half.y);
    };
    const double start = energy();
    Crossings crossings;
    double late = 0;
    int late_frames = 0;
    for (int frame = 1; frame * world.frame() < 10 + exact; ++frame) {
        world.step();
        const double time = frame * world.frame();
        crossings.sample(time, position(rod).x);
        // Symplectic steps carry an energy error that swings with the motion; over a period it averages out.
        if (time > 10) late += energy(), ++late_frames;
    }
    EXPECT_NEAR(crossings.period() / exact, 1, 0.003) << "period " << crossings.period() << " s, exact " << exact;
    EXPECT_NEAR(late / late_frames / start, 1, 0.01);
    RecordProperty("period_error_pct", std::to_string(100 * (crossings.period() / exact - 1)));
    RecordProperty("energy", std::to_string(late / late_frames / start));
}

INSTANTIATE_TEST_SUITE_P(Degrees, PendulumAtAmplitude, testing::Values(10.0, 45.0, 90.0, 150.0),
                         [](const auto& tested) { return std::to_string(static_cast<int>(tested.param)); });

// K itself, from tables (Abramowitz and Stegun 17.1): k^2 = 0, 1/2, 0.99.
TEST(EllipticIntegral, MatchesTables) {
    EXPECT_NEAR(elliptic_k(0), 1.570796326794897, 1e-14);
    EXPECT_NEAR(elliptic_k(std::sqrt(0.5)), 1.854074677301372, 1e-14);
    EXPECT_NEAR(elliptic_k(std::sqrt(0.99)), 3.695637362989875, 1e-12);
}

}  // namespace
