// Shapes that are built from many points or triangles, in a world or ahead of one.
#pragma once

#include <taut/shape.h>

#include "api/sized.h"

namespace taut {

// The parts of a def that need no memory, and what is built of a def that passed. A refusal stays in check.
bool check_build(Check& check, const taut_hull_def& def);
bool check_build(Check& check, const taut_mesh_def& def);
bool check_build(Check& check, const taut_height_field_def& def);
collision::Shape build_shape(Check& check, const taut_hull_def& def, Memory& memory);
collision::Shape build_shape(Check& check, const taut_mesh_def& def, Memory& memory);
collision::Shape build_shape(Check& check, const taut_height_field_def& def, Memory& memory);

inline void init_def(taut_hull_def* def) { taut_hull_def_init(def); }
inline void init_def(taut_mesh_def* def) { taut_mesh_def_init(def); }
inline void init_def(taut_height_field_def* def) { taut_height_field_def_init(def); }

}  // namespace taut
