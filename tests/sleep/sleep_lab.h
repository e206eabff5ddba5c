// Worlds that sleep, and what the tests ask them.
#pragma once

#include <cstring>

#include "physics/contact_lab.h"
#include "scenes/running_scene.h"

namespace lab {

inline void let_sleep(taut_world_def& def) { def.sleeping = 1; }

inline bool awake(taut_body body) {
    uint32_t out = 0;
    ok(taut_body_get_awake(body, &out));
    return out == 1;
}
inline bool all_asleep(const std::vector<taut_body>& bodies) {
    return std::none_of(bodies.begin(), bodies.end(), awake);
}
inline bool all_awake(const std::vector<taut_body>& bodies) { return std::all_of(bodies.begin(), bodies.end(), awake); }

// Poses and velocities to the last bit.
struct Bits {
    std::vector<taut_pose> poses;
    std::vector<taut_vec3> linear, angular;

    Bits(taut_world world, const std::vector<taut_body>& bodies)
        : poses(bodies.size()), linear(bodies.size()), angular(bodies.size()) {
        ok(taut_world_get_body_states(world, bodies.data(), static_cast<uint32_t>(bodies.size()), poses.data(), 0,
                                      linear.data(), 0, angular.data(), 0));
    }
    bool operator==(const Bits& b) const {
        const auto same = [](const auto& one, const auto& other) {
            return one.size() == other.size() && std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]) == 0;
        };
        return same(poses, b.poses) && same(linear, b.linear) && same(angular, b.angular);
    }
};

// Cubes of half a metre on each other, at x on the ground.
inline std::vector<taut_body> add_stack(const World& world, int count, double x = 0, double z = 0) {
    const taut_shape cube = world.box({0.25, 0.25, 0.25});
    std::vector<taut_body> stack;
    for (int i = 0; i < count; ++i) stack.push_back(world.add({.shape = cube, .position = {x, 0.25 + 0.5 * i, z}}));
    return stack;
}

// Steps until all of these sleep; the number of steps, or -1.
inline int steps_to_sleep(const World& world, const std::vector<taut_body>& bodies, int most = 600) {
    for (int i = 1; i <= most; ++i) {
        world.step();
        if (all_asleep(bodies)) return i;
    }
    return -1;
}

}  // namespace lab
