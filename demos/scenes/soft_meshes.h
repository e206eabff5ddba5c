// Meshes of cloths and solids, made in code.
#pragma once

#include "scene.h"

namespace scenes {

constexpr double kSheetSide = 1.5;                                      // [m]
constexpr double kSheetDensity = 0.2;                                   // [kg/m^2]
constexpr double kSheetMass = kSheetSide * kSheetSide * kSheetDensity;  // [kg]

// rows x columns vertices in a level rectangle about the origin, two triangles a cell with alternating diagonals;
// vertex i columns + k at x by i, z by k, with texture coordinates in metres [m].
Cloth grid_cloth(int rows, int columns, double length, double width, double height);

// Bends a level cloth so long along x to a hanging arc of a circle of twice that angle, its ends as high as before
// [m, rad]. The level one is its rest shape: chords of the arc are a little shorter.
void sag(Cloth& cloth, double length, double half_angle);

// n x n of it, kSheetSide wide, of links that hardly stretch or shear, without bending.
Cloth sheet(int n, double height);

constexpr double kTrampolineHeight = 1;  // [m]
// A mat of side x side vertices that hardly stretches, the scene's first cloth, on springs of 5 kN/m in a frame.
void add_trampoline(Scene& scene, int side, double wide);

// Vertices of a box of nodes[0] x nodes[1] x nodes[2], z fastest.
inline uint32_t box_vertex(const int (&nodes)[3], int i, int j, int k) {
    return static_cast<uint32_t>((i * nodes[1] + j) * nodes[2] + k);
}

// Appends the five tetrahedra of a hexahedral cell, mirrored where the cell is odd; vertices by corner b of the cell,
// which is at (b & 1, b >> 1 & 1, b >> 2).
void add_five_tets(const uint32_t (&corner)[8], bool odd, std::vector<uint32_t>& cells);

// Box of such cells with its least corner there [m].
Solid box_of_tets(const double (&size)[3], const int (&nodes)[3], taut_pos corner);

// Ball of such cells, n^3 vertices: a cube whose shells become round towards the outside.
Solid ball_of_tets(double radius, int n, taut_pos centre);

// Ring about the z axis of such cells, `around` of them, an even number, and across^2 vertices in its round section.
Solid ring_of_tets(double ring, double tube, int around, int across, taut_pos centre);

// Box of hexahedra.
Solid box_of_hexahedra(const double (&size)[3], const int (&nodes)[3], taut_pos corner);

// The same vertices without the mesh, with its boundary.
Solid without_mesh(Solid solid);

// Moves and scales points so that their box stands on the height, about the y axis, and is so tall [m].
void stand_up(std::vector<taut_pos>& points, double tall, double height);

// An empty scene seen from where something of that height fills the picture [m].
Scene soft_hall(double height);

Bounds box_about(const std::vector<taut_pos>& points);

}  // namespace scenes
