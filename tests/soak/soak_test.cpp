// Ten minutes of the main demo, of a pile that bodies join and leave, of a bridge that breaks and of a ragdoll that is
// shaken; the short forms take ten seconds of it.
#include <cstdio>
#include <deque>

#include "scenes/random.h"
#include "scenes/running_scene.h"
#include "soak/allocation_counter.h"
#include "soak/frame_time.h"

namespace {

using namespace lab;
using soak::kBudget, soak::kTimed, soak::processor_ms;

class Figures {
public:
    explicit Figures(uint64_t warm_up) : warm_up_(warm_up) {}

    void step(taut_world world) {
        step(world, [world] { ok(taut_world_step(world)); });
    }
    // With what the scene moves by plan; of its joints only the rigid ones count.
    void step(scenes::TautWorld& scene) {
        const double before = joint_error;
        step(scene.world, [&scene] { scene.step(); });
        joint_error = std::max(before, scene.joint_error());
    }
    template <typename Take>
    void step(taut_world world, const Take& take) {
        const uint64_t taken = soak::allocations();
        const double start = processor_ms();
        take();
        ms_.push_back(processor_ms() - start);
        if (ms_.size() > warm_up_) allocations += soak::allocations() - taken;
        taut_events events{};
        ok(taut_world_get_events(world, &events));
        quarantined += events.quarantined_count;
        taut_profile profile{};
        profile.struct_size = sizeof profile;
        ok(taut_world_get_profile(world, &profile));
        joint_error = std::max(joint_error, static_cast<double>(profile.joint_error));
        open += profile.joint_error > kOpen;
        penetration = std::max(penetration, static_cast<double>(profile.penetration));
        bytes = profile.bytes;
    }
    // Prints everything; the 99th percentile in ms.
    double report(const char* what) {
        std::vector<double> sorted = ms_;
        std::sort(sorted.begin(), sorted.end());
        double sum = 0;
        for (double ms : sorted) sum += ms;
        const double p99 = sorted[sorted.size() * 99 / 100];
        const auto over = sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), kBudget);
        std::printf(
            "%s: frames %zu, step mean %.3f ms, p99 %.3f ms, worst %.3f ms, over %.2f ms: %td, allocations after "
            "warm-up %llu, worst joint error %.3f mm (over 5 mm: %llu), deepest overlap %.1f mm, quarantined %llu, "
            "%.1f MiB held\n",
            what, sorted.size(), sum / static_cast<double>(sorted.size()), p99, sorted.back(), kBudget, over,
            static_cast<unsigned long long>(allocations), 1e3 * joint_error, static_cast<unsigned long long>(open),
            1e3 * penetration, static_cast<unsigned long long>(quarantined), static_cast<double>(bytes) / (1 << 20));
        return p99;
    }

    static constexpr double kOpen = 0.005;  // of a joint [m]
    uint64_t allocations = 0, quarantined = 0, bytes = 0;
    uint64_t open = 0;  // steps after which some joint is
    double joint_error = 0, penetration = 0;

private:
    uint64_t warm_up_;
    std::vector<double> ms_;
};

void run_main(int frames) {
    RunningScene run("main");
    // The ball swings on among the bricks for ever, so that an array may still grow to a new maximum; SteadyShort
    // asks steady scenes for none at all.
    const uint64_t allowed = 4;
    Figures figures(static_cast<uint64_t>(frames / 2));
    for (int i = 0; i < frames; ++i) {
        figures.step(run.world.world);
        ASSERT_TRUE(i % 60 != 59 || run.sound()) << "frame " << i;
    }
    const double p99 = figures.report("main");
    EXPECT_EQ(figures.quarantined, 0u);
    // Now and then the ball falls into the slack chain, which catches it with up to fifteen times its weight: then
    // joints open by up to 10 mm. In ten minutes from 21 starts, 3 have such frames, up to 5 each.
    EXPECT_LE(figures.open, static_cast<uint64_t>(frames / 3600));
    EXPECT_LE(figures.joint_error, 0.015);
    if (kTimed) {
        EXPECT_LT(p99, kBudget);
    }
    EXPECT_LE(figures.allocations, allowed);
}

