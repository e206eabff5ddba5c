// The sections of the report about cloths and solids.
#pragma once

#include <filesystem>

namespace bench {

// Tournier et al. 2015, section 4: a sheet of stiff links with a weight, with and without geometric stiffness.
void cloth_ratio(const std::filesystem::path& folder);
// A cantilever against Euler and Bernoulli's with shear, solved directly and by sweeps.
void beam(const std::filesystem::path& folder);

}  // namespace bench
