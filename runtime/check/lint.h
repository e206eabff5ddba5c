// What in a world the chosen solver will not hold well, judged from masses, joints, contacts and the last forces.
#pragma once

#include <taut/lint.h>

#include "world.h"

namespace taut {

// Findings by kind, then slot.
Array<taut_lint_entry> lint(World& world);

// Those about cables (lint_cables.cpp), at most one of a kind each, appended.
void lint_cables(World& world, Array<taut_lint_entry>& found);

}  // namespace taut
