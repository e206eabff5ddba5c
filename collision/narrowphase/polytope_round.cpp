// Box or hull against sphere or capsule: the distance of the axis from the polytope less the radius, or the least
// push where the axis is inside; two points where a capsule lies on a face. All in the polytope's frame.
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/kernel.h"

namespace taut::collision {
namespace {

// A capsule lies on a face whose normal is within 11 degrees of the least distance's.
constexpr float kLies = 0.98f;

// Ids of the points: one alone, or the ends of the stretch on a face.
enum : uint32_t { kAlone = 1, kFirstEnd = 2, kSecondEnd = 3 };

// How the axis lies to every face.
struct Faces {
    float from[kMaxFaces], to[kMaxFaces];  // height of the axis' ends [m]
    int best = 0;                          // the face that separates the whole axis most
    float separation = -1e30f;             // of the axis from it
    bool inside = false;                   // part of the axis is in the polytope
};

bool above(const Faces& faces, int face) { return faces.from[face] > 0 || faces.to[face] > 0; }

// False if one face alone is further than reach; cached is the face that was, and is tried first.
bool find_faces(const Polytope& polytope, const Segment& axis, float reach, uint32_t cached, Faces& faces) {
    const Vec3f end = axis.at(1);
    if (cached < polytope.faces.size()) {
        const Face& face = polytope.faces[cached];
        faces.best = int(cached);
        faces.separation = std::min(face.normal.dot(axis.from), face.normal.dot(end)) - face.offset;
        if (faces.separation > reach) return false;
        faces.separation = -1e30f;
    }
    float enter = 0;
    float leave = 1;
    for (size_t i = 0; i < polytope.faces.size(); ++i) {
        const Face& face = polytope.faces[i];
        const float from = face.normal.dot(axis.from) - face.offset;
        const float to = face.normal.dot(end) - face.offset;
        faces.from[i] = from;
        faces.to[i] = to;
        const float lower = std::min(from, to);
        if (lower > faces.separation) {
            faces.separation = lower;
            faces.best = int(i);
            if (lower > reach) return false;
        }
        if (from > 0 && to > 0) leave = -1;
        if (from > 0 && to <= 0) enter = std::max(enter, from / (from - to));
        if (to > 0 && from <= 0) leave = std::min(leave, from / (from - to));
    }
    faces.inside = enter <= leave;
    return true;
}

// Where and in which direction the axis is nearest to the polytope.
struct Nearest {
    float separation = 1e30f;  // of the axis from the surface [m]
    float t = 0;               // parameter on the axis
    Vec3f normal = Vec3f::Zero();
};

bool over(const Polytope& polytope, const Face& face, const Vec3f& p) {
    const float x = face.u.dot(p);
    const float y = face.v.dot(p);
    for (const Side& side : polytope.sides_of(face)) {
        if (side.x * x + side.y * y > side.offset) return false;
    }
    return true;
}

// Outside, the nearest features are an end of the axis over a face, or the axis and an edge; and one of an
// edge's two faces then sees an end of the axis above itself.
Nearest nearest_outside(const Polytope& polytope, const Segment& axis, const Faces& faces) {
    Nearest nearest;
    for (size_t i = 0; i < polytope.faces.size(); ++i) {
        const Face& face = polytope.faces[i];
        for (const float t : {0.0f, 1.0f}) {
            // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): find_faces filled as many as there are
            const float height = t == 0 ? faces.from[i] : faces.to[i];
            if (height > 0 && height < nearest.separation && over(polytope, face, axis.at(t))) {
                nearest = {height, t, face.normal};
            }
        }
    }
    // No distance is less than what one face alone separates.
    if (nearest.separation <= faces.separation) return nearest;
    float least = nearest.separation * nearest.separation;
    bool on_edge = false;
    for (const Edge& edge : polytope.edges) {
        if (!above(faces, edge.left) && !above(faces, edge.right)) continue;
        const Segment line = {polytope.vertices[edge.from], polytope.direction(edge)};
        const SegmentPair points = nearest_points(line, axis);
        const Vec3f between = axis.at(points.t) - line.at(points.s);
        const float squared = between.squaredNorm();
        if (squared < least) {
            least = squared;
            nearest.t = points.t;
            nearest.normal = between;
            on_edge = true;
        }
    }
    if (!on_edge) return nearest;
    nearest.separation = std::sqrt(least);
    nearest.normal /= std::max(nearest.separation, 1e-20f);
    return nearest;
}

// Inside, the least push is along a face, or across the axis and an edge whose arc of normals the axis' plane of
// normals crosses. What is across a nearly parallel edge rounding decides: all corners are asked before it is believed.
Nearest nearest_inside(const Polytope& polytope, const Segment& axis, const Faces& faces) {
    const size_t best = size_t(faces.best);
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): as above
    Nearest nearest = {faces.separation, faces.from[best] < faces.to[best] ? 0.0f : 1.0f, polytope.faces[best].normal};
    for (const Edge& edge : polytope.edges) {
        const Face& left = polytope.faces[edge.left];
        const Face& right = polytope.faces[edge.right];
        if (left.normal.dot(axis.step) * right.normal.dot(axis.step) >= 0) continue;
        Vec3f normal = polytope.direction(edge).cross(axis.step);
        if (normal.dot(left.normal + right.normal) < 0) normal = -normal;
        normal.normalize();
        const float separation = normal.dot(axis.from - polytope.vertices[edge.from]);
        if (separation > nearest.separation + 1e-4f &&
            normal.dot(axis.from) - highest(polytope, normal) > nearest.separation + 1e-4f) {
            const Segment line = {polytope.vertices[edge.from], polytope.direction(edge)};
            nearest = {separation, nearest_points(line, axis).t, normal};
        }
    }
    return nearest;
}

struct RoundSide {
    Segment axis;  // in the polytope's frame
    float radius;
};

// Midway between the polytope's surface and the round one along the normal; height of the axis' point.
void add_point(const RoundSide& round, float t, float height, uint32_t feature, Manifold& out) {
    out.points[out.count++] = {round.axis.at(t) - out.normal * (0.5f * (height + round.radius)), height - round.radius,
                               feature};
}

// The stretch of the axis over the face; false if none is, or none as deep as the nearest point.
bool lie_on_face(const Polytope& polytope, const RoundSide& round, const Faces& faces, const Nearest& nearest,
                 float margin, Manifold& out) {
    size_t best = 0;
    float alignment = -1;
    for (size_t i = 0; i < polytope.faces.size(); ++i) {
        const float dot = polytope.faces[i].normal.dot(nearest.normal);
        if (dot > alignment) {
            alignment = dot;
            best = i;
        }
    }
    if (alignment < kLies) return false;
    const Face& face = polytope.faces[best];
    const float x = face.u.dot(round.axis.from), dx = face.u.dot(round.axis.step);
    const float y = face.v.dot(round.axis.from), dy = face.v.dot(round.axis.step);
    float enter = 0;
    float leave = 1;
    for (const Side& side : polytope.sides_of(face)) {
        const float from = side.x * x + side.y * y - side.offset;
        const float to = from + side.x * dx + side.y * dy;
        if (from > 0 && to > 0) return false;
        if (from > 0) enter = std::max(enter, from / (from - to));
        if (to > 0) leave = std::min(leave, from / (from - to));
    }
    if (enter >= leave) return false;
    const float slope = faces.to[best] - faces.from[best];
    const float first = faces.from[best] + slope * enter;
    const float second = faces.from[best] + slope * leave;
    if (std::min(first, second) > nearest.separation + Preference(round.radius).slop) return false;
    out.normal = face.normal;
    if (first - round.radius <= margin) add_point(round, enter, first, kFirstEnd, out);
    if (second - round.radius <= margin) add_point(round, leave, second, kSecondEnd, out);
    return out.count > 0;
}

}  // namespace

