// The collision room's only header: shapes and boxes in, pairs and contact manifolds out.
//
// Frames: a placement is the pose of a body's frame in the world. Contact points are relative to body a's
// origin, world axes, so that single precision suffices anywhere in the world.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/math.h"
#include "base/memory.h"

namespace taut::collision {

// ---------------------------------------------------------------- shapes

struct Hull;          // vertices, merged faces, edges with their two faces; see hull.h
struct Surface;       // triangles with their neighbours, of a mesh or a height field; see surface.h
struct DistanceGrid;  // signed distance of a closed mesh, sampled; see distance_grid.h

enum class ShapeKind : uint8_t { plane, box, sphere, capsule, hull, cylinder, cone, tapered_capsule, surface };
constexpr int kShapeKinds = 9;
constexpr int kConvexKinds = kShapeKinds - 1;  // that collide() knows; the surface comes last

// Round shapes lie along y, from -half length to +half length; a capsule's ends are the centres of its balls.
struct Shape {
    ShapeKind kind = ShapeKind::sphere;
    // [m]. box: half extents; sphere: (radius,,); capsule, cylinder: (radius, half length,); cone: (radius of the base
    // at -half length, half length,); tapered capsule: (radius at -half length, half length, radius at +half length);
    // plane: unit normal [1]
    Vec3f size = Vec3f::Zero();
    std::shared_ptr<const Hull> hull;                  // hull only
    std::shared_ptr<const Surface> surface = nullptr;  // surface only; size: its scale along x, y, z, none of them 0
    std::shared_ptr<const DistanceGrid> distance = nullptr;  // of a surface, where the host had it sampled
};

// But for hull, surface and distance, which the host's shapes hold.
template <class Visitor, Like<Shape> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [kind, size, hull, surface, distance] = of;
    TAUT_FIELDS(visitor, kind, size);
}

inline bool is_convex(const Shape& shape) { return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::surface; }

struct MassProperties {
    double mass = 0;             // [kg]
    Vec3 centre = Vec3::Zero();  // [m], body frame
    Sym3 inertia;                // about the centre, body axes [kg m^2]
};

// What is built holds memory of the one it is built with, which outlives it, and so does what the work takes meanwhile.
// Builds the hull of points [m]: at most max_vertices of them (never more than 64), coplanar faces merged as long as
// they stay convex, vertices and faces in an order that depends on the points alone. Faces may lie off the points by
// 2e-4 of their extent. Returns null and a reason (static text) for fewer than 4 points, non-finite points, or points
// thinner than thickness [m].
std::shared_ptr<const Hull> build_hull(std::span<const Vec3f> points, int max_vertices, float thickness,
                                       const char** reason, Memory& memory);
// The hull with its points multiplied, axis by axis; negative factors mirror it. Faces and their corners stay the same.
// Null and a reason if it came out thinner than thickness [m].
std::shared_ptr<const Hull> scale_hull(const Hull& hull, const Vec3f& factors, float thickness, const char** reason,
                                       Memory& memory);
std::span<const Vec3f> hull_vertices(const Hull& hull);
uint32_t hull_triangle_count(const Hull& hull);

// Takes the corners of triangles, three a triangle, outward counter-clockwise.
class PointSink {
public:
    virtual void take(const Vec3f& point) = 0;

protected:
    ~PointSink() = default;
};
void hull_triangles(const Hull& hull, PointSink& points);

struct SurfaceCounts {
    uint32_t triangles = 0, facets = 0;
    uint32_t without_area = 0, duplicates = 0;  // triangles left out
};

// Builds a mesh of finite vertices [m] and valid indices, three a triangle, outward counter-clockwise. Vertices at the
// same place but for rounding become one; triangles thinner than 1e-5 of their longest edge and second copies are left
// out. Null if none remains. two_sided: bodies meet triangles from behind as well.
std::shared_ptr<const Surface> build_mesh(std::span<const Vec3f> vertices, std::span<const uint32_t> indices,
                                          bool two_sided, Memory& memory);

struct HeightGrid {
    uint32_t rows, columns;          // at least 2 each
    float spacing_x, spacing_z;      // between columns, between rows [m]
    std::span<const float> heights;  // row by row [m]; not-a-number: a hole
};