// A bin of 500 cubes of 5 to 15 kg; every half second the ten oldest leave and ten fall in at the top.
class ChangingPile {
public:
    ChangingPile() {
        const taut_shape ground = world_.box({10, 1, 10}), along_x = world_.box({0.5, 8, 3.5}),
                         along_z = world_.box({3.5, 8, 0.5});
        world_.add({.kind = TAUT_BODY_STATIC, .shape = ground, .position = {0, -1, 0}});
        for (double sign : {-1.0, 1.0}) {
            world_.add({.kind = TAUT_BODY_STATIC, .shape = along_x, .position = {sign * 3, 8, 0}});
            world_.add({.kind = TAUT_BODY_STATIC, .shape = along_z, .position = {0, 8, sign * 3}});
        }
        cube_ = world_.box({0.25, 0.25, 0.25});
        for (int i = 0; i < kBodies; ++i) {
            const int layer = i / 36;
            drop(i, 0.5 + 0.7 * layer);
        }
    }
    void change() {
        for (int i = 0; i < 10; ++i) {
            ok(taut_body_remove(pile_.front()));
            pile_.pop_front();
            drop(next_ += 7, 11);  // ten places of the 36, other ones each time
        }
    }
    bool sound() const {
        return std::all_of(pile_.begin(), pile_.end(), [](taut_body b) { return finite(b); });
    }
    int escaped() const {
        return static_cast<int>(std::count_if(pile_.begin(), pile_.end(), [](taut_body b) {
            const Vec p = position(b);
            return std::abs(p.x) > 2.5 || std::abs(p.z) > 2.5 || p.y < 0;
        }));
    }
    taut_world handle() const { return world_.handle; }

private:
    static constexpr int kBodies = 500;

    void drop(int place, double height) {
        const taut_vec3 axis = random_.direction();
        pile_.push_back(world_.add({.shape = cube_,
                                    .position = {-2 + 0.75 * (place % 6), height, -2 + 0.75 * (place / 6 % 6)},
                                    .rotation = Quat::turn(axis, random_.uniform()),
                                    .mass = 5 + 10 * random_.uniform()}));
    }

    World world_;
    taut_shape cube_{};
    std::deque<taut_body> pile_;
    int next_ = 0;
    scenes::Random random_{7};
};

void run_pile(int frames) {
    ChangingPile pile;
    Figures figures(static_cast<uint64_t>(frames / 2));
    for (int i = 0; i < frames; ++i) {
        if (i % 30 == 29) pile.change();
        figures.step(pile.handle());
        ASSERT_TRUE(i % 60 != 59 || pile.sound()) << "frame " << i;
    }
    const double p99 = figures.report("pile of 500");
    EXPECT_EQ(figures.quarantined, 0u);
    EXPECT_EQ(pile.escaped(), 0);
    if (kTimed) {
        EXPECT_LT(p99, kBudget);
    }
}

// Running least of an energy and how far it rose above that.
struct Rise {
    double least = INFINITY, most = 0;  // [J]

    void sample(double energy) {
        least = std::min(least, energy);
        most = std::max(most, energy - least);
    }
};

// The truck's motors stand still after 12 s: from then on nothing brings energy in but ropes that were tight.
void run_breaking_bridge(int frames) {
    constexpr int kMotors = 720;
    RunningScene run("bridge_breaking");
    Figures figures(static_cast<uint64_t>(frames / 2));
    Rise rise;
    const double start = run.energy();
    double most = 0;
    for (int i = 0; i < frames; ++i) {
        figures.step(run.world);
        ASSERT_TRUE(i % 60 != 59 || run.sound()) << "frame " << i;
        if (i < kMotors)
            most = std::max(most, run.energy());
        else if (i % 10 == 0)
            rise.sample(run.energy());
    }
    const double p99 = figures.report("bridge_breaking");
    std::printf("bridge_breaking: %zu joints broke, energy rose by %.1f kJ under power, %.3f kJ after\n",
                run.world.broken.size(), 1e-3 * (most - start), 1e-3 * rise.most);
    EXPECT_GE(run.world.broken.size(), 10u);
    EXPECT_EQ(figures.quarantined, 0u);
    EXPECT_LE(figures.joint_error, 0.005);
    EXPECT_LE(most - start, 100e3) << "8 t at 4 m/s are 64 kJ";
    EXPECT_LE(rise.most, 20);
    if (kTimed) {
        EXPECT_LT(p99, kBudget);
    }
}

