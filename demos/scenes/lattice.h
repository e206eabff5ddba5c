// A closed surface filled with a lattice of tetrahedra, in which it is embedded.
#pragma once

#include "obj_file.h"
#include "scene.h"

namespace scenes {

// A solid of cubes of five tetrahedra each, about so many cubes: those of which a part lies inside the surface, by the
// parity of what a line through it crosses. Vertices on the lattice's boundary are drawn to the surface as far as its
// cells stay well shaped. The surface is the solid's skin.
// The def is the default one. Throws BadFile, which names the source, for a surface that is not closed, that encloses
// nothing, or that is finer than so many cubes can fill.
Solid fill_surface(const Surface& surface, int cubes, const std::string& source);

}  // namespace scenes
