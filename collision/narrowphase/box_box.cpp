// Box against box: separating axes (three faces each, nine edge pairs), then face clipping or one edge point.
#include <array>
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/kernel.h"
#include "collision/narrowphase/segment.h"

namespace taut::collision {
namespace {

// Axes by number: 0..2 faces of a, 3..5 faces of b, 6 + 3 i + j edge i of a with edge j of b.
constexpr int kFirstEdge = 6;
constexpr int kAxes = 15;

// The cache's word 0: 1 + axis, and whether the boxes touched along it.
constexpr uint32_t kTouching = 1u << 8;

// Nearly parallel edges (0.6 degrees) have no axis of their own: the square of the sine of their angle.
constexpr float kEdgeSine2 = 1e-4f;

constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }

struct Boxes {
    Vec3f a, b;       // half extents
    Mat3f r, q;       // b's axes in a's frame, and their magnitudes
    Vec3f t, t_in_b;  // from a's centre to b's, in a's and in b's frame

    explicit Boxes(const Pair& pair)
        : a(pair.a.size),
          b(pair.b.size),
          r(pair.b_in_a.rotation),
          q(r.cwiseAbs()),
          t(pair.b_in_a.position),
          t_in_b(r.transpose() * t) {}

    // |t . n| - (reach of a) - (reach of b) along the unit axis n; negative is overlap.
    float face_a(int i) const { return std::fabs(t[i]) - a[i] - (q(i, 0) * b[0] + q(i, 1) * b[1] + q(i, 2) * b[2]); }
    float face_b(int j) const {
        return std::fabs(t_in_b[j]) - b[j] - (q(0, j) * a[0] + q(1, j) * a[1] + q(2, j) * a[2]);
    }
    // n = e_i x r_j / sin of their angle; -1e30 for one that separates by no more than least (not positive).
    float edge(int i, int j, float least) const {
        const float sine_squared = 1 - r(i, j) * r(i, j);
        if (sine_squared < kEdgeSine2) return -1e30f;
        const int i1 = next(i), i2 = next(i1), j1 = next(j), j2 = next(j1);
        const float reach = a[i1] * q(i2, j) + a[i2] * q(i1, j) + b[j1] * q(i, j2) + b[j2] * q(i, j1);
        const float apart = std::fabs(t[i2] * r(i1, j) - t[i1] * r(i2, j)) - reach;
        return apart > least ? apart / std::sqrt(sine_squared) : -1e30f;
    }
    float face(int axis) const { return axis < 3 ? face_a(axis) : face_b(axis - 3); }
    // Of an axis, without its sign; zero for parallel edges.
    Vec3f normal(int axis) const {
        if (axis < 3) return Vec3f::Unit(axis);
        if (axis < kFirstEdge) return r.col(axis - 3);
        const Vec3f n = Vec3f::Unit((axis - kFirstEdge) / 3).cross(r.col((axis - kFirstEdge) % 3));
        return n.squaredNorm() < kEdgeSine2 ? Vec3f(Vec3f::Zero()) : n.normalized();
    }
    float size() const { return std::min(a.minCoeff(), b.minCoeff()); }
};

struct Best {
    int axis = -1;
    float separation = -1e30f;
};

// Whether two axes look about the same way.
bool same_axis(const Vec3f& one, const Vec3f& other) { return std::fabs(one.dot(other)) > kSamePlane; }

struct Axes {
    Best face, edge;
    Best across;      // of the edges whose axes do not look the face's way
    Best separating;  // an axis further apart than the margin; the rest is unset then
};

// kept: last frame's face, preferred; -1 for none. Edges that could not be chosen over the best face are left out.
Axes find_axes(const Boxes& boxes, float margin, int kept, const Preference& preference) {
    Axes axes;
    float best = -1e30f;
    for (int axis = 0; axis < kFirstEdge; ++axis) {
        const float s = boxes.face(axis);
        if (s > margin) {
            axes.separating = {axis, s};
            return axes;
        }
        const float score = axis == kept ? s + preference.keep : s;
        if (score > best + 1e-5f) {
            best = score;
            axes.face = {axis, s};
        }
    }
    const float least = std::min(0.0f, axes.face.separation - preference.slop);
    for (int axis = kFirstEdge; axis < kAxes; ++axis) {
        const float s = boxes.edge((axis - kFirstEdge) / 3, (axis - kFirstEdge) % 3, least);
        if (s > margin) {
            axes.separating = {axis, s};
            return axes;
        }
        if (s > axes.edge.separation) axes.edge = {axis, s};
        if (s > std::max(least, axes.across.separation) && !same_axis(boxes.normal(axis), boxes.normal(axes.face.axis)))
            axes.across = {axis, s};
    }
    return axes;
}

// The face axis of either box that looks most along a normal.
int facing(const Boxes& boxes, const Vec3f& normal) {
    const Vec3f in_b = boxes.r.transpose() * normal;
    int a = 0, b = 0;
    normal.cwiseAbs().maxCoeff(&a);
    in_b.cwiseAbs().maxCoeff(&b);
    return std::fabs(normal[a]) >= std::fabs(in_b[b]) ? a : 3 + b;
}

// A long box that tilts over another's rim soon overlaps far beyond the face that it lay on: what bears it are edges
// that cross nearly in that face's plane. They are as good as another face then, and preferred to it where the pair
// touched that way before; else a link's end face catches on the rim. kept: last frame's normal, or zero.
bool edges_bear(const Boxes& boxes, const Axes& axes, const Vec3f& kept, const Preference& preference) {
    const float gain = axes.across.separation - axes.face.separation;
    if (gain <= -preference.keep) return false;
    const Vec3f edges = boxes.normal(axes.across.axis);
    if (!same_axis(edges, boxes.normal(facing(boxes, edges)))) return false;
    return same_axis(edges, kept) || gain > preference.keep;
}

// The two edges that support the axis, their nearest points and the point between.
void edge_contact(const Boxes& boxes, const Best& edge, Manifold& out) {
    const int i = (edge.axis - kFirstEdge) / 3;
    const int j = (edge.axis - kFirstEdge) % 3;
    const Vec3f along_b = boxes.r.col(j);
    Vec3f normal = Vec3f::Unit(i).cross(along_b).normalized();
    if (normal.dot(boxes.t) < 0) normal = -normal;
    Vec3f middle_a = Vec3f::Zero();
    Vec3f middle_b = boxes.t;
    int signs = 0;
    for (int k = 0; k < 3; ++k) {
        const bool up_a = normal[k] > 0;
        const bool up_b = normal.dot(boxes.r.col(k)) > 0;
        if (k != i) middle_a[k] = up_a ? boxes.a[k] : -boxes.a[k];
        if (k != j) middle_b -= boxes.r.col(k) * (up_b ? boxes.b[k] : -boxes.b[k]);
        if (k != i) signs = signs * 2 + up_a;
        if (k != j) signs = signs * 2 + up_b;
    }
    const Vec3f reach_a = Vec3f::Unit(i) * boxes.a[i];
    const Vec3f reach_b = along_b * boxes.b[j];
    const Segment edge_a = {middle_a - reach_a, 2 * reach_a};
    const Segment edge_b = {middle_b - reach_b, 2 * reach_b};
    const SegmentPair nearest = nearest_points(edge_a, edge_b);
    out.normal = normal;
    out.count = 1;
    out.points[0] = {0.5f * (edge_a.at(nearest.s) + edge_b.at(nearest.t)), edge.separation,
                     edge_feature(edge.axis, signs)};
}

// One box as the reference, the other as the incident box in the reference's frame.
struct BoxFace {
    Vec3f reference, incident;  // half extents
    Vec3f centre;               // of the incident box
    Mat3f axes;                 // of the incident box
};

// Whether the incident box lies over the reference face with all of its corners, wherever it turns.
bool is_plane(const BoxFace& view, int r) {
    const float reach = view.incident.norm();
    return std::fabs(view.centre[next(r)]) + reach < view.reference[next(r)] &&
           std::fabs(view.centre[next(next(r))]) + reach < view.reference[next(next(r))];
}

// Then any of them may touch it, not those of one face alone. In the incident box's frame, normal to the face.
void touch_plane(const BoxFace& view, int r, const Wanted& wanted, Manifold& out) {
    const Vec3f up = view.axes.row(r).transpose() * (view.centre[r] < 0 ? -1.0f : 1.0f);
    collision::touch_plane(box_corners(view.incident), 0, up, std::fabs(view.centre[r]) - view.reference[r], wanted,
                           out);
}

// Clips the incident face that looks most against the reference face.
void face_contact(const BoxFace& view, int r, bool reference_on_b, const Wanted& wanted, Manifold& out) {
    const int u = next(r);
    const int v = next(u);
    const float sign = view.centre[r] < 0 ? -1.0f : 1.0f;
    int k = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(view.axes(r, i)) > std::fabs(view.axes(r, k)) + 1e-4f) k = i;
    }
    const float against = view.axes(r, k) * sign > 0 ? -1.0f : 1.0f;
    const Vec3f centre = view.centre + view.axes.col(k) * (against * view.incident[k]);
    const Vec3f p = view.axes.col(next(k)) * view.incident[next(k)];
    const Vec3f q = view.axes.col(next(next(k))) * view.incident[next(next(k))];
    Polygon polygon;
    polygon.count = 4;
    constexpr float kCorners[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int i = 0; i < 4; ++i) {
        const Vec3f corner = centre + p * kCorners[i][0] + q * kCorners[i][1];
        polygon.points[i] = {corner[u], corner[v], sign * corner[r] - view.reference[r], uint32_t(i)};
    }
    const float hu = view.reference[u];
    const float hv = view.reference[v];
    const std::array<Side, 4> sides = {{{1, 0, hu}, {-1, 0, hu}, {0, 1, hv}, {0, -1, hv}}};
    clip(polygon, sides, flush_slack(std::min(hu, hv)));
    const ReferencePlane plane = {Vec3f::Unit(u), Vec3f::Unit(v), sign * Vec3f::Unit(r), view.reference[r]};
    out.normal = plane.normal;
    add_points(polygon, plane, face_base(reference_on_b, 2 * r + (sign > 0), 2 * k + (against > 0)), wanted, out);
}