// Shaken for all but the last part, in which it must calm down by itself.
void run_shaken_ragdoll(int frames, int calm) {
    scenes::Scene scene = scenes::make_scene("ragdoll_liana");
    scene.motions.front().track.shake.end = (frames - calm) / 60.0;
    RunningScene run(std::move(scene));
    Figures figures(static_cast<uint64_t>(frames / 2));
    Rise rise;
    const double start = run.energy();
    double most = 0, angle = 0;
    int over = 0;  // frames with a stop overrun by more than 2 degrees
    for (int i = 0; i < frames; ++i) {
        figures.step(run.world);
        ASSERT_TRUE(i % 60 != 59 || run.sound()) << "frame " << i;
        const double off = run.angular_error();
        angle = std::max(angle, off);
        over += off > 2 * kPi / 180;
        if (i < frames - calm)
            most = std::max(most, run.energy());
        else
            rise.sample(run.energy());
    }
    const double p99 = figures.report("ragdoll_liana");
    std::printf(
        "ragdoll_liana: shaken up by %.0f J, rose by %.2f J after, angles off by %.2f degrees, %d frames by 2\n",
        most - start, rise.most, angle * 180 / kPi, over);
    EXPECT_EQ(figures.quarantined, 0u);
    EXPECT_LE(figures.joint_error, 0.006);
    EXPECT_LE(over, frames / 10000);
    EXPECT_LE(angle, 4 * kPi / 180);
    EXPECT_LE(most - start, 5000) << "75 kg and 20 kg of liana, thrown 5 m up";
    EXPECT_LE(rise.most, 1e-3 * (most - start));
    if (kTimed) {
        EXPECT_LT(p99, kBudget);
    }
}

TEST(BreakingBridgeShort, HoldsForTwentySeconds) { run_breaking_bridge(1200); }
TEST(ShakenRagdollShort, HoldsForTenSeconds) { run_shaken_ragdoll(600, 240); }
TEST(BreakingBridge, HoldsForTenMinutes) { run_breaking_bridge(36000); }
TEST(ShakenRagdoll, HoldsForTenMinutes) { run_shaken_ragdoll(36000, 1800); }

TEST(MainShort, HoldsForTenSeconds) { run_main(600); }
TEST(PileShort, HoldsForTenSeconds) { run_pile(600); }
TEST(Main, HoldsForTenMinutes) { run_main(36000); }
TEST(Pile, HoldsForTenMinutesWhileBodiesComeAndGo) { run_pile(36000); }

// Too long for the quick tests.
class TallPyramid : public testing::TestWithParam<int> {};

TEST_P(TallPyramid, StandsForAMinute) {
    const std::string name = "pyramid" + std::to_string(GetParam());
    RunningScene run(name);
    Figures figures(600);
    double rest = 0;  // after ten seconds
    for (int i = 0; i < 3600; ++i) {
        figures.step(run.world.world);
        if (i >= 600 && i % 20 == 0) rest = std::max(rest, run.pile_speed());
    }
    figures.report(name.c_str());
    ASSERT_TRUE(run.sound());
    const auto top = static_cast<size_t>(run.scene.roles.top_body);
    const Vec moved = run.body(top).position - run.start[top].position;
    EXPECT_LE(-moved.y, 0.01 * run.start[top].position.y);
    EXPECT_LE(std::hypot(moved.x, moved.z), 0.05);
    EXPECT_LE(rest, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Of, TallPyramid, testing::Values(20, 30), testing::PrintToStringParamName());

// design.md, T8: towers stand for a minute.
TEST(Stack20, StandsForAMinute) {
    RunningScene run("stack20");
    for (int i = 0; i < 3600; ++i) run.step();
    ASSERT_TRUE(run.sound());
    const auto top = static_cast<size_t>(run.scene.roles.top_body);
    const Vec moved = run.body(top).position - run.start[top].position;
    std::printf("stack20: top sank by %.3f mm, moved by %.3f mm\n", -1e3 * moved.y, 1e3 * std::hypot(moved.x, moved.z));
    EXPECT_LE(-moved.y, 0.01 * run.start[top].position.y);
    EXPECT_LE(std::hypot(moved.x, moved.z), 0.05);
    EXPECT_LE(run.pile_speed(), 0.01);
}

}  // namespace
