// Random mechanisms of swept joints of every type, at rest or thrown.
#pragma once

#include <algorithm>
#include <random>

#include "physics/joint_lab.h"

namespace lab {

enum class JointKind { ball, distance, fixed, hinge, slider, cylindrical, universal, cone_twist, six_dof };
constexpr int kJointKinds = 9;

struct SweptPlan {
    uint64_t seed = 1;
    int kind = -1;          // JointKind; -1: each joint another
    int loops = 0;          // joints beyond a tree's
    bool chain = false;     // else a tree
    bool held = true;       // by the world
    double ratio = 1;       // of masses, at most
    double speed = 0;       // thrown at that, and turned by that a metre [m/s]
    uint32_t substeps = 4;  // of a frame
    double rate = 60;       // frames a second
    uint32_t sweeps = 0;    // 0: the solver's own
    taut_solver solver = TAUT_SOLVER_BLOCK_LDLT;
    int bodies = 12;
};

class SweptMechanism {
public:
    static constexpr double kLink = 0.4;  // [m]

    explicit SweptMechanism(const SweptPlan& plan)
        : world([&](taut_world_def& def) {
              def.substeps = plan.substeps;
              def.sweeps = plan.sweeps;
              def.solver = plan.solver;
              def.time_step = static_cast<float>(1 / plan.rate);
          }),
          plan_(plan),
          random_(plan.seed) {
        const Vec velocity = plan.speed * direction(), spin = plan.speed * direction();
        for (int i = 0; i < plan.bodies; ++i) add(i, velocity, spin);
        for (int i = 0; i < plan.loops; ++i) {
            const size_t a = pick(bodies.size()), b = pick(bodies.size());
            if (a != b) join(bodies[a], bodies[b], 0.5 * (place_[a] + place_[b]), place_[b] - place_[a]);
        }
        start_ = energy();
        scale_ = totals(bodies).kinetic + totals(bodies).mass * kG * kLink;
    }

    void step(int frames) {
        for (int i = 0; i < frames; ++i) {
            world.step();
            gain = std::max(gain, (energy() - start_) / scale_);
        }
    }
    double fastest() const {  // [m/s]
        double most = 0;
        for (const taut_body body : bodies) most = std::max(most, norm(velocity(body)));
        return most;
    }
    double gap() const {  // [m]
        double most = 0;
        for (const taut_joint joint : joints) most = std::max(most, error(joint));
        return most;
    }

    World world;
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;
    double gain = 0;  // of mechanical energy above that of the start, of what moves and of a link's height

private:
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    size_t pick(size_t count) { return std::min(count - 1, static_cast<size_t>(uniform() * static_cast<double>(count))); }
    Vec direction() {
        for (;;) {
            const Vec v(2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1);
            if (dot(v, v) < 1 && dot(v, v) > 0.01) return unit(v);
        }
    }
    double energy() const {
        const Totals t = totals(bodies);
        return t.kinetic + kG * t.height;
    }

    // Those at rest hang straight down, in balance whatever joins them.
    void add(int i, const Vec& velocity, const Vec& spin) {
        const size_t parent = i == 0 ? 0 : plan_.chain ? place_.size() - 1 : pick(place_.size());
        const bool still = plan_.speed == 0;
        const Vec way = still ? Vec(0, -1, 0) : direction(), from = i == 0 ? Vec() : place_[parent];
        const Vec at = from + kLink * way;
        const double mass = std::pow(plan_.ratio, uniform()), about = 0.3 * kLink * kLink * mass;
        place_.push_back(at);
        bodies.push_back(world.add({.position = at,
                                    .velocity = velocity + cross(spin, at),
                                    .spin = spin,
                                    .mass = mass,
                                    .inertia = {about, (0.6 + 0.4 * uniform()) * about, about}}));
        if (i > 0 || plan_.held) join(i > 0 ? bodies[parent] : taut_body{}, bodies.back(), from + 0.5 * kLink * way, way);
    }

