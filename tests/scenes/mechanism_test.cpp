// Machines of many joints at work: crane, bridges, hinges with stops, ragdoll, Ferris wheel, tensegrity.
#include <set>

#include "scenes/running_scene.h"
#include "starts.h"

namespace {

using namespace lab;

constexpr double kDegree = kPi / 180;

std::vector<taut_lint_entry> lint(taut_world world) {
    uint32_t count = 0;
    taut_world_lint(world, nullptr, 0, &count);
    std::vector<taut_lint_entry> found(count);
    if (count > 0) ok(taut_world_lint(world, found.data(), count, &count));
    return found;
}

struct Machine {
    const char* scene;
    double gap_mm, angle_deg;  // most that a rigid joint gives way, and that an angle is off or overruns its stop
};

void PrintTo(const Machine& m, std::ostream* out) { *out << m.scene; }

class EveryMachine : public testing::TestWithParam<Machine> {};

TEST_P(EveryMachine, HoldsTogetherForTenSeconds) {
    RunningScene run(GetParam().scene);
    for (const taut_lint_entry& entry : lint(run.world.world)) ADD_FAILURE() << taut_lint_text(entry.kind);
    double gap = 0, angle = 0;
    for (int frame = 0; frame < 600; ++frame) {
        run.step();
        gap = std::max(gap, run.joint_error());
        angle = std::max(angle, run.angular_error());
    }
    ASSERT_TRUE(run.sound());
    EXPECT_LE(1e3 * gap, GetParam().gap_mm);
    EXPECT_LE(angle, GetParam().angle_deg * kDegree);
    RecordProperty("gap_mm", std::to_string(1e3 * gap));
    RecordProperty("angle_deg", std::to_string(angle / kDegree));
}

INSTANTIATE_TEST_SUITE_P(Scene, EveryMachine,
                         testing::Values(Machine{"crane", 0.02, 0.01}, Machine{"bridge", 0.2, 0.02},
                                         Machine{"bridge_breaking", 5, 0.1}, Machine{"hinges50", 0.5, 0.1},
                                         Machine{"ragdoll_liana", 2, 2}, Machine{"ferris_wheel10", 0.02, 0.01},
                                         Machine{"ferris_wheel24", 0.05, 0.02}, Machine{"tensegrity", 0, 0},
                                         Machine{"cable_drum", 0.5, 0.01}),
                         [](const auto& tested) { return tested.param.scene; });

TEST(Crane, LiftsItsLoadThatSwingsLittle) {
    RunningScene run("crane");
    const auto load = static_cast<size_t>(run.scene.roles.load);
    const taut_cable cable = run.world.cables.front();
    taut_joint top{};  // of the cable, at the boom
    ok(taut_cable_get_end_joint(cable, 0, &top));
    double swing = 0;
    for (uint32_t frame = 0; frame < run.scene.steps; ++frame) {
        run.step();
        taut_pos a{}, b{};
        ok(taut_joint_get_anchors(top, &a, &b));
        const Vec off = run.body(load).position - Vec(a);
        swing = std::max(swing, std::hypot(off.x, off.z));
    }
    ASSERT_TRUE(run.sound());
    EXPECT_GT(run.body(load).position.y - run.start[load].position.y, 3);
    EXPECT_LT(swing, 0.8) << "off the plumb line, of 10.5 m";
    EXPECT_LT(norm(run.body(load).velocity), 0.5);
    taut_vec3 force{};
    ok(taut_joint_get_force(top, &force));
    const double hanging = 5000 + 50 * length_of(cable);  // [kg]
    EXPECT_NEAR(norm(force), hanging * kG, 0.02 * hanging * kG) << "the cable carries load and itself";
    EXPECT_NEAR(length_of(cable), 7, 0.01) << "3 m of it are hauled in";
    RecordProperty("swing_m", std::to_string(swing));
}

TEST(CableDrum, HoldsCarriesAndReels) {
    constexpr double kAround = 0.525 * 2.4;  // of the cable that the driven drum takes along [m]
    RunningScene run("cable_drum");
    const auto held = static_cast<size_t>(run.scene.roles.pile[0]),
               carried = static_cast<size_t>(run.scene.roles.pile[1]);
    const auto reeled = static_cast<size_t>(run.scene.roles.load);
    const auto sunk = [&](size_t i) { return run.start[i].position.y - run.body(i).position.y; };
    double down = 0, out = 0, up = 0;
    for (uint32_t frame = 0; frame < run.scene.steps; ++frame) {
        run.step();
        if (frame != 450) continue;  // all are at their turning points
        down = sunk(held), up = -sunk(carried), out = sunk(reeled);
    }
    ASSERT_TRUE(run.sound());
    EXPECT_NEAR(down, 0, 0.02);
    EXPECT_NEAR(up, kAround, 0.05 * kAround);
    EXPECT_NEAR(out, 1.2, 0.02);
    EXPECT_NEAR(sunk(held), 0, 0.02);
    EXPECT_NEAR(sunk(carried), 0, 0.05 * kAround);
    EXPECT_NEAR(sunk(reeled), 0, 0.02);
}

TEST(Bridge, CarriesTheTruckAcross) {
    RunningScene run("bridge");
    const auto truck = static_cast<size_t>(run.scene.roles.load);
    double lowest = INFINITY;
    for (uint32_t frame = 0; frame < run.scene.steps; ++frame) {
        run.step();
        for (int plank : run.scene.roles.pile)
            lowest = std::min(lowest, run.body(static_cast<size_t>(plank)).position.y);
    }
    ASSERT_TRUE(run.sound());
    EXPECT_TRUE(run.world.broken.empty());
    EXPECT_GT(run.body(truck).position.x, 14) << "beyond the bank's edge at 12";
    EXPECT_GT(run.body(truck).position.y, 5.5) << "on its wheels";
    EXPECT_LT(std::abs(run.body(truck).position.z), 0.5) << "in its lane";
    EXPECT_LT(norm(run.body(truck).velocity), 0.05);
    EXPECT_GT(lowest, 3.9) << "the deck sags by less than a metre";
}

TEST(BridgeBreaking, BreaksHangerByHanger) {
    RunningScene run("bridge_breaking");
    std::set<int> frames;
    size_t before = 0;
    for (int frame = 0; frame < static_cast<int>(run.scene.steps); ++frame) {
        run.step();
        if (run.world.broken.size() > before) frames.insert(frame);
        before = run.world.broken.size();
    }
    ASSERT_TRUE(run.sound());
    EXPECT_GE(run.world.broken.size(), 10u);
    EXPECT_GE(frames.size(), 6u) << "one after another";
    EXPECT_EQ(run.scene.joints[static_cast<size_t>(run.world.broken.front())].kind, TAUT_JOINT_DISTANCE);
}

// Where a bridge tears is chance, that it drops the truck is not.
TEST(BridgeBreaking, DropsTheTruckFromEveryStart) {
    for (uint64_t seed = 1; seed <= starts<uint64_t>(8); ++seed) {
        scenes::Options options;
        options.seed = seed;
        RunningScene run(scenes::make_scene("bridge_breaking", options));
        for (uint32_t frame = 0; frame < run.scene.steps; ++frame) run.step();
        EXPECT_LT(run.body(static_cast<size_t>(run.scene.roles.load)).position.y, 3) << "seed " << seed;
    }
}

class Stops {
public:
    // Furthest beyond a stop, now [degrees], and how many of them push.
    void look(const RunningScene& run) {
        over = -INFINITY, pushing = 0;
        for (size_t i = 0; i < run.scene.joints.size(); ++i) {
            if (run.scene.joints[i].kind != TAUT_JOINT_HINGE) continue;
            float angle = 0;
            taut_axis_forces forces{};
            ok(taut_joint_get_coordinates(run.world.joints[i], 0, &angle, nullptr));
            ok(taut_joint_get_axis_forces(run.world.joints[i], 0, &forces));
            over = std::max(over, std::abs(static_cast<double>(angle)) / kDegree - 20);
            pushing += forces.active_stop != 0;
        }
    }
    double over = 0;
    int pushing = 0;
};

TEST(Hinges, StopAtTwentyDegreesInMotion) {
    RunningScene run("hinges50");
    Stops stops;
    double over = 0;
    int pushing = 0;
    for (int frame = 0; frame < 1200; ++frame) {
        run.step();
        stops.look(run);
        over = std::max(over, stops.over);
        pushing = std::max(pushing, stops.pushing);
    }
    ASSERT_TRUE(run.sound());
    EXPECT_LE(over, 0.1);
    EXPECT_GE(pushing, 4) << "at once";
    RecordProperty("over_deg", std::to_string(over));
    RecordProperty("pushing", pushing);
}

// Damped so much that it hangs still at the end: the first four turn a right angle and 10 degrees are left.
TEST(Hinges, HangOnTheirStopsAtRest) {
    scenes::Scene scene = scenes::make_scene("hinges50");
    for (scenes::Joint& joint : scene.joints)
        if (joint.kind == TAUT_JOINT_HINGE) joint.axes[0].drive.damping = 1e5f;
    RunningScene run(std::move(scene));
    for (int frame = 0; frame < 2400; ++frame) run.step();
    Stops stops;
    stops.look(run);
    ASSERT_TRUE(run.sound());
    EXPECT_LE(std::abs(stops.over), 0.01);
    EXPECT_GE(stops.pushing, 2);
    EXPECT_LT(norm(run.body(static_cast<size_t>(run.scene.roles.load)).velocity), 0.01);
}

TEST(RagdollOnLiana, CalmsDownWhenTheShakingEnds) {
    RunningScene run("ragdoll_liana");
    const double least = run.energy();
    double most = 0, lowest = INFINITY, rise = 0;
    for (int frame = 0; frame < 1800; ++frame) {
        run.step();
        const double now = run.energy();
        if (frame < 420) {
            most = std::max(most, now);
            continue;
        }
        lowest = std::min(lowest, now);
        rise = std::max(rise, now - lowest);
    }
    ASSERT_TRUE(run.sound());
    EXPECT_GT(most, least + 100) << "it was shaken";
    EXPECT_LT(rise, 1) << "energy gained while nothing moves it [J]";
    EXPECT_LT(run.energy(), least + 60) << "what is left of the swinging";
    RecordProperty("rise_J", std::to_string(rise));
}

class FerrisWheel : public testing::TestWithParam<const char*> {};

TEST_P(FerrisWheel, TurnsAtItsMotorsSpeed) {
    constexpr double kSpeed = 0.35;
    RunningScene run(GetParam());
    double slowest = INFINITY, fastest = 0;
    for (int frame = 0; frame < 600; ++frame) {
        run.step();
        float rate = 0;
        ok(taut_joint_get_coordinates(run.world.joints[0], 0, nullptr, &rate));
        if (frame < 150) continue;
        slowest = std::min(slowest, static_cast<double>(rate));
        fastest = std::max(fastest, static_cast<double>(rate));
    }
    ASSERT_TRUE(run.sound());
    EXPECT_GE(slowest, 0.98 * kSpeed);
    EXPECT_LE(fastest, 1.02 * kSpeed);
}

INSTANTIATE_TEST_SUITE_P(Of, FerrisWheel, testing::Values("ferris_wheel10", "ferris_wheel24"),
                         [](const auto& tested) { return tested.param; });

TEST(Tensegrity, LandsOnItsStrutsAndStaysTaut) {
    RunningScene run("tensegrity");
    for (int frame = 0; frame < 600; ++frame) {
        run.step();
        uint32_t count = 0;
        taut_world_get_contacts(run.world.world, nullptr, 0, &count);
        std::vector<taut_contact> contacts(count);
        ok(taut_world_get_contacts(run.world.world, contacts.data(), count, &count));
        for (const taut_contact& c : contacts) {
            taut_body_kind a{}, b{};
            ok(taut_body_get_kind(c.body_a, &a));
            ok(taut_body_get_kind(c.body_b, &b));
            ASSERT_NE(a, b) << "two struts touch, frame " << frame;
        }
    }
    ASSERT_TRUE(run.sound());
    for (taut_joint rope : run.world.joints) {
        taut_vec3 force{};
        ok(taut_joint_get_force(rope, &force));
        EXPECT_GT(norm(force), 1000);
        EXPECT_LT(norm(force), 5000);
    }
    EXPECT_LT(run.pile_speed(), 1e-3);
}

}  // namespace
