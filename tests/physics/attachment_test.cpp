// Attachments against mechanics: forces on the bodies of an anchor, springs, rods, welds, breaking, momentum.
#include "physics/attachment_lab.h"

namespace {

using namespace lab;

// ---------------------------------------------------------------- statics

// A weight hangs from a point of a triangle or tetrahedron of particles, each held by a joint: the joints carry their
// particle and its share of the weight.
TEST(Attachment, SharesItsForceByTheWeights) {
    const std::vector<std::vector<double>> all = {{0.2, 0.5, 0.3}, {0.1, 0.2, 0.3, 0.4}, {1.3, -0.3}, {1}};
    for (const std::vector<double>& weights : all) {
        const World world;
        const Vec corner[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.3, 0.6, 0.2}};
        constexpr double kCorner = 0.25, kWeight = 3;
        std::vector<taut_body> particles;
        std::vector<taut_joint> held;
        Vec place;
        for (size_t n = 0; n < weights.size(); ++n) {
            particles.push_back(world.particle(kCorner, corner[n]));
            held.push_back(world.ball({}, corner[n], particles.back(), {}));
            place += weights[n] * corner[n];
        }
        const taut_body weight = world.add({.position = place, .mass = kWeight, .inertia = {0.1, 0.1, 0.1}});
        const taut_attachment hung = attach(world, anchor_of(particles, weights), anchor_on(world, weight, place));
        world.step(20);
        EXPECT_NEAR(force_of(hung).y, kWeight * kG, 1e-6 * kWeight * kG);
        EXPECT_LE(error_of(hung), 1e-8);
        for (size_t n = 0; n < weights.size(); ++n) {
            taut_vec3 force{};
            ok(taut_joint_get_force(held[n], &force));
            EXPECT_NEAR(Vec(force).y, (kCorner + weights[n] * kWeight) * kG, 1e-5 * kWeight * kG) << n;
        }
    }
}

// A point skinned to two bodies that turn is between where it is on each, and its force turns them both.
TEST(Attachment, IsBetweenTheBodiesThatItIsSkinnedTo) {
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    constexpr double kShare = 0.3, kForce = 5;
    const taut_body one = world.add({.position = {0, 0, 0}, .mass = 1, .inertia = {1, 1, 1}});
    const taut_body two = world.add({.position = {2, 0, 0}, .mass = 1, .inertia = {1, 1, 1}});
    const taut_joint hold_one = world.ball({}, {0, 0, 0}, one, {}), hold_two = world.ball({}, {2, 0, 0}, two, {});
    const Vec place(1, 0.5, 0);
    taut_anchor skinned = anchor_of({one, two}, {kShare, 1 - kShare});
    skinned.points[0] = place.pos();
    skinned.points[1] = (place - Vec(2, 0, 0)).pos();
    const taut_body pulled = world.particle(1, place);
    const taut_attachment on = attach(world, skinned, anchor_on(world, pulled, {}));
    ok(taut_body_apply_force(pulled, Vec(0, 0, kForce).narrow(), {0, 0, 0}));
    world.step();
    // Ends turn freely: what the joints carry is only what turning does not take, and centres stay.
    EXPECT_LE(norm(position(one)), 1e-9);
    EXPECT_LE(norm(position(two) - Vec(2, 0, 0)), 1e-9);
    // Torques are r x f by shares, about centres that are alike: spins are as r x (weight force).
    const Vec spin_one = state(one).spin, spin_two = state(two).spin;
    const Vec expected_one = kShare * cross(place, {0, 0, 1});
    const Vec expected_two = (1 - kShare) * cross(place - Vec(2, 0, 0), {0, 0, 1});
    EXPECT_GT(norm(spin_one), 1e-3);
    EXPECT_LE(norm(cross(unit(spin_one), unit(expected_one))), 1e-2);
    EXPECT_NEAR(norm(spin_one) / norm(spin_two), norm(expected_one) / norm(expected_two), 1e-2);
    for (int i = 0; i < 30; ++i) world.step();
    const BodyState a = state(one), b = state(two);
    const Vec between = kShare * (a.position + a.rotation.rotate(place)) +
                        (1 - kShare) * (b.position + b.rotation.rotate(place - Vec(2, 0, 0)));
    EXPECT_LE(norm(position(pulled) - between), 1e-5);
    EXPECT_LE(error_of(on), 1e-5);
    (void)hold_one, (void)hold_two;
}

