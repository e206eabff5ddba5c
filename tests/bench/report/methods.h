// Solvers with the settings that Frâncu 2016 compares, as curves of the report.
#pragma once

#include "scenes/scene.h"

namespace bench {

constexpr float kShort = 0.008f, kLong = 0.016f;  // the thesis' steps [s]

struct Method {
    const char* name;
    taut_solver solver;
    double relaxation = 0;  // 0: the solver's own
    taut_momentum momentum = TAUT_MOMENTUM_NESTEROV;
    taut_stepping stepping = TAUT_STEPPING_PROJECTION;
    double share = 0;          // of errors that joints and contacts undo in a step, k_c or gamma; 0: by default, softly
    double velocity_gain = 1;  // k_v
};

inline bool is_direct(const Method& method) { return method.solver == TAUT_SOLVER_BLOCK_LDLT; }

// One step a frame without substeps.
inline void as_in_thesis(scenes::Scene& scene, const Method& method, uint32_t iterations, float step) {
    taut_world_def& world = scene.world;
    world.time_step = step;
    world.substeps = world.fixed_substeps = 1;
    world.solver = method.solver;
    world.sweeps = is_direct(method) ? 0 : iterations;
    world.momentum = method.momentum;
    world.stepping = method.stepping;
    world.velocity_gain = static_cast<float>(method.velocity_gain);
    if (method.share > 0) world.stabilisation = world.contact_stabilisation = static_cast<float>(method.share);
    if (method.relaxation > 0) world.relaxation = static_cast<float>(method.relaxation);
}

}  // namespace bench
