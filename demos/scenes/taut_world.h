// A scene living in a Taut world, made through the public C API only.
#pragma once

#include <taut/taut.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene.h"

namespace scenes {

// A call of the C API was refused; what() is taut_last_error() with what was being made.
class TautError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// By the name that taut_solver_name() gives it. Throws BadScene for another.
taut_solver solver_named(const std::string& name);

// Throws TautError unless result is TAUT_OK.
void check(taut_result result, const char* what);

class TautWorld {
public:
    // Bodies, joints, cables and shapes get their indices in the scene as user data and as places in these lists. The
    // scene is kept. history: what the world goes through before the scene is built in it.
    explicit TautWorld(const Scene& scene, const std::function<void(taut_world)>& history = nullptr);
    ~TautWorld();
    TautWorld(const TautWorld&) = delete;
    TautWorld& operator=(const TautWorld&) = delete;

    void step();  // what has a plan follows it
    bool is_whole(size_t joint) const { return taut_joint_is_valid(joints[joint]) != 0; }
    taut_pose pose(size_t body) const;
    taut_profile profile() const;
    double joint_error() const;  // largest of the rigid joints that are whole, those of rigid cables among them [m]

    double energy() const;  // of motion and height of all bodies, vertices and points among them [J]

    taut_world world{};
    std::vector<taut_shape> shapes;
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;
    std::vector<taut_cable> cables;
    std::vector<taut_cloth> cloths;
    std::vector<taut_solid> solids;
    std::vector<std::vector<taut_body>> cloth_vertices, solid_vertices;
    std::vector<int> broken;   // joints of the scene, in the order in which they broke
    uint32_t quarantined = 0;  // bodies

private:
    void build();
    taut_cable add(Cable plan, uint64_t index) const;
    taut_cloth add(Cloth plan, uint64_t index) const;
    taut_solid add(Solid plan, uint64_t index) const;
    void follow_plans();
    void take_away(double time);
    void move(int body, double time) const;
    void move_vertices(const Motion& motion, double value) const;
    void add_parts(const Body& plan, taut_body body) const;
    void add_joints();
    void add_cables();
    void drive(const Motion& motion, double value, double rate) const;
    taut_body end(int index) const { return index == kWorld ? taut_body{} : bodies[static_cast<size_t>(index)]; }
    taut_body end(int index, const SoftVertex& vertex) const;

    Scene scene_;
    uint64_t steps_ = 0;
};

}  // namespace scenes