float polytope_round(const Pair& pair, Manifold& out) {
    const PolytopeOf storage(pair.a);
    const Polytope& polytope = storage.view();
    const Segment own = round_axis(pair.b);
    const RoundSide round = {{pair.b_in_a * own.from, pair.b_in_a.rotation * own.step}, round_radius(pair.b)};

    // Word 0 of the cache: the face that separated most.
    Faces faces;
    const bool near = find_faces(polytope, round.axis, round.radius + pair.wanted.margin, pair.cache.words[0], faces);
    pair.cache.words[0] = uint32_t(faces.best);
    if (!near) return faces.separation - round.radius;

    Nearest nearest;
    if (!faces.inside) nearest = nearest_outside(polytope, round.axis, faces);
    // Touching axes have no direction of their own.
    if (faces.inside || nearest.separation < 1e-4f * round.radius) {
        nearest = nearest_inside(polytope, round.axis, faces);
    }
    if (nearest.separation - round.radius > pair.wanted.margin) return nearest.separation - round.radius;
    const bool lies =
        round.axis.step.squaredNorm() > 0 && lie_on_face(polytope, round, faces, nearest, pair.wanted.margin, out);
    if (lies) return 0;
    out.normal = nearest.normal;
    add_point(round, nearest.t, nearest.separation, kAlone, out);
    return 0;
}

}  // namespace taut::collision
