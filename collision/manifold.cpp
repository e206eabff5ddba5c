#include "collision/manifold.h"

#include <algorithm>
#include <cmath>

namespace taut::collision {
namespace {

// A point this much deeper than the chosen ones takes the nearest one's place [m].
constexpr float kClearlyDeeper = 0.001f;

struct Chosen {
    int count = 0;
    int index[4];

    void add(int i) {
        if (std::find(index, index + count, i) == index + count) index[count++] = i;
    }
};

// Diagonals keep the widest support for a box on a box; the factor breaks the ties of regular polygons.
constexpr float kDiagonals[4][2] = {{-1, -1.02f}, {1, -1.02f}, {-1, 1.02f}, {1, 1.02f}};

// How far points reach along a diagonal that goes down by a slope.
struct Diagonal {
    float x, y, slope;

    float reach(const ClipPoint& p) const { return x * p.x + y * p.y - slope * p.z; }
};

float lowest(const ClipPoint* points, const Chosen& chosen) {
    float least = 1e30f;
    for (int i = 0; i < chosen.count; ++i) least = std::min(least, points[chosen.index[i]].z);
    return least;
}

int lowest_of(const ClipPoint* points, int count) {
    const auto lower = [](const ClipPoint& one, const ClipPoint& other) { return one.z < other.z; };
    return int(std::min_element(points, points + count, lower) - points);
}

// The four that the contact had; none unless all are there, none is clearly deeper, and they reach along each diagonal
// as far as any, but for a quarter of the way from the one that reaches least.
Chosen keep(const ClipPoint* points, int count, uint32_t base, const Wanted& wanted, float slope) {
    constexpr float kNearly = 0.25f;
    Chosen kept;
    if (wanted.had < 4) return kept;
    for (int i = 0; i < count && kept.count < 4; ++i)
        if (std::ranges::find(wanted.features, base | points[i].id) != std::end(wanted.features)) kept.add(i);
    if (kept.count < 4 || points[lowest_of(points, count)].z < lowest(points, kept) - kClearlyDeeper) return {};
    for (const auto& [dx, dy] : kDiagonals) {
        const Diagonal diagonal = {dx, dy, slope};
        float least = 1e30f, most = -1e30f, own = -1e30f;
        for (int i = 0; i < count; ++i) {
            least = std::min(least, diagonal.reach(points[i]));
            most = std::max(most, diagonal.reach(points[i]));
        }
        for (const int i : kept.index) own = std::max(own, diagonal.reach(points[i]));
        if (own < most - kNearly * (most - least)) return {};
    }
    return kept;
}

Chosen choose(const ClipPoint* points, int count, float slope = 0) {
    Chosen chosen;
    for (const auto& [dx, dy] : kDiagonals) {
        const Diagonal diagonal = {dx, dy, slope};
        int best = 0;
        float most = diagonal.reach(points[0]);
        for (int i = 1; i < count; ++i) {
            const float reach = diagonal.reach(points[i]);
            if (reach > most) {
                most = reach;
                best = i;
            }
        }
        chosen.add(best);
    }
    const int deepest = lowest_of(points, count);
    if (points[deepest].z > lowest(points, chosen) - kClearlyDeeper) return chosen;
    if (chosen.count < 4) {
        chosen.add(deepest);
        return chosen;
    }
    int nearest = 0;
    float least = 1e30f;
    for (int i = 0; i < 4; ++i) {
        const float dx = points[chosen.index[i]].x - points[deepest].x;
        const float dy = points[chosen.index[i]].y - points[deepest].y;
        if (dx * dx + dy * dy < least) {
            least = dx * dx + dy * dy;
            nearest = i;
        }
    }
    chosen.index[nearest] = deepest;
    return chosen;
}

// What is swept in order feels, of each point, those before it: to a tilt about one axis answers a moment about the
// other, as the sum over j < i of r_j x r_i, r from the points' mean. Around a patch all terms have one sign, and
// towers that sway begin to whirl and never stop. That sum is r_0 x r_1 + r_2 x r_3: 0 for a rectangle in zigzag.
// Otherwise points keep their order, so that they are swept in the same one every frame.
void break_circle(const ClipPoint* points, int (&index)[4]) {
    std::sort(index, index + 4);
    float x = 0, y = 0;
    for (const int i : index) x += 0.25f * points[i].x, y += 0.25f * points[i].y;
    const auto cross = [&](const ClipPoint& p, const ClipPoint& q) {
        return (p.x - x) * (q.y - y) - (p.y - y) * (q.x - x);
    };
    if (cross(points[index[0]], points[index[1]]) * cross(points[index[2]], points[index[3]]) > 0)
        std::swap(index[2], index[3]);
}

}  // namespace

// Sutherland-Hodgman, side by side. A crossing is cut on the side itself. Each end and each crossing is written, and
// counted where there is one: branches would be mispredicted.
void clip(Polygon& polygon, std::span<const Side> sides, float slack) {
    Polygon spare;
    Polygon* in = &polygon;
    Polygon* out = &spare;
    for (size_t s = 0; s < sides.size() && in->count > 0; ++s) {
        const Side& side = sides[s];
        float outside[kMaxClip];
        bool any = false;
        for (int i = 0; i < in->count; ++i) {
            outside[i] = side.x * in->points[i].x + side.y * in->points[i].y - side.offset;
            any |= outside[i] > slack;
        }
        if (!any) continue;
        out->count = 0;
        const uint32_t line = kSideLine + uint32_t(s);
        for (int i = 0; i < in->count && out->count + 2 <= kMaxClip; ++i) {
            const int j = i + 1 == in->count ? 0 : i + 1;
            const ClipPoint& from = in->points[i];
            const ClipPoint& to = in->points[j];
            const bool from_in = outside[i] <= slack;
            const bool to_in = outside[j] <= slack;
            out->points[out->count] = from;
            out->count += from_in;
            const float inner = std::min(0.0f, std::min(outside[i], outside[j]));
            const float outer = std::max(outside[i], outside[j]);
            const float t = inner / (inner - outer);  // from the inner end, of a crossing
            const ClipPoint& a = from_in ? from : to;
            const ClipPoint& b = from_in ? to : from;
            out->points[out->count] = {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                                       from_in ? line : from.id};
            out->count += from_in != to_in;
        }
        std::swap(in, out);
    }
    if (in != &polygon) {
        polygon.count = in->count;
        std::copy(in->points, in->points + in->count, polygon.points);
    }
    uint32_t previous = polygon.count > 0 ? polygon.points[polygon.count - 1].id : 0;
    for (int i = 0; i < polygon.count; ++i) {
        const uint32_t line = polygon.points[i].id;
        polygon.points[i].id = previous << 7 | line;
        previous = line;
    }
}

void add_points(const Polygon& polygon, const ReferencePlane& plane, uint32_t base, const Wanted& wanted, Manifold& out,
                float slope) {
    ClipPoint low[kMaxClip];
    int count = 0;
    for (int i = 0; i < polygon.count; ++i) {
        if (polygon.points[i].z <= wanted.margin) low[count++] = polygon.points[i];
    }
    if (count == 0) return;
    Chosen chosen = {count, {0, 1, 2, 3}};
    if (count > 4) chosen = keep(low, count, base, wanted, slope);
    if (chosen.count == 0) chosen = choose(low, count, slope);
    if (chosen.count == 4) break_circle(low, chosen.index);
    for (int i = 0; i < chosen.count && out.count < 4; ++i) {
        const ClipPoint& p = low[chosen.index[i]];
        out.points[out.count++] = {plane.u * p.x + plane.v * p.y + plane.normal * (plane.offset + 0.5f * p.z), p.z,
                                   base | p.id};
    }
}

// Of all corners within the margin none takes the place of one that it lies above by more than 55 degrees, as the top
// of a thin plate would that of its bottom: add_points' diagonals are sqrt 2 long. Steeper ones leave corners out that
// a plate comes down on as it turns.
constexpr float kSlope = 1;

float touch_plane(std::span<const Vec3f> corners, float radius, const Vec3f& up, float height, const Wanted& wanted,
                  Manifold& out) {
    // Tangents from the shape's own axes turn with it, so that the same corners are chosen every frame.
    int k = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(up[i]) < std::fabs(up[k]) - 1e-3f) k = i;
    }
    ReferencePlane plane;
    plane.normal = up;
    plane.u = (Vec3f::Unit(k) - up * up[k]).normalized();
    plane.v = up.cross(plane.u);
    plane.offset = -height;
    Polygon polygon;
    float least = 1e30f;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3f& p = corners[i];
        const float z = up.dot(p) + height - radius;
        least = std::min(least, z);
        if (z > wanted.margin) continue;
        polygon.points[polygon.count++] = {plane.u.dot(p), plane.v.dot(p), z, vertex_feature(int(i))};
    }
    if (polygon.count == 0) return least;
    add_points(polygon, plane, 0, wanted, out, kSlope);
    out.normal = -up;
    return 0;
}

