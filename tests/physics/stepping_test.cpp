// How a substep goes over its rows (Frâncu 2016, sections 6.3, 6.9, 8.2 and 8.3): position based dynamics, velocity
// time stepping, Sequential Positions and mixtures of them, against what their equations say of one step.
#include <algorithm>

#include "lab.h"

namespace {

using namespace lab;

constexpr taut_body kWorld{0};

// Gains of one world: k_c of joints and contacts, k_v.
struct Gains {
    double share, velocity;
};
constexpr Gains kPositionBased{1, 0}, kSequential{1, 0.1}, kVelocity{0.5, 0};

std::function<void(taut_world_def&)> with(taut_solver solver, taut_stepping stepping, const Gains& gains, double hz,
                                          uint32_t sweeps = 30) {
    return [=](taut_world_def& def) {
        def.solver = solver;
        def.stepping = stepping;
        def.stabilisation = def.contact_stabilisation = static_cast<float>(gains.share);
        def.velocity_gain = static_cast<float>(gains.velocity);
        def.time_step = static_cast<float>(1 / hz);
        def.substeps = def.fixed_substeps = 1;
        def.sweeps = sweeps;
    };
}

class SteppingAt : public testing::TestWithParam<int> {
protected:
    double hz() const { return GetParam(); }
    double h() const { return static_cast<float>(1 / hz()); }
};
INSTANTIATE_TEST_SUITE_P(Hz, SteppingAt, testing::Values(30, 60, 120, 240),
                         [](const auto& rate) { return std::to_string(rate.param); });

constexpr double kRadius = 0.1, kOverlap = 0.004;  // of a ball in the ground [m]

// Where a ball at rest in the ground is moved to in a step, and the speed at which it leaves.
struct Pop {
    double moved, speed;
};
Pop pop_of(const std::function<void(taut_world_def&)>& change) {
    const World world([&](taut_world_def& def) {
        change(def);
        def.gravity = {};
    });
    world.add_ground();
    const taut_body ball = world.add({.shape = world.sphere(kRadius), .position = {0, kRadius - kOverlap, 0}});
    world.step();
    return {position(ball).y - kRadius + kOverlap, velocity(ball).y};
}

// Position based dynamics takes an overlap back within a step and leaves at overlap / h; of that each iteration of the
// velocity pass takes k_v away.
TEST_P(SteppingAt, OverlapsPopAsTheGainsSay) {
    constexpr auto kSolver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL;
    constexpr double kRounding = 1e-6;  // of positions [m]
    for (const double share : {0.5, 1.0})
        for (const double gain : {0.0, 0.1, 0.5, 1.0})
            for (const uint32_t sweeps : {1u, 5u, 20u}) {
                const Pop pop = pop_of(with(kSolver, TAUT_STEPPING_PROJECTION, {share, gain}, hz(), sweeps));
                EXPECT_NEAR(pop.moved, share * kOverlap, kRounding);
                EXPECT_NEAR(pop.speed, share * kOverlap / h() * std::pow(1 - gain, sweeps), kRounding / h());
            }
}

// Figure 8.10: velocity time stepping leaves gamma overlap / h of velocity along a contact however often it iterates,
// Sequential Positions 0.9^n overlap / h: less from the seventh iteration on, for gamma = 1/2.
TEST_P(SteppingAt, SequentialPositionsLeaveLessThanVelocityTimeSteppingFromTheSeventhIteration) {
    constexpr auto kSolver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL;
    for (const uint32_t sweeps : {1u, 6u, 7u, 60u}) {
        const double sequential = pop_of(with(kSolver, TAUT_STEPPING_PROJECTION, kSequential, hz(), sweeps)).speed,
                     velocity = pop_of(with(kSolver, TAUT_STEPPING_VELOCITY, kVelocity, hz(), sweeps)).speed;
        EXPECT_NEAR(velocity, kVelocity.share * kOverlap / h(), 1e-6 / h());
        EXPECT_EQ(sequential < velocity, sweeps >= 7) << sweeps;
    }
}

// Contacts of velocity time stepping after links, and positions corrected after velocities, do not.
TEST_P(SteppingAt, MixedSteppingsTakeOverlapsBackWithoutAPop) {
    constexpr auto kSolver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL;
    for (const taut_stepping stepping :
         {TAUT_STEPPING_LINKS_FIRST, TAUT_STEPPING_VELOCITY_FIRST, TAUT_STEPPING_POST_STABILISED}) {
        const Pop pop = pop_of(with(kSolver, stepping, {1, 1}, hz()));
        EXPECT_NEAR(pop.moved, kOverlap, 1e-6) << stepping;
        EXPECT_NEAR(pop.speed, 0, 1e-6 / h()) << stepping;
    }
}

// A particle that goes round at s on a rod of L moves along the tangent by velocity time stepping and ends at
// sqrt(L^2 + (h s)^2); what projects rods ends on the circle.
TEST_P(SteppingAt, RodsKeepTheirLengthWhereTheyAreProjected) {
    constexpr double kLength = 1, kSpeed = 4;
    for (uint32_t stepping = 0; stepping <= TAUT_STEPPING_POST_STABILISED; ++stepping) {
        const World world([&](taut_world_def& def) {
            with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, static_cast<taut_stepping>(stepping), {1, 1}, hz())(def);
            def.gravity = {};
        });
        const taut_body body = world.particle(1, {kLength, 0, 0}, {0, kSpeed, 0});
        world.rod(kWorld, {}, body, {}, kLength);
        world.step();
        const double expected = stepping == TAUT_STEPPING_VELOCITY ? std::hypot(kLength, h() * kSpeed) : kLength;
        EXPECT_NEAR(norm(position(body)), expected, 1e-6) << stepping;
    }
}

