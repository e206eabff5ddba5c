// Random mechanisms of swept joints of every type, at rest or thrown.
#pragma once

#include "physics/mechanism_lab.h"

namespace lab {

enum class Net { chain, tree, loops, grid };  // loops: a tree with a few joints more; grid: hung by its upper row

struct SweptPlan {
    uint32_t seed = 1;
    uint32_t kind = kJointKinds;  // of its joints; kJointKinds: any
    Net net = Net::tree;
    int bodies = 12;        // of a grid: on a side
    bool held = true;       // by the world
    double ratio = 1;       // of masses, at most
    double speed = 0;       // thrown at that, and turned by that a metre [m/s]; those at rest hang in balance
    double rate = 60;       // frames a second
    uint32_t substeps = 4;  // of a frame
    uint32_t sweeps = 0;    // 0: the solver's own
    taut_solver solver = TAUT_SOLVER_BLOCK_LDLT;
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
        velocity_ = plan.speed * direction(random_);
        spin_ = plan.speed * direction(random_);
        if (plan.net == Net::grid)
            hang_grid();
        else
            hang_tree();
        const Totals t = totals(bodies);
        start_ = energy();
        scale_ = t.kinetic + t.mass * kG * kLink;
    }

    void step(int frames) {
        for (int i = 0; i < frames; ++i) {
            world.step();
            gain = std::max(gain, (energy() - start_) / scale_);
            gap = 0;
            for (const taut_joint joint : joints) gap = std::max(gap, error(joint));
            widest = std::max(widest, gap);
        }
    }
    double fastest() const {  // [m/s]
        double most = 0;
        for (const taut_body body : bodies) most = std::max(most, norm(velocity(body)));
        return most;
    }

    World world;
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;
    double gap = 0, widest = 0;  // of the joints after the last step, and so far [m]
    double gain = 0;             // of mechanical energy above the start's, of what moved then and of a link's height

private:
    double energy() const {
        const Totals t = totals(bodies);
        return t.kinetic + kG * t.height;
    }
    taut_body fixed(const Vec& at) { return world.add({.kind = TAUT_BODY_STATIC, .position = at}); }
    taut_body add(const Vec& at) {
        const double mass = std::pow(plan_.ratio, draw(random_, 0, 1)), about = 0.3 * kLink * kLink * mass;
        bodies.push_back(world.add({.position = at,
                                    .velocity = velocity_ + cross(spin_, at),
                                    .spin = spin_,
                                    .mass = mass,
                                    .inertia = {about, draw(random_, 0.6, 1) * about, about}}));
        return bodies.back();
    }
    void hang_tree() {
        for (int i = 0; i < plan_.bodies; ++i) hang(i);
        for (int i = 0; plan_.net == Net::loops && i < plan_.bodies / 2; ++i) {
            const size_t a = random_() % bodies.size(), b = random_() % bodies.size();
            const Vec at_a = position(bodies[a]), at_b = position(bodies[b]);
            if (norm(at_b - at_a) > 0.1 * kLink) tie(bodies[a], bodies[b], 0.5 * (at_a + at_b));
        }
    }
    void hang(int i) {
        const Vec way = plan_.speed == 0 ? Vec(0, -1, 0) : direction(random_);
        const size_t parent = i == 0 || plan_.net == Net::chain ? bodies.size() - 1 : random_() % bodies.size();
        const taut_body from = i > 0 ? bodies[parent] : plan_.held ? fixed({}) : taut_body{};
        const Vec at = i > 0 ? position(from) : Vec();
        const taut_body body = add(at + kLink * way);
        if (i > 0 || plan_.held) tie(from, body, at + 0.5 * kLink * way);
    }
    void hang_grid() {
        const auto side = static_cast<size_t>(plan_.bodies);
        for (size_t i = 0; i < side; ++i)
            for (size_t k = 0; k < side; ++k) {
                const Vec at(kLink * static_cast<double>(i), -kLink * static_cast<double>(k), 0);
                const taut_body above = k > 0 ? bodies.back() : fixed(at + Vec(0, kLink, 0));
                tie(above, add(at), at + Vec(0, 0.5 * kLink, 0));
                if (i > 0) tie(bodies[bodies.size() - 1 - side], bodies.back(), at - Vec(0.5 * kLink, 0, 0));
            }
    }
    // What slides goes across the link: it does not fall.
    void tie(taut_body a, taut_body b, const Vec& pivot) {
        const uint32_t kind = plan_.kind < kJointKinds ? plan_.kind : random_() % kJointKinds;
        const Vec way = position(b) - position(a), side = cross(way, {0, 1, 0});
        const Vec across = unit(norm(side) > 0.1 * norm(way) ? side : cross(way, {1, 0, 0}));
        joints.push_back(join(world, kind, a, b, pivot, across));
        ok(taut_joint_set_solve(joints.back(), TAUT_JOINT_SOLVE_SOFT));
        const taut_axis_def slide = limited(-kLink, kLink);
        if (kind == TAUT_JOINT_SLIDER || kind == TAUT_JOINT_CYLINDRICAL)
            ok(taut_joint_set_axis(joints.back(), 0, &slide));
    }

    SweptPlan plan_;
    std::mt19937 random_;
    Vec velocity_, spin_;
    double start_ = 0, scale_ = 1;
};

}  // namespace lab
