// Static friction, and friction by direction: against Coulomb's law on slopes, the stick-slip of a block on a belt, and
// the ellipse of forces, integrated finely.
#include <array>

#include "physics/lab.h"

namespace {

using namespace lab;

// How contacts are solved: in lanes, beside joints that are solved directly or swept, as rows, all at once or by
// gradients, or as part of a block that a joint makes.
enum class Way { lanes, swept, jacobi, gradients, block };

void PrintTo(Way way, std::ostream* out) {
    constexpr const char* kNames[] = {"lanes", "swept", "jacobi", "gradients", "block"};
    *out << kNames[static_cast<int>(way)];
}

struct Setting {
    Way way;
    double hz;
    uint32_t substeps;
};

void PrintTo(const Setting& s, std::ostream* out) {
    PrintTo(s.way, out);
    *out << "_" << s.hz << "_hz_" << s.substeps << "_substeps";
}

std::vector<Setting> settings(std::initializer_list<Way> ways) {
    std::vector<Setting> out;
    for (const Way way : ways)
        for (const auto& [hz, substeps] : std::initializer_list<std::pair<double, uint32_t>>{
                 {30, 4}, {60, 1}, {60, 2}, {60, 4}, {60, 8}, {120, 4}, {240, 1}, {240, 4}})
            out.push_back({way, hz, substeps});
    return out;
}

constexpr double kKinetic = 0.4, kStatic = 0.6;

class FrictionLaw : public testing::TestWithParam<Setting> {
protected:
    FrictionLaw()
        : world([](taut_world_def& def) {
              def.time_step = static_cast<float>(1 / GetParam().hz);
              def.substeps = GetParam().substeps;
              if (GetParam().way == Way::swept) def.solver = TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL;
              if (GetParam().way == Way::jacobi) def.solver = TAUT_SOLVER_ACCELERATED_JACOBI;
              if (GetParam().way == Way::gradients) def.solver = TAUT_SOLVER_CONJUGATE_GRADIENTS;
          }) {}

    static taut_collider collider_of(taut_body body) {
        taut_collider out{};
        uint32_t count = 0;
        ok(taut_body_get_colliders(body, &out, 1, &count));
        return out;
    }
    static void set_friction(taut_body body, double sticking, double factor = 0, const Vec& direction = {}) {
        taut_friction friction;
        taut_friction_init(&friction);
        friction.static_friction = static_cast<float>(sticking);
        friction.slide_factor = static_cast<float>(factor);
        friction.slide_direction = direction.narrow();
        ok(taut_collider_set_friction(collider_of(body), &friction));
    }
    // A flat block on the plane through the origin; for a block of the solver with a light rider fixed to it.
    taut_body add_block(const Vec& normal, const Quat& turn, const Vec& velocity, double friction) const {
        BodyPlan plan{.shape = world.box(kHalf),
                      .position = kHalf.y * normal,
                      .rotation = turn,
                      .velocity = velocity,
                      .mass = kMass,
                      .friction = friction,
                      .group = -1};
        const taut_body body = world.add(plan);
        if (GetParam().way != Way::block) return body;
        plan.shape = world.sphere(0.01);
        plan.mass = kMass / 500;
        const taut_body rider = world.add(plan);
        taut_fixed_joint_def d;
        taut_fixed_joint_def_init(&d);
        d.base.body_a = body;
        d.base.body_b = rider;
        d.base.solve = TAUT_JOINT_SOLVE_DIRECT;
        taut_joint out{};
        ok(taut_world_add_fixed_joint(world.handle, &d, &out));
        return body;
    }
    // A slope down along x on which the block lies.
    taut_body on_slope(double tangent, double speed) const {
        const double angle = std::atan(tangent);
        const Vec normal(std::sin(angle), std::cos(angle), 0);
        const taut_body ground =
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(normal), .friction = kKinetic});
        const Vec down(std::cos(angle), -std::sin(angle), 0);
        const taut_body block = add_block(normal, Quat::turn({0, 0, 1}, -angle), speed * down, kKinetic);
        set_friction(ground, kStatic);
        set_friction(block, kStatic);
        return block;
    }
    void run(double seconds) const { world.step(static_cast<int>(std::lround(seconds / world.frame()))); }

    inline static const Vec kHalf{0.5, 0.05, 0.5};
    static constexpr double kMass = 10;
    World world;
};

// What a direct solve takes in has the material's friction, and so have rows.
class StaticFriction : public FrictionLaw {};
class DirectedFriction : public FrictionLaw {};
INSTANTIATE_TEST_SUITE_P(At, StaticFriction, testing::ValuesIn(settings({Way::lanes, Way::swept})));
INSTANTIATE_TEST_SUITE_P(At, DirectedFriction,
                         testing::ValuesIn(settings({Way::lanes, Way::swept, Way::jacobi, Way::gradients,
                                                     Way::block})));

