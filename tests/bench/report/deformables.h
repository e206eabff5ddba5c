// The sections of the report about cloths and solids.
#pragma once

#include <filesystem>

namespace bench {

// Tournier et al. 2015, section 4: a sheet of stiff links with a weight, with and without geometric stiffness.
void cloth_ratio(const std::filesystem::path& folder);
// A cantilever against Euler and Bernoulli's with shear, solved directly and by sweeps.
void beam(const std::filesystem::path& folder);
// Frâncu 2016, figures 8.3, 8.4 and 8.7: a sheet of 50 x 50 by each solver.
void cloth_solvers(const std::filesystem::path& folder);

}  // namespace bench
