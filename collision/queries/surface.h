// Queries of meshes and height fields, triangle by triangle. Nothing is inside a surface. Rays and casts meet triangles
// from the front, on two-sided surfaces from both sides; overlaps and gaps do not ask for the side.
#pragma once

#include "collision/collide.h"

namespace taut::collision {

bool cast_ray_at_surface(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit,
                         Hit& out);
bool cast_at_surface(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                     const Placement& at, double limit, Hit& out);
// b is the surface.
// The earliest moment at which a triangle of b is as near as reach, by impact.cpp's convex_meeting, and its number; or
// limit.
double surface_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                       double limit, uint32_t& number);
// Whether the ways lead deeper into a triangle of b than depth from the moment met on, by triangle_passes_deep; that of
// the number is asked first.
bool surface_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b,
                         uint32_t number, double met, double depth, double until);
bool surface_overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
Gap surface_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);

}  // namespace taut::collision
