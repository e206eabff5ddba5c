// Box or hull against box or hull: the axis that separated or touched last frame, else all axes; then face clipping, or
// one point between two edges. What these do not tell of an overlap, GJK does.
#include <algorithm>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/least_push.h"
#include "collision/narrowphase/polytope_cache.h"

namespace taut::collision {
namespace {

constexpr float kUnknown = 1e30f;
// The id of the one point of what no pair of features bears.
constexpr uint32_t kPushed = (3u << 30) | 1;

// A face of the reference polytope and the other polytope over it, all in the reference's frame.
class FaceView {
public:
    // lowest: the vertex of the other polytope that reaches furthest down.
    FaceView(const Polytope& reference, int number, const Polytope& other, const Pose& pose, int lowest)
        : reference_(reference),
          number_(number),
          other_(other),
          pose_(pose),
          face_(reference.faces[size_t(number)]),
          up_(pose.rotation.transpose() * face_.normal),
          lowest_(lowest >= 0 ? lowest : support(other, -up_)),
          at_(pose * other.vertices[size_t(lowest_)]),
          x_(face_.u.dot(at_)),
          y_(face_.v.dot(at_)),
          z_(face_.normal.dot(at_) - face_.offset) {}

    float slack() const { return flush_slack(reference_.inner_radius); }
    // Whether no axis separates by ask more than the face: none separates further than the lowest vertex is from the
    // reference, and that is over the face or, inside, nearest to it.
    bool decides(float ask) const {
        for (const Side& side : reference_.sides_of(face_))
            if (outside(side) > slack()) return false;
        return collision::outside(reference_, at_) <= z_ + ask;
    }
    // How far the two are apart at most: no further than the lowest vertex is from the face's edge nearest to it.
    float most_apart() const;
    // Whether the other lies over the face with all of its corners, wherever it turns.
    bool is_plane() const {
        const float x = face_.u.dot(pose_.position), y = face_.v.dot(pose_.position);
        for (const Side& side : reference_.sides_of(face_))
            if (side.x * x + side.y * y + reach() > side.offset) return false;
        return true;
    }
    // Then any of them may touch it, not those of one face alone. In the other's frame, with the normal to the face.
    void touch_plane(const Wanted& wanted, Manifold& out) const {
        const float height = face_.normal.dot(pose_.position) - face_.offset;
        collision::touch_plane(other_.vertices, 0, up_, height, wanted, out);
    }
    // The normal comes out of the reference face. incident: the face last found to lie against it, if known.
    void clip_faces(uint8_t& incident, bool known, bool reference_on_b, const Wanted& wanted, Polygon& clipped,
                    Manifold& out) const;
    // As most_apart(), by what was clipped.
    float most_apart(const Polygon& clipped) const;

private:
    // Of the other's corners from its origin, at most [m].
    float reach() const { return other_.centre.norm() + other_.outer_radius; }
    float outside(const Side& side) const { return side.x * x_ + side.y * y_ - side.offset; }
    void lay_out(int incident, Polygon& polygon) const;
    // Whether one of the corners is as deep as any vertex, within tolerance [m].
    bool holds_deepest(const Polygon& polygon, float tolerance) const {
        float least = polygon.points[0].z;
        for (int i = 1; i < polygon.count; ++i) least = std::min(least, polygon.points[i].z);
        return least <= z_ + tolerance;
    }

