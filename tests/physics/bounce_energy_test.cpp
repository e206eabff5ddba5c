// No impact gives energy, whatever hits what, and however: bodies of many shapes, thrown and spinning, alone, in heaps
// and in joints, with restitution 1.
#include <random>

#include "physics/bounce_lab.h"

namespace {

using namespace lab;

struct Throw {
    taut_solver solver;
    int hz;
    uint32_t substeps;
    double friction;
};
void PrintTo(const Throw& plan, std::ostream* out) {
    *out << "solver " << plan.solver << ", " << plan.hz << " Hz, " << plan.substeps << " substeps, friction "
         << plan.friction;
}

class NothingGainsEnergy : public testing::TestWithParam<Throw> {
protected:
    auto def() const {
        return [plan = GetParam()](taut_world_def& def) {
            def.solver = plan.solver;
            def.time_step = 1.0f / static_cast<float>(plan.hz);
            def.substeps = plan.substeps;
            def.fixed_substeps = 1;
        };
    }
    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec vec(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }

    // A cube, a plate, a beam, a rod, a disc, a capsule, a cone, a ball.
    taut_shape shape(const World& world, int kind) const {
        switch (kind % 8) {
            case 0: return world.box({0.2, 0.2, 0.2});
            case 1: return world.box({0.4, 0.05, 0.3});
            case 2: return world.box({0.5, 0.1, 0.1});
            case 3: return world.cylinder(0.06, 0.5);
            case 4: return world.cylinder(0.3, 0.06);
            case 5: return world.capsule(0.1, 0.3);
            case 6: return world.cone(0.2, 0.25);
            default: return world.sphere(0.2);
        }
    }
    taut_body add(const World& world, int kind, const Vec& at, double speed, double spin) {
        return world.add({.shape = shape(world, kind),
                          .position = at,
                          .rotation = Quat::turn(vec(1), real(0, 6)),
                          .velocity = vec(speed),
                          .spin = vec(spin),
                          .mass = real(0.5, 3),
                          .friction = GetParam().friction,
                          .restitution = 1});
    }

    std::mt19937 engine_{20};
};

TEST_P(NothingGainsEnergy, Alone) {
    double least = 1e9;
    for (int shot = 0; shot < 48; ++shot) {
        World world(def());
        world.add_ground(GetParam().friction, 1);
        const std::vector<taut_body> body = {add(world, shot, {0, real(0.7, 1.5), 0}, 4, 12)};
        const double before = energy(world, body);
        double most = before, last = 0;
        for (int i = 0; i < 3 * GetParam().hz; ++i) {
            world.step();
            most = std::max(most, last = energy(world, body));
        }
        EXPECT_LT(most / before, 1.01) << "shape " << shot % 8 << ", shot " << shot;
        least = std::min(least, last / before);
    }
    RecordProperty("least", std::to_string(least));
}

TEST_P(NothingGainsEnergy, InAHeap) {
    World world(def());
    world.add_ground(GetParam().friction, 1);
    std::vector<taut_body> bodies;
    for (int k = 0; k < 24; ++k)
        bodies.push_back(add(world, k, {1.2 * (k % 3), 0.8 + 1.2 * (k / 6), 1.2 * (k / 3 % 2)}, 2, 4));
    const double before = energy(world, bodies);
    double most = before;
    for (int i = 0; i < 3 * GetParam().hz; ++i) {
        world.step();
        most = std::max(most, energy(world, bodies));
    }
    EXPECT_LT(most / before, 1.01);
}

// Chains of three, thrown at the ground.
TEST_P(NothingGainsEnergy, InJoints) {
    for (int shot = 0; shot < 8; ++shot) {
        World world(def());
        world.add_ground(GetParam().friction, 1);
        std::vector<taut_body> chain;
        const Vec velocity = vec(4);
        for (int k = 0; k < 3; ++k) {
            const Vec at{0.5 * k, 1.2 + 0.1 * shot, 0};
            chain.push_back(world.add({.shape = shot % 2 ? world.box({0.2, 0.08, 0.08}) : world.sphere(0.15),
                                       .position = at,
                                       .velocity = velocity,
                                       .mass = 1,
                                       .friction = GetParam().friction,
                                       .restitution = 1,
                                       .group = -1}));
            if (k > 0) world.ball(chain[static_cast<size_t>(k) - 1], {0.25, 0, 0}, chain.back(), {-0.25, 0, 0});
        }
        const double before = energy(world, chain);
        double most = before;
        for (int i = 0; i < 3 * GetParam().hz; ++i) {
            world.step();
            most = std::max(most, energy(world, chain));
        }
        EXPECT_LT(most / before, 1.02) << "shot " << shot;
    }
}

INSTANTIATE_TEST_SUITE_P(Plans, NothingGainsEnergy,
                         testing::Values(Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 60, 4, 0.6},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 30, 1, 0.3},
                                         Throw{TAUT_SOLVER_BLOCK_LDLT, 240, 1, 0},
                                         Throw{TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, 60, 8, 0.3},
                                         Throw{TAUT_SOLVER_ACCELERATED_JACOBI, 60, 4, 0.3}));

}  // namespace
