// A heap of all kinds of shapes comes to rest and stays whole.
#include <span>

#include "scenes/running_scene.h"
#include "starts.h"

namespace {

using namespace lab;

// Mean depth of the contact points that overlap [m].
double mean_overlap(const RunningScene& run) {
    uint32_t count = 0;
    taut_world_get_contacts(run.world.world, nullptr, 0, &count);
    std::vector<taut_contact> contacts(count);
    ok(taut_world_get_contacts(run.world.world, contacts.data(), count, &count));
    double sum = 0;
    int overlapping = 0;
    for (const taut_contact& contact : contacts) {
        if (contact.separation >= 0) continue;
        sum -= static_cast<double>(contact.separation);
        ++overlapping;
    }
    return overlapping > 0 ? sum / overlapping : 0;
}

// Nineteen of twenty starts within 25 s (94 of 96, of another 96 all); in the others a body shifts for longer.
TEST(Heap, OfTwoHundredMixedShapesComesToRest) {
    uint64_t at_rest = 0;
    const auto count = starts<uint64_t>(8);
    for (uint64_t seed = 0; seed < count; ++seed) {
        SCOPED_TRACE(seed);
        scenes::Options options;
        options.seed = seed;
        RunningScene run(scenes::make_scene("shapes200", options));
        double fastest = 0, mean = 0;
        for (int frame = 0; frame < 1500; ++frame) {
            run.step();
            ASSERT_TRUE(run.sound()) << "frame " << frame;
            if (frame < 1440) continue;
            fastest = std::max(fastest, run.pile_speed());
            double sum = 0;
            for (int i : run.scene.roles.pile) sum += norm(run.body(static_cast<size_t>(i)).velocity);
            mean = std::max(mean, sum / static_cast<double>(run.scene.roles.pile.size()));
        }
        const double overlap = mean_overlap(run);
        EXPECT_LE(overlap, 0.002);
        EXPECT_LE(mean, 0.005);
        EXPECT_LE(fastest, 0.3);
        at_rest += mean <= 0.001 && fastest <= 0.03;
        for (int i : run.scene.roles.pile) EXPECT_GT(run.body(static_cast<size_t>(i)).position.y, 0) << i;
        std::printf("heap, seed %d: mean overlap %.3f mm, mean speed %.5f m/s, fastest %.4f m/s\n",
                    static_cast<int>(seed), 1e3 * overlap, mean, fastest);
    }
    EXPECT_GE(at_rest, 7 * count / 8);
}

// Their joints are solved by load: at rest nothing in the heap needs a direct solve, and the joints stay closed.
TEST(Heap, OfRagdollsHoldsTogetherBySweepsAlone) {
    for (uint64_t seed : {0u, 3u, 4u}) {
        SCOPED_TRACE(seed);
        scenes::Options options;
        options.seed = seed;
        RunningScene run(scenes::make_scene("ragdolls16", options));
        double falling = 0, resting = 0;
        uint32_t solves = 0;
        for (int frame = 0; frame < 600; ++frame) {
            run.step();
            ASSERT_TRUE(run.sound()) << "frame " << frame;
            double& most = frame < 480 ? falling : resting;  // a limb may slip from the heap in the eighth second
            most = std::max(most, run.joint_error());
            if (frame >= 540) solves += run.world.profile().solves;
        }
        EXPECT_EQ(solves, 0u);
        EXPECT_LE(resting, 0.006);  // as one slips later
        EXPECT_LE(falling, 0.1);
        EXPECT_LE(mean_overlap(run), 0.002);
        std::printf("ragdolls, seed %d: joints within %.2f mm at rest, %.1f mm in the fall; overlap %.2f mm\n",
                    static_cast<int>(seed), 1e3 * resting, 1e3 * falling, 1e3 * mean_overlap(run));
    }
}

// A forearm that hangs on two others and carries its ragdoll, its joint open by 23 mm for seconds where sweeps are left
// with it.
TEST(Heap, OfAHundredRagdollsClosesWhatIsJammed) {
    scenes::Options options;
    options.seed = 52;
    RunningScene run(scenes::make_scene("ragdolls100", options));
    double most = 0;
    for (int frame = 0; frame < 480; ++frame) {
        run.step();
        if (frame >= 420) most = std::max(most, run.joint_error());
    }
    std::printf("joints within %.2f mm\n", 1e3 * most);
    EXPECT_LE(most, 0.002);
}

// A body that bursts or whips has its own remedies: the substeps of all that it touches are not for it.
TEST(Heap, OfRagdollsLandsWithFourSubsteps) {
    constexpr uint64_t kSeeds[] = {2, 5, 6, 7};
    const auto tried = std::span(kSeeds).first(starts(std::size(kSeeds)));
    int more = 0;
    for (const uint64_t seed : tried) {
        scenes::Options options;
        options.seed = seed;
        RunningScene run(scenes::make_scene("ragdolls100", options));
        for (int frame = 0; frame < 120; ++frame) {
            run.step();
            more += run.world.profile().substeps > 4;
        }
    }
    std::printf("%d of %d frames with more\n", more, 120 * static_cast<int>(tried.size()));
    EXPECT_LE(more, 3);
}

// Swept joints and contacts of one body must see the same inertia: where they did not, nine hundred limbs left the bin.
TEST(Heap, OfAHundredRagdollsLosesNoLimb) {
    RunningScene run("ragdolls100");
    double highest = -1e9, fastest = 0;
    for (size_t i = 0; i < run.world.bodies.size(); ++i) highest = std::max(highest, run.body(i).position.y);
    for (int frame = 0; frame < 240; ++frame) run.step();
    ASSERT_TRUE(run.sound());
    for (size_t i = 0; i < run.world.bodies.size(); ++i) {
        EXPECT_LT(run.body(i).position.y, highest) << "body " << i;
        EXPECT_GT(run.body(i).position.y, -0.5) << "body " << i;
        fastest = std::max(fastest, norm(run.body(i).velocity));
    }
    std::printf("fastest %.2f m/s\n", fastest);
    EXPECT_LT(fastest, 3);
}

}  // namespace