void face_contact(const Pair& pair, const Boxes& boxes, int axis, Manifold& out) {
    const bool on_b = axis >= 3;
    const BoxFace view = on_b ? BoxFace{boxes.b, boxes.a, -boxes.t_in_b, boxes.r.transpose()}
                              : BoxFace{boxes.a, boxes.b, boxes.t, boxes.r};
    const int r = axis % 3;
    const bool plane = is_plane(view, r);
    if (plane)
        touch_plane(view, r, pair.wanted, out);
    else
        face_contact(view, r, on_b, pair.wanted, out);
    if (plane != on_b) move_to_a(pair.b_in_a, out);
}

// Points of the face next to the edges, where they cross nearly in its plane. That face need not separate best: the
// other edge may run far under it.
void add_face_beside(const Pair& pair, const Boxes& boxes, Manifold& out) {
    Manifold face;
    face_contact(pair, boxes, facing(boxes, out.normal), face);
    add_beside(face, out);
}

// Of a box from its centre along an axis of the world.
float reach(const Shape& box, const Placement& at, const Vec3f& axis) {
    return (at.rotation.transpose() * axis).cwiseAbs().dot(box.size);
}

}  // namespace

float boxes_apart(const Sides& sides, const PairCache& cache) {
    const uint32_t word = cache.words[0];
    const int axis = int(word & 0xff) - 1;
    if (axis < 0 || axis >= kAxes || word & kTouching) return kNoAxis;
    const Mat3f& a = sides.at_a.rotation;
    const Mat3f& b = sides.at_b.rotation;
    Vec3f n;
    if (axis < kFirstEdge) {
        n = axis < 3 ? a.col(axis) : b.col(axis - 3);
    } else {
        n = a.col((axis - kFirstEdge) / 3).cross(b.col((axis - kFirstEdge) % 3));
        if (n.squaredNorm() < kEdgeSine2) return kNoAxis;
        n.normalize();
    }
    return std::fabs(n.dot(sides.apart)) - reach(sides.a, sides.at_a, n) - reach(sides.b, sides.at_b, n);
}

