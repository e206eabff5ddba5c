// The sections of the report about the two forms of one element, as rows with compliance and as stiffness (Tournier et
// al. 2015, section 4.2).
#pragma once

#include <filesystem>

#include "engine.h"

namespace bench {

// Of a Taut engine before its first step: all elements as rows with multipliers, which geometric_stiffness is for.
void take_as_rows(const Engine& engine);

// Table 2: condition numbers of both systems while a stiff sheet of 10 x 10 falls.
void conditioning(const std::filesystem::path& folder);
// Iterations of the method of minimum residuals on a sheet of 1 GPa in both forms.
void minres(const std::filesystem::path& folder);
// A soft cantilever in both forms, and without geometric stiffness.
void beam_forms(const std::filesystem::path& folder);

}  // namespace bench
