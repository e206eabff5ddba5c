// From where Newton's method converges, with line search and without, in one step of a solid of 36 freedoms: a bar of
// twelve vertices, free and at rest, one end of which is anywhere in a square (Gast and Schroeder 2014, figure 2). For
// the test and the report.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenes/soft_meshes.h"
#include "scenes/taut_world.h"

namespace bench {

// A picture, row by row from below: how many of Newton's steps each pixel takes.
struct NewtonMap {
    static constexpr uint32_t kMostSolves = 500;  // of one that does not converge
    static constexpr double kSteps[] = {1 / (24.0 * 170), 1 / (24.0 * 40), 1 / (24.0 * 20),
                                        1 / (24.0 * 10),  1 / 24.0,        1};  // [s]

    NewtonMap(double h, bool search, int size);

    int failed() const { return static_cast<int>(std::count(solves.begin(), solves.end(), kMostSolves)); }
    double mean() const {
        double sum = 0;
        for (const uint32_t each : solves) sum += each;
        return sum / static_cast<double>(solves.size());
    }

    std::vector<uint32_t> solves;
};

// Until the step converged from where the end is about (x, y) [m], the middle half way, by steps of h [s].
inline uint32_t newton_solves_from(double x, double y, double h, bool search) {
    constexpr double kYoung = 1e7;       // [Pa]
    constexpr double kLongest = 0.1;     // step of a world [s]: a longer one is one of a stiffer solid
    constexpr double kTolerance = 1e-6;  // of a step's residual over h
    const double stiffer = std::max(1.0, h / kLongest * h / kLongest);
    h = std::min(h, kLongest);
    scenes::Scene scene;
    taut_world_def_init(&scene.world);
    scene.world.solver = TAUT_SOLVER_MINIMISATION;
    scene.world.time_step = static_cast<float>(h);
    scene.world.substeps = 1;
    scene.world.gravity = {0, 0, 0};
    scene.world.sweeps = NewtonMap::kMostSolves;
    scene.world.line_search = search;
    scenes::Solid bar = scenes::box_of_tets({1, 0.5, 0.5}, {3, 2, 2}, {0, 0, 0});
    bar.def.material = TAUT_SOLID_FIXED_COROTATED;
    bar.def.young_modulus = static_cast<float>(kYoung * stiffer);
    bar.def.poisson_ratio = 0.3f;
    bar.def.filter.mask = 0;
    bar.rest = bar.points;
    for (taut_pos& p : bar.points) {
        const double part = p.x;
        p.x += part * (x - 1);
        p.y += part * y;
    }
    scene.add_solid(std::move(bar));
    scenes::TautWorld world(scene);
    world.step();
    const taut_profile profile = world.profile();
    const bool converged = world.quarantined == 0 && static_cast<double>(profile.residual) * h < 1.01 * kTolerance;
    return converged ? profile.solves : NewtonMap::kMostSolves;
}

// Rest is at (3/5, 1/2) of the picture.
inline NewtonMap::NewtonMap(double h, bool search, int size) {
    constexpr double kSide = 2.5;  // [m]
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double u = (column + 0.5) / size, v = (row + 0.5) / size;
            solves.push_back(newton_solves_from(1 + kSide * (u - 0.6), kSide * (v - 0.5), h, search));
        }
}

}  // namespace bench