// ---------------------------------------------------------------- springs of two laws

// A spring of length L and compliance c whose limit takes over from l on, with C: below the limit it is c m g longer,
// beyond it (x - L)/c + (x - l)/C = m g. The force that is read is that of both.
TEST(Biphasic, HangsAsLongAsItsTwoLawsSay) {
    constexpr double kLength = 0.5, kSoft = 1e-2, kLimit = 0.8;
    for (const double mass : {1.0, 2.0, 10.0, 30.0})
        for (const double stiff : {1e-4, 0.0})
            for (const bool pulls : {false, true})
                for (const taut_joint_solve solve : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT}) {
                    const World world;
                    const taut_body weight = world.particle(mass, {0, -kLength, 0});
                    const taut_attachment spring =
                        attach(world, anchor_in_world(world, {}), anchor_on(world, weight, {}),
                               {.kind = TAUT_ATTACHMENT_DISTANCE,
                                .length = kLength,
                                .compliance = kSoft,
                                .damping = 30,
                                .solve = solve,
                                .pulls = pulls,
                                .limit = kLimit,
                                .limit_compliance = stiff});
                    world.step(600);
                    const double alone = kLength + kSoft * mass * kG;
                    const double both =
                        stiff > 0 ? (mass * kG + kLength / kSoft + kLimit / stiff) / (1 / kSoft + 1 / stiff) : kLimit;
                    const double expected = alone < kLimit ? alone : both;
                    EXPECT_NEAR(-position(weight).y, expected, 2e-4 * expected) << mass << ' ' << stiff << ' ' << solve;
                    EXPECT_NEAR(force_of(spring).y, mass * kG, 1e-3 * mass * kG)
                        << mass << ' ' << stiff << ' ' << solve;
                }
}

// What only pulls is not there while it is slack: a weight below it falls freely, and one pressed together is not
// pushed apart.
TEST(Biphasic, OneThatPullsDoesNotPush) {
    for (const double compliance : {0.0, 1e-4}) {
        const World world;
        const taut_body weight = world.particle(1, {0, -0.2, 0});
        const taut_attachment rope = attach(
            world, anchor_in_world(world, {}), anchor_on(world, weight, {}),
            {.kind = TAUT_ATTACHMENT_DISTANCE, .length = 1, .compliance = compliance, .damping = 50, .pulls = true});
        const int steps = 18;  // .3 s: .44 m
        world.step(steps);
        const double h = world.frame() / world.def.substeps, n = steps * world.def.substeps;
        EXPECT_NEAR(position(weight).y, -0.2 - kG * h * h * n * (n + 1) / 2, 1e-6);
        EXPECT_EQ(norm(force_of(rope)), 0);
        EXPECT_EQ(error_of(rope), 0);
        world.step(300);
        EXPECT_NEAR(position(weight).y, -1 - compliance * kG, 2e-4);
        EXPECT_NEAR(force_of(rope).y, kG, 1e-3 * kG);
    }
}

// Between points within two beams, which it pulls alike.
TEST(Biphasic, PullsSkinnedPointsOfBothSides) {
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Beam beam({0.2, 0.2, 0.2}, 3, 3, 3, false);
    std::vector<taut_solid> solids;
    for (const double x : {0.0, 1.0}) {
        Beam at = beam;
        for (taut_pos& p : at.points) p.x += x;
        taut_solid_def def = at.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.3);
        def.filter.mask = 0;
        solids.push_back(add(world, def));
    }
    const taut_attachment spring =
        attach(world, anchor_on(solids[0], {0.15, 0.1, 0.1}), anchor_on(solids[1], {1.05, 0.1, 0.1}),
               {.kind = TAUT_ATTACHMENT_DISTANCE,
                .length = 0.3,
                .compliance = 0.05,
                .pulls = true,
                .limit = 0.6,
                .limit_compliance = 1e-3});
    const double length = 0.9, force = (length - 0.3) / 0.05 + (length - 0.6) / 1e-3;
    world.step(1);
    EXPECT_NEAR(norm(force_of(spring)), force, 0.25 * force);  // it gave way within the step
    const Vec one = momentum_of(bodies_of(solids[0])), two = momentum_of(bodies_of(solids[1]));
    EXPECT_GT(one.x, 0.5 * force * world.frame());
    EXPECT_LE(norm(one + two), 1e-6 * one.x);
}

