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
    // The vertex of the other polytope that reaches furthest down, in the reference's frame.
    Vec3f lowest() const { return other_in_reference * other.vertices[size_t(support(other, -up))]; }
    // Whether no axis separates by ask more than the face: none separates further than the lowest vertex is from the
    // reference, and that is over the face or, inside, nearest to it.
    bool decides(const Vec3f& lowest, float ask, float slack) const {
        const float x = face.u.dot(lowest), y = face.v.dot(lowest), z = face.normal.dot(lowest) - face.offset;
        for (const Side& side : reference.sides_of(face)) {
            if (side.x * x + side.y * y - side.offset > slack) return false;
        }
        return outside(reference, lowest) <= z + ask;
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
    const auto [a, b] = pair.edges(axis);
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

// Points of the face next to the edges, where they cross nearly in its plane.
void add_face_beside(const PolytopePair& pair, Axis edges, float margin, Manifold& out) {
    FaceBeside face = face_beside(pair, edges, out.normal);
    if (face.along < kSamePlane) return;
    Manifold clipped;
    contact(pair, face.axis, false, margin, clipped);
    add_beside(clipped, out);
}

bool same_way(const Vec3f& one, const Vec3f& other) { return one.dot(other) > kSamePlane; }

// As of boxes: a long polytope that tilts over another's rim is borne by edges that cross nearly in the plane of the
// face that it lay on. last: the normal along which the pair touched before, or zero.
bool edges_bear(const PolytopePair& pair, const Separation& edges, const Separation& face, const Vec3f& last,
                const Preference& preference) {
    const float gain = edges.distance - face.distance;
    if (gain <= -preference.keep) return false;
    const Vec3f normal = pair.normal(edges.axis);
    if (same_way(normal, pair.normal(face.axis)) || face_beside(pair, edges.axis, normal).along < kSamePlane)
        return false;
    return same_way(normal, last) || gain > preference.keep;
}

// Whether no axis separates by clearly more than the given one.
bool decides(const PolytopePair& pair, Axis axis) {
    const Preference preference(pair.size());
    if (axis.kind == AxisKind::edges) return edges_decide(pair, axis, preference.slop);
    const FaceView view = view_of(pair, axis);
    return view.decides(view.lowest(), preference.keep, flush_slack(view.reference.inner_radius));
}

// Whether last frame's axis still gives the contact, as the pair has hardly moved or no other axis separates by more.
bool keep_contact(const PolytopePair& pair, Kept& kept, float margin, PairCache& cache, Manifold& out) {
    if (!kept.touching || !pair.valid(kept.axis)) return false;
    const bool is_still = still(kept, pair);
    if (!is_still && !decides(pair, kept.axis)) return false;
    contact(pair, kept.axis, true, margin, out);
    if (out.count == 0 || is_still) return out.count > 0;
    if (kept.axis.kind == AxisKind::edges) add_face_beside(pair, kept.axis, margin, out);
    write(kept.axis, true, pair, cache);
    return true;
}

}  // namespace

float polytope_polytope(const Pair& shapes, Manifold& out) {
    const PolytopeOf storage_a(shapes.a);
    const PolytopeOf storage_b(shapes.b);
    const PolytopePair pair(storage_a.view(), storage_b.view(), shapes.b_in_a);
    const float margin = shapes.margin;
    Kept kept = read(shapes.cache);
    if (keep_contact(pair, kept, margin, shapes.cache, out)) return 0;

    Separation face = best_face_a(pair, margin);
    if (face.distance <= margin) {
        const Separation face_b = best_face_b(pair, margin);
        // a's face is the reference of parallel faces, unless b's was.
        const float keep = Preference(pair.size()).keep;
        const bool b_was = kept.touching && kept.axis.kind == AxisKind::face_b;
        if (face_b.distance > margin || face_b.distance > face.distance + (b_was ? -keep : keep)) face = face_b;
    }
    if (face.distance > margin) {
        write(face.axis, false, pair, shapes.cache);
        return face.distance;
    }
    const Preference preference(pair.size());
    const bool was_edge = kept.touching && kept.axis.kind == AxisKind::edges;
    const FaceView view = view_of(pair, face.axis);
    const float slack = flush_slack(view.reference.inner_radius);
    contact(pair, face.axis, false, margin, out);
    const float ask = preference.ask(was_edge);
    // Where the faces lie over each other the two are at most so far apart.
    const float most = deepest(out);
    const Vec3f last = kept.touching && pair.valid(kept.axis) ? pair.normal(kept.axis) : Vec3f(Vec3f::Zero());
    const bool other_way = last != Vec3f::Zero() && !same_way(last, pair.normal(face.axis));
    if (!other_way && (std::max(most, 0.0f) <= face.distance + slack || view.decides(view.lowest(), ask, slack))) {
        write(face.axis, true, pair, shapes.cache);
        return 0;
    }
    const float depth = std::max(std::min(margin, most + slack), -face.distance + (other_way ? preference.keep : 0.0f));
    Separation edges = best_edges(pair, pair.normal(face.axis), depth, margin);
    if (edges.distance > margin) {
        out.count = 0;
        write(edges.axis, false, pair, shapes.cache);
        return edges.distance;
    }
    if (preference.edge_wins(edges.distance, face.distance, was_edge) ||
        preference.face_misses(deepest(out), edges.distance, face.distance) ||
        edges_bear(pair, edges, face, last, preference)) {
        out.count = 0;
        face.axis = edges.axis;
        contact(pair, edges.axis, false, margin, out);
        add_face_beside(pair, edges.axis, margin, out);
    }
    write(face.axis, true, pair, shapes.cache);
    return 0;
}

}  // namespace taut::collision
