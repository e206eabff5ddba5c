// A character in the laboratory's world, at any rate, and what the tests measure of it.
#pragma once

#include <algorithm>
#include <cstring>
#include <utility>

#include "physics/lab.h"

namespace lab {

constexpr double kRadius = 0.3, kHalf = 0.6;  // of the capsule [m]: 1.8 m tall

inline std::function<void(taut_world_def&)> at_rate(double hz) {
    return [hz](taut_world_def& def) { def.time_step = static_cast<float>(1 / hz); };
}

class Walker {
public:
    // feet: where it stands.
    Walker(const World& world, double hz, const Vec& feet) : world_(world), seconds_(static_cast<float>(1 / hz)) {
        taut_character_def_init(&def);
        def.shape = world.capsule(kRadius, kHalf);
        taut_character_init(&body);
        body.position = (feet + Vec(0, kRadius + kHalf + gap(), 0)).pos();
    }

    // The world's step, then the character's frame.
    void frame(const Vec& walk, double jump = 0) {
        world_.step();
        move(walk, jump);
    }
    void move(const Vec& walk, double jump = 0) {
        ok(taut_character_move(world_.handle, &def, walk.narrow(), static_cast<float>(jump), seconds_, &body));
        deepest = std::max(deepest, depth());
    }
    int frames(double time) const { return static_cast<int>(std::lround(time / static_cast<double>(seconds_))); }
    void walk(const Vec& velocity, double time) {
        for (int i = frames(time); i > 0; --i) frame(velocity);
    }

    Vec position() const { return body.position; }
    Vec feet() const { return position() - Vec(0, kRadius + kHalf + gap(), 0); }
    Vec velocity() const { return Vec(body.velocity) + Vec(body.ground_velocity); }
    double gap() const { return static_cast<double>(def.gap); }
    bool on_ground() const { return body.state == TAUT_CHARACTER_ON_GROUND; }
    // How deep the capsule is within anything [m].
    double depth() const {
        const taut_pose pose = {body.position, {0, 0, 0, 1}, {0, 0}};
        taut_distance distance{};
        ok(taut_world_nearest_collider(world_.handle, def.shape, &pose, 0, def.filter, &distance));
        return distance.body.bits != 0 ? std::max(-static_cast<double>(distance.distance), 0.0) : 0.0;
    }

    taut_character_def def{};
    taut_character body{};
    double deepest = 0;  // of all frames [m]

private:
    const World& world_;
    float seconds_;
};

}  // namespace lab