// Kinds of ends that hold a weight by a spring.
TEST(Attachment, GivesByTheForceTimesItsCompliance) {
    constexpr double kWeight = 2, kCompliance = 2e-3, kDamping = 100;
    for (const taut_attachment_kind kind : {TAUT_ATTACHMENT_BALL, TAUT_ATTACHMENT_DISTANCE}) {
        for (const uint32_t count : {1u, 3u}) {
            const World world;
            std::vector<taut_body> top;
            for (uint32_t n = 0; n < count; ++n)
                top.push_back(
                    world.add({.kind = TAUT_BODY_STATIC, .position = {std::cos(2.0 * n), 0, std::sin(2.0 * n)}}));
            taut_anchor from = anchor_of(top, std::vector<double>(count, 1.0 / count));
            taut_pos at{};
            ok(taut_world_get_anchor_point(world.handle, &from, &at));
            const bool rod = kind == TAUT_ATTACHMENT_DISTANCE;
            const Vec place = Vec(at) - Vec(0, rod ? 0.5 : 0, 0);
            const taut_body weight = world.particle(kWeight, place);
            const taut_attachment spring =
                attach(world, from, anchor_on(world, weight, {}),
                       {.kind = kind, .length = rod ? 0.5 : 0.0, .compliance = kCompliance, .damping = kDamping});
            world.step(240);
            const double sag = kWeight * kG * kCompliance;
            EXPECT_NEAR(place.y - position(weight).y, sag, 1e-4 * sag);
            EXPECT_NEAR(error_of(spring), sag, 1e-4 * sag);
            EXPECT_NEAR(force_of(spring).y, kWeight * kG, 1e-4 * kWeight * kG);
            // Twice as soft.
            ok(taut_attachment_set_compliance(spring, static_cast<float>(2 * kCompliance), kDamping / 2));
            world.step(240);
            EXPECT_NEAR(place.y - position(weight).y, 2 * sag, 2e-4 * sag);
            // And rigid again.
            ok(taut_attachment_set_compliance(spring, 0, 0));
            world.step(120);
            EXPECT_NEAR(place.y - position(weight).y, 0, 1e-6);
        }
    }
}

// ---------------------------------------------------------------- rods and welds

// A pendulum from a point of a triangle of a cloth that is pinned.
TEST(Attachment, KeepsItsDistance) {
    const World world;
    const Sheet sheet(3, 3, 1, 1, 2);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < 9; ++v) ok(taut_cloth_pin(cloth, v, 1));
    const Vec top(0.4, 2, 0.3);
    const taut_body bob = world.particle(5, top + Vec(0.6, 0, 0));
    const taut_attachment rod =
        attach(world, anchor_on(cloth, top), anchor_on(world, bob, {}), {.kind = TAUT_ATTACHMENT_DISTANCE});
    double lowest = top.y;
    for (int i = 0; i < 120; ++i) {
        world.step();
        // A straight substep leaves a circle by (h v)^2/(2 L), with v^2 = 2 g L at the lowest.
        EXPECT_NEAR(norm(position(bob) - top), 0.6, 1.05 * kG * world.substep() * world.substep());
        lowest = std::min(lowest, position(bob).y);
    }
    EXPECT_NEAR(lowest, top.y - 0.6, 0.02);
    ok(taut_attachment_set_length(rod, 0.7f));
    world.step(2);
    EXPECT_NEAR(norm(position(bob) - top), 0.7, 1.05 * kG * world.substep() * world.substep() + 1e-4);
}