struct Way {
    uint32_t solver, stepping;
};
std::vector<Way> all_ways() {
    std::vector<Way> ways;
    for (uint32_t solver = TAUT_SOLVER_ACCELERATED_JACOBI; solver <= TAUT_SOLVER_CONJUGATE_GRADIENTS; ++solver)
        for (uint32_t stepping = 0; stepping <= TAUT_STEPPING_POST_STABILISED; ++stepping)
            if (solver != TAUT_SOLVER_CONJUGATE_GRADIENTS || stepping != TAUT_STEPPING_POST_STABILISED)
                ways.push_back({solver, stepping});
    return ways;
}
class SteppingOf : public testing::TestWithParam<Way> {};
std::string name_of(const testing::TestParamInfo<Way>& way) {
    constexpr const char* kNames[] = {"projection", "velocity", "links_first", "velocity_first", "post_stabilised"};
    return std::string(taut_solver_name(static_cast<taut_solver>(way.param.solver))) + "_" + kNames[way.param.stepping];
}
INSTANTIATE_TEST_SUITE_P(Every, SteppingOf, testing::ValuesIn(all_ways()), name_of);

// A ball on the ground, and a chain of three particles from above it: what each bears is the weight below it.
TEST_P(SteppingOf, BearsTheWeightBelow) {
    constexpr int kLinks = 3;
    constexpr double kMass = 2;
    const World world([&](taut_world_def& def) {
        def.solver = static_cast<taut_solver>(GetParam().solver);
        def.stepping = static_cast<taut_stepping>(GetParam().stepping);
        def.substeps = def.fixed_substeps = 1;
        def.sweeps = 200;
    });
    world.add_ground();
    const taut_body ball = world.add({.shape = world.sphere(kRadius), .position = {0, kRadius, 0}, .mass = kMass});
    std::vector<taut_joint> rod;
    taut_body above = kWorld;
    for (int i = 0; i < kLinks; ++i) {
        const taut_body link = world.particle(kMass, {0, 4.0 - 1 - i, 0});
        rod.push_back(world.rod(above, i == 0 ? Vec(0, 4, 0) : Vec(), link, {}, 1));
        above = link;
    }
    world.step(120);
    for (int i = 0; i < kLinks; ++i) {
        taut_vec3 force{};
        ok(taut_joint_get_force(rod[static_cast<size_t>(i)], &force));
        EXPECT_NEAR(norm(force), (kLinks - i) * kMass * kG, 0.01 * kMass * kG) << "rod " << i;
    }
    const std::vector<taut_contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(static_cast<double>(contacts[0].normal_impulse) / world.substep(), kMass * kG, 0.01 * kMass * kG);
    EXPECT_LE(norm(velocity(ball)), 1e-3);
    EXPECT_NEAR(position(ball).y, kRadius, 0.005);
}

// A ball leaves the ground with its restitution times the speed at which it came, seen up to a frame later.
TEST_P(SteppingOf, BouncesBack) {
    constexpr double kRestitution = 0.6, kHeight = 1;
    const World world([&](taut_world_def& def) {
        def.solver = static_cast<taut_solver>(GetParam().solver);
        def.stepping = static_cast<taut_stepping>(GetParam().stepping);
    });
    world.add_ground(0.5, kRestitution);
    const taut_body ball =
        world.add({.shape = world.sphere(kRadius), .position = {0, kRadius + kHeight, 0}, .restitution = kRestitution});
    double up = 0;
    for (int frame = 0; frame < 45; ++frame) {
        world.step();
        up = std::max(up, velocity(ball).y);
    }
    const double expected = kRestitution * std::sqrt(2 * kG * kHeight);
    EXPECT_LE(up, 1.02 * expected);
    EXPECT_GE(up, 0.98 * expected - kG * std::max(world.frame(), static_cast<double>(world.def.time_step)));
}