void reduce(Polygon& points) {
    const Chosen chosen = choose(points.points, points.count);
    ClipPoint kept[4];
    for (int i = 0; i < chosen.count; ++i) kept[i] = points.points[chosen.index[i]];
    std::copy(kept, kept + chosen.count, points.points);
    points.count = chosen.count;
}

void add_beside(const Manifold& face, Manifold& edges) {
    constexpr float kSamePlace = 0.25f;  // of the way to the farthest point
    const float along = face.normal.dot(edges.normal);
    if (face.count == 0 || edges.count != 1 || along < kSamePlane) return;
    const ContactPoint crossing = edges.points[0];
    auto away = [&](const ContactPoint& p) { return (p.position - crossing.position).norm(); };
    float farthest = 0;
    for (int i = 0; i < face.count; ++i) farthest = std::max(farthest, away(face.points[i]));
    for (int i = 0; i < face.count && edges.count < 4; ++i) {
        ContactPoint point = face.points[i];
        if (away(point) <= kSamePlace * farthest) continue;
        point.separation = std::max(along * point.separation, crossing.separation);
        edges.points[edges.count++] = point;
    }
}

float deepest(const Manifold& manifold) {
    float least = 1e30f;
    for (int i = 0; i < manifold.count; ++i) least = std::min(least, manifold.points[i].separation);
    return least;
}

}  // namespace taut::collision