    template <class Def>
    taut_joint framed(void (*init)(Def*), taut_result (*add_joint)(taut_world, const Def*, taut_joint*), taut_body a,
                      taut_body b, const Vec& pivot, const Vec& axis) {
        Def def = at(world, init, a, b, pivot, axis);
        def.solve = TAUT_JOINT_SOLVE_SOFT;
        if constexpr (requires { def.slide; }) def.slide = limited(-kLink, kLink);  // or it slides out without end
        taut_joint out{};
        ok(add_joint(world.handle, &def, &out));
        return out;
    }

    void join(taut_body a, taut_body b, const Vec& pivot, const Vec& way) {
        const auto kind = static_cast<JointKind>(plan_.kind >= 0 ? plan_.kind : static_cast<int>(pick(kJointKinds)));
        // Across the link: what slides does not fall, what turns swings.
        const Vec side = std::abs(way.y) < 0.9 * norm(way) ? cross(way, {0, 1, 0}) : cross(way, {1, 0, 0});
        const Vec across = unit(side);
        joints.push_back(make(kind, a, b, pivot, way, across));
    }

    taut_joint make(JointKind kind, taut_body a, taut_body b, const Vec& pivot, const Vec& way, const Vec& across) {
        switch (kind) {
            case JointKind::ball: return ball(a, b, pivot);
            case JointKind::distance: return rod(a, b, pivot, unit(way));
            case JointKind::fixed: return framed(taut_fixed_joint_def_init, taut_world_add_fixed_joint, a, b, pivot, across);
            case JointKind::hinge: return framed(taut_hinge_joint_def_init, taut_world_add_hinge_joint, a, b, pivot, across);
            case JointKind::slider: return framed(taut_slider_joint_def_init, taut_world_add_slider_joint, a, b, pivot, across);
            case JointKind::cylindrical: return framed(taut_cylindrical_joint_def_init, taut_world_add_cylindrical_joint, a, b, pivot, across);
            case JointKind::universal: return framed(taut_universal_joint_def_init, taut_world_add_universal_joint, a, b, pivot, across);
            case JointKind::cone_twist: return framed(taut_cone_twist_joint_def_init, taut_world_add_cone_twist_joint, a, b, pivot, across);
            case JointKind::six_dof: return framed(taut_six_dof_joint_def_init, taut_world_add_six_dof_joint, a, b, pivot, across);
        }
        return {};
    }
    Vec in(taut_body body, const Vec& point) const {  // anchor of a body that is not turned yet
        return body.bits == 0 ? point : point - position(body);
    }
    taut_joint ball(taut_body a, taut_body b, const Vec& pivot) {
        taut_ball_joint_def d;
        taut_ball_joint_def_init(&d);
        d.body_a = a, d.body_b = b;
        d.anchor_a = in(a, pivot).pos(), d.anchor_b = in(b, pivot).pos();
        d.solve = TAUT_JOINT_SOLVE_SOFT;
        taut_joint out{};
        ok(taut_world_add_ball_joint(world.handle, &d, &out));
        return out;
    }
    taut_joint rod(taut_body a, taut_body b, const Vec& pivot, const Vec& way) {
        taut_distance_joint_def d;
        taut_distance_joint_def_init(&d);
        d.body_a = a, d.body_b = b;
        d.anchor_a = in(a, pivot - 0.25 * kLink * way).pos(), d.anchor_b = in(b, pivot + 0.25 * kLink * way).pos();
        d.solve = TAUT_JOINT_SOLVE_SOFT;
        taut_joint out{};
        ok(taut_world_add_distance_joint(world.handle, &d, &out));
        return out;
    }

    SweptPlan plan_;
    std::mt19937_64 random_;
    std::vector<Vec> place_;
    double start_ = 0, scale_ = 1;
};

}  // namespace lab
