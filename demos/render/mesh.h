// Triangle meshes of the renderer.
#pragma once

#include <vector>

#include "matrix.h"

namespace render {

struct Vertex {
    Vec3 position, normal;
};

// Three vertices a triangle, counter-clockwise seen from outside; each reaches from -1 to 1.
std::vector<Vertex> box_mesh();
std::vector<Vertex> sphere_mesh(int rings);
std::vector<Vertex> cylinder_mesh(int sides);

// A point of a profile that is turned about y, with its normal (across, along y).
struct ProfilePoint {
    float radius, y, normal_radius, normal_y;
};
// The surface that each pair of neighbouring points sweeps, from the lowest up; two points in one place make an edge.
std::vector<Vertex> turned_mesh(const std::vector<ProfilePoint>& profile, int sides);

// Flat shaded triangles from points, three a triangle.
std::vector<Vertex> flat_mesh(const std::vector<Vec3>& points);

}  // namespace render
