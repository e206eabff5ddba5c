// The table of kernels, one a pair of kinds, and the way into and out of their frames.
#include "collision/collide.h"

#include <array>

#include "collision/narrowphase/kernel.h"

namespace taut::collision {
namespace {

// A kernel takes its shapes in one order; swapped says that it is the other one.
struct Entry {
    Kernel kernel;
    bool swapped;
    ApartTest apart;
};

float never_touch(const Pair&, Manifold&) { return 0; }
float ask_the_kernel(const Sides&, const PairCache&) { return kNoAxis; }

constexpr Entry kNone = {never_touch, false, ask_the_kernel};
constexpr Entry kBoxes = {box_box, false, boxes_apart};
constexpr Entry kPolytopes = {polytope_polytope, false, polytopes_apart};
constexpr Entry kRounds = {round_round, false, ask_the_kernel};
constexpr Entry kOnRound = {polytope_round, false, ask_the_kernel};
constexpr Entry kRoundOn = {polytope_round, true, ask_the_kernel};
constexpr Entry kOnPlane = {core_plane, false, ask_the_kernel};
constexpr Entry kUnder = {core_plane, true, ask_the_kernel};
constexpr Entry kConvex = {convex_convex, false, ask_the_kernel};
constexpr Entry kConvexOnPlane = {convex_plane, false, ask_the_kernel};
constexpr Entry kUnderConvex = {convex_plane, true, ask_the_kernel};

// Rows and columns: plane, box, sphere, capsule, hull, cylinder, cone, tapered capsule. Surfaces have none, see
// collide_parts().
constexpr std::array<std::array<Entry, kShapeKinds>, kShapeKinds> kKernels = {{
    {kNone, kUnder, kUnder, kUnder, kUnder, kUnderConvex, kUnderConvex, kUnderConvex},
    {kOnPlane, kBoxes, kOnRound, kOnRound, kPolytopes, kConvex, kConvex, kConvex},
    {kOnPlane, kRoundOn, kRounds, kRounds, kRoundOn, kConvex, kConvex, kConvex},
    {kOnPlane, kRoundOn, kRounds, kRounds, kRoundOn, kConvex, kConvex, kConvex},
    {kOnPlane, kPolytopes, kOnRound, kOnRound, kPolytopes, kConvex, kConvex, kConvex},
    {kConvexOnPlane, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex},
    {kConvexOnPlane, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex},
    {kConvexOnPlane, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex, kConvex},
}};

const Entry& entry_of(const Shape& a, const Shape& b) { return kKernels[size_t(a.kind)][size_t(b.kind)]; }

// The difference of positions in double, all else in single precision.
Vec3f apart_of(const Placement& a, const Placement& b) { return (b.position - a.position).cast<float>(); }

// Where b lies as a sees it.
Pose relative(const Placement& a, const Placement& b, const Vec3f& apart) {
    return {a.rotation.transpose() * b.rotation, a.rotation.transpose() * apart};
}

// From the first shape's frame to axes of the world.
void to_world(const Mat3f& rotation, Manifold& manifold) {
    manifold.normal = rotation * manifold.normal;
    for (int i = 0; i < manifold.count; ++i) manifold.points[i].position = rotation * manifold.points[i].position;
}

}  // namespace

float held_apart(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, const PairCache& cache) {
    if (has_parts(a) || has_parts(b)) return kNoAxis;
    return entry_of(a, b).apart({a, b, at_a, at_b, apart_of(at_a, at_b)}, cache);
}

float collide(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, float margin,
              PairCache& cache, Manifold& out) {
    const Wanted wanted(margin, out);
    out.count = 0;
    if (has_parts(a) || has_parts(b)) return 0;
    const Entry& entry = entry_of(a, b);
    const Vec3f apart = apart_of(at_a, at_b);
    const float held = entry.apart({a, b, at_a, at_b, apart}, cache);
    if (held > margin) return held;
    if (!entry.swapped) {
        const float gap = entry.kernel({a, b, at_a, at_b, relative(at_a, at_b, apart), wanted, cache}, out);
        if (out.count > 0) to_world(at_a.rotation, out);
        return gap;
    }
    const float gap = entry.kernel({b, a, at_b, at_a, relative(at_b, at_a, -apart), wanted, cache}, out);
    if (out.count == 0) return gap;
    to_world(at_b.rotation, out);
    out.normal = -out.normal;
    for (int i = 0; i < out.count; ++i) out.points[i].position += apart;
    return 0;
}

}  // namespace taut::collision
