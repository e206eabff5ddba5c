// Box or hull against box or hull: the axis that separated or touched last frame, else all axes; then face
// clipping, or one point between two edges.
#include "collision/narrowphase/core.h"
#include "collision/narrowphase/polytope_cache.h"

namespace taut::collision {
namespace {

// A face of the reference polytope and the other polytope over it, all in the reference's frame.
struct FaceView {
    const Polytope& reference;
    int number;
    const Polytope& other;
    const Pose& other_in_reference;
    const Face& face = reference.faces[size_t(number)];
    const Vec3f up = other_in_reference.rotation.transpose() * face.normal;  // the normal in the other's frame

    // The corners of a face of the other polytope in this face's coordinates.
    void lay_out(int incident, Polygon& polygon) const {
        const Vec3f along = other_in_reference.rotation.transpose() * face.u;
        const Vec3f across = other_in_reference.rotation.transpose() * face.v;
        const float x = face.u.dot(other_in_reference.position);
        const float y = face.v.dot(other_in_reference.position);
        polygon.count = 0;
        for (const int corner : other.loop_of(other.faces[size_t(incident)])) {
            const Vec3f& p = other.vertices[size_t(corner)];
            polygon.points[polygon.count] = {along.dot(p) + x, across.dot(p) + y, up.dot(p) + height(),
                                             uint32_t(polygon.count)};
            ++polygon.count;
        }
    }
    // Whether no edge pair separates by ask more than the face. Its deepest point is a vertex of the other polytope: no
    // axis separates further than that vertex is from the reference, which is over the face or, inside, nearest to it.
    bool decides(float ask, float slack) const {
        const Vec3f vertex = other_in_reference * other.vertices[size_t(support(other, -up))];
        const float x = face.u.dot(vertex), y = face.v.dot(vertex), z = face.normal.dot(vertex) - face.offset;
        for (const Side& side : reference.sides_of(face)) {
            if (side.x * x + side.y * y - side.offset > slack) return false;
        }
        for (const Face& beside : reference.faces) {
            if (beside.normal.dot(vertex) - beside.offset > z + ask) return false;
        }
        return true;
    }
    float height() const { return face.normal.dot(other_in_reference.position) - face.offset; }
    // Whether one of the corners is as deep as any vertex, within tolerance [m].
    bool holds_deepest(const Polygon& polygon, float tolerance) const {
        float least = polygon.points[0].z;
        for (int i = 1; i < polygon.count; ++i) least = std::min(least, polygon.points[i].z);
        return least <= height() - highest(other, -up) + tolerance;
    }
};

FaceView view_of(const PolytopePair& pair, Axis axis) {
    if (axis.kind == AxisKind::face_a) return {pair.a, axis.i, pair.b, pair.b_in_a};
    return {pair.b, axis.j, pair.a, pair.a_in_b};
}

// The normal comes out of the reference face. incident: the face last found to lie against it, if known.
void clip_faces(const FaceView& view, uint8_t& incident, bool known, bool reference_on_b, float margin, Manifold& out) {
    const Face& face = view.face;
    const float slack = flush_slack(view.reference.inner_radius);
    Polygon polygon;
    if (known) view.lay_out(incident, polygon);
    if (!known || !view.holds_deepest(polygon, 0.1f * slack)) {
        incident = uint8_t(face_against(view.other, view.up));
        view.lay_out(incident, polygon);
    }
    clip(polygon, view.reference.sides_of(face), slack);
    out.normal = face.normal;
    add_points(polygon, {face.u, face.v, face.normal, face.offset}, face_base(reference_on_b, view.number, incident),
               margin, out);
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

// kept: the axis is last frame's, with the face that lay against it; else the axis gets that face.
void contact(const PolytopePair& pair, Axis& axis, bool kept, float margin, Manifold& out) {
    if (axis.kind == AxisKind::edges) return edge_point(pair, axis, margin, out);
    const bool on_b = axis.kind == AxisKind::face_b;
    clip_faces(view_of(pair, axis), on_b ? axis.i : axis.j, kept, on_b, margin, out);
    if (on_b) move_to_a(pair.b_in_a, out);
}

// The contact of the best axis; returns the axis taken.
Axis choose_contact(const PolytopePair& pair, Separation face, Separation edges, bool was_edge, float margin,
                    Manifold& out) {
    const Preference preference(pair.size());
    Manifold clipped;
    contact(pair, face.axis, false, margin, clipped);
    if (!preference.edge_wins(edges.distance, face.distance, was_edge) &&
        !preference.face_misses(deepest(clipped), edges.distance, face.distance)) {
        out = clipped;
        return face.axis;
    }
    contact(pair, edges.axis, false, margin, out);
    add_beside(clipped, out);
    return edges.axis;
}

}  // namespace

void polytope_polytope(const Pair& shapes, Manifold& out) {
    const PolytopeOf storage_a(shapes.a);
    const PolytopeOf storage_b(shapes.b);
    const PolytopePair pair(storage_a.view(), storage_b.view(), shapes.b_in_a);
    const float margin = shapes.margin;
    Kept kept = read(shapes.cache);
    if (kept.touching && pair.valid(kept.axis) && still(kept, pair)) {
        contact(pair, kept.axis, true, margin, out);
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
    const bool was_edge = kept.touching && kept.axis.kind == AxisKind::edges;
    const FaceView view = view_of(pair, face.axis);
    if (view.decides(Preference(pair.size()).ask(was_edge), flush_slack(view.reference.inner_radius))) {
        contact(pair, face.axis, false, margin, out);
        return write(face.axis, true, pair, shapes.cache);
    }
    const float depth = std::max(margin, -face.distance);
    const Separation edges = best_edges(pair, pair.normal(face.axis), depth, margin);
    if (edges.distance > margin) return write(edges.axis, false, pair, shapes.cache);
    const Axis taken = choose_contact(pair, face, edges, was_edge, margin, out);
    write(taken, true, pair, shapes.cache);
}

}  // namespace taut::collision
