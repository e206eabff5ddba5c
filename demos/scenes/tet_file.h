// Meshes of tetrahedra and hexahedra from files.
#pragma once

#include <taut/math.h>

#include <cstdint>
#include <string>
#include <vector>

namespace scenes {

struct CellMesh {
    std::vector<taut_pos> points;  // those that cells use, in the order of the file
    std::vector<uint32_t> cells;
    uint32_t corners = 4;  // of a cell
};

// TetGen's pair of files, by the name of either: FILE.node with points, FILE.ele with tetrahedra (of the first four of
// its nodes where these are quadratic). Numbers of points begin with 0 or 1.
// Throws BadFile naming file and line.
CellMesh read_tetgen(const std::string& path);

// Gmsh's .msh as ASCII of version 2 or 4.1: tetrahedra, or hexahedra; other elements are left out.
// Throws BadFile naming file and line.
CellMesh read_gmsh(const std::string& path);

}  // namespace scenes
