// Tearing of cloths: where an edge is stretched beyond the cloth's tear strain, the mesh opens along the edges at one
// end of it that go most nearly across it. That vertex, and each one on the rim that these lead to, falls into fans of
// triangles that no whole edge ties together: the first keeps it, the others get new ones.
#pragma once

#include "world.h"

namespace taut {

// After a step, each with its events. Where room or memory fails the tear does not happen, and nothing changes.
void tear_cloths(World& world);

}  // namespace taut
