// Chains whose upper end is jerked about: slack links snap taut under a weight.
#include "physics/cable_lab.h"
#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

struct Jerk {
    double ratio, speed, gap;  // weight over link, of the hand [m/s], of a joint at most [m]
};

void PrintTo(const Jerk& jerk, std::ostream* out) { *out << "1:" << jerk.ratio << " at " << jerk.speed << " m/s"; }

// Nine links of 1 kg and 0.5 m and a weight hang from a hand.
struct HeldChain {
    World world;
    taut_body hand;
    std::vector<taut_body> links;
    std::vector<taut_joint> joints;

    explicit HeldChain(double weight, const std::function<void(taut_world_def&)>& change = {}) : world(change) {
        hand = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.box({0.1, 0.1, 0.1}), .group = -1});
        const taut_shape link = world.box({0.05, 0.25, 0.05}), end = world.box({0.2, 0.25, 0.2});
        for (int i = 0; i < 10; ++i) {
            links.push_back(world.add({.shape = i < 9 ? link : end,
                                       .position = {0, -0.25 - 0.5 * i, 0},
                                       .mass = i < 9 ? 1 : weight,
                                       .group = -1}));
            const Vec up(0, 0.25, 0);
            joints.push_back(i == 0 ? world.ball(hand, {}, links[0], up)
                                    : world.ball(links[links.size() - 2], -up, links.back(), up));
        }
    }
    void move(const Vec& velocity) const { ok(taut_body_set_velocity(hand, velocity.narrow(), {0, 0, 0})); }
    double gap() const {
        double most = 0;
        for (taut_joint joint : joints) most = std::max(most, error(joint));
        return most;
    }
    double energy() const {
        const Totals t = totals(links);
        return t.kinetic + kG * t.height;
    }
};

class JerkedChain : public testing::TestWithParam<Jerk> {};

// The hand sets off in another direction four times a second, and stops after two seconds.
TEST_P(JerkedChain, StaysClosedAndGainsNoEnergyOfItself) {
    constexpr int kStarts = 16, kJerked = 120, kFrames = 360, kJerk = 15;  // frames
    const Jerk jerk = GetParam();
    const double unit = 0.5 * (jerk.ratio + 9) * jerk.speed * jerk.speed;
    double worst = 0, gained = 0;
    for (unsigned seed = 0; seed < kStarts; ++seed) {
        std::mt19937 random(seed);
        const HeldChain chain(jerk.ratio);
        double least = 0;
        for (int frame = 0; frame < kFrames; ++frame) {
            if (frame % kJerk == 0) chain.move(frame < kJerked ? jerk.speed * random_direction(random) : Vec());
            chain.world.step();
            worst = std::max(worst, chain.gap());
            if (frame < kJerked) continue;
            const double energy = chain.energy();
            least = frame == kJerked ? energy : std::min(least, energy);
            gained = std::max(gained, (energy - least) / unit);
        }
    }
    EXPECT_LE(worst, jerk.gap);
    EXPECT_LE(gained, 0.02);
    RecordProperty("gap_mm", std::to_string(1e3 * worst));
}

INSTANTIATE_TEST_SUITE_P(Of, JerkedChain,
                         testing::Values(Jerk{1, 20, 0.005}, Jerk{1, 50, 0.02}, Jerk{10, 20, 0.03}, Jerk{100, 10, 0.01},
                                         Jerk{100, 20, 0.08}, Jerk{1000, 5, 0.05}, Jerk{1000, 20, 0.1}),
                         [](const auto& tested) {
                             return "ratio_" + std::to_string(static_cast<int>(tested.param.ratio)) + "_at_" +
                                    std::to_string(static_cast<int>(tested.param.speed));
                         });

uint32_t most_substeps(const HeldChain& chain) {
    uint32_t most = 0;
    for (const Vec& velocity : {Vec(0, 20, 0), Vec(20, 0, 0), Vec(0, -20, 0)}) {
        chain.move(velocity);
        for (int frame = 0; frame < 15; ++frame) {
            chain.world.step();
            most = std::max(most, chain.world.profile().substeps);
        }
    }
    return most;
}

TEST(JerkedChainsSubsteps, AreHalvedWhereTheyMayBe) {
    EXPECT_GT(most_substeps(HeldChain(100)), pace().substeps);
    EXPECT_EQ(most_substeps(HeldChain(100, [](taut_world_def& def) { def.fixed_substeps = 1; })), pace().substeps);
}

// A pile beside a chain that whips does what it does alone, but for the frame in which that begins: they are solved
// together until then.
TEST(JerkedChainsSubsteps, HardlyChangeWhatANeighbourDoes) {
    const auto top_of_stack = [](bool jerked) {
        const HeldChain chain(100);
        const taut_shape cube = chain.world.box({0.5, 0.5, 0.5});
        chain.world.add({.kind = TAUT_BODY_STATIC, .shape = chain.world.box({5, 0.5, 5}), .position = {200, -0.5, 0}});
        taut_body top{};
        for (int i = 0; i < 5; ++i) top = chain.world.add({.shape = cube, .position = {200 + 0.01 * i, 0.51 + i, 0}});
        std::mt19937 random(1);
        std::vector<Vec> way;
        for (int frame = 0; frame < 120; ++frame) {
            if (jerked && frame % 15 == 0) chain.move(20 * random_direction(random));
            chain.world.step();
            way.push_back(position(top));
        }
        return way;
    };
    const auto beside = top_of_stack(true), alone = top_of_stack(false);
    for (size_t i = 0; i < alone.size(); ++i) EXPECT_LT(norm(beside[i] - alone[i]), 1e-3) << "frame " << i;
}

// Two boxes of 1 kg on a slack cable of links of 30 g part until it snaps taut. Of forty such starts some burst: links
// reached 2700 m/s and joints opened by a metre.
TEST(SlackCable, SnapsTautWithoutABurst) {
    constexpr double kSpeed = 20;
    double fastest = 0, gap = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed);
        const CableLab world([](taut_world_def& def) { weightless(def); });
        const taut_shape box = world.box({0.3, 0.3, 0.3});
        const taut_body one = world.add(
            {.shape = box, .position = {-2, 0, 0}, .velocity = {-kSpeed, between(random, -6, 6), 0}, .mass = 1});
        const taut_body other =
            world.add({.shape = box, .position = {2, 0, 0}, .velocity = {0, 0, between(random, -1, 1)}, .mass = 1});
        taut_cable_def def = CableLab::plan(TAUT_CABLE_LINKS);
        def.end[0] = to_body(one, {0.3, 0, 0});
        def.end[1] = to_body(other, {-0.3, 0, 0});
        def.segment_count = 12;
        def.mass_per_metre = 0.1f;
        def.length = static_cast<float>(3.4 * (1 + between(random, 0, 0.3)));
        const std::vector<taut_body> links = bodies_of(world.cable(def));
        for (int frame = 0; frame < 240; ++frame) {
            world.step();
            for (const taut_body link : links) fastest = std::max(fastest, norm(velocity(link)));
            gap = std::max(gap, static_cast<double>(world.profile().joint_error));
        }
    }
    EXPECT_LT(fastest, 4 * kSpeed);
    EXPECT_LT(gap, 0.05);
}

}  // namespace
