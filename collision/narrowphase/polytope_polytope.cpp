// Box or hull against box or hull: the axis that separated or touched last frame, else all axes; then face
// clipping, or one point between two edges.
#include <bit>
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/polytope_axes.h"

namespace taut::collision {
namespace {

// ---------------------------------------------------------------- cache

// A touching pair keeps its axis until b moved this far in a's frame [m] since all axes were tried.
constexpr float kStill = 0.005f;

// Two columns of the rotation, 16 bits an entry: |dc0|^2 + |dc1|^2 bounds the squared angle of the turn.
struct Kept {
    Axis axis;
    bool touching = false;
    Vec3f centre = Vec3f::Zero();  // of b in a's frame
    int16_t columns[6] = {};
};

int16_t quantised(float x) { return int16_t(std::floor(x * 32767.0f + 0.5f)); }

// Word 0: kind, i, j, touching a byte each; words 1 to 3 the centre, 4 to 6 the columns.
Kept read(const PairCache& cache) {
    Kept kept;
    const uint32_t word = cache.words[0];
    kept.axis = {AxisKind(word & 3), uint8_t(word >> 8), uint8_t(word >> 16)};
    kept.touching = word >> 24 & 1;
    for (int i = 0; i < 3; ++i) {
        kept.centre[i] = std::bit_cast<float>(cache.words[1 + i]);
        kept.columns[2 * i] = int16_t(cache.words[4 + i] & 0xffff);
        kept.columns[2 * i + 1] = int16_t(cache.words[4 + i] >> 16);
    }
    return kept;
}

void write(Axis axis, bool touching, const PolytopePair& pair, PairCache& cache) {
    const Vec3f centre = pair.b_in_a * pair.b.centre;
    cache.words[0] = uint32_t(axis.kind) | uint32_t(axis.i) << 8 | uint32_t(axis.j) << 16 | uint32_t(touching) << 24;
    for (int i = 0; i < 3; ++i) {
        const uint16_t lo = uint16_t(quantised(pair.b_in_a.rotation(i, 0)));
        const uint16_t hi = uint16_t(quantised(pair.b_in_a.rotation(i, 1)));
        cache.words[1 + i] = std::bit_cast<uint32_t>(centre[i]);
        cache.words[4 + i] = uint32_t(hi) << 16 | lo;
    }
}

bool still(const Kept& kept, const PolytopePair& pair) {
    const float limit = std::min(kStill, 0.02f * pair.size());
    // Written so that not-a-number is motion.
    if (!((pair.b_in_a * pair.b.centre - kept.centre).squaredNorm() <= limit * limit)) return false;
    float turned = 0;
    for (int i = 0; i < 6; ++i) {
        const float change = pair.b_in_a.rotation(i / 2, i % 2) - float(kept.columns[i]) * (1.0f / 32767.0f);
        turned += change * change;
    }
    const float radius = pair.b.outer_radius;
    return turned * radius * radius <= limit * limit;
}

// ---------------------------------------------------------------- contacts

// Everything in the reference polytope's frame; normal out of the reference face.
void clip_faces(const Polytope& reference, int number, const Polytope& other, const Pose& other_in_reference,
                bool reference_on_b, float margin, Manifold& out) {
    const Face& face = reference.faces[size_t(number)];
    const int incident = incident_face(other, other_in_reference.rotation.transpose() * face.normal);
    Polygon polygon;
    for (const int corner : other.loop_of(other.faces[size_t(incident)])) {
        const Vec3f p = other_in_reference * other.vertices[size_t(corner)];
        polygon.points[polygon.count] = {face.u.dot(p), face.v.dot(p), face.normal.dot(p) - face.offset,
                                         uint32_t(polygon.count)};
        ++polygon.count;
    }
    clip(polygon, reference.sides_of(face), flush_slack(reference.inner_radius));
    out.normal = face.normal;
    add_points(polygon, {face.u, face.v, face.normal, face.offset}, face_base(reference_on_b, number, incident), margin,
               out);
}

void edge_point(const PolytopePair& pair, Axis axis, float margin, Manifold& out) {
    const Edge& edge_a = pair.a.edges[axis.i];
    const Edge& edge_b = pair.b.edges[axis.j];
    const Segment a = {pair.a.vertices[edge_a.from], pair.a.direction(edge_a)};
    const Segment b = {pair.b_in_a * pair.b.vertices[edge_b.from], pair.b_in_a.rotation * pair.b.direction(edge_b)};
    const SegmentPair nearest = nearest_points(a, b);
    const Vec3f normal = pair.normal(axis);
    const float separation = normal.dot(b.from - a.from);
    if (separation > margin) return;
    out.normal = normal;
    out.count = 1;
    out.points[0] = {0.5f * (a.at(nearest.s) + b.at(nearest.t)), separation, edge_feature(axis.i, axis.j)};
}

void contact(const PolytopePair& pair, Axis axis, float margin, Manifold& out) {
    if (axis.kind == AxisKind::edges) {
        edge_point(pair, axis, margin, out);
    } else if (axis.kind == AxisKind::face_a) {
        clip_faces(pair.a, axis.i, pair.b, pair.b_in_a, false, margin, out);
    } else {
        clip_faces(pair.b, axis.j, pair.a, pair.a_in_b, true, margin, out);
        move_to_a(pair.b_in_a, out);
    }
}

// The contact of the best axis; returns the axis taken.
Axis choose_contact(const PolytopePair& pair, const Separation& face, const Separation& edges, bool was_edge,
                    float margin, Manifold& out) {
    const Preference preference(pair.size());
    Manifold clipped;
    contact(pair, face.axis, margin, clipped);
    if (!preference.edge_wins(edges.distance, face.distance, was_edge) &&
        !preference.face_misses(deepest(clipped), edges.distance, face.distance)) {
        out = clipped;
        return face.axis;
    }
    contact(pair, edges.axis, margin, out);
    add_beside(clipped, out);
    return edges.axis;
}

}  // namespace

void polytope_polytope(const Pair& shapes, Manifold& out) {
    const PolytopeOf storage_a(shapes.a);
    const PolytopeOf storage_b(shapes.b);
    const PolytopePair pair(storage_a.view(), storage_b.view(), shapes.b_in_a);
    const float margin = shapes.margin;
    const Kept kept = read(shapes.cache);
    const bool known = pair.valid(kept.axis);
    if (known && !kept.touching && pair.distance(kept.axis) > margin) return;
    if (known && kept.touching && still(kept, pair)) {
        contact(pair, kept.axis, margin, out);
        if (out.count > 0) return;
    }

    Separation face = best_face_a(pair, margin);
    if (face.distance <= margin) {
        const Separation face_b = best_face_b(pair, margin);
        // a's face is the reference of parallel faces, unless b's was.
        const float keep = Preference(pair.size()).keep;
        const bool b_was = kept.touching && kept.axis.kind == AxisKind::face_b;
        if (face_b.distance > margin || face_b.distance > face.distance + (b_was ? -keep : keep)) face = face_b;
    }
    if (face.distance > margin) return write(face.axis, false, pair, shapes.cache);
    const float depth = std::max(margin, -face.distance);
    const Separation edges = best_edges(pair, pair.normal(face.axis), depth, margin);
    if (edges.distance > margin) return write(edges.axis, false, pair, shapes.cache);
    const bool was_edge = kept.touching && kept.axis.kind == AxisKind::edges;
    const Axis taken = choose_contact(pair, face, edges, was_edge, margin, out);
    write(taken, true, pair, shapes.cache);
}

}  // namespace taut::collision
