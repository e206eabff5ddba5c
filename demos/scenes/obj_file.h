// Convex pieces, and surfaces, from an OBJ file.
#pragma once

#include <taut/math.h>

#include <cstdint>
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

// All faces as triangles; vertices in one place are one.
struct Surface {
    std::vector<taut_pos> points;
    std::vector<uint32_t> triangles;
    std::vector<float> uv;  // two a point, the first that a face gives it; none where some face gives none
};
// Throws BadFile naming file and line.
Surface read_surface(const std::string& path);

}  // namespace scenes