// A beam of rigid mass welded to a pinned triangle: what it holds is force and torque of the weight.
TEST(Attachment, WeldsARigidBodyToATriangle) {
    const World world;
    const Sheet sheet(2, 2, 0.4, 0.4, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 1));
    constexpr double kWeight = 4;
    const Vec far(1.5, 0.2, 0.1);
    const taut_body body = world.add({.position = far, .mass = kWeight, .inertia = {0.2, 0.3, 0.4}});
    const float third[] = {1 / 3.0f, 1 / 3.0f, 1 / 3.0f};
    taut_anchor triangle{};
    ok(taut_cloth_get_anchor(cloth, 0, third, &triangle));
    const taut_attachment weld = attach(world, triangle, anchor_on(world, body, far), {.kind = TAUT_ATTACHMENT_FIXED});
    world.step(60);
    EXPECT_LE(norm(position(body) - far), 1e-5);
    EXPECT_LE(error_of(weld), 1e-5);
    EXPECT_NEAR(force_of(weld).y, kWeight * kG, 1e-4 * kWeight * kG);
    taut_vec3 torque{};
    ok(taut_attachment_get_torque(weld, &torque));
    // On b, the body, about the triangle's middle: minus that of its weight.
    const Vec expected = -cross(far - points_of(weld).first, {0, -kWeight * kG, 0});
    EXPECT_LE(norm(Vec(torque) - expected), 1e-3 * norm(expected));
}

struct WeldCase {
    const char* name;
    double ratio, gap;  // mass of the body over the beam's; widest gap [m]
};
class WeldedBeam : public testing::TestWithParam<WeldCase> {};
INSTANTIATE_TEST_SUITE_P(Of, WeldedBeam,
                         testing::Values(WeldCase{"Equal", 1, 5e-5}, WeldCase{"Thousandfold", 1000, 1e-3}),
                         [](const auto& each) { return std::string(each.param.name); });

// A rigid body welded to the free end of a soft beam, let go.
TEST_P(WeldedBeam, HoldsItsBody) {
    World world;
    const Beam beam({0.5, 0.1, 0.1}, 11, 3, 3, false);
    taut_solid_def def = beam.def(TAUT_SOLID_NEO_HOOKEAN, 1e6, 0.3);
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    const double mass = GetParam().ratio * 0.5 * 0.1 * 0.1 * 1000, inertia = mass * 0.01 / 6;
    const taut_body body =
        world.add({.position = {0.55, 0.05, 0.05}, .mass = mass, .inertia = {inertia, inertia, inertia}});
    std::vector<taut_attachment> welds;
    std::vector<taut_body> vertex(beam.points.size());
    uint32_t count = 0;
    ok(taut_solid_get_bodies(solid, vertex.data(), static_cast<uint32_t>(vertex.size()), &count));
    std::vector<taut_body> face;
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) face.push_back(vertex[beam.at(10, j, k)]);
    for (size_t first = 0; first < face.size(); first += 3)
        welds.push_back(
            attach(world,
                   anchor_of({face.begin() + static_cast<long>(first), face.begin() + static_cast<long>(first) + 3},
                             {0.4, 0.3, 0.3}),
                   anchor_on(world, body, {0.5, 0.05, 0.05}), {.kind = TAUT_ATTACHMENT_FIXED}));
    double widest = 0, time = 0;
    for (int i = 0; i < 240; ++i) {
        world.step();
        time += static_cast<double>(world.profile().step_us) / 240;
        for (const taut_attachment weld : welds) widest = std::max(widest, error_of(weld));
        ASSERT_TRUE(finite(body));
    }
    RecordProperty("widest_gap_mm", std::to_string(1000 * widest));
    RecordProperty("step_ms", std::to_string(time / 1000));
    std::printf("gap %.6f mm, %.2f ms\n", 1000 * widest, time / 1000);
    EXPECT_LE(widest, GetParam().gap);
}

