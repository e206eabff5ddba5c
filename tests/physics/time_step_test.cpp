// The time step may change between steps: what moves keeps its velocity, and what rests does not notice.
#include <random>
#include <vector>

#include "physics/cable_lab.h"

namespace {

using namespace lab;

// A plan of steps [s] for a step number.
struct Plan {
    const char* name;
    double (*length)(int step, std::mt19937& random);
};

const Plan kPlans[] = {
    {"Halved", [](int, std::mt19937&) { return 1.0 / 120; }},
    {"Quartered", [](int, std::mt19937&) { return 1.0 / 240; }},
    {"Doubled", [](int, std::mt19937&) { return 1.0 / 30; }},
    {"Quadrupled", [](int, std::mt19937&) { return 1.0 / 15; }},
    {"InTurns", [](int step, std::mt19937&) { return step % 2 ? 1.0 / 30 : 1.0 / 120; }},
    {"AtRandom",
     [](int, std::mt19937& random) {
         return 1.0 / 60 * std::pow(4.0, std::uniform_real_distribution<double>(-1, 1)(random));
     }},
};

struct Case {
    const Plan* plan;
    taut_solver solver;
};

class ChangedStep : public testing::TestWithParam<Case> {
protected:
    ChangedStep() : world([this](taut_world_def& def) { def.solver = GetParam().solver; }) {}

    // Lets it come to rest, then changes steps for two seconds: how far it goes at most [m], how fast [m/s].
    void expect_rest(const std::vector<taut_body>& bodies, int settle) {
        world.step(settle);
        std::vector<Vec> start;
        for (taut_body body : bodies) start.push_back(position(body));
        double way = 0, speed = 0, time = 0;
        std::mt19937 random(77);
        for (int i = 0; time < 2; ++i) {
            const double length = GetParam().plan->length(i, random);
            ok(taut_world_set_time_step(world.handle, static_cast<float>(length)));
            ok(taut_world_step(world.handle));
            time += length;
            for (size_t k = 0; k < bodies.size(); ++k) {
                way = std::max(way, norm(position(bodies[k]) - start[k]));
                speed = std::max(speed, norm(velocity(bodies[k])));
            }
        }
        EXPECT_LT(way, 1e-4);
        EXPECT_LT(speed, 1e-3);
    }

    CableLab world;
};

std::vector<Case> cases() {
    std::vector<Case> out;
    for (const Plan& plan : kPlans) out.push_back({&plan, TAUT_SOLVER_BLOCK_LDLT});
    return out;
}
INSTANTIATE_TEST_SUITE_P(Plans, ChangedStep, testing::ValuesIn(cases()),
                         [](const auto& each) { return std::string(each.param.plan->name); });

TEST_P(ChangedStep, AStackRests) {
    world.add_ground();
    std::vector<taut_body> bodies;
    for (int i = 0; i < 4; ++i)
        bodies.push_back(world.add({.shape = world.box({0.3, 0.25, 0.35}), .position = {0, 0.25 + 0.5 * i, 0}}));
    expect_rest(bodies, 180);
}

TEST_P(ChangedStep, AWallRests) {
    world.add_ground();
    std::vector<taut_body> bodies;
    const taut_shape brick = world.box({0.2, 0.1, 0.1});
    for (int row = 0; row < 6; ++row)
        for (int i = 0; i < 5; ++i)
            bodies.push_back(world.add(
                {.shape = brick, .position = {0.4 * i + 0.2 * (row % 2), 0.1 + 0.2 * row, 0}, .friction = 0.6}));
    expect_rest(bodies, 240);
}

TEST_P(ChangedStep, ABoxOnASlopeRests) {
    const double angle = 0.3;
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane({std::sin(angle), std::cos(angle), 0}), .friction = 0.8});
    const Quat turn = Quat::turn({0, 0, 1}, -angle);
    const taut_body box = world.add(
        {.shape = world.box({0.4, 0.2, 0.3}), .position = turn.rotate({0, 0.2, 0}), .rotation = turn, .friction = 0.8});
    const taut_body ball = world.add({.shape = world.sphere(0.2),
                                      .position = turn.rotate({0, 0.2, 2}),
                                      .friction = 0.8,
                                      .rolling = 0.1,
                                      .spinning = 0.1});
    expect_rest({box, ball}, 120);
}

TEST_P(ChangedStep, AChainHangs) {
    std::vector<taut_body> bodies;
    taut_body end{};
    for (int i = 0; i < 8; ++i) {
        const taut_body next = world.add({.shape = world.box({0.05, 0.25, 0.05}),
                                          .position = {0, 10 - 0.25 - 0.5 * i, 0},
                                          .mass = i < 7 ? 1.0 : 200.0});
        world.ball(end, i == 0 ? Vec(0, 10, 0) : Vec(0, -0.25, 0), next, {0, 0.25, 0});
        bodies.push_back(end = next);
    }
    expect_rest(bodies, 120);
}

