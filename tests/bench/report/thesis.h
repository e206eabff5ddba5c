// The sections of the report beside the figures and tables of Frâncu 2016 about cloth and grains.
#pragma once

#include <filesystem>

namespace bench {

// Figures 8.3 and 8.4: a sheet of 50 x 50 by each solver, error over time and cost over iterations.
void cloth_solvers(const std::filesystem::path& folder);
// Figure 6.3: what is left at rest after so many iterations a step.
void cloth_rest(const std::filesystem::path& folder);
// Figure 8.7: a sheet of 100 x 100.
void cloth_large(const std::filesystem::path& folder);
// Tables 8.1 to 8.3: a frame's time by Gauss-Seidel and accelerated Jacobi.
void solver_times(const std::filesystem::path& folder);
// Figures 4.1, 8.11 and 8.12: energy of a sheet, of one of rubber, and of a damped one.
void cloth_energy(const std::filesystem::path& folder);
// Figures 8.8 and 8.10: overlaps of 3000 grains over time, velocities along contacts of 1000 over iterations.
void grains_error(const std::filesystem::path& folder);
void grains_velocity(const std::filesystem::path& folder);
// Section 8.3, figure 8.14: a thousand grains on a sheet, with projection and velocity time stepping mixed.
void mixing(const std::filesystem::path& folder);

}  // namespace bench