TEST_P(StaticFriction, HoldsUpToTheStaticCoefficient) {
    const taut_body block = on_slope(0.97 * kStatic, 0);
    const Vec start = position(block);
    run(3);
    EXPECT_LT(norm(position(block) - start), 2e-3);
}

TEST_P(StaticFriction, GivesWayAboveItAndSlidesByTheKineticOne) {
    const double angle = std::atan(1.03 * kStatic);
    const taut_body block = on_slope(std::tan(angle), 0);
    run(1);
    const double early = norm(velocity(block));
    run(1);
    const double exact = kG * (std::sin(angle) - kKinetic * std::cos(angle));
    EXPECT_NEAR((norm(velocity(block)) - early) / exact, 1, 0.01);
    EXPECT_GT(early, 0.6 * exact) << "it began to slide at once";
}

// Between the two angles what is pushed slides on, ever faster, and what lies stays.
TEST_P(StaticFriction, PushedItSlidesWhereItWouldLie) {
    const double tangent = 0.5 * (kKinetic + kStatic), angle = std::atan(tangent);
    const taut_body block = on_slope(tangent, 0.5);
    run(2);
    const double exact = 0.5 + 2 * kG * (std::sin(angle) - kKinetic * std::cos(angle));
    EXPECT_NEAR(norm(velocity(block)) / exact, 1, 0.02);
}

// Slip that turns round goes through rest, where static friction takes over.
TEST_P(StaticFriction, PushedUphillItStaysWhereItStops) {
    const double tangent = 0.5 * (kKinetic + kStatic), angle = std::atan(tangent);
    const taut_body block = on_slope(tangent, -1.3);
    const Vec start = position(block);
    run(3);
    const double deceleration = kG * (std::sin(angle) + kKinetic * std::cos(angle)),
                 exact = 1.3 * 1.3 / (2 * deceleration);
    // Each substep h goes by the velocity at its end, which takes the part a h / v from the way.
    EXPECT_NEAR(norm(position(block) - start) / exact, 1 - deceleration * world.substep() / 1.3, 0.01);
    EXPECT_LT(norm(velocity(block)), 1e-3);
}

// A block on a belt of speed V, held by a spring k: it sticks up to k x = mu_s m g, and then swings about
// mu_k m g / k until it has the belt's speed again. With w^2 = k / m, d = (mu_s - mu_k) g / w^2 and a = atan(d w / V)
//   the amplitude about that is sqrt(d^2 + (V / w)^2), the period 2 d / V + (2 pi - 2 a) / w.
TEST_P(StaticFriction, SticksAndSlipsOnABeltAsTheoryHasIt) {
    constexpr double kSpeed = 0.25, kRate = 5;  // [m/s], [rad/s]
    const taut_body ground = world.add_ground(kKinetic), block = add_block({0, 1, 0}, {}, {}, kKinetic);
    set_friction(ground, kStatic);
    set_friction(block, kStatic);
    ok(taut_collider_set_surface_velocity(collider_of(ground), Vec(kSpeed, 0, 0).narrow(), {}));
    const double w = kRate, d = (kStatic - kKinetic) * kG / (w * w), amplitude = std::hypot(d, kSpeed / w);
    const double period = 2 * d / kSpeed + (2 * kPi - 2 * std::atan2(d, kSpeed / w)) / w;
    const double middle = kKinetic * kG / (w * w), dt = world.frame();
    double most = -1e9, least = 1e9, last = 0, before = 0;
    std::vector<double> crossings;  // of the middle, downwards
    for (double time = 0; time < 8 * period; time += dt) {
        const double x = position(block).x, v = velocity(block).x;
        // The spring's force at the middle of the step, so that the host's step does not drive the swing.
        ok(taut_body_apply_force(block, Vec(-kMass * w * w * (x + 0.5 * dt * v), 0, 0).narrow(), {}));
        world.step();
        last = position(block).x;
        if (time > 3 * period) {
            most = std::max(most, last), least = std::min(least, last);
            if (before > middle && last <= middle) crossings.push_back(time);
        }
        before = last;
    }
    const double late = 0.02 + 1.1 * std::sqrt(world.substep());  // it begins to slip later, by the root of a substep
    EXPECT_NEAR((most - middle) / amplitude, 1, late);
    EXPECT_NEAR((middle - least) / amplitude, 1, late);
    ASSERT_GE(crossings.size(), 3u);
    const double measured = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    EXPECT_NEAR(measured / period, 1, late);
}