TEST_P(ChangedStep, SpringsRest) {
    std::vector<taut_body> bodies;
    for (double stiffness : {400.0, 4e3, 4e5}) {  // [N/m], of 5 kg: 1.4, 4.5 and 45 Hz
        const double x = std::log10(stiffness), sag = 5 * kG / stiffness;
        const taut_body body = world.add({.shape = world.sphere(0.2), .position = {x, 3 - sag, 0}, .mass = 5});
        world.rod({}, {x, 4, 0}, body, {0, 0, 0}, 1, 1 / stiffness, 2 * std::sqrt(5 * stiffness));
        bodies.push_back(body);
    }
    expect_rest(bodies, 240);
}

TEST_P(ChangedStep, DrivesHold) {
    std::vector<taut_body> bodies;
    for (double frequency : {0.7, 3.0, 12.0}) {
        const double z = frequency;
        taut_hinge_joint_def def;
        taut_hinge_joint_def_init(&def);
        def.base.body_b = world.add({.shape = world.box({0.5, 0.05, 0.1}), .position = {0.5, 2, z}, .mass = 2});
        const taut_quat about_z = Quat::turn({0, 1, 0}, -kPi / 2).narrow();
        def.base.frame_a = {{0, 2, z}, about_z};
        def.base.frame_b = {{-0.5, 0, 0}, about_z};
        def.angle.drive.frequency = static_cast<float>(frequency);
        def.angle.drive.damping_ratio = 1;
        taut_joint joint{};
        ok(taut_world_add_hinge_joint(world.handle, &def, &joint));
        bodies.push_back(def.base.body_b);
    }
    expect_rest(bodies, 600);
}

TEST_P(ChangedStep, ACableHangs) {
    std::vector<taut_body> loads;
    for (taut_cable_kind kind : {TAUT_CABLE_LINKS, TAUT_CABLE_PARTICLES}) {
        const double x = 3.0 * static_cast<double>(loads.size());
        loads.push_back(world.add({.shape = world.sphere(0.3), .position = {x, -4, 0}, .mass = 300}));
        taut_cable_def def = CableLab::plan(kind, loads.back());
        def.end[0] = to_world({x, 0, 0});
        def.segment_count = 16;
        def.filter.mask = 0;
        world.cable(def);
    }
    expect_rest(loads, 120);
}

// So may their number: no fewer than before, or as many fewer as the steps are shorter.
TEST(ChangedSubsteps, AStackRests) {
    World world;
    world.add_ground();
    std::vector<taut_body> bodies;
    for (int i = 0; i < 4; ++i)
        bodies.push_back(world.add({.shape = world.box({0.2, 0.3, 0.25}), .position = {0, 0.3 + 0.6 * i, 0}}));
    world.step(180);
    std::vector<Vec> start;
    for (taut_body body : bodies) start.push_back(position(body));
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) {
        const uint32_t shorter = 1 + random() % 4;
        ok(taut_world_set_time_step(world.handle, 1.0f / 60 / static_cast<float>(shorter)));
        ok(taut_world_set_substeps(world.handle, 4 / shorter + 1 + random() % 8));
        ok(taut_world_step(world.handle));
        for (size_t k = 0; k < bodies.size(); ++k) {
            ASSERT_LT(norm(position(bodies[k]) - start[k]), 1e-4) << i;
            ASSERT_LT(norm(velocity(bodies[k])), 1e-3) << i;
        }
    }
}

// Fewer and longer ones let what rests settle, and as many as before bring it back.
TEST(ChangedSubsteps, SettleAndComeBack) {
    World world;
    world.add_ground();
    const taut_body box = world.add({.shape = world.box({0.2, 0.3, 0.25}), .position = {0, 0.3, 0}});
    world.step(120);
    const double before = position(box).y;
    ok(taut_world_set_substeps(world.handle, 1));
    world.step(240);
    EXPECT_EQ(world.profile().substeps, 1u);
    EXPECT_LT(position(box).y, before - 5e-4);
    ok(taut_world_set_substeps(world.handle, world.def.substeps));
    world.step(240);
    EXPECT_NEAR(position(box).y, before, 1e-5);
}

// What moves keeps its velocity, and arrives where it would have.
TEST_P(ChangedStep, AFreeBodyFliesOn) {
    const taut_body ball =
        world.add({.shape = world.sphere(0.2), .velocity = {3, 0, 1}, .spin = {0, 2, 0}, .gravity_scale = 0});
    std::mt19937 random(5);
    double time = 0;
    for (int i = 0; time < 1; ++i) {
        const float length = static_cast<float>(GetParam().plan->length(i, random));
        ok(taut_world_set_time_step(world.handle, length));
        EXPECT_EQ(velocity(ball).x, 3);
        ok(taut_world_step(world.handle));
        time += static_cast<double>(length);
        ASSERT_NEAR(position(ball).x, 3 * time, 1e-6);
    }
    EXPECT_NEAR(state(ball).spin.y, 2, 1e-6);
}

}  // namespace