// What a kinematic body leads follows it to the end of each step.
TEST(Attachment, FollowsAKinematicBody) {
    const World world;
    const Sheet sheet(4, 4, 0.6, 0.6, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.filter.mask = 0;
    def.damping = 0.1f;
    const taut_cloth cloth = add(world, def);
    const Vec place(0.25, 0, 0.35);
    const taut_body hand = world.add({.kind = TAUT_BODY_KINEMATIC, .position = place});
    const taut_attachment held = attach(world, anchor_on(cloth, place), anchor_on(world, hand, place));
    for (int i = 1; i <= 90; ++i) {
        taut_pose to{};
        to.position = (place + Vec(0.01 * i, 0.005 * i, 0)).pos();
        to.rotation.w = 1;
        ok(taut_body_move_kinematic(hand, &to));
        world.step();
        EXPECT_LE(error_of(held), 1e-6) << i;
    }
    // b is the hand, which the cloth pulls down, by its weight on the mean.
    double weight = 0, mean = 0;
    for (const taut_body vertex : bodies_of(cloth)) weight += mass_of(vertex).mass * kG;
    world.step(120);
    constexpr int kFrames = 480;
    for (int i = 0; i < kFrames; ++i) {
        world.step();
        mean += force_of(held).y / kFrames;
    }
    EXPECT_NEAR(mean, -weight, 0.02 * weight);
}

// A weight between two points of a cable; it goes when one of them is reeled in.
TEST(Attachment, HangsFromACable) {
    const World world;
    const taut_pos ends[] = {{0, 3, 0}, {4, 3, 0}};
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = TAUT_CABLE_PARTICLES;
    def.points = ends;
    def.point_count = 2;
    def.segment_count = 8;
    def.mass_per_metre = 0.5f;
    for (int e = 0; e < 2; ++e) {
        def.end[e].attached = 1;
        def.end[e].anchor = ends[e];
    }
    taut_cable cable{};
    ok(taut_world_add_cable(world.handle, &def, &cable));
    std::vector<taut_body> bodies(9);
    uint32_t count = 0;
    ok(taut_cable_get_bodies(cable, bodies.data(), 9, &count));
    ASSERT_EQ(count, 9u);
    const Vec between = 0.25 * position(bodies[4]) + 0.75 * position(bodies[5]);
    const taut_body weight = world.particle(3, between);
    const taut_attachment hung =
        attach(world, anchor_of({bodies[4], bodies[5]}, {0.25, 0.75}), anchor_on(world, weight, {}));
    for (int i = 0; i < 240; ++i) {
        world.step();
        ASSERT_TRUE(finite(weight));
        EXPECT_LE(error_of(hung), 1e-3);
    }
    ok(taut_cable_set_reel_speed(cable, 1, -1, 0));
    for (int i = 0; i < 300 && taut_attachment_is_valid(hung); ++i) {
        world.step();
        ASSERT_TRUE(finite(weight));
    }
    EXPECT_EQ(taut_attachment_is_valid(hung), 0);
    world.step(10);
    EXPECT_TRUE(finite(weight));
}

// ---------------------------------------------------------------- momentum

struct Free {
    explicit Free(uint32_t threads = 1)
        : world([&](taut_world_def& def) {
              def.gravity = {0, 0, 0};
              def.threads = threads;
          }) {}
    void take(taut_cloth cloth) {
        for (const taut_body body : bodies_of(cloth)) bodies.push_back(body);
    }
    void take(taut_solid solid, size_t count) {
        std::vector<taut_body> own(count);
        uint32_t written = 0;
        ok(taut_solid_get_bodies(solid, own.data(), static_cast<uint32_t>(count), &written));
        bodies.insert(bodies.end(), own.begin(), own.end());
    }
    taut_cloth cloth(const Vec& place) {
        Sheet sheet(4, 4, 0.6, 0.6, 0);
        for (taut_pos& p : sheet.points) p = (Vec(p) + place).pos();
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.filter.mask = 0;
        const taut_cloth out = add(world, def);
        take(out);
        return out;
    }
    taut_solid solid(const Vec& place, bool hex) {
        Beam beam({0.4, 0.4, 0.4}, 3, 3, 3, hex);
        for (taut_pos& p : beam.points) p = (Vec(p) + place).pos();
        taut_solid_def def = beam.def(TAUT_SOLID_COROTATED, 1e4, 0.3);
        def.filter.mask = 0;
        const taut_solid out = add(world, def);
        take(out, beam.points.size());
        return out;
    }
    taut_body body(const Vec& place, const Vec& velocity) {
        bodies.push_back(world.add(
            {.position = place, .velocity = velocity, .spin = {1, 2, -1}, .mass = 0.5, .inertia = {0.02, 0.02, 0.02}}));
        return bodies.back();
    }
    void expect_kept(int frames) {
        const Totals before = totals(bodies);
        world.step(frames);
        const Totals after = totals(bodies);
        double size = 0;
        for (const taut_body body : bodies) size += mass_of(body).mass * norm(velocity(body));
        EXPECT_GT(size, 0.1);
        EXPECT_LE(norm(after.momentum - before.momentum), 1e-5 * size);
        EXPECT_LE(norm(after.spin - before.spin), 0.02 * norm(before.spin));
    }

    World world;
    std::vector<taut_body> bodies;
};

TEST(Attachment, KeepsTheMomentumOfBodyAndCloth) {
    Free free;
    const taut_cloth cloth = free.cloth({});
    const taut_body body = free.body({0.25, -0.1, 0.35}, {0, 1, 0.5});
    attach(free.world, anchor_on(cloth, {0.25, 0, 0.35}), anchor_on(free.world, body, {0.25, 0, 0.35}));
    free.expect_kept(30);
}
TEST(Attachment, KeepsTheMomentumOfSolidAndBody) {
    for (const bool hex : {false, true}) {
        Free free;
        const taut_solid solid = free.solid({}, hex);
        const taut_body body = free.body({0.2, 0.5, 0.2}, {0.5, 0.5, 0});
        attach(free.world, anchor_on(solid, {0.15, 0.33, 0.22}), anchor_on(free.world, body, {0.15, 0.33, 0.22}));
        free.expect_kept(30);
    }
}
TEST(Attachment, KeepsTheMomentumOfTwoClothsAndAWeld) {
    Free free;
    const taut_cloth one = free.cloth({}), two = free.cloth({0.5, 0.1, 0});
    const taut_body body = free.body({0.1, 0.2, 0.1}, {1, 0, 0.5});
    attach(free.world, anchor_on(one, {0.55, 0, 0.3}), anchor_on(two, {0.55, 0.1, 0.3}),
           {.kind = TAUT_ATTACHMENT_DISTANCE, .compliance = 1e-3});
    attach(free.world, anchor_on(one, {0.1, 0, 0.1}), anchor_on(free.world, body, {0.1, 0.2, 0.1}),
           {.kind = TAUT_ATTACHMENT_FIXED});
    free.expect_kept(30);
}

// ---------------------------------------------------------------- every solver, swept ones

class AttachedWithEachSolver : public testing::TestWithParam<uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Of, AttachedWithEachSolver, testing::Range(0u, uint32_t{TAUT_SOLVER_MINIMISATION}),
                         [](const auto& each) {
                             return std::string(taut_solver_name(static_cast<taut_solver>(each.param)));
                         });

