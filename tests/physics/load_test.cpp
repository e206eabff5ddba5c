// Who carries what: contact pressure under stacks, joint forces of hanging chains, the shape of a hanging cable.
#include <ctime>
#include <map>
#include <numbers>

#include "physics/joint_lab.h"

namespace {

using namespace lab;

// Force between the bodies of each touching pair in the last substep [N], keyed by user-visible handles.
std::map<std::pair<uint64_t, uint64_t>, double> pressures(const World& world) {
    std::map<std::pair<uint64_t, uint64_t>, double> sum;
    for (const taut_contact& c : world.contacts()) {
        const auto pair = std::minmax(c.body_a.bits, c.body_b.bits);
        sum[pair] += static_cast<double>(c.normal_impulse) / world.substep();
    }
    return sum;
}

TEST(Stack, EveryInterfaceCarriesTheWeightAbove) {
    for (const std::vector<double>& masses :
         {std::vector<double>{5, 5, 5, 5, 5}, {40, 25, 12, 6, 3}, {10, 20, 15, 30}}) {
        World world;
        std::vector<taut_body> bodies = {world.add_ground()};
        const taut_shape cube = world.box({0.25, 0.25, 0.25});
        for (double mass : masses)
            bodies.push_back(world.add(
                {.shape = cube, .position = {0, 0.5 * static_cast<double>(bodies.size()) - 0.25, 0}, .mass = mass}));
        world.step(300);
        const auto found = pressures(world);
        double above = 0;
        for (size_t i = bodies.size() - 1; i > 0; --i) {
            above += masses[i - 1];
            const auto at = found.find(std::minmax(bodies[i].bits, bodies[i - 1].bits));
            ASSERT_NE(at, found.end()) << "bodies " << i - 1 << " and " << i << " do not touch";
            EXPECT_NEAR(at->second / (kG * above), 1, 0.005) << "interface " << i << " of " << masses.size();
        }
    }
}

// Statically indeterminate, but the ground carries the whole weight and nothing else.
TEST(Stack, GroundUnderAPyramidCarriesItsWeight) {
    World world;
    const taut_body ground = world.add_ground();
    const taut_shape cube = world.box({0.25, 0.25, 0.25});
    double weight = 0;
    for (int row = 0; row < 5; ++row)
        for (int i = 0; i < 5 - row; ++i, weight += 8 * kG)
            world.add({.shape = cube, .position = {0.52 * (i + 0.5 * row), 0.25 + 0.5 * row, 0}, .mass = 8});
    world.step(400);
    double carried = 0;
    for (const auto& [pair, force] : pressures(world))
        if (pair.first == ground.bits || pair.second == ground.bits) carried += force;
    EXPECT_NEAR(carried / weight, 1, 0.005);
}

TEST(HangingChain, JointForcesAreTheWeightsBelow) {
    World world;
    const std::vector<double> masses = {1, 2, 0.5, 3, 1, 10, 0.2, 50};
    std::vector<taut_body> bodies = {{}};
    std::vector<taut_joint> joints;
    double y = 10, below = 0;
    for (double mass : masses) {
        below += mass;
        const bool first = joints.empty();
        bodies.push_back(
            world.add({.position = {0, y - 0.25, 0}, .mass = mass, .inertia = mass * Vec(0.02, 0.003, 0.02)}));
        joints.push_back(world.ball(bodies[bodies.size() - 2], first ? Vec(0, y, 0) : Vec(0, -0.25, 0), bodies.back(),
                                    {0, 0.25, 0}));
        y -= 0.5;
    }
    world.step(120);
    for (size_t i = 0; i < joints.size(); ++i) {
        taut_vec3 force{};
        ok(taut_joint_get_force(joints[i], &force));  // on the lower body
        EXPECT_LT(norm(Vec(force) - Vec(0, below * kG, 0)), 0.001 * below * kG) << "joint " << i;
        below -= masses[i];
    }
}

// Five links of 1 kg with stops, motors and friction, for which a direct solve costs far more than sweeps; the last
// one.
taut_body hang_stopped_links(const World& world) {
    taut_axis_def axis = limited(-1, 1);
    axis.friction = axis.drive.max_force = 1e-3f;
    axis.drive.damping = 1e-3f;
    taut_body before{};
    for (int i = 0; i < 5; ++i) {
        const double y = 10 - 0.5 * i;
        const taut_body link = world.add({.position = {0, y - 0.25, 0}, .mass = 1, .inertia = Vec(0.02, 0.003, 0.02)});
        hinge(world, before, link, {0, y, 0}, {0, 0, 1}, axis);
        before = link;
    }
    return before;
}

// The end of such links is pulled at: swept with a force that sweeps hold, solved directly beyond, without a jump at
// the change.
TEST(ByLoad, HoldsDirectlyWhatSweepsWouldNot) {
    World world;
    const taut_body before = hang_stopped_links(world);
    double fastest = 0;
    auto pull = [&](float force, int frames) {
        for (int i = 0; i < frames; ++i) {
            ok(taut_body_apply_force(before, {0, -force, 0}, {0, 0, 0}));
            world.step();
            fastest = std::max(fastest, norm(state(before).velocity));
        }
        return world.profile();
    };
    const taut_profile light = pull(900, 120);
    EXPECT_EQ(light.solves, 0u);
    EXPECT_LE(light.joint_error, 1e-3f);
    EXPECT_LE(fastest, 2);  // as it stretches to hold
    fastest = 0;
    const taut_profile heavy = pull(3000, 120);
    EXPECT_GT(heavy.solves, 0u);
    EXPECT_LE(heavy.joint_error, 5e-5f);
    EXPECT_LE(fastest, 5);
    fastest = 0;
    const taut_profile after = pull(0, 120);
    EXPECT_EQ(after.solves, 0u);
    EXPECT_LE(after.joint_error, 1e-4f);
    EXPECT_LE(fastest, 0.05);
}

// A pull that swings about the limit, slower and faster than the time for which a chain is held: each change between
// the two ways of solving passes without a kick.
TEST(ByLoad, ChangesToAndFroWithoutAKick) {
    int changes = 0;
    for (const double frequency : {0.3, 0.6, 1.0}) {
        SCOPED_TRACE(frequency);
        World world;
        const taut_body before = hang_stopped_links(world);
        double fastest = 0, widest = 0;
        bool direct = false;
        for (int frame = 0; frame < 900; ++frame) {
            const double pull = 1300 + 900 * std::sin(2 * std::numbers::pi * frequency * frame / 60.0);
            ok(taut_body_apply_force(before, {0, static_cast<float>(-pull), 0}, {0, 0, 0}));
            world.step();
            const taut_profile profile = world.profile();
            if (frame < 120) continue;
            changes += (profile.solves > 0) != direct;
            direct = profile.solves > 0;
            fastest = std::max(fastest, norm(state(before).velocity));
            widest = std::max(widest, static_cast<double>(profile.joint_error));
        }
        EXPECT_LE(fastest, 0.13);
        EXPECT_LE(widest, 0.013);  // as the pull changes by 5.7 kN a second
    }
    EXPECT_GE(changes, 20);
}

// Graphs of joints whose factor is dense: 780 and 1770 joints among 40 and 60 bodies, each tied to each, 1500 between
// two. Ends are where they are as the world begins, so that nothing moves but by its weight.
TEST(JointGraphs, TakeNoStepLong) {
    const auto slowest_step = [](World& world) {
        double slowest = 0;  // [s] of the processor
        for (int step = 0; step < 5; ++step) {
            const std::clock_t start = std::clock();
            world.step();
            slowest = std::max(slowest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
        return slowest;
    };
    for (const int count : {40, 60}) {
        World world;
        std::vector<taut_body> bodies;
        std::vector<Vec> at;
        for (int i = 0; i < count; ++i) {
            at.emplace_back(i % 4, 0.5 * (i / 16), i / 4 % 4);
            bodies.push_back(world.add({.position = at.back(), .mass = 1, .inertia = Vec(0.1, 0.1, 0.1)}));
        }
        for (size_t i = 0; i < bodies.size(); ++i)
            for (size_t k = 0; k < i; ++k) {
                const Vec middle = 0.5 * (at[i] + at[k]);
                world.ball(bodies[i], middle - at[i], bodies[k], middle - at[k]);
            }
        EXPECT_LE(slowest_step(world), 0.05) << count << " bodies";
        EXPECT_EQ(world.profile().solves, 0u);
        EXPECT_LE(world.profile().joint_error, 1e-3f);
    }
    World world;
    const taut_body one = world.add({.position = {0, 0, 0}, .mass = 1, .inertia = Vec(0.1, 0.1, 0.1)});
    const taut_body other = world.add({.position = {1, 0, 0}, .mass = 1, .inertia = Vec(0.1, 0.1, 0.1)});
    for (int i = 0; i < 1500; ++i) {
        const Vec pivot(0.5, 0.1 * std::sin(i), 0.1 * std::cos(i));
        world.ball(one, pivot, other, pivot - Vec(1, 0, 0));
    }
    EXPECT_LE(slowest_step(world), 0.05) << "between two";
    EXPECT_LE(world.profile().joint_error, 1e-3f);
}

// y = a cosh(x / a) with 2 a sinh(span / 2 a) = length. Arc length from the middle: a sinh(x / a).
TEST(HangingCable, TakesTheShapeOfACatenary) {
    constexpr int kPoints = 40;
    constexpr double kSpan = 8, kLength = 10, kHeight = 10;
    World world;
    const double piece = kLength / (kPoints + 1);
    // It starts as a V, which has the right length.
    const double slope = std::sqrt(kLength * kLength / 4 - kSpan * kSpan / 4);
    std::vector<taut_body> points;
    for (int i = 1; i <= kPoints; ++i) {
        const double part = static_cast<double>(i) / (kPoints + 1);
        points.push_back(
            world.particle(0.5, {(part - 0.5) * kSpan, kHeight - slope * 2 * std::min(part, 1 - part), 0}));
    }
    world.rod({}, {-kSpan / 2, kHeight, 0}, points.front(), {}, piece);
    for (size_t i = 1; i < kPoints; ++i) world.rod(points[i - 1], {}, points[i], {}, piece);
    world.rod(points.back(), {}, {}, {kSpan / 2, kHeight, 0}, piece);

    // Nothing damps it: whenever its kinetic energy passes a maximum it is stopped (dynamic relaxation).
    double before = 0;
    for (int frame = 0; frame < 1200; ++frame) {
        world.step();
        const double kinetic = totals(points).kinetic;
        if (kinetic < before)
            for (taut_body point : points) ok(taut_body_set_velocity(point, {0, 0, 0}, {0, 0, 0}));
        before = kinetic < before ? 0 : kinetic;
    }

    double low = 1e-3, high = 1e3;  // of a
    for (int i = 0; i < 200; ++i) {
        const double a = 0.5 * (low + high);
        (2 * a * std::sinh(kSpan / (2 * a)) > kLength ? low : high) = a;
    }
    const double a = low, lift = kHeight - a * std::cosh(kSpan / (2 * a));
    double worst = 0;
    for (int i = 0; i < kPoints; ++i) {
        const double arc = (i + 1) * piece - kLength / 2, x = a * std::asinh(arc / a);
        worst =
            std::max(worst, norm(position(points[static_cast<size_t>(i)]) - Vec(x, lift + a * std::cosh(x / a), 0)));
    }
    EXPECT_LT(worst, 0.005 * kSpan);
    RecordProperty("worst_pct_of_span", std::to_string(100 * worst / kSpan));
}

}  // namespace