// Builds a height field, which looks along +y. Null if no cell has three heights.
std::shared_ptr<const Surface> build_height_field(const HeightGrid& grid, Memory& memory);

SurfaceCounts surface_counts(const Shape& shape);
// In the frame of a shape that is a surface.
void surface_triangles(const Shape& shape, PointSink& points);

// Exact for each kind, by polyhedral integration for hulls. A plane and a surface have no mass.
MassProperties mass_properties(const Shape& shape, double density);

// ---------------------------------------------------------------- bounds and pairs

struct Placement {
    Vec3 position = Vec3::Zero();        // of the body's origin [m]
    Mat3f rotation = Mat3f::Identity();  // world from body
};
template <class Visitor, Like<Placement> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [position, rotation] = of;
    TAUT_FIELDS(visitor, position, rotation);
}

struct Box {
    Vec3f lo, hi;  // [m], world
};
template <class Visitor, Like<Box> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [lo, hi] = of;
    TAUT_FIELDS(visitor, lo, hi);
}

// Tight axis-aligned box (exact support of the shape), not grown. A plane's box is +-1e9 on every side.
Box bounds(const Shape& shape, const Placement& placement);

// A box that goes along a line, looking for others: a ray, a shape's sweep, or one that stays where it is.
struct Probe {
    Vec3 from, along;                           // [m]: the way of its middle, of length 0 where it stays
    Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();  // its box about the middle [m]
    double limit = 1;                           // what lies further along, in parts of the way, does not matter
    double reach = 0;                           // how far around the box to look as well [m]
};

// What a probe comes by. It may lower the probe's limit, below 0 to end the search, and reach.
class Visitor {
public:
    virtual void visit(uint32_t id, Probe& probe) = 0;

protected:
    ~Visitor() = default;
};

// Dynamic tree of fat boxes with sorted pairs. Ids are the caller's node numbers.
class Broadphase {
public:
    explicit Broadphase(Memory& memory);
    ~Broadphase();
    Broadphase(const Broadphase&) = delete;
    Broadphase& operator=(const Broadphase&) = delete;

    // moves: false for static bodies. Two ids that both do not move never pair, nor do two grains: each of these kinds
    // has a tree of its own. One that is there already becomes what it is said to be.
    void add(uint32_t id, const Box& tight, bool moves, bool grain = false);
    void remove(uint32_t id);
    // Re-inserts the leaf if the tight box (already grown by the contact margin) left its fat box; displacement [m]
    // is the motion to expect, by which the new fat box reaches ahead.
    void update(uint32_t id, const Box& tight, const Vec3f& displacement);
    // Whether its fat box still holds a tight one.
    bool holds(uint32_t id, const Box& tight) const;

    // Brings the pair list up to date: find_pairs() for ranges that cover [0, start_refresh()), any number at once,
    // which takes no memory, then finish_refresh(). Returns true if the list changed.
    uint32_t start_refresh();
    void find_pairs(uint32_t begin, uint32_t end);
    bool finish_refresh();
    // All of this by the caller alone.
    bool refresh_pairs();
    // Sorted keys (smaller id << 32 | larger id) of overlapping fat boxes; independent of the tree's history.
    std::span<const uint64_t> pairs() const;
    // What the last refresh added to them and took away, sorted likewise.
    std::span<const uint64_t> arrived() const;
    std::span<const uint64_t> departed() const;
    // Of what it worked with, after which the last two are empty.
    void let_go();
    // Gives back the room of pairs that are no more, if that is most of it.
    void trim() noexcept;

    // What of it is state: the tree follows.
    struct FatBox {
        Box box = {Vec3f::Zero(), Vec3f::Zero()};
        bool moves = false;
        bool grain = false;
        bool stray = false;  // the collider may be outside; see note_stray()
        bool stale = false;  // its pairs must be found again; listed in Boxes::stale
    };
    struct Boxes {
        explicit Boxes(Memory& memory) : of(memory), stale(memory), pairs(memory) {}

        Array<FatBox> of;       // by id
        Array<uint32_t> stale;  // ids, of those that are gone as well
        Array<uint64_t> pairs;  // sorted keys
    };
    Boxes& boxes();
    const Boxes& boxes() const;
    // Once Boxes hold other ones: the tree's memory for them, which may throw std::bad_alloc, and then its leaves, of
    // the ids for which lives(id).
    void reserve_tree();
    template <class Lives>
    void rebuild(const Lives& lives) {
        start_rebuild();
        for (uint32_t id = 0; id < boxes().of.size(); ++id) set_leaf(id, lives(id));
    }

