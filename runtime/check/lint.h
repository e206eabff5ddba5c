// What in a world the chosen solver will not hold well, judged from masses, joints, contacts and the last forces.
#pragma once

#include <taut/lint.h>

#include "world.h"

namespace taut {

// Findings by kind, then slot.
Array<taut_lint_entry> lint(World& world);

}  // namespace taut