// A weight hangs from a cloth that hangs by its corners, by all kinds: it stays finite, and near.
TEST_P(AttachedWithEachSolver, HangsFromACloth) {
    for (const taut_attachment_kind kind : {TAUT_ATTACHMENT_BALL, TAUT_ATTACHMENT_DISTANCE, TAUT_ATTACHMENT_FIXED}) {
        World world([&](taut_world_def& def) { def.solver = static_cast<taut_solver>(GetParam()); });
        const Sheet sheet(4, 4, 0.9, 0.9, 0);
        taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
        def.stretch_compliance[0] = def.stretch_compliance[1] = 1e-4f;
        def.filter.mask = 0;
        const taut_cloth cloth = add(world, def);
        for (const int corner : {0, 3, 12, 15}) ok(taut_cloth_pin(cloth, static_cast<uint32_t>(corner), 1));
        const Vec place(0.4, 0, 0.5);
        const taut_body body =
            world.add({.position = place - Vec(0, 0.3, 0), .mass = 0.3, .inertia = {0.01, 0.01, 0.01}});
        const bool rod = kind == TAUT_ATTACHMENT_DISTANCE;
        attach(world, anchor_on(cloth, place), anchor_on(world, body, place - Vec(0, rod ? 0.2 : 0, 0)),
               {.kind = kind});
        for (int i = 0; i < 90; ++i) {
            world.step();
            ASSERT_TRUE(finite(body)) << i;
        }
        EXPECT_LE(norm(position(body) - (place - Vec(0, 0.3, 0))), 0.5) << kind;
        for (const Vec& x : points_of(cloth)) EXPECT_TRUE(finite(x));
    }
}