constexpr double kMass = 2, kLength = 1, kAmplitude = 0.2, kOmega = 6;  // of a spring [kg, m, m, rad/s]

// Damping by rho = eta / kappa (eq. 6.50, 6.51), along a spring: v' = v - h omega^2 (x' + rho v'), x' = x + h v'.
TEST_P(SteppingAt, SpringsAreDampedAsTheirEquationsSay) {
    for (uint32_t solver = 0; solver <= TAUT_SOLVER_CONJUGATE_GRADIENTS; ++solver) {
        if (solver == TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL) continue;  // one sweep a substep
        double left[3];
        for (const int steps : {0, 1, 10}) {
            const double rho = steps * h(), compliance = 1 / (kMass * kOmega * kOmega);
            const World world([&](taut_world_def& def) {
                def.solver = static_cast<taut_solver>(solver);
                def.time_step = static_cast<float>(h());
                def.substeps = def.fixed_substeps = 1;
                def.sweeps = solver == TAUT_SOLVER_BLOCK_LDLT ? 0 : 50;
                def.gravity = {};
            });
            const taut_body body = world.particle(kMass, {kLength + kAmplitude, 0, 0});
            world.rod(kWorld, {}, body, {}, kLength, compliance, rho / compliance);
            double x = kAmplitude, v = 0, worst = 0;
            for (int i = 0; i < static_cast<int>(hz()); ++i) {
                world.step();
                v = (v - h() * kOmega * kOmega * x) / (1 + h() * (h() + rho) * kOmega * kOmega);
                x += h() * v;
                worst = std::max(worst, std::abs(position(body).x - kLength - x));
            }
            EXPECT_LE(worst, 1e-4 * kAmplitude) << taut_solver_name(static_cast<taut_solver>(solver)) << ", " << steps;
            left[steps > 1 ? 2 : steps] = x * x + v * v / (kOmega * kOmega);
        }
        EXPECT_GT(left[0], left[1]);
        EXPECT_GT(left[1], left[2]);
    }
}

// Balls that fall into a box of 0.8 m: mean |J v| over those that touch, and mean overlap, after two thirds of a
// second.
struct Contacts {
    double rate = 0, overlap = 0;
};
Contacts of_balls(taut_stepping stepping, const Gains& gains, double hz, uint32_t sweeps) {
    constexpr int kRow = 4, kLayers = 6;
    constexpr double kHalf = 0.45;
    const World world(with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, stepping, gains, hz, sweeps));
    world.add_ground();
    for (const double side : {-1.0, 1.0}) {
        world.add(
            {.kind = TAUT_BODY_STATIC, .shape = world.box({0.5, 2, 1}), .position = {side * (kHalf + 0.5), 2, 0}});
        world.add(
            {.kind = TAUT_BODY_STATIC, .shape = world.box({1, 2, 0.5}), .position = {0, 2, side * (kHalf + 0.5)}});
    }
    std::vector<taut_body> balls;
    for (int i = 0; i < kRow * kRow * kLayers; ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double aside = 0.01 * std::sin(17.0 * i), across = 0.01 * std::cos(29.0 * i);
        balls.push_back(
            world.add({.shape = world.sphere(kRadius),
                       .position = {0.22 * (column - 1.5) + aside, 0.15 + 0.23 * layer, 0.22 * (row - 1.5) + across}}));
    }
    world.step(static_cast<int>(hz) / 2);
    Contacts sum;
    size_t count = 0;
    for (int frame = 0; frame < static_cast<int>(hz); ++frame) {
        world.step();
        std::vector<BodyState> now;
        for (const taut_body ball : balls) now.push_back(state(ball));
        for (size_t i = 0; i < now.size(); ++i)
            for (size_t k = 0; k < i; ++k) {
                const Vec apart = now[i].position - now[k].position;
                const double gap = norm(apart) - 2 * kRadius;
                if (gap > 0.01 * kRadius) continue;
                sum.rate += std::abs(dot(unit(apart), now[i].velocity - now[k].velocity));
                sum.overlap += std::max(0.0, -gap);
                ++count;
            }
    }
    return {sum.rate / static_cast<double>(count), sum.overlap / static_cast<double>(count)};
}

