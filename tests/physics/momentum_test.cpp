// Bodies that joints hold, hit: what a contact gives to one it takes from another, whoever solves it.
#include "physics/mechanism_lab.h"

namespace {

using namespace lab;

struct RowPlan {
    int count = 3;
    bool hinged = false;
    double gap = 0, restitution = 0, friction = 0;
    uint32_t substeps = 4;
    double rate = 60;  // [Hz]
};

// Equal balls hang side by side without weight, each on an arm of its own, and the first comes: for as long as they
// hardly swing nothing but contacts acts along the row.
std::vector<double> speeds_of(const RowPlan& plan) {
    constexpr double kRadius = 0.12, kArm = 1.5, kMass = 3, kSpeed = 2.5;
    const World world([&](taut_world_def& def) {
        def.gravity = {0, 0, 0};
        def.substeps = plan.substeps;
        def.time_step = static_cast<float>(1 / plan.rate);
    });
    const taut_shape shape = world.sphere(kRadius);
    std::vector<taut_body> balls;
    for (int i = 0; i < plan.count; ++i) {
        const double x = i * (2 * kRadius + plan.gap) - (i == 0 ? 0.03 : 0), speed = i == 0 ? kSpeed : 0;
        balls.push_back(world.add({.shape = shape,
                                   .position = {x, 0, 0},
                                   .velocity = {speed, 0, 0},
                                   .spin = {0, 0, speed / kArm},
                                   .mass = kMass,
                                   .friction = plan.friction,
                                   .restitution = plan.restitution}));
        if (plan.hinged)
            hinge(world, {}, balls.back(), {x, kArm, 0}, {0, 0, 1});
        else
            world.ball({}, {x, kArm, 0}, balls.back(), {0, kArm, 0});
    }
    world.step(static_cast<int>(0.1 * plan.rate));
    std::vector<double> speeds;
    for (const taut_body ball : balls) speeds.push_back(velocity(ball).x / kSpeed);
    return speeds;
}

std::string text_of(const RowPlan& plan, const std::vector<double>& speeds) {
    std::string text = std::to_string(plan.count) + (plan.hinged ? " on hinges" : " on ball joints") + ", gap " +
                       std::to_string(plan.gap) + ", friction " + std::to_string(plan.friction) + ", " +
                       std::to_string(plan.substeps) + " substeps at " + std::to_string(plan.rate) + " Hz:";
    for (const double speed : speeds) text.append(" ").append(std::to_string(speed));
    return text;
}

// With friction, balls that touch must roll on each other as they swing, which takes what little it may.
TEST(HangingRow, SharesAPlasticBlow) {
    for (const double rate : {30.0, 60.0, 120.0, 240.0})
        for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u})
            for (const int count : {2, 3, 5, 7}) {
                const RowPlan plan{.count = count,
                                   .hinged = count % 2 == 0,
                                   .gap = count == 5 ? 1.5e-3 : 0,
                                   .substeps = substeps,
                                   .rate = rate};
                const std::vector<double> speeds = speeds_of(plan);
                double sum = 0;
                for (const double speed : speeds) sum += speed;
                EXPECT_NEAR(sum, 1, 0.02) << text_of(plan, speeds);
                if (plan.gap > 0) continue;  // the last may go ahead
                for (const double speed : speeds) EXPECT_NEAR(speed, 1.0 / count, 0.1 / count) << text_of(plan, speeds);
            }
}

TEST(HangingRow, KeepsMomentumAndEnergyInAnElasticBlow) {
    for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u})
        for (const int count : {2, 3, 4, 6})
            for (const double gap : {0.0, 2e-3}) {
                const RowPlan plan{
                    .count = count, .hinged = count > 3, .gap = gap, .restitution = 1, .substeps = substeps};
                const std::vector<double> speeds = speeds_of(plan);
                double sum = 0, energy = 0;
                for (const double speed : speeds) sum += speed, energy += speed * speed;
                EXPECT_NEAR(sum, 1, 0.02) << text_of(plan, speeds);
                EXPECT_LE(energy, 1.02) << text_of(plan, speeds);
            }
}

