// What taut-bench asks of an engine: step a scene and tell where everything is.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/scene.h"

namespace bench {

struct Motion {
    taut_pos position{};
    taut_quat rotation{0, 0, 0, 1};
    taut_vec3 linear_velocity{}, angular_velocity{};
};

// Zero mass for what doesn't move by itself. The scenes' bodies have their centre of mass at the origin.
struct Mass {
    double mass = 0;      // [kg]
    taut_sym3 inertia{};  // body axes [kg m^2]
};

// Vertices of a cloth or solid.
struct SoftState {
    std::vector<taut_pos> points;
    std::vector<taut_vec3> velocities;
};

// Time that the last step spent on direct solves.
struct SolveTime {
    double microseconds = 0;
    uint32_t solves = 0;
};

// How long a stage of the last step took.
struct StageTime {
    const char* name;
    double milliseconds;
};

class Engine {
public:
    virtual ~Engine() = default;
    virtual const char* name() const = 0;
    virtual const char* solver() const = 0;
    virtual uint32_t substeps() const = 0;
    virtual void step() = 0;
    virtual Motion motion(size_t body) const = 0;
    virtual Mass mass(size_t body) const = 0;
    // Of a cloth or solid of the scene. Throw scenes::BadScene for what the engine doesn't have.
    virtual void read_cloth(size_t index, SoftState& state) const;
    virtual void read_solid(size_t index, SoftState& state) const;
    virtual uint64_t state_hash() const = 0;
    virtual taut_world world() const { return {}; }  // null: not Taut
    virtual SolveTime solve_time() const { return {}; }
    virtual std::vector<StageTime> stage_times() const { return {}; }  // the same stages after every step
    virtual uint64_t bytes() const { return 0; }                       // that it holds; 0: not known
    virtual uint32_t asleep() const { return 0; }                      // bodies
    virtual uint32_t quarantined() const { return 0; }  // bodies frozen by the last step because they became non-finite
};

std::unique_ptr<Engine> make_taut_engine(const scenes::Scene& scene);

// Peers: only in builds with TAUT_BENCH_PEERS. They throw scenes::BadScene for what the engine doesn't have.
std::unique_ptr<Engine> make_bullet_engine(const scenes::Scene& scene, uint32_t substeps);
// ODE's two solvers: the direct one over all rows of an island, and the one that sweeps.
enum class OdeSolver : uint8_t { step, quickstep };
std::unique_ptr<Engine> make_ode_engine(const scenes::Scene& scene, uint32_t substeps, OdeSolver solver);
// Joints ask for the direct one; piles would take it minutes a step.
OdeSolver ode_solver_for(const scenes::Scene& scene);

}  // namespace bench
