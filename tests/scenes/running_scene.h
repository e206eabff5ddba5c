// A scene of the catalogue in a world, and what the tests read off it.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "physics/cable_lab.h"
#include "scenes/catalogue.h"
#include "scenes/taut_world.h"

namespace scenes {

inline void PrintTo(const Family& family, std::ostream* out) { *out << family.example; }

}  // namespace scenes

namespace lab {

// Two pieces for mesh_drop, a tetrahedron and a wedge, in a file of this process while it is asked for.
class SmallMesh {
public:
    SmallMesh() {
        std::ofstream(path) << "g tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
                               "g wedge\nv 3 0 0\nv 5 0 0\nv 3 1 0\nv 3 0 1\nv 5 0 1\nv 3 1 1\n"
                               "f 5 7 6\nf 8 9 10\nf 5 6 9 8\nf 6 7 10 9\nf 7 5 8 10\n";
    }
    ~SmallMesh() { std::remove(path.c_str()); }
    SmallMesh(const SmallMesh&) = delete;
    SmallMesh& operator=(const SmallMesh&) = delete;

    const std::string path = testing::TempDir() + "taut_pieces_" + std::to_string(getpid()) + ".obj";
};

// Each family's example, with what it needs.
inline scenes::Scene example_of(const scenes::Family& family, uint64_t seed = 0) {
    std::optional<SmallMesh> mesh;
    scenes::Options options;
    options.seed = seed;
    if (family.needs_mesh) options.mesh = mesh.emplace().path;
    return scenes::make_scene(family.example, options);
}

class RunningScene {
public:
    explicit RunningScene(scenes::Scene plan) : scene(std::move(plan)), world(scene) {
        for (size_t i = 0; i < scene.bodies.size(); ++i) start.push_back(body(i));
    }
    explicit RunningScene(const std::string& name) : RunningScene(scenes::make_scene(name)) {}

    void step() { world.step(); }
    BodyState body(size_t i) const { return state(world.bodies[i]); }
    bool sound() const {
        if (world.quarantined > 0) return false;
        const auto all = everything();
        return std::all_of(all.begin(), all.end(), [](taut_body b) { return finite(b); });
    }
    // The scene's bodies and those that its cables, cloths and solids are made of.
    std::vector<taut_body> everything() const {
        std::vector<taut_body> all = world.bodies;
        for (taut_cable cable : world.cables) {
            const auto own = bodies_of(cable);
            all.insert(all.end(), own.begin(), own.end());
        }
        for (const auto* soft : {&world.cloth_vertices, &world.solid_vertices})
            for (const auto& vertices : *soft) all.insert(all.end(), vertices.begin(), vertices.end());
        return all;
    }
    double pile_speed() const {  // fastest
        double most = 0;
        for (int i : scene.roles.pile) most = std::max(most, norm(body(static_cast<size_t>(i)).velocity));
        return most;
    }
    double pile_shift() const {  // furthest from its start [m]
        double most = 0;
        for (int i : scene.roles.pile)
            most = std::max(most, norm(body(static_cast<size_t>(i)).position - start[static_cast<size_t>(i)].position));
        return most;
    }
    double joint_error() const {  // [m]
        const double most = world.joint_error();
        return std::isnan(most) ? INFINITY : most;
    }
    double angular_error() const {  // [rad]
        float most = 0;
        for (size_t i = 0; i < world.joints.size(); ++i) {
            float error = 0;
            if (!world.is_whole(i)) continue;
            ok(taut_joint_get_angular_error(world.joints[i], &error));
            most = std::isnan(error) ? INFINITY : std::max(most, error);
        }
        return static_cast<double>(most);
    }
    double energy() const {  // kinetic and of height [J]
        std::vector<taut_body> moving;
        for (taut_body body : everything()) {
            taut_body_kind kind{};
            ok(taut_body_get_kind(body, &kind));
            if (kind == TAUT_BODY_DYNAMIC) moving.push_back(body);
        }
        const Totals sum = totals(moving);
        return sum.kinetic + kG * sum.height;
    }
    // From the anchor along the points of a cable [m].
    double cable_length() const {
        const scenes::Chain& chain = *scene.roles.chain;
        Vec last = chain.anchor;
        double sum = 0;
        for (int i : chain.bodies) {
            const Vec at = position(world.bodies[static_cast<size_t>(i)]);
            sum += norm(at - last);
            last = at;
        }
        return sum;
    }

    scenes::Scene scene;
    scenes::TautWorld world;
    std::vector<BodyState> start;
};

}  // namespace lab
