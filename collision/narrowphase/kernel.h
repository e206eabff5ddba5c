// One kernel a pair of kinds. Kernels work in the frame of their first shape, in single precision.
#pragma once

#include "collision/collide.h"
#include "collision/manifold.h"

namespace taut::collision {

struct Pose {
    Mat3f rotation;
    Vec3f position;

    Vec3f operator*(const Vec3f& point) const { return rotation * point + position; }
};

struct Pair {
    const Shape& a;
    const Shape& b;
    const Placement& at_a;
    const Placement& at_b;
    Pose b_in_a;  // takes points of b's frame to a's
    Wanted wanted;
    PairCache& cache;
};

// Two shapes as they stand in the world.
struct Sides {
    const Shape& a;
    const Shape& b;
    const Placement& at_a;
    const Placement& at_b;
    Vec3f apart;  // from a's origin to b's, world axes [m]
};

// How far the axis that parted the pair last holds it apart [m]; negative where it does not, or there is none. Asked
// before the kernel, in the world: the pair's own frame costs more than the answer.
using ApartTest = float (*)(const Sides& sides, const PairCache& cache);
constexpr float kNoAxis = -1e30f;

float boxes_apart(const Sides& sides, const PairCache& cache);
float polytopes_apart(const Sides& sides, const PairCache& cache);

// Fills out (empty on entry) in a's frame: normal from a to b, positions in a's axes about a's origin. Returns, where
// it finds no points, how far apart the two are at least [m]; 0 where that is not known.
using Kernel = float (*)(const Pair& pair, Manifold& out);

float box_box(const Pair& pair, Manifold& out);
float polytope_polytope(const Pair& pair, Manifold& out);  // box or hull against box or hull
float polytope_round(const Pair& pair, Manifold& out);     // box or hull against sphere or capsule
float round_round(const Pair& pair, Manifold& out);        // sphere or capsule against sphere or capsule
float core_plane(const Pair& pair, Manifold& out);         // box, sphere, capsule or hull against a plane
float convex_convex(const Pair& pair, Manifold& out);      // any two kinds but a plane
float convex_plane(const Pair& pair, Manifold& out);       // any kind but a plane against a plane

// Takes a manifold from b's frame, with its normal from b to a, to a's frame.
inline void move_to_a(const Pose& b_in_a, Manifold& manifold) {
    manifold.normal = -(b_in_a.rotation * manifold.normal);
    for (int i = 0; i < manifold.count; ++i) manifold.points[i].position = b_in_a * manifold.points[i].position;
}

// Which axis a pair chooses. Face contacts stand on more points, so an edge pair must separate by clearly more; what
// was chosen last frame keeps a small advantage, lest the ids flicker. size: of the smaller shape [m].
struct Preference {
    float slop, keep;

    explicit Preference(float size) : slop(std::min(0.0025f, 0.1f * size)), keep(0.4f * slop) {}

    // By how much an edge pair must separate more than a face, at least.
    float ask(bool was_edge) const { return was_edge ? slop - keep : slop; }
    bool edge_wins(float edge, float face, bool was_edge) const {
        return edge > face + ask(was_edge) && edge > 0.9f * face + 0.2f * ask(was_edge);
    }
    // The incident face may lie beside the reference face where edges are what meets: then the clipped face shows
    // nothing of the overlap (found: its deepest point).
    bool face_misses(float found, float edge, float face) const { return edge > face - slop && found > edge + slop; }
};

}  // namespace taut::collision