float box_box(const Pair& pair, Manifold& out) {
    const Boxes boxes(pair);
    uint32_t& word = pair.cache.words[0];
    const int kept = int(word & 0xff) - 1;
    const bool touched = word & kTouching && kept >= 0 && kept < kAxes;
    const Preference preference(boxes.size());
    const Axes axes = find_axes(boxes, pair.wanted.margin, touched ? kept : -1, preference);
    if (axes.separating.axis >= 0) {
        word = uint32_t(axes.separating.axis + 1);
        return axes.separating.separation;
    }
    const bool was_edge = touched && kept >= kFirstEdge;
    const Vec3f last = touched ? boxes.normal(kept) : Vec3f(Vec3f::Zero());
    Best edge = axes.edge;
    bool on_edge = preference.edge_wins(edge.separation, axes.face.separation, was_edge);
    if (!on_edge && edges_bear(boxes, axes, last, preference)) {
        on_edge = true;
        edge = axes.across;
    }
    Manifold face;
    face_contact(pair, boxes, axes.face.axis, face);
    if (!on_edge) on_edge = preference.face_misses(deepest(face), axes.edge.separation, axes.face.separation);
    if (on_edge) {
        edge_contact(boxes, edge, out);
        add_face_beside(pair, boxes, out);
    } else {
        out = face;
    }
    word = uint32_t((on_edge ? edge.axis : axes.face.axis) + 1) | kTouching;
    return 0;
}

}  // namespace taut::collision
