// Solids and cloths from files of the user.
#pragma once

#include <string>

#include "limbs.h"
#include "obj_file.h"
#include "scene.h"

namespace scenes {

// A solid from FILE.node or FILE.ele (TetGen), FILE.msh (Gmsh) or FILE.obj, a closed surface that a lattice of about so
// many cubes fills. Throws BadFile.
Solid solid_from_file(const std::string& path, int cubes);

// A figure that stands: of a file; without one that of the folder TAUT_DATA, else one of made here, of about 1200
// vertices. Throws BadFile.
Solid figure(const std::string& path);

// Likewise, of the file of that name in TAUT_DATA, else of limbs, filled with about so many cubes.
Solid creature(const std::string& path, const char* in_data, std::span<const FigureLimb> limbs, int cubes);

// A closed surface of a figure that is made here [m].
Surface figure_surface();

}  // namespace scenes
