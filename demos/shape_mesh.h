// Triangles of a scene's shapes at their size, and the colours of its bodies: what pictures and exports share.
#pragma once

#include <vector>

#include "render/draw_list.h"
#include "render/mesh.h"
#include "scenes/scene.h"

namespace demo {

// Of a body by its look; neighbours rarely share one, and a body keeps its own.
render::Colour colour_of(scenes::Look look, size_t body);
constexpr uint32_t kClothPaint = 0xB8473A, kSolidPaint = 0x4E8C6A;  // sRGB of those that have none of their own

// Of a cone, a tapered capsule, a hull, mesh or height field, which the renderer has no mesh of its own for; of the
// latter as the library has it.
std::vector<render::Vertex> own_mesh(const scenes::Shape& shape, taut_shape handle);
// Of any shape; of a plane a square of a half width [m].
std::vector<render::Vertex> shape_mesh(const scenes::Shape& shape, taut_shape handle, float plane_half_width);

// The points of a skin, which are in the middle of four of its solid's vertices each.
std::vector<taut_pos> skin_points(const scenes::Skin& skin, const std::vector<taut_pos>& vertices);
// By the areas of the triangles about each point; up where there are none.
std::vector<taut_vec3> normals_of(const std::vector<taut_pos>& points, const std::vector<uint32_t>& triangles);

}  // namespace demo
