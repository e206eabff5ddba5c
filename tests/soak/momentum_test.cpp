// Many random mechanisms that random bodies hit, by each kind of joint: see tests/physics/momentum_test.cpp.
#include "physics/mechanism_lab.h"

namespace {

using namespace lab;

class HitMechanism : public testing::TestWithParam<double> {};

// In 1 to 16 substeps, with friction and without. Plastic blows never gain energy; of elastic ones, in the substep
// after, joints that a blow opened may.
TEST_P(HitMechanism, KeepsMomentumAndGainsNoEnergy) {
    const double restitution = GetParam();
    constexpr uint32_t kStarts = 20;
    int gains = 0, starts = 0;
    Losses worst;
    for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u})
        for (const double friction : {0.0, 0.02, 0.4})
            for (uint32_t kind = 0; kind <= kJointKinds; ++kind)
                for (uint32_t start = 1; start <= kStarts; ++start) {
                    const Losses losses = losses_of({.seed = 7000 + start,
                                                     .kind = kind,
                                                     .restitution = restitution,
                                                     .friction = friction,
                                                     .substeps = substeps},
                                                    0.4);
                    ++starts;
                    gains += losses.energy > 1e-3;
                    worst.momentum = std::max(worst.momentum, losses.momentum);
                    worst.turning = std::max(worst.turning, losses.turning);
                    worst.energy = std::max(worst.energy, losses.energy);
                }
    std::printf("restitution %g: momentum within %.1e, angular %.3f; %d of %d gain energy, %.4f at most\n", restitution,
                worst.momentum, worst.turning, gains, starts, worst.energy);
    EXPECT_LE(worst.momentum, 1e-5);
    EXPECT_LE(worst.turning, restitution == 0 ? 0.1 : 0.3);
    EXPECT_LE(gains, restitution == 0 ? 0 : starts / 30);
    EXPECT_LE(worst.energy, restitution == 0 ? 1e-6 : 0.15);
}

INSTANTIATE_TEST_SUITE_P(Restitution, HitMechanism, testing::Values(0.0, 0.5, 1.0),
                         [](const auto& of) { return std::to_string(static_cast<int>(10 * of.param)); });

}  // namespace
