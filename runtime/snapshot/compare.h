// Where two worlds part, field by field, as far as it counts for the hash.
#pragma once

#include <string>

#include "world.h"

namespace taut {

// Names of the fields that lead to the first one that differs, with the slot in whose row it is; empty: none does.
std::string first_difference(const World& one, const World& other);

}  // namespace taut
