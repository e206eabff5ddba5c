// From features in touch to at most four contact points.
#pragma once

#include <span>

#include "collision/collide.h"
#include "collision/polytope.h"

namespace taut::collision {

// A point on the incident feature in the reference face's coordinates: x along u, y along v, height z above it [m].
struct ClipPoint {
    float x, y, z;
    uint32_t id;
};
constexpr uint32_t kSideLine = 64;

// Convex, in order around. A cut by one of at most 64 sides adds at most one point; the rest is room for rounding.
constexpr int kMaxClip = 2 * kMaxVertices + 8;
struct Polygon {
    int count = 0;
    ClipPoint points[kMaxClip];
};

// The plane normal . p = offset with tangents u, v.
struct ReferencePlane {
    Vec3f u, v, normal;
    float offset;
};

// Cuts away what lies further than slack [m] outside of any side. Points within slack stay as they are, so that flush
// faces keep the ids of the incident corners while they jitter. On entry a point's id is the line from it to
// the next point, below kSideLine; on return it is the two lines that meet there, 14 bits: the incident face's
// edges, or kSideLine + a side.
void clip(Polygon& polygon, std::span<const Side> sides, float slack);

// The slack for a reference face of this size [m].
inline float flush_slack(float size) { return std::min(1e-3f, 0.01f * size); }

// Which points a contact gets.
struct Wanted {
    float margin;  // those that are closer [m]
    // If there are more than four: those that it had, unless others bear it better by far; see add_points().
    int had = 0;
    uint32_t features[4];

    Wanted(float closer) : margin(closer) {}
    Wanted(float closer, const Manifold& before) : margin(closer), had(before.count) {
        for (int i = 0; i < had; ++i) features[i] = before.points[i].feature;
    }
};

// Appends the polygon's points that are wanted, at most four: the supports of the plane's four diagonals, and the
// deepest where it is clearly deeper. Four that the contact had stay, while they reach nearly as far and as deep: with
// each other choice the body would tilt another way, and back again. Positions are midway between plane and point; ids
// name base and the two lines that meet. The diagonals go down by slope, where the points are not those of one face.
void add_points(const Polygon& polygon, const ReferencePlane& plane, uint32_t base, const Wanted& wanted, Manifold& out,
                float slope = 0);

// Corners of a shape that touch a plane, up . p = -height in the shape's frame: as add_points, of those lower than
// the margin less the radius that they are grown by, with the normal down. Returns how high the lowest is [m].
float touch_plane(std::span<const Vec3f> corners, float radius, const Vec3f& up, float height, const Wanted& wanted,
                  Manifold& out);

// Keeps the four points that add_points would take of them, in no particular order.
void reduce(Polygon& points);

// Edges whose normal is so near to a face's cross nearly in its plane: cosine.
constexpr float kSamePlane = 0.9f;

// Two edges that cross nearly in a face's plane are one end of that face's contact: the body rolls onto the other end
// within the step. Adds the face's points that lie away from the crossing to the edges' manifold.
void add_beside(const Manifold& face, Manifold& edges);

// Deepest separation of a manifold [m]; 1e30 for none.
float deepest(const Manifold& manifold);

// Ids by what touches: see also add_points, whose bases leave the lower 14 bits free.
constexpr uint32_t face_base(bool reference_on_b, int reference, int incident) {
    return (uint32_t(reference_on_b) << 28) | (uint32_t(reference) << 21) | (uint32_t(incident) << 14);
}
constexpr uint32_t edge_feature(int edge_a, int edge_b) {
    return (1u << 30) | (uint32_t(edge_a) << 8) | uint32_t(edge_b);
}
constexpr uint32_t vertex_feature(int vertex) { return (2u << 30) | uint32_t(vertex); }

}  // namespace taut::collision
