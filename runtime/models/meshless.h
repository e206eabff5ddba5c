// Solids without a mesh: what a sample of one knows of the vertices about it, and samples for those that have none.
//
// A sample takes the 8 nearest vertices by w_n = (1 - (d_n / reach)^2)^2, 0 beyond the reach: the distance of the
// ninth, so that a fit goes over smoothly from vertex to vertex, or the radius, where that is less. On a cubic lattice
// that of a sample a quarter of a cell from a vertex has its weighted mean where the sample is, as trilinear weights
// do.
//
// Made are samples about each vertex, one in each octant of the axes that is not empty or flat: half way to the mean of
// the up to 8 vertices nearest to it there by their largest coordinate, itself with them, and with an eighth of the
// volume of a brick of corners of the same second moments, 8 sqrt(det M): on lattices of bricks these are 8 samples a
// cell and its volume. None reaches beyond the vertices that it was made of: samples at the boundary, where the ninth
// is far, weigh as those within do.
#pragma once

#include <limits>

#include "models/neighbours.h"

namespace taut {

constexpr uint32_t kSampleNodes = 8;

struct Sample {
    Vec3 at;                                                 // of the rest shape [m]
    double volume;                                           // [m^3]
    double reach = std::numeric_limits<double>::infinity();  // at most [m]
};

struct SampleNodes {
    uint32_t vertex[kSampleNodes];
    double weight[kSampleNodes];  // not negative
};

// Of a solid of at least so many vertices.
SampleNodes nodes_of_sample(const Neighbours& neighbours, const Vec3& at, double reach);

// Twice the mean distance of vertices to their sixth-nearest other one [m].
double usual_radius(std::span<const Vec3> rest, const Neighbours& neighbours);

void make_samples(std::span<const Vec3> rest, const Neighbours& neighbours, double radius, Array<Sample>& out);

}  // namespace taut
