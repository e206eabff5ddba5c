// Random mechanisms that nothing holds to the world, hit by random bodies: what is left of momentum and energy.
#pragma once

#include <algorithm>
#include <random>

#include "physics/joint_lab.h"

namespace lab {

inline double draw(std::mt19937& random, double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random()) / 4294967296.0);
}
inline bool one_in(std::mt19937& random, uint32_t n) { return random() % n == 0; }
inline Vec direction(std::mt19937& random) {
    for (;;) {
        const Vec v(draw(random, -1, 1), draw(random, -1, 1), draw(random, -1, 1));
        if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
    }
}

constexpr uint32_t kJointKinds = 9;  // in the order of taut_joint_kind

template <class Def>
taut_joint framed(const World& world, void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*),
                  taut_body a, taut_body b, const Vec& pivot, const Vec& axis) {
    const Def def = at(world, init, a, b, pivot, axis);
    taut_joint out{};
    ok(add(world.handle, &def, &out));
    return out;
}

// A joint of a kind at a place between two bodies.
inline taut_joint join(const World& w, uint32_t kind, taut_body a, taut_body b, const Vec& pivot, const Vec& axis) {
    const BodyState sa = state(a), sb = state(b);
    const auto inside = [&](const BodyState& s) { return s.rotation.rotate_back(pivot - s.position); };
#define TAUT_TEST_FRAMED(name) framed(w, taut_##name##_joint_def_init, taut_world_add_##name##_joint, a, b, pivot, axis)
    if (kind == TAUT_JOINT_BALL) return w.ball(a, inside(sa), b, inside(sb));
    if (kind == TAUT_JOINT_DISTANCE) return w.rod(a, {}, b, {}, norm(sb.position - sa.position));
    if (kind == TAUT_JOINT_FIXED) return TAUT_TEST_FRAMED(fixed);
    if (kind == TAUT_JOINT_HINGE) return TAUT_TEST_FRAMED(hinge);
    if (kind == TAUT_JOINT_SLIDER) return TAUT_TEST_FRAMED(slider);
    if (kind == TAUT_JOINT_UNIVERSAL) return TAUT_TEST_FRAMED(universal);
    if (kind == TAUT_JOINT_CYLINDRICAL) return TAUT_TEST_FRAMED(cylindrical);
    if (kind == TAUT_JOINT_CONE_TWIST) return TAUT_TEST_FRAMED(cone_twist);
    return TAUT_TEST_FRAMED(six_dof);
#undef TAUT_TEST_FRAMED
}

struct MechanismPlan {
    uint32_t seed = 1;
    uint32_t kind = TAUT_JOINT_BALL;  // of its joints; kJointKinds: any
    double restitution = 0, friction = 0;
    uint32_t substeps = 4;
    double rate = 60;  // [Hz]
    taut_solver solver = TAUT_SOLVER_BLOCK_LDLT;
};

// Two to nine bodies in a row, each next to the last, which one or two others hit.
class Mechanism {
public:
    explicit Mechanism(const MechanismPlan& plan)
        : world([&](taut_world_def& def) {
              def.gravity = {0, 0, 0};
              def.substeps = plan.substeps;
              def.time_step = static_cast<float>(1 / plan.rate);
              def.solver = plan.solver;
          }),
          plan_(plan),
          random_(plan.seed) {
        const uint32_t count = 2 + random_() % 8;
        const bool tight = one_in(random_, 2);  // bodies touch, and collide
        Vec at;
        for (uint32_t i = 0; i < count; ++i) {
            bodies.push_back(body(at, {}));
            const Vec along = unit(Vec(1, 0, 0) + 0.3 * direction(random_));
            if (i > 0) tie(bodies[i - 1], bodies[i], along);
            at += (tight ? 2 * kSize + 1e-3 : 2.6 * kSize) * along;
        }
        for (uint32_t hits = 1 + random_() % 2; hits-- > 0;) {
            const Vec aim = position(bodies[random_() % count]), from = direction(random_);
            Vec start = aim + 3 * kSize * from;
            for (bool clear = false; !clear; start += 0.5 * kSize * from)
                clear = std::all_of(bodies.begin(), bodies.end(), [&](taut_body b) {
                    return norm(position(b) - start - 0.5 * kSize * from) > 4 * kSize;
                });
            const Vec velocity = draw(random_, 1, 10) * unit(-from + 0.2 * direction(random_));
            bodies.push_back(body(start, velocity));
        }
    }

    World world;
    std::vector<taut_body> bodies;

private:
    static constexpr double kSize = 0.1;  // [m]

    taut_body body(const Vec& at, const Vec& velocity) {
        const uint32_t shape = random_() % 3;
        return world.add({.shape = shape == 0   ? world.sphere(kSize)
                                   : shape == 1 ? world.box({0.6 * kSize, 0.5 * kSize, 0.6 * kSize})
                                                : world.capsule(0.5 * kSize, 0.5 * kSize),
                          .position = at,
                          .rotation = Quat::turn(direction(random_), draw(random_, 0, 3)),
                          .velocity = velocity,
                          .mass = draw(random_, 1, 8),
                          .friction = plan_.friction,
                          .restitution = plan_.restitution});
    }
    void tie(taut_body a, taut_body b, const Vec&) {
        const uint32_t kind = plan_.kind < kJointKinds ? plan_.kind : random_() % kJointKinds;
        const Vec pivot = 0.5 * (position(a) + position(b));
        const taut_joint joint = join(world, kind, a, b, pivot, direction(random_));
        if (kind != TAUT_JOINT_SIX_DOF) return;
        const taut_axis_def loose = free_axis();
        for (uint32_t axis : {0u, 3u, 5u})
            if (one_in(random_, 2)) ok(taut_joint_set_axis(joint, axis, &loose));
    }

    MechanismPlan plan_;
    std::mt19937 random_;
};

// Momentum, angular momentum about the origin and energy of all bodies, and how large their parts are.
struct Balance {
    Vec momentum, turning;
    double energy = 0, momentum_scale = 0, size = 0;  // size: how far from the origin they are [m]

    explicit Balance(const std::vector<taut_body>& bodies) {
        for (const taut_body body : bodies) {
            const BodyState s = state(body);
            const Mass m = mass_of(body);
            const Vec p = m.mass * s.velocity, spin = spin_momentum(s, m.inertia);
            momentum += p;
            turning += cross(s.position, p) + spin;
            energy += 0.5 * dot(p, s.velocity) + 0.5 * dot(spin, s.spin);
            momentum_scale += norm(p);
            size = std::max(size, norm(s.position));
        }
    }
};

// The worst of a while, in parts of what there was at the start.
struct Losses {
    double momentum = 0, turning = 0, energy = -1;  // of energy what was gained
};

inline Losses losses_of(const MechanismPlan& plan, double time = 0.5) {
    const Mechanism mechanism(plan);
    const Balance start(mechanism.bodies);
    const double turning = start.momentum_scale * start.size;
    Losses worst;
    for (int frame = 0; frame < static_cast<int>(time * plan.rate); ++frame) {
        mechanism.world.step();
        const Balance now(mechanism.bodies);
        worst.momentum = std::max(worst.momentum, norm(now.momentum - start.momentum) / start.momentum_scale);
        worst.turning = std::max(worst.turning, norm(now.turning - start.turning) / turning);
        worst.energy = std::max(worst.energy, now.energy / start.energy - 1);
    }
    return worst;
}

}  // namespace lab
