// A scene living in a Taut world, made through the public C API only.
#pragma once

#include <taut/taut.h>

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

// "block_ldlt", "projected_gauss_seidel", "accelerated_jacobi". Throws BadScene for another name.
taut_solver solver_named(const std::string& name);
const char* solver_name(taut_solver solver);

// Throws TautError unless result is TAUT_OK.
void check(taut_result result, const char* what);

class TautWorld {
public:
    // Bodies, joints and shapes get their indices in the scene as user data and as places in these lists.
    explicit TautWorld(const Scene& scene);
    ~TautWorld();
    TautWorld(const TautWorld&) = delete;
    TautWorld& operator=(const TautWorld&) = delete;

    void step() { check(taut_world_step(world), "taking a step"); }
    taut_pose pose(size_t body) const;
    taut_profile profile() const;

    taut_world world{};
    std::vector<taut_shape> shapes;
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;

private:
    void build(const Scene& scene);
    taut_body end(int index) const { return index == kWorld ? taut_body{} : bodies[static_cast<size_t>(index)]; }
};

}  // namespace scenes