    // Where bodies are after a step may be outside the fat boxes that foresaw it: such strays keep their leaves, on
    // which the pairs depend, but every probe visits them. Noted anew after each step: those that it does not hold.
    void clear_strays();
    void note_stray(uint32_t id);
    // Visits each id whose box the probe may meet, roughly the nearest first; in an order that depends on the tree's
    // history. Any number of threads at once. Of all kinds, or some: bits.
    static constexpr uint8_t kMoving = 1, kStanding = 2, kGrains = 4, kAll = 7;
    void visit(Probe probe, Visitor& visitor, uint8_t kinds = kAll) const;

private:
    struct State;
    void start_rebuild();
    void set_leaf(uint32_t id, bool lives);

    State* state_;
    Memory& memory_;
};
template <class Visitor, Like<Broadphase::FatBox> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [box, moves, grain, stray, stale] = of;  // stale: as listed
    TAUT_FIELDS(visitor, box, moves, grain, stray);
}
template <class Visitor, Like<Broadphase::Boxes> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [boxes, stale, pairs] = of;  // boxes: rows of the colliders, world.h
    TAUT_FIELDS(visitor, pairs);
    TAUT_ASIDE(visitor, stale);  // what the next refresh looks at anew, be it that nothing came of it
}

// ---------------------------------------------------------------- contacts

struct ContactPoint {
    Vec3f position;    // midway between the surfaces, relative to a's origin, world axes [m]
    float separation;  // along the normal [m], negative when overlapping
    uint32_t feature;  // the same pair of features keeps its id over frames
};
template <class Visitor, Like<ContactPoint> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [position, separation, feature] = of;
    TAUT_FIELDS(visitor, position, separation, feature);
}

struct Manifold {
    Vec3f normal;  // unit, from a to b, world axes
    int count = 0;
    ContactPoint points[4];
};
template <class Visitor, Like<Manifold> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [normal, count, points] = of;
    TAUT_FIELDS(visitor, normal, count);
    for (int k = 0; k < count; ++k) TAUT_FIELDS(visitor, points[k]);
}

// What a pair remembers between calls: the axis that last separated or touched, and the relative pose it was found at.
// Zero is a fresh pair; the result of collide() may depend on it only within the tolerance of the axis choice, and it
// is part of the state hash. It belongs to the pair in one order of a and b.
struct PairCache {
    uint32_t words[8] = {0, 0, 0, 0, 0, 0, 0, 0};
};

// Contact points of two shapes that are closer than margin [m] (speculative points have positive separation).
// At most four points, chosen for area and depth. The kinds may come in any order; two planes never touch. A plane
// is best b: positions are relative to a, and a plane's own origin may be far off.
// out is on entry what was found the last time (count 0: nothing): of more than four points those tend to stay that
// were. Of it, normal and points beyond count are written only where count > 0.
// Returns, where there are no points, how far apart the two are at least [m], margin or more; 0 where that is not
// known.
float collide(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, float margin,
              PairCache& cache, Manifold& out);

// How far the axis that parted two shapes last, by the cache, holds them apart [m]; negative where it does not, or
// there is none. Costs less than collide(), which begins with it.
float held_apart(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, const PairCache& cache);

// Whether a shape touches with parts of its own; collide() finds nothing on it.
inline bool has_parts(const Shape& shape) { return shape.kind == ShapeKind::surface; }

// A part of a surface in touch: a facet (triangles in one plane that hang together), a convex edge or a vertex.
struct PartManifold {
    uint32_t part;  // never 0; the same part keeps its number
    Manifold manifold;

    bool is_face() const { return part < 1u << 30; }
};

// At most so many parts touch at a time: the deepest.
constexpr int kMaxParts = 16;

struct Parts {
    explicit Parts(Memory& memory) : found(memory), near(memory), order(memory) {}

    Array<PartManifold> found;  // sorted by part
    Array<uint32_t> near;       // scratch: triangles that the body's box meets
    Array<uint64_t> order;      // scratch: facet << 32 | triangle, sorted
};