// Figure 8.8, and section 8.3: VTS before projection softens impacts.
TEST_P(SteppingAt, VelocityFirstLeavesLessThanEitherAlone) {
    constexpr uint32_t kFew = 5;
    const Contacts velocity = of_balls(TAUT_STEPPING_VELOCITY, kVelocity, hz(), kFew),
                   positions = of_balls(TAUT_STEPPING_PROJECTION, kPositionBased, hz(), kFew),
                   sequential = of_balls(TAUT_STEPPING_PROJECTION, kSequential, hz(), kFew),
                   mixed = of_balls(TAUT_STEPPING_VELOCITY_FIRST, kPositionBased, hz(), kFew);
    std::printf("%g Hz: velocity %.3g m/s, %.3g m; positions %.3g, %.3g; sequential %.3g, %.3g; mixed %.3g, %.3g\n",
                hz(), velocity.rate, velocity.overlap, positions.rate, positions.overlap, sequential.rate,
                sequential.overlap, mixed.rate, mixed.overlap);
    EXPECT_LT(sequential.overlap, velocity.overlap);
    EXPECT_LT(mixed.rate, std::min(velocity.rate, positions.rate));
    EXPECT_LT(mixed.overlap, std::min(velocity.overlap, positions.overlap));
}

// A rope of rigid links with balls at its nodes falls across a bar and slides off: how far links are off their length,
// as parts of it, and the most energy over the start's of a kilogramme [J].
struct Links {
    double mean = 0, most = 0, energy = 0;
};
Links of_rope(taut_stepping stepping, const Gains& gains, double hz) {
    constexpr size_t kNodes = 12;
    constexpr double kLink = 0.25;
    const World world(with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, stepping, gains, hz, 40));
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.05, 0.05, 1}), .position = {0, -0.5, 0}});
    std::vector<taut_body> node;
    for (size_t i = 0; i < kNodes; ++i) {
        const double x = kLink * (static_cast<double>(i) - 4.5);
        node.push_back(world.add({.shape = world.sphere(0.08), .position = {x, 0, 0}, .mass = 0.1}));
        if (i > 0) world.rod(node[i - 1], {}, node[i], {}, kLink);
    }
    const int frames = 3 * static_cast<int>(hz) / 2;
    Links links;
    for (int frame = 0; frame < frames; ++frame) {
        world.step();
        for (size_t k = 1; k < kNodes; ++k) {
            const double error = std::abs(norm(position(node[k]) - position(node[k - 1])) / kLink - 1);
            links.mean += error / static_cast<double>(kNodes - 1) / frames;
            links.most = std::max(links.most, error);
        }
        const Totals now = totals(node);
        links.energy = std::max(links.energy, (now.kinetic + kG * now.height) / now.mass);
    }
    return links;
}

// Figure 8.14: links that are projected before contacts are solved keep their length better than by velocity time
// stepping on the whole, though not at each impact, which the next step mends; projected after velocities, always.
TEST_P(SteppingAt, ProjectedLinksKeepTheirLengthAtImpacts) {
    const Links velocity = of_rope(TAUT_STEPPING_VELOCITY, kVelocity, hz()),
                positions = of_rope(TAUT_STEPPING_PROJECTION, kPositionBased, hz()),
                first = of_rope(TAUT_STEPPING_LINKS_FIRST, {1, 1}, hz()),
                mixed = of_rope(TAUT_STEPPING_VELOCITY_FIRST, kPositionBased, hz()),
                stabilised = of_rope(TAUT_STEPPING_POST_STABILISED, {1, 1}, hz());
    for (const auto& [name, links] : {std::pair("velocity", velocity),
                                      {"positions", positions},
                                      {"links first", first},
                                      {"velocity first", mixed},
                                      {"post-stabilised", stabilised}}) {
        std::printf("%g Hz, %s: %.2g of a link on average, %.2g at most\n", hz(), name, links.mean, links.most);
        EXPECT_LE(links.energy, 1e-3) << name;
    }
    EXPECT_LT(first.mean, 0.6 * velocity.mean);
    EXPECT_LT(mixed.most, positions.most);
    EXPECT_LT(stabilised.most, positions.most);
    EXPECT_LT(positions.most, velocity.most);
}

// The state after half a second, on one thread and on three.
TEST(Stepping, HasTheSameBitsOnAnyTeam) {
    for (uint32_t stepping = 0; stepping <= TAUT_STEPPING_POST_STABILISED; ++stepping) {
        uint64_t hash[2];
        for (const uint32_t more : {0u, 1u}) {
            const World world([&](taut_world_def& def) {
                def.solver = TAUT_SOLVER_ACCELERATED_JACOBI;
                def.stepping = static_cast<taut_stepping>(stepping);
                def.threads = 1 + 2 * more;
            });
            world.add_ground();
            taut_body above = kWorld;
            for (int i = 0; i < 40; ++i) {
                const taut_body ball =
                    world.add({.shape = world.sphere(kRadius), .position = {0.21 * (i % 8), 0.3 + 0.02 * i, 0.2 * i}});
                if (i % 8 > 0) world.rod(above, {}, ball, {}, 0.3);
                above = ball;
            }
            world.step(30);
            ok(taut_world_get_state_hash(world.handle, &hash[more]));
        }
        EXPECT_EQ(hash[0], hash[1]) << stepping;
    }
}

}  // namespace
