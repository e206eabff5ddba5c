#include "collision/manifold.h"

#include <algorithm>
#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

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

// (x, y, z, 0): an id would be a subnormal number, with which processors are slow.
#if defined(__SSE2__)
Eigen::Array4f place_of(const ClipPoint& point) {
    const __m128 three = _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1));
    Eigen::Array4f place;
    _mm_store_ps(place.data(), _mm_and_ps(_mm_loadu_ps(&point.x), three));
    return place;
}
#else
Eigen::Array4f place_of(const ClipPoint& point) { return {point.x, point.y, point.z, 0}; }
#endif

// A polygon while it is cut: its corners, and the lines from each to the next.
struct Outline {
    int count = 0;
    Eigen::Array4f corner[kMaxClip + 1];  // one is room for the first once more
    uint32_t line[kMaxClip];

    explicit Outline(const Polygon& polygon) : count(polygon.count) {
        for (int i = 0; i < count; ++i) {
            corner[i] = place_of(polygon.points[i]);
            line[i] = polygon.points[i].id;
        }
    }
    Outline() {}
};

// Where a side cuts an outline.
struct Cuts {
    using Four = Eigen::Map<Eigen::Array4f>;
    static_assert(kMaxClip % 4 == 0);

    alignas(16) float outside[kMaxClip + 4];  // how far each corner is, and once more the first [m]
    alignas(16) float crossing[kMaxClip];     // on the line from it to the next, in parts of that from the inner end
    bool any = false;                         // is further than slack

    Cuts(const Outline& outline, const Side& side, float slack) {
        for (int i = 0; i < outline.count; ++i) {
            outside[i] = side.x * outline.corner[i].x() + side.y * outline.corner[i].y() - side.offset;
            any |= outside[i] > slack;
        }
    }
    void find_crossings(int count) {
        outside[count] = outside[0];
        for (int i = 0; i < count; i += 4) {
            const Eigen::Array4f from = Four(outside + i), to = Four(outside + i + 1);
            const Eigen::Array4f inner = from.min(to).min(0.0f);
            Four(crossing + i) = inner / (inner - from.max(to));
        }
    }
};

// Sutherland-Hodgman, one side. A crossing is cut on the side itself. Each end and each crossing is written, and
// counted where there is one: branches would be mispredicted.
void cut(Outline& in, const Cuts& cuts, uint32_t side, float slack, Outline& out) {
    in.corner[in.count] = in.corner[0];
    int made = 0;
    for (int i = 0; i < in.count && made + 2 <= kMaxClip; ++i) {
        const int from_in = cuts.outside[i] <= slack, to_in = cuts.outside[i + 1] <= slack;  // 0 or 1
        const uint32_t line = in.line[i];
        out.corner[made] = in.corner[i];
        out.line[made] = line;
        made += from_in;
        const Eigen::Array4f &inner = in.corner[i + 1 - from_in], &outer = in.corner[i + from_in];
        out.corner[made] = inner + (outer - inner) * cuts.crossing[i];
        out.line[made] = line ^ ((line ^ side) & uint32_t(-from_in));  // the side, where it leaves
        made += from_in ^ to_in;
    }
    out.count = made;
}

}  // namespace

void clip(Polygon& polygon, std::span<const Side> sides, float slack) {
    Outline outline(polygon), spare;
    Outline *in = &outline, *out = &spare;
    for (size_t s = 0; s < sides.size() && in->count > 0; ++s) {
        Cuts cuts(*in, sides[s], slack);
        if (!cuts.any) continue;
        cuts.find_crossings(in->count);
        cut(*in, cuts, kSideLine + uint32_t(s), slack, *out);
        std::swap(in, out);
    }
    polygon.count = in->count;
    uint32_t previous = in->count > 0 ? in->line[in->count - 1] : 0;
    for (int i = 0; i < in->count; ++i) {
        const Eigen::Array4f& p = in->corner[i];
        polygon.points[i] = {p.x(), p.y(), p.z(), previous << 7 | in->line[i]};
        previous = in->line[i];
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