// Four legs, each a pair of its own, share the load as they like: together they hold as one.
TEST_P(StaticFriction, FourLegsHoldUpToTheStaticCoefficient) {
    const taut_body block = on_slope(0.95 * kStatic, 0);
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = world.sphere(0.05);
    def.density = 0;
    def.material.friction = static_cast<float>(kKinetic);
    def.filter.group = -1;
    def.friction.static_friction = static_cast<float>(kStatic);
    ok(taut_collider_set_shape(collider_of(block), def.shape, Vec(0.45, 0, 0.4).narrow(), {0, 0, 0, 1}));
    for (const Vec& at : {Vec(-0.45, 0, 0.4), Vec(0.45, 0, -0.4), Vec(-0.4, 0, -0.45)}) {
        taut_collider leg{};
        def.position = at.narrow();
        ok(taut_body_add_collider(block, &def, &leg));
    }
    const Vec start = position(block);
    run(3);
    EXPECT_LT(norm(position(block) - start), 5e-3);
}

TEST_P(StaticFriction, GoesOnAlikeAfterARestoration) {
    const taut_body ground = world.add_ground(kKinetic), block = add_block({0, 1, 0}, {}, {0.3, 0, 0.1}, kKinetic);
    set_friction(ground, kStatic);
    set_friction(block, kStatic, 0.5, {1, 0, 1});
    ok(taut_collider_set_surface_velocity(collider_of(ground), Vec(0.05, 0, 0).narrow(), {}));
    uint64_t size = 0, hash[2] = {};
    std::vector<std::byte> then;
    for (const int round : {0, 1}) {
        if (round == 1) ok(taut_world_restore(world.handle, then.data(), size));
        for (int i = 0; i < 40; ++i) {
            if (round == 0 && i == 7) {
                ok(taut_world_snapshot_size(world.handle, &size));
                then.resize(size);
                ok(taut_world_save(world.handle, then.data(), size, &size));
            }
            if (round == 1 && i < 7) continue;
            ok(taut_body_apply_force(block, Vec(i % 5 == 0 ? -40 * kMass : 0, 0, 0).narrow(), {}));
            world.step();
        }
        ok(taut_world_get_state_hash(world.handle, &hash[round]));
    }
    EXPECT_EQ(hash[0], hash[1]);
}

// v' = -g D D v / |D v|, D = mu diag(m, 1) along the direction and across it, by small steps; where it comes to rest.
std::array<double, 2> slid(double friction, double factor, std::array<double, 2> v, double seconds) {
    constexpr double kStep = 2e-5;
    const double mu[2] = {factor * friction, friction};
    std::array<double, 2> at{};
    for (double time = 0; time < seconds; time += kStep) {
        const double size = std::hypot(mu[0] * v[0], mu[1] * v[1]);
        if (size < 1e-5 * friction) break;
        for (int i = 0; i < 2; ++i)
            v[static_cast<size_t>(i)] -= kStep * kG * mu[i] * mu[i] * v[static_cast<size_t>(i)] / size;
        for (size_t i = 0; i < 2; ++i) at[i] += kStep * v[i];
    }
    return at;
}

TEST_P(DirectedFriction, SlidesByTheEllipse) {
    constexpr double kSeconds = 0.5;
    for (const double factor : {0.3, 0.05})
        for (int turn = 0; turn < 5; ++turn) {
            const double yaw = 0.9 * turn, way = 0.4 + 0.7 * turn;  // of the direction, and of the velocity against it
            const Vec along(std::cos(yaw), 0, -std::sin(yaw)), across(-std::sin(yaw), 0, -std::cos(yaw));
            const taut_body ground = world.add_ground(kKinetic);
            // The direction is the block's, which is turned.
            const taut_body block = add_block({0, 1, 0}, Quat::turn({0, 1, 0}, yaw),
                                              2 * std::cos(way) * along + 2 * std::sin(way) * across, kKinetic);
            set_friction(block, 0, factor, {2, 0, 0});
            const Vec start = position(block);
            run(kSeconds);
            const auto exact = slid(kKinetic, factor, {2 * std::cos(way), 2 * std::sin(way)}, kSeconds);
            const Vec moved = position(block) - start;
            const double far = std::hypot(exact[0], exact[1]);
            EXPECT_NEAR(dot(moved, along), exact[0], 0.03 * far) << "factor " << factor << ", turn " << turn;
            EXPECT_NEAR(dot(moved, across), exact[1], 0.03 * far) << "factor " << factor << ", turn " << turn;
            ok(taut_body_remove(ground));
            ok(taut_body_set_enabled(block, 0));
        }
}

// On rollers: free along, held across.
TEST_P(DirectedFriction, AFactorOfZeroSlidesFreely) {
    const taut_body ground = world.add_ground(kStatic), block = add_block({0, 1, 0}, {}, {1, 0, 0.5}, kStatic);
    set_friction(ground, 0, 0, {1, 0, 0});
    run(2);
    EXPECT_NEAR(velocity(block).x, 1, 1e-3);
    EXPECT_NEAR(velocity(block).z, 0,
                GetParam().way == Way::gradients ? 0.05 : 1e-3);  // these end before they are there
}

}  // namespace