// A spring and a weld under each scheme of time integration: the weight sinks by as much.
TEST(Attachment, TakesEachScheme) {
    for (const taut_scheme scheme : {TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2}) {
        World world([&](taut_world_def& def) { def.scheme = scheme; });
        const Sheet sheet(2, 2, 0.4, 0.4, 0);
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.filter.mask = 0;
        const taut_cloth cloth = add(world, def);
        for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 1));
        const Vec place(0.1, 0, 0.2);
        const taut_body plate = world.add({.position = place, .mass = 1, .inertia = {0.1, 0.1, 0.1}});
        const taut_attachment weld =
            attach(world, anchor_on(cloth, place), anchor_on(world, plate, place), {.kind = TAUT_ATTACHMENT_FIXED});
        const taut_body weight = world.particle(1, place - Vec(0, 0.5, 0));
        attach(world, anchor_on(world, plate, place), anchor_on(world, weight, {}),
               {.kind = TAUT_ATTACHMENT_DISTANCE, .compliance = 1e-3, .damping = 50});
        world.step(300);
        EXPECT_NEAR(position(weight).y, -0.5 - 1e-3 * kG, 1e-4) << scheme;
        EXPECT_LE(error_of(weld), 1e-5) << scheme;
    }
}

// Swept where asked for, on a cloth that is swept: still near.
TEST(Attachment, IsSweptWhereAskedFor) {
    World world;
    const Sheet sheet(4, 4, 0.9, 0.9, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.solve = TAUT_DEFORMABLE_SWEPT;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const int corner : {0, 3, 12, 15}) ok(taut_cloth_pin(cloth, static_cast<uint32_t>(corner), 1));
    const Vec place(0.4, 0, 0.5);
    const taut_body body = world.add({.position = place, .mass = 0.05, .inertia = {0.001, 0.001, 0.001}});
    const taut_attachment hung =
        attach(world, anchor_on(cloth, place), anchor_on(world, body, place), {.solve = TAUT_JOINT_SOLVE_SOFT});
    for (int i = 0; i < 120; ++i) {
        world.step();
        ASSERT_TRUE(finite(body)) << i;
    }
    EXPECT_LE(error_of(hung), 0.01);
    EXPECT_EQ(world.profile().blocks, 0u);
}

// ---------------------------------------------------------------- rest, what is not finite

struct HungFromAPinnedSheet {
    explicit HungFromAPinnedSheet(bool sleeping) : world([&](taut_world_def& def) { def.sleeping = sleeping; }) {
        const Sheet sheet(3, 3, 1, 1, 2);
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.filter.mask = 0;
        cloth = add(world, def);
        for (uint32_t v = 0; v < 9; ++v) ok(taut_cloth_pin(cloth, v, v != 4));
        const Vec place(0.4, 2, 0.3);
        body = world.particle(0.05, place - Vec(0, 0.4, 0));
        rod = attach(world, anchor_on(cloth, place), anchor_on(world, body, {}),
                     {.kind = TAUT_ATTACHMENT_DISTANCE, .compliance = 1e-4, .damping = 100});
    }
    World world;
    taut_cloth cloth{};
    taut_body body{};
    taut_attachment rod{};
};

TEST(Attachment, SleepsAndWakesWithItsBodies) {
    const HungFromAPinnedSheet hung(true);
    const auto awake = [&] {
        uint32_t out = 0;
        ok(taut_body_get_awake(hung.body, &out));
        return out != 0;
    };
    for (int i = 0; i < 1200 && awake(); ++i) hung.world.step();
    ASSERT_FALSE(awake());
    const Vec force = force_of(hung.rod);
    EXPECT_NEAR(force.y, 0.05 * kG, 0.01);
    hung.world.step(10);
    EXPECT_EQ(force_of(hung.rod).y, force.y);
    ok(taut_attachment_set_compliance(hung.rod, 1e-3f, 10));
    EXPECT_TRUE(awake());
    for (int i = 0; i < 1200 && awake(); ++i) hung.world.step();
    ASSERT_FALSE(awake());
    ok(taut_attachment_remove(hung.rod));
    EXPECT_TRUE(awake());
    const double before = position(hung.body).y;
    hung.world.step(30);
    EXPECT_LT(position(hung.body).y, before - 1);
}

TEST(Attachment, TakesNoMemoryInAStep) {
    const HungFromAPinnedSheet hung(false);
    hung.world.step(60);
    for (int i = 0; i < 30; ++i) {
        hung.world.step();
        EXPECT_EQ(hung.world.profile().allocations, 0u) << i;
    }
}

