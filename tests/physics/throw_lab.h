// Bodies of many shapes thrown at the ground, spinning, with restitution 1: alone, in heaps, in chains of joints.
#pragma once

#include <random>

#include "physics/bounce_lab.h"

namespace lab {

struct Throw {
    taut_solver solver;
    int hz;
    uint32_t substeps;
    double friction;
};
inline void PrintTo(const Throw& plan, std::ostream* out) {
    *out << "solver " << plan.solver << ", " << plan.hz << " Hz, " << plan.substeps << " substeps, friction "
         << plan.friction;
}

class Thrower {
public:
    Thrower(const Throw& plan, uint32_t seed) : plan_(plan), engine_(seed) {}

    static constexpr int kShapes = 8;

    // Most energy of three seconds, in parts of that at the start.
    double throw_one(int kind) {
        World world(def());
        world.add_ground(plan_.friction, 1);
        return gain(world, {add(world, kind, {0, real(0.7, 1.5), 0}, 4, 12)});
    }
    double throw_heap(int count) {
        World world(def());
        world.add_ground(plan_.friction, 1);
        std::vector<taut_body> bodies;
        for (int k = 0; k < count; ++k)
            bodies.push_back(add(world, k, {1.2 * (k % 3), 0.8 + 1.2 * (k / 6), 1.2 * (k / 3 % 2)}, 2, 4));
        return gain(world, bodies);
    }
    double throw_chain(bool of_boxes) {
        World world(def());
        world.add_ground(plan_.friction, 1);
        const taut_shape shape = of_boxes ? world.box({0.2, 0.08, 0.08}) : world.sphere(0.15);
        const Vec velocity = vec(4);
        const double height = real(1, 2);
        std::vector<taut_body> chain;
        for (int k = 0; k < 3; ++k) {
            chain.push_back(world.add({.shape = shape,
                                       .position = {0.5 * k, height, 0},
                                       .velocity = velocity,
                                       .mass = 1,
                                       .friction = plan_.friction,
                                       .restitution = 1,
                                       .group = -1}));
            if (k > 0) world.ball(chain[static_cast<size_t>(k) - 1], {0.25, 0, 0}, chain.back(), {-0.25, 0, 0});
        }
        return gain(world, chain);
    }

private:
    std::function<void(taut_world_def&)> def() const {
        return [plan = plan_](taut_world_def& def) {
            def.solver = plan.solver;
            def.time_step = 1.0f / static_cast<float>(plan.hz);
            def.substeps = plan.substeps;
            def.fixed_substeps = 1;
        };
    }
    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec vec(double size) {
        const double x = real(-size, size), y = real(-size, size);
        return {x, y, real(-size, size)};
    }

    static taut_shape shape(const World& world, int kind) {
        if (kind == 0) return world.box({0.2, 0.2, 0.2});
        if (kind == 1) return world.box({0.4, 0.05, 0.3});
        if (kind == 2) return world.box({0.5, 0.1, 0.1});
        if (kind == 3) return world.cylinder(0.06, 0.5);
        if (kind == 4) return world.cylinder(0.3, 0.06);
        if (kind == 5) return world.capsule(0.1, 0.3);
        if (kind == 6) return world.cone(0.2, 0.25);
        return world.sphere(0.2);
    }
    taut_body add(const World& world, int kind, const Vec& at, double speed, double spin) {
        const Vec axis = vec(1), velocity = vec(speed), turning = vec(spin);
        const double angle = real(0, 6), mass = real(0.5, 3);
        return world.add({.shape = shape(world, kind % kShapes),
                          .position = at,
                          .rotation = Quat::turn(axis, angle),
                          .velocity = velocity,
                          .spin = turning,
                          .mass = mass,
                          .friction = plan_.friction,
                          .restitution = 1});
    }
    double gain(const World& world, const std::vector<taut_body>& bodies) const {
        const double before = energy(world, bodies);
        double most = before;
        for (int i = 0; i < 3 * plan_.hz; ++i) {
            world.step();
            most = std::max(most, energy(world, bodies));
        }
        return most / before;
    }

    Throw plan_;
    std::mt19937 engine_;
};

}  // namespace lab