    const Polytope& reference_;
    int number_;
    const Polytope& other_;
    const Pose& pose_;  // of the other in the reference's frame
    const Face& face_;
    Vec3f up_;  // the normal in the other's frame
    int lowest_;
    Vec3f at_;         // the lowest vertex,
    float x_, y_, z_;  // in the face's coordinates
};

float FaceView::most_apart() const {
    const auto sides = reference_.sides_of(face_);
    size_t furthest = 0;
    for (size_t i = 1; i < sides.size(); ++i)
        if (outside(sides[i]) > outside(sides[furthest])) furthest = i;
    if (outside(sides[furthest]) <= 0) return std::max(z_, 0.0f);
    const auto loop = reference_.loop_of(face_);
    const Vec3f& from = reference_.vertices[loop[furthest]];
    const Vec3f& to = reference_.vertices[loop[furthest + 1 < loop.size() ? furthest + 1 : 0]];
    const Segment edge = {from, to - from};
    return (edge.at(edge.nearest(at_)) - at_).norm();
}

// The corners of a face of the other polytope in this face's coordinates.
void FaceView::lay_out(int incident, Polygon& polygon) const {
    const Vec3f along = pose_.rotation.transpose() * face_.u, across = pose_.rotation.transpose() * face_.v;
    const float x = face_.u.dot(pose_.position), y = face_.v.dot(pose_.position);
    const float z = face_.normal.dot(pose_.position) - face_.offset;
    polygon.count = 0;
    for (const int corner : other_.loop_of(other_.faces[size_t(incident)])) {
        const Vec3f& p = other_.vertices[size_t(corner)];
        polygon.points[polygon.count] = {along.dot(p) + x, across.dot(p) + y, up_.dot(p) + z, uint32_t(polygon.count)};
        ++polygon.count;
    }
}

// As in decides(), of the corner that is deepest where the faces lie over each other.
float FaceView::most_apart(const Polygon& clipped) const {
    if (clipped.count == 0) return kUnknown;
    const ClipPoint& deepest =
        *std::min_element(clipped.points, clipped.points + clipped.count,
                          [](const ClipPoint& one, const ClipPoint& other) { return one.z < other.z; });
    if (deepest.z > 0) return deepest.z;
    const float height = deepest.z + face_.offset;
    return collision::outside(reference_, deepest.x * face_.u + deepest.y * face_.v + height * face_.normal);
}

void FaceView::clip_faces(uint8_t& incident, bool known, bool reference_on_b, const Wanted& wanted, Polygon& polygon,
                          Manifold& out) const {
    if (known) lay_out(incident, polygon);
    if (!known || !holds_deepest(polygon, 0.1f * slack())) {
        incident = uint8_t(face_against(other_, lowest_, up_));
        lay_out(incident, polygon);
    }
    clip(polygon, reference_.sides_of(face_), slack());
    out.normal = face_.normal;
    add_points(polygon, {face_.u, face_.v, face_.normal, face_.offset}, face_base(reference_on_b, number_, incident),
               wanted, out);
}

// Of a face axis; nearest: as in Separation, if known.
FaceView view_of(const PolytopePair& pair, Axis axis, int nearest = -1) {
    if (axis.kind == AxisKind::face_a) return {pair.a, axis.i, pair.b, pair.b_in_a, nearest};
    return {pair.b, axis.j, pair.a, pair.a_in_b, nearest};
}

// None of edges that turned parallel since their axis was chosen.
void edge_point(const PolytopePair& pair, Axis axis, float margin, Manifold& out) {
    const auto [a, b] = pair.edges(axis);
    const SegmentPair nearest = nearest_points(a, b);
    const Vec3f normal = pair.normal(axis);
    const float separation = normal.dot(b.from - a.from);
    if (normal == Vec3f::Zero() || separation > margin) return;
    out.normal = normal;
    out.count = 1;
    out.points[0] = {0.5f * (a.at(nearest.s) + b.at(nearest.t)), separation, edge_feature(axis.i, axis.j)};
}

// kept: the axis is last frame's, with the face that lay against it; else the axis gets that face. clipped: what lies
// over the other face, if that was asked for.
void face_points(const PolytopePair& pair, const FaceView& view, Axis& axis, bool kept, const Wanted& wanted,
                 Polygon& clipped, Manifold& out) {
    const bool on_b = axis.kind == AxisKind::face_b;
    const bool plane = view.is_plane();
    clipped.count = 0;
    if (plane)
        view.touch_plane(wanted, out);
    else
        view.clip_faces(on_b ? axis.i : axis.j, kept, on_b, wanted, clipped, out);
    if (plane != on_b) move_to_a(pair.b_in_a, out);
}

// The points of a face axis, which names the face alone.
struct FacePoints {
    Axis axis;
    Manifold points;
};

// Points of the face next to the edges, where they cross nearly in its plane. known: those of a face that were found
// already.
void add_face_beside(const PolytopePair& pair, Axis edges, const FacePoints& known, const Wanted& wanted,
                     Manifold& out) {
    FaceBeside face = face_beside(pair, edges, out.normal);
    if (face.along < kSamePlane) return;
    if (face.axis == known.axis) return add_beside(known.points, out);
    Polygon clipped;
    Manifold points;
    face_points(pair, view_of(pair, face.axis), face.axis, false, wanted, clipped, points);
    add_beside(points, out);
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

// Whether last frame's axis still gives the contact, as the pair has hardly moved or no other axis separates by clearly
// more.
bool keep_contact(const PolytopePair& pair, Kept& kept, const Wanted& wanted, PairCache& cache, Manifold& out) {
    if (!kept.touching || !pair.valid(kept.axis)) return false;
    const bool is_still = still(kept, pair);
    const Preference preference(pair.size());
    if (kept.axis.kind == AxisKind::edges) {
        if (!is_still && !edges_decide(pair, kept.axis, preference.slop)) return false;
        edge_point(pair, kept.axis, wanted.margin, out);
    } else {
        const FaceView view = view_of(pair, kept.axis);
        if (!is_still && !view.decides(preference.keep)) return false;
        Polygon clipped;
        face_points(pair, view, kept.axis, true, wanted, clipped, out);
    }
    if (out.count == 0) return false;
    if (kept.axis.kind == AxisKind::edges) add_face_beside(pair, kept.axis, {}, wanted, out);
    if (!is_still) write_touching(kept.axis, pair, cache);
    return true;
}

// The face of either that separates most. a's is the reference of parallel faces, unless b's was.
Separation best_face(const PolytopePair& pair, const Kept& kept, float margin) {
    const Separation face_a = best_face_a(pair, margin);
    if (face_a.distance > margin) return face_a;
    const float keep = Preference(pair.size()).keep;
    const bool b_was = kept.touching && kept.axis.kind == AxisKind::face_b;
    const float least = std::min(face_a.distance + (b_was ? -keep : keep), margin);
    const Separation face_b = best_face_b(pair, least, margin);
    return face_b.distance > least ? face_b : face_a;
}

// How far an axis separates the two by all of their corners.
float separation(const PolytopePair& pair, const Vec3f& normal) {
    const Vec3f against = pair.b_in_a.rotation.transpose() * -normal;
    return normal.dot(pair.b_in_a.position) - highest(pair.b, against) - highest(pair.a, normal);
}

// Whether points tell how deep the two overlap along an axis that separates by distance, negative.
bool tells(const Manifold& points, float distance, const Preference& preference) {
    return deepest(points) <= 0.9f * distance + preference.slop;
}

// The face of either that looks most along a normal.
Axis facing(const PolytopePair& pair, const Vec3f& normal) {
    const auto most_along = [](const Polytope& polytope, const Vec3f& direction) {
        const auto less = [&](const Face& one, const Face& other) {
            return one.normal.dot(direction) < other.normal.dot(direction);
        };
        return int(std::max_element(polytope.faces.begin(), polytope.faces.end(), less) - polytope.faces.begin());
    };
    const Vec3f against = pair.b_in_a.rotation.transpose() * -normal;
    const int i = most_along(pair.a, normal), j = most_along(pair.b, against);
    const bool on_b = pair.b.faces[size_t(j)].normal.dot(against) > pair.a.faces[size_t(i)].normal.dot(normal);
    return on_b ? Axis{AxisKind::face_b, 0, uint8_t(j)} : Axis{AxisKind::face_a, uint8_t(i), 0};
}

// Where no face's points and no pair of edges tell the overlap, as rounding has it among faces that are slivers: the
// direction of least push by GJK, with the points of the face along it or one between the deepest points. An overlap
// always gets a point.
float touch_by_push(const Pair& shapes, const PolytopePair& pair, Manifold& out) {
    const Push push = least_push(Solid(shapes.a), Solid(shapes.b), shapes, Vec3::Zero(), double(shapes.wanted.margin));
    const float distance = float(push.separation);
    shapes.cache = {};
    out.count = 0;
    if (distance > shapes.wanted.margin) return distance;
    const Vec3f normal = push.normal.cast<float>();
    Axis axis = facing(pair, normal);
    Polygon clipped;
    Manifold face;
    face_points(pair, view_of(pair, axis), axis, false, shapes.wanted, clipped, face);
    if (face.count > 0 && face.normal.dot(normal) > kSamePlane && tells(face, distance, Preference(pair.size()))) {
        out = face;
        return 0;
    }
    out.normal = normal;
    out.count = 1;
    const Vec3 middle = push.on_a + 0.5 * push.separation * push.normal;
    out.points[0] = {middle.cast<float>(), distance, kPushed};
    add_beside(face, out);
    return 0;
}

// The axis chosen, and its points, if they tell the overlap.
float conclude(const Pair& shapes, const PolytopePair& pair, const Separation& chosen, Manifold& out) {
    const Preference preference(pair.size());
    const bool edges = chosen.axis.kind == AxisKind::edges;
    const float distance = edges ? separation(pair, pair.normal(chosen.axis)) : chosen.distance;
    if ((chosen.distance - distance > preference.slop) || (distance <= 0 && !tells(out, distance, preference)))
        return touch_by_push(shapes, pair, out);
    write_touching(chosen.axis, pair, shapes.cache);
    return 0;
}

}  // namespace

float polytope_polytope(const Pair& shapes, Manifold& out) {
    const PolytopeOf storage_a(shapes.a);
    const PolytopeOf storage_b(shapes.b);
    const PolytopePair pair(storage_a.view(), storage_b.view(), shapes.b_in_a);
    const float margin = shapes.wanted.margin;
    Kept kept = read(shapes.cache);
    if (keep_contact(pair, kept, shapes.wanted, shapes.cache, out)) return 0;

    Separation face = best_face(pair, kept, margin);
    const Axis face_alone = face.axis;
    if (face.distance > margin) {
        write_apart(face.axis, shapes.cache);
        return face.distance;
    }
    const Preference preference(pair.size());
    const bool was_edge = kept.touching && kept.axis.kind == AxisKind::edges;
    const FaceView view = view_of(pair, face.axis, face.nearest);
    Polygon clipped;
    face_points(pair, view, face.axis, false, shapes.wanted, clipped, out);
    // Where the faces lie over each other the two are at most so far apart.
    const float most = deepest(out);
    const Vec3f last = kept.touching && pair.valid(kept.axis) ? pair.normal(kept.axis) : Vec3f(Vec3f::Zero());
    const bool other_way = last != Vec3f::Zero() && !same_way(last, pair.normal(face.axis));
    const float ask = preference.ask(was_edge);
    if (!other_way && (std::max(most, 0.0f) <= face.distance + view.slack() ||
                       view.most_apart(clipped) <= face.distance + ask || view.decides(ask))) {
        return conclude(shapes, pair, face, out);
    }
    // Edges that separate by slop less may bear what the face misses.
    const float apart = std::min({margin, most + view.slack(), view.most_apart() + preference.slop});
    const float depth = std::max(apart, -face.distance + (other_way ? preference.keep : 0.0f));
    const float least = face.distance - preference.slop;  // less bears nothing
    const Separation edges = best_edges(pair, pair.normal(face.axis), depth, least);
    if (edges.distance > margin) {
        if (!(separation(pair, pair.normal(edges.axis)) > margin)) return touch_by_push(shapes, pair, out);
        out.count = 0;
        write_apart(edges.axis, shapes.cache);
        return edges.distance;
    }
    if (preference.edge_wins(edges.distance, face.distance, was_edge) ||
        preference.face_misses(deepest(out), edges.distance, face.distance) ||
        edges_bear(pair, edges, face, last, preference)) {
        const FacePoints of_face = {face_alone, out};
        out.count = 0;
        face = edges;
        edge_point(pair, edges.axis, margin, out);
        add_face_beside(pair, edges.axis, of_face, shapes.wanted, out);
    }
    return conclude(shapes, pair, face, out);
}

}  // namespace taut::collision