// Two free bodies of any shape, of which one hits the other anywhere; what they lose of angular momentum, in parts of
// their momentum times how far apart they were.
double lost_turning(uint32_t seed, double restitution, double rate, uint32_t substeps) {
    std::mt19937 random(seed);
    const World world([&](taut_world_def& def) {
        def.gravity = {0, 0, 0};
        def.substeps = substeps;
        def.time_step = static_cast<float>(1 / rate);
    });
    const auto shape = [&] {
        const double r = draw(random, 0.1, 0.4);
        const uint32_t kind = random() % 3;
        return kind == 0   ? world.sphere(r)
               : kind == 1 ? world.box({r, draw(random, 0.1, 0.4), draw(random, 0.1, 0.4)})
                           : world.capsule(r, draw(random, 0.1, 0.3));
    };
    const double friction = one_in(random, 2) ? draw(random, 0, 0.8) : 0;
    const Vec from = direction(random), aim = draw(random, 0, 0.3) * direction(random);
    std::vector<taut_body> bodies;
    for (const bool comes : {false, true})
        bodies.push_back(world.add({.shape = shape(),
                                    .position = comes ? 1.6 * from + aim : Vec{},
                                    .rotation = Quat::turn(direction(random), draw(random, 0, 3)),
                                    .velocity = comes ? draw(random, 3, 9) * -from : Vec{},
                                    .spin = draw(random, 0, 3) * direction(random),
                                    .mass = draw(random, 1, 8),
                                    .friction = friction,
                                    .restitution = restitution}));
    const Balance start(bodies);
    world.step(static_cast<int>(0.6 * rate));
    return norm(Balance(bodies).turning - start.turning) / (start.momentum_scale * start.size);
}

TEST(Impact, KeepsAngularMomentum) {
    for (const double rate : {30.0, 60.0, 240.0})
        for (const uint32_t substeps : {1u, 4u, 8u}) {
            std::vector<double> lost;
            for (uint32_t seed = 1; seed <= 60; ++seed)
                lost.push_back(lost_turning(seed, seed % 2 == 0 ? 1 : 0.4, rate, substeps));
            std::sort(lost.begin(), lost.end());
            const std::string text = std::to_string(rate) + " Hz, " + std::to_string(substeps) + " substeps";
            EXPECT_LE(lost[lost.size() / 2], 1e-4) << text;
            EXPECT_LE(lost[9 * lost.size() / 10], rate * substeps < 60 ? 5e-3 : 5e-4) << text;
        }
}

class FreeMechanism : public testing::TestWithParam<uint32_t> {};

// Angular momentum as far as a straight substep keeps it: what turns opens joints, and what closes them moves bodies
// without a force. Elastic blows of one substep may gain a little where joints are to close. Some starts of each kind;
// tests/soak has more.
TEST_P(FreeMechanism, KeepsMomentumAndGainsNoEnergy) {
    for (const double restitution : {0.0, 1.0})
        for (const uint32_t substeps : {1u, 4u})
            for (uint32_t seed = 1; seed <= 6; ++seed) {
                const MechanismPlan plan{.seed = seed,
                                         .kind = GetParam(),
                                         .restitution = restitution,
                                         .friction = seed % 2 == 0 ? 0.4 : 0,
                                         .substeps = substeps};
                const Losses losses = losses_of(plan, 0.3);
                const std::string text = "restitution " + std::to_string(restitution) + ", " +
                                         std::to_string(substeps) + " substeps, seed " + std::to_string(seed);
                EXPECT_LE(losses.momentum, 1e-6) << text;
                EXPECT_LE(losses.turning, restitution == 0 ? 0.03 : 0.12) << text;
                EXPECT_LE(losses.energy, restitution == 0 ? 1e-6 : 0.08) << text;
            }
}

INSTANTIATE_TEST_SUITE_P(OfKind, FreeMechanism, testing::Range(0u, kJointKinds + 1));

}  // namespace
