// Convex pieces from an OBJ file.
#pragma once

#include <taut/math.h>

#include <string>
#include <vector>

namespace scenes {

// The vertices that the faces of one group or object use.
struct ObjPiece {
    std::string name;
    int line = 0;  // of the file, where the piece begins
    std::vector<taut_vec3> points;
};

// Reads every group and object that has faces. Throws BadFile naming file and line.
std::vector<ObjPiece> read_obj(const std::string& path);

}  // namespace scenes