// A body that is thrown beyond all numbers is made static; what it is attached to goes on.
TEST(Attachment, SparesTheOthersWhatIsNotFinite) {
    const HungFromAPinnedSheet hung(false);
    hung.world.step(10);
    ok(taut_body_apply_force(hung.body, {1e23f, 0, 0}, {0, 0, 0}));
    hung.world.step(30);
    taut_events events{};
    ok(taut_world_get_events(hung.world.handle, &events));
    ASSERT_EQ(events.quarantined_count, 1u);
    EXPECT_TRUE(finite(hung.body));
    for (const Vec& x : points_of(hung.cloth)) EXPECT_TRUE(finite(x));
    EXPECT_EQ(taut_attachment_is_valid(hung.rod), 1);
}

// ---------------------------------------------------------------- bits and snapshots

struct Mixed {
    explicit Mixed(uint32_t threads)
        : world([&](taut_world_def& def) {
              def.threads = threads;
              def.sleeping = 1;
          }) {
        world.add_ground();
        Sheet sheet(6, 6, 1, 1, 1);
        const taut_cloth cloth = add(world, sheet.def(TAUT_CLOTH_TRIANGLES));
        for (const int corner : {0, 5, 30, 35}) ok(taut_cloth_pin(cloth, static_cast<uint32_t>(corner), 1));
        Beam cube({0.3, 0.3, 0.3}, 3, 3, 3, true);
        for (taut_pos& p : cube.points) p = (Vec(p) + Vec(0.3, 0.5, 0.3)).pos();
        const taut_solid solid = add(world, cube.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.3));
        for (int i = 0; i < 12; ++i) {
            const Vec place(0.2 + 0.05 * i, 1, 0.7 - 0.04 * i);
            bodies.push_back(world.add({.shape = world.sphere(0.04), .position = place - Vec(0, 0.1, 0), .mass = 0.2}));
            attach(world, anchor_on(cloth, place), anchor_on(world, bodies.back(), place),
                   {.kind = i % 2 ? TAUT_ATTACHMENT_BALL : TAUT_ATTACHMENT_FIXED});
        }
        for (int i = 0; i < 4; ++i)
            attach(world, anchor_on(cloth, {0.3 + 0.1 * i, 1, 0.4}), anchor_on(solid, {0.3 + 0.1 * i, 0.8, 0.4}),
                   {.kind = TAUT_ATTACHMENT_DISTANCE, .compliance = i % 2 ? 1e-3 : 0, .damping = 10});
    }
    uint64_t hash() const {
        uint64_t out = 0;
        ok(taut_world_get_state_hash(world.handle, &out));
        return out;
    }
    std::vector<uint64_t> step(int frames) const {
        std::vector<uint64_t> out;
        for (int i = 0; i < frames; ++i) world.step(), out.push_back(hash());
        return out;
    }

    World world;
    std::vector<taut_body> bodies;
};

TEST(Attachment, GivesTheSameBitsOnAnyNumberOfThreads) {
    const std::vector<uint64_t> alone = Mixed(1).step(60);
    for (const uint32_t threads : {2u, 5u}) EXPECT_EQ(Mixed(threads).step(60), alone) << threads;
}

TEST(Attachment, IsRestored) {
    const Mixed mixed(1);
    mixed.step(10);
    uint32_t count = 0;
    std::vector<taut_attachment_state> all(64);
    ok(taut_world_get_attachments(mixed.world.handle, all.data(), 64, &count));
    ASSERT_EQ(count, 16u);
    const double carried = norm(Vec(all[3].force));
    ok(taut_attachment_set_break(all[3].attachment, static_cast<float>(0.5 * carried), 0));
    uint64_t size = 0, written = 0;
    ok(taut_world_snapshot_size(mixed.world.handle, &size));
    std::vector<unsigned char> saved(size);
    ok(taut_world_save(mixed.world.handle, saved.data(), size, &written));
    const std::vector<uint64_t> first = mixed.step(30);
    EXPECT_EQ(taut_attachment_is_valid(all[3].attachment), 0);
    // What is changed and taken away meanwhile is there again.
    ok(taut_attachment_remove(all[0].attachment));
    ok(taut_attachment_set_compliance(all[2].attachment, 0.01f, 1));
    ok(taut_body_remove(mixed.bodies[5]));
    mixed.step(5);
    ok(taut_world_restore(mixed.world.handle, saved.data(), size));
    for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(taut_attachment_is_valid(all[i].attachment), 1) << i;
    EXPECT_EQ(mixed.step(30), first);
    for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(taut_attachment_is_valid(all[i].attachment), i == 3 ? 0 : 1) << i;
}

}  // namespace
