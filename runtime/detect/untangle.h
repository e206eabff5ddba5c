// Surfaces that go through each other, as they began or because nobody held them apart: the line along which they cut
// is made shorter until it is gone (Volino and Magnenat-Thalmann 2006, Resolving surface collisions through
// intersection contour minimization).
#pragma once

#include "detect/surface_finder.h"

namespace taut {

// Where the segment from p to q goes through a triangle.
bool goes_through(const Vec3f& p, const Vec3f& q, const Vec3f (&face)[3]);

// From the crossings in SurfaceContacts, and those before that stay: takes away contacts of what is tangled, which hold
// it as it is, but for those in touch before that are on their sides, and adds such that push edges along the ways in
// which they shorten the cut.
void untangle(const SurfaceFinder& finder, Array<SurfaceContact>& found);

}  // namespace taut