// Contact points of a convex shape and one that has_parts, in either order, into parts.found; otherwise as collide().
// Neighbouring facets shadow each other: a seam in a flat surface, and a concave edge, touch nothing.
// Facets are met from the front: one that lies more than half of the body's depth in front of its centre is passed
// by, and so is what a shallower part pushes out of sooner.
void collide_parts(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, float margin,
                   Parts& parts);

// General convex pair by libccd's MPR on support functions with face clipping: an oracle for tests, and a yardstick for
// the kernels. Same contract as collide(), but for planes, which have no support; the normal
// and depth are MPR's: the depth is not the least, on the mean some 10 % more. Round shapes get one point.
void collide_support_mapped(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, float margin,
                            Manifold& out);

// A point of a shape that stands out, as a ball: corners of polytopes, ends of the axes of spheres and capsules, of a
// cone its apex, and points of rims; vertices at sharp edges of surfaces.
struct Corner {
    Vec3f at;      // in the shape's frame [m]
    float radius;  // [m]
    uint32_t number;
};
// Those within a box, in the shape's frame, into out.
void list_corners(const Shape& shape, const Box& near, Array<Corner>& out);

// ---------------------------------------------------------------- queries

// Where a ray or a shape on its way meets a surface. All in the world.
struct Hit {
    double fraction = 0;  // of the way
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  // unit, out of the surface; of a ray that starts inside, against the ray
    bool inside = false;         // it overlaps at the start: fraction 0
    uint32_t feature = 0;        // triangle of a mesh; 0
};

// A ray from a point as far as along [m]; hits beyond the fraction limit do not matter.
bool cast_ray(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit, Hit& out);

// A convex shape (any but a plane) goes from its placement as far as along [m], without turning, until it is within
// 1e-5 of the smaller shape's inner radius of the other.
bool cast_shape(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still, const Placement& at,
                double limit, Hit& out);

// A shape under way with its body: at constant velocities from its placement.
struct Motion {
    Placement at;
    Vec3 centre;          // that it turns about [m]
    Vec3 velocity, spin;  // of that centre, world axes [m/s, rad/s]
    double reach;         // no point of the shape's core is further from the centre: spin_radius() [m]

    Placement after(double time) const;
    // The same from then on.
    Motion from(double time) const { return {after(time), centre + time * velocity, velocity, spin, reach}; }
    Vec3 place_after(double time) const;  // of the shape's origin
    // By how much the way of that leaves its chord until a time [m].
    double bend(double time) const;
    // No point of the core is further from the shape's origin [m].
    double own_reach() const { return reach - (at.position - centre).norm(); }
};

// How far a point of the shape's core (which a ball grows to the shape) can be from a point that is as far as lever [m]
// from the shape's origin [m].
double spin_radius(const Shape& shape, double lever);

// Radius of the ball that grows the core to the shape [m]: what of the shape does not turn with it.
double ball_radius(const Shape& shape);

// Whether the shape has circles about its y axis, on which contacts stay in place while it rolls: of cylinders, cones
// and tapered capsules.
bool rolls(const Shape& shape);
// About where that ball, and the one inside the shape, have their middle, in the shape's frame.
Vec3 middle(const Shape& shape);

// Radius of a ball inside the shape [m]; 0 of planes and surfaces, which a body that touches them from behind is past.
double thickness(const Shape& shape);

// When two moving shapes come as near as reach [m], if by horizon [s], and if their ways then lead deeper into each
// other than depth [m], for what grazes does not meet: the moment [s], 0 if they are as near at the start; infinite if
// they do not. Not two planes or surfaces.
double find_impact(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                   double depth, double horizon);

// The least distance of two shapes, in the world.
struct Gap {
    double distance = 0;         // [m]; negative: the least push that parts them
    Vec3 normal = Vec3::Zero();  // unit, from a to b
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
};
// a is not a plane.
bool overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
Gap find_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
// Whether a comes within a radius [m] of a triangle, of corners as seen from the origin of a, along world axes.
bool near_triangle(const Shape& a, const Placement& at_a, const Vec3 (&corner)[3], double radius);
// a is a point.
bool contains(const Shape& b, const Placement& at_b, const Vec3& point);
Gap find_gap(const Vec3& point, const Shape& b, const Placement& at_b);

// Asserts that the Bullet library linked has single precision, as this room was compiled. False: refuse to run.
bool precision_matches();

}  // namespace taut::collision
