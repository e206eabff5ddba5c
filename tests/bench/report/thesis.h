// The sections of the report beside the figures and tables of Frâncu 2016 about cloth.
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
// Figures 8.11 and 8.12: energy of a sheet of rubber, and of a damped one.
void cloth_energy(const std::filesystem::path& folder);

}  // namespace bench
